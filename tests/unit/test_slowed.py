"""Fast vibrations of a line are slowed, and no other motion notices."""

from __future__ import annotations

import numpy as np
import pytest

from hdrive_mbs.compiled.idle_coordinates import without_idle
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.compiled.rotor_equations import masses
from hdrive_mbs.compiled.slowed import SMALL, Slowed, slowed_accelerations, slowed_vibrations
from hdrive_mbs.compiled.step_limit import jacobian, longest_step, stable_step
from hdrive_mbs.diagnosis.pace import CLOSE
from hdrive_mbs.errors import SimulationError
from hdrive_mbs.network.network import Network
from models import drive_bench, rotor_bench

FASTEST = 8800.0
SAMPLE = rotor_bench.SAMPLE_TIME


@pytest.fixture(scope="module")
def network() -> Network:
    return without_idle(rotor_bench.build("run_up").network())


def changed(network: Network, slowed: tuple[Slowed, ...]) -> np.ndarray:
    """Q of q'' -> Q q'', over the coordinates."""
    names = [body.name for body in network.bodies]
    rows = slowed_accelerations(dict(zip(names, np.eye(len(names)), strict=True)), slowed)
    return np.array([rows[name] for name in names])


def lateral_part(network: Network) -> list[int]:
    return [k for k, body in enumerate(network.bodies) if body.lateral]


def squares(network: Network, change: np.ndarray) -> np.ndarray:
    """Squares of the angular frequencies of the lateral and tilting vibrations at rest without damping, rising."""
    n = len(network.bodies)
    rates = change @ jacobian(network)[n : 2 * n, :n]
    at = np.ix_(lateral_part(network), lateral_part(network))
    return np.sort(np.linalg.eigvals(-rates[at]).real)


def test_fast_vibrations_get_the_frequency_that_was_asked_for_and_the_others_keep_theirs(network: Network) -> None:
    slowed = slowed_vibrations(network, FASTEST)
    before, after = (np.sqrt(squares(network, change)) for change in (np.eye(len(network.bodies)), changed(network, slowed)))
    slow = before < FASTEST
    assert len(slowed) == np.count_nonzero(~slow) == 6
    assert before[-1] > 2.5 * FASTEST
    np.testing.assert_allclose(after[: np.count_nonzero(slow)], before[slow], rtol=2e-6)  # SMALL squared, twice
    np.testing.assert_allclose(after[np.count_nonzero(slow) :], FASTEST, rtol=SMALL)


def test_the_masses_that_stand_for_it_are_symmetric_positive_and_grow_in_fast_vibrations_alone(network: Network) -> None:
    at = np.ix_(lateral_part(network), lateral_part(network))
    names, matrix = masses(network)
    assert names == [body.name for body in network.bodies]
    mass = np.asarray(matrix, float)[at]
    inverse = changed(network, slowed_vibrations(network, FASTEST))[at] @ np.linalg.inv(mass)
    scale = np.sqrt(np.diag(mass))
    scaled = inverse * np.outer(scale, scale)
    np.testing.assert_allclose(scaled, scaled.T, atol=1e-9)
    values = np.linalg.eigvalsh(0.5 * (scaled + scaled.T))
    assert values[0] > 0.0
    np.testing.assert_allclose(values[6:], 1.0, rtol=1e-5)
    assert (values[:6] < 0.999).all()


def test_a_damped_spinning_line_takes_longer_steps_and_nothing_grows(network: Network) -> None:
    change = changed(network, slowed_vibrations(network, FASTEST))
    n = len(network.bodies)
    whole = np.eye(2 * n + len(network.states))
    whole[n : 2 * n, n : 2 * n] = change
    for speed in (0.0, 1000.0):
        rates = jacobian(network, speeds={rotor.coordinates[5]: speed for rotor in network.rotors})
        before, after = np.linalg.eigvals(rates), np.linalg.eigvals(whole @ rates)
        assert stable_step(after) > SAMPLE > 2.0 * stable_step(before)
        assert after.real.max() < before.real.max() + 1e-3
        seen = before[(np.abs(before.imag) > 100.0) & (np.abs(before.imag) < 3000.0)]
        apart = np.abs(after[None, :] - seen[:, None]).min(axis=1) / np.abs(seen)
        assert len(seen) > 10
        assert apart.max() < 1e-4


def test_with_masses_and_stiffnesses_off_nothing_grows_and_slow_vibrations_are_theirs(network: Network) -> None:
    """All in one, by a tenth and more: what a fit moves, slowed as the nominal line is."""
    slowed = slowed_vibrations(network, FASTEST)
    factors = {"rotor_1_mass": 1.1, "rotor_2_mass": 0.9, "ring_mass": 1.2, "bearing_stiffness": 0.8, "youngs_modulus": 1.1}
    other = rotor_bench.build("run_up", **{name: factor * rotor_bench.NOMINAL[name] for name, factor in factors.items()})
    line = without_idle(other.network())
    n, change = len(line.bodies), changed(line, slowed)
    whole = np.eye(2 * n + len(line.states))
    whole[n : 2 * n, n : 2 * n] = change
    rates = jacobian(line, speeds={rotor.coordinates[5]: 500.0 for rotor in line.rotors})
    before, after = np.linalg.eigvals(rates), np.linalg.eigvals(whole @ rates)
    assert after.real.max() < before.real.max() + 1e-3
    assert stable_step(after) > SAMPLE
    seen = before[(np.abs(before.imag) > 100.0) & (np.abs(before.imag) < 3000.0)]
    apart = np.abs(after[None, :] - seen[:, None]).min(axis=1) / np.abs(seen)
    assert apart.max() < 1e-3


def test_what_a_changed_stiffness_adds_to_slow_vibrations_is_of_second_order_and_as_derived(network: Network) -> None:
    """(w_k^2/w_0^2 - 1) ((M v_k).u)^2 of the mass of each: half of it of its frequency."""
    slowed, names = slowed_vibrations(network, FASTEST), [body.name for body in network.bodies]
    at = lateral_part(network)
    shifts = []
    for size in (0.2, 0.1, 0.05):
        scene = rotor_bench.build("run_up", bearing_stiffness=(1.0 - size) * rotor_bench.NOMINAL["bearing_stiffness"])
        line = without_idle(scene.network())
        n, mass = len(line.bodies), np.asarray(masses(line)[1], float)[np.ix_(at, at)]
        stiffness = -mass @ jacobian(line)[n : 2 * n, :n][np.ix_(at, at)]
        root = np.linalg.cholesky(mass)
        shapes = np.linalg.solve(root.T, np.linalg.eigh(np.linalg.solve(root, np.linalg.solve(root, stiffness).T))[1])
        before, after = squares(line, np.eye(n)), squares(line, changed(line, slowed))
        slow = np.flatnonzero(before < 3000.0**2)
        derived = np.zeros(len(slow))
        for vibration in slowed:
            weights, shares = np.zeros(len(names)), np.zeros(len(names))
            for name, weight, share in vibration.parts:
                weights[names.index(name)], shares[names.index(name)] = weight, share
            taken = float(weights @ shares)  # b = 1 - w_0^2/w_k^2, since v.M v = 1
            derived += taken / (1.0 - taken) * (weights[at] @ shapes[:, slow]) ** 2
        shift = 1.0 - after[slow] / before[slow]
        np.testing.assert_allclose(shift, derived, rtol=0.05, atol=2e-7)
        shifts.append(shift.max())
    # below a twentieth what SMALL leaves out, squared, shows beside it
    assert shifts[1] / shifts[2] == pytest.approx(4.0, rel=0.1)


def test_planes_that_are_alike_are_slowed_apart() -> None:
    """Their vibrations are equal, and any mixture of the two would be one too."""
    alike = rotor_bench.build("run_up", support_stiffness_y=rotor_bench.NOMINAL["support_stiffness_x"])
    found = slowed_vibrations(without_idle(alike.network()), FASTEST)
    assert len(found) == 6
    for vibration in found:
        planes = {name.rpartition(".")[2] for name, _, _ in vibration.parts}
        assert planes <= {"x", "theta"} or planes <= {"y", "psi"}


def test_a_run_in_whole_samples_is_that_of_the_line_as_it_is(network: Network) -> None:
    channels = {column: rotor_bench.CHANNELS[column] for column in ("r1_x", "r2_y", "h1_ax", "h2_ay")}
    names = tuple(channels.values())
    start = dict.fromkeys(rotor_bench.POSITIONS, 20.0)
    exact = CompiledLine(network, names).run(8000, SAMPLE, step=SAMPLE / 12, speeds=start)
    quick = CompiledLine(network, names, slowed_vibrations(network, FASTEST)).run(8000, SAMPLE, step=SAMPLE, speeds=start)
    for column, name in channels.items():
        apart = np.sqrt(np.mean((exact.values[name] - quick.values[name]) ** 2)) / rotor_bench.NOISE[column]
        assert apart < CLOSE, column
        assert np.abs(exact.values[name]).max() > 30.0 * rotor_bench.NOISE[column]
    with pytest.raises(SimulationError):
        CompiledLine(network, names).run(8000, SAMPLE, step=SAMPLE, speeds=start)
    assert longest_step(network) < SAMPLE


def test_lines_without_fast_vibrations_stay_as_they_are(network: Network) -> None:
    assert slowed_vibrations(network, 1e6) == ()
    assert slowed_vibrations(drive_bench.build().network(), 1.0) == ()
    plain, slowed = (CompiledLine(network, ["rotor_1.x"], item) for item in ((), slowed_vibrations(network, 1e6)))
    assert plain.structure == slowed.structure
    found = {"a": 1.0, "b": 2.0}
    away = Slowed((("a", 1.0, 0.5), ("gone", 1.0, 0.5)))
    assert slowed_accelerations(found, [away]) == found
    there = Slowed((("a", 3.0, 0.5), ("b", 1.0, 0.25)))
    assert slowed_accelerations(found, [there]) == {"a": 1.0 - 0.5 * 5.0, "b": 2.0 - 0.25 * 5.0}
