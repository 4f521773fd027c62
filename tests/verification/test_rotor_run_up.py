"""The two-rotor line of seed M on the engine against the independent model in scipy (reference_rotors.py)."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid
from scipy.linalg import eig

import hdrive_mbs as hm
from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices, LineSystem
from hdrive_mbs.analysis.whirl.rotor_point import rotor_point
from hdrive_mbs.network.coupling import Gyroscope
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network
from models.two_rotor_line import build
from tests.verification import reference_rotor_values as values
from tests.verification import reference_whirl
from tests.verification.reference_rotors import GRAVITY, Line, System, full, reference_line
from tests.verification.reference_run_up import RunUp, exponential, start

ROTORS = values.ROTORS
PLACES = {"drive": "drive_disc", "A": "bearing_a", "B": "bearing_b", "rotor_1": "rotor_1", "rotor_2": "rotor_2"}
"""Place of each station of the reference."""
BEARINGS = ("bearing_a", "bearing_b")


def with_gravity(scene: hm.Scene) -> hm.Scene:
    return replace(scene, parts={**scene.parts, "gravity": hm.Gravity(y=-GRAVITY)})


def with_cubic_bearings(scene: hm.Scene) -> hm.Scene:
    """Bearings with 1.2e7 N/m and 1e18 N/m^3 in x and in y."""
    parts = dict(scene.parts)
    for name in BEARINGS:
        bearing = parts[name]
        assert isinstance(bearing, hm.Bearing)
        linear = {field: value for field, value, _ in bearing.law.fields()} | {"stiffness_xx": 1.2e7, "stiffness_yy": 1.2e7}
        parts[name] = bearing.replacing(law=hm.PowerBearing(**linear, power_stiffness_xx=1e18, power_stiffness_yy=1e18))
    return replace(scene, parts=parts)


def without_damping(scene: hm.Scene) -> hm.Scene:
    parts = dict(scene.parts)
    for name, part in parts.items():
        if isinstance(part, hm.ShaftSection):
            parts[name] = part.replacing(damping=0.0)
        if isinstance(part, hm.Bearing):
            assert part.housing is not None
            free = hm.LinearBearing.from_matrices(stiffness=part.law.stiffness_matrix(), damping=np.zeros((6, 6)))
            parts[name] = part.replacing(law=free, housing=part.housing.replacing(damping_x=0.0, damping_y=0.0))
    return replace(scene, parts=parts)


UNDAMPED = replace(reference_line().with_bearings(damping=0.0, tilt_damping=0.0, housing_damping=0.0, axial_damping=0.0), damping=0.0)


@dataclass(frozen=True)
class Case:
    """The same line twice."""

    scene: Callable[[], hm.Scene]
    line: Line


CASES = {
    "m_ref full": Case(build, reference_line()),
    "m_ref2 full": Case(lambda: build(variant="damped_bearings"), reference_line(damped_in_bearing=True)),
    "m_ref full, gravity": Case(lambda: with_gravity(build()), reference_line(gravity=True)),
    "m_ref full, bearings 1.2e7 N/m and 1e18 N/m3": Case(
        lambda: with_cubic_bearings(build()), reference_line().with_bearings(stiffness=1.2e7, cubic=1e18)
    ),
}
"""Names as in the stored values of the reference."""
CUBIC_AND_GRAVITY = reference_line(gravity=True).with_bearings(stiffness=1.2e7, cubic=1e18)


# -- between the two ---------------------------------------------------------------------------------


def channel(label: str, rate: bool = False) -> str:
    """The channel of a coordinate of the reference."""
    station, _, coordinate = label.partition(".")
    if coordinate == "phi":
        return f"{PLACES[station]}.{'speed' if rate else 'angle'}"
    return f"{PLACES[station]}.{coordinate}{'_rate' if rate else ''}"


def states(response: hm.Response, system: System) -> np.ndarray:
    """Rows [q, q'] of the reference."""
    return np.array([response.values[channel(label, rate)] for rate in (False, True) for label in system.labels]).T


def as_reference(response: hm.Response, line: Line) -> RunUp:
    """The histories as a run of the reference, whose peaks and energies are then calculated by its own code."""
    system, times = full(line), response.times
    rows = states(response, system)
    v = rows[:, len(system.labels) :]
    torque = np.array([line.drive(speed) for speed in v[:, 5]])
    work = cumulative_trapezoid(torque, rows[:, 5], initial=0.0)
    dissipated = cumulative_trapezoid(np.einsum("ni,ij,nj->n", v, system.damping, v), times, initial=0.0)
    return RunUp(system, times, rows, work, dissipated)


def at_rest(scene: hm.Scene) -> dict[str, float]:
    """Static deflection as initial values."""
    point = rotor_point(scene, 0.0)
    return {body.name: point.angles[body.name] for body in scene.network().bodies if body.lateral}


@functools.cache
def run_up(name: str, step: float) -> tuple[hm.Response, RunUp]:
    scene = CASES[name].scene()
    solver = hm.Trapezoidal(step=step, newton_tolerance=1e-5)
    response = hm.simulate(scene, values.END, solver=solver, initial=at_rest(scene), progress=False)
    return response, as_reference(response, CASES[name].line)


def errors(name: str, step: float) -> dict[str, dict[str, float]]:
    """Relative error of amplitude and speed of the peak of each rotor against the stored values."""
    run, wanted = run_up(name, step)[1], values.load()[name]["peaks"]
    peaks = {rotor: run.peak(rotor) for rotor in ROTORS}
    return {
        "amplitude": {rotor: peak.amplitude / wanted[rotor]["amplitude"] - 1.0 for rotor, peak in peaks.items()},
        "speed": {rotor: peak.speed / wanted[rotor]["speed"] - 1.0 for rotor, peak in peaks.items()},
    }


# -- run-up ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", CASES)
def test_peaks_and_their_speeds_are_those_of_the_reference_within_a_tenth_of_a_percent(name: str) -> None:
    found = errors(name, 1e-4)
    for quantity in ("amplitude", "speed"):
        for rotor in ROTORS:
            assert abs(found[quantity][rotor]) < 1e-3, found
    response, run = run_up(name, 1e-4)
    assert set(response.lowering.values()) <= {"native", "symbolic"}
    assert response.values["rotor_1.radial"].max() == pytest.approx(run.distance("rotor_1").max(), rel=1e-12)
    stored = values.load()[name]
    # nothing damps torsion in M-REF2: it rings by 0.05 rad/s at 965 rad/s, and w^3 h^2 t/12 = 2 rad late
    assert run.rate("rotor_1.phi")[-1] == pytest.approx(stored["final_speed"], rel=1e-4 if name == "m_ref2 full" else 1e-6)
    assert run.work[-1] == pytest.approx(stored["work"], rel=1e-5)


@pytest.mark.parametrize("name", CASES)
def test_error_of_the_peaks_falls_with_the_square_of_the_step(name: str) -> None:
    coarse, fine = (errors(name, step)["amplitude"] for step in (1e-4, 5e-5))
    for rotor in ROTORS:
        assert math.log2(coarse[rotor] / fine[rotor]) == pytest.approx(2.0, abs=0.3)
        # without the term in h^2 a tenth of it is left, so the two models agree to that
        assert abs(4.0 * fine[rotor] - coarse[rotor]) / 3.0 < 5e-5


@pytest.mark.parametrize("name", CASES)
def test_damping_turns_as_much_energy_into_heat_as_in_the_reference(name: str) -> None:
    coarse, fine = (run_up(name, step)[1].dissipated[-1] for step in (1e-4, 5e-5))
    assert (4.0 * fine - coarse) / 3.0 == pytest.approx(values.load()[name]["dissipated"], rel=1e-4)


# -- histories -----------------------------------------------------------------------------------------


def test_static_deflection_is_that_of_the_reference() -> None:
    """The reference does not hold the spin: m g e = 1.6e-3 N m turns rotor 1, and m e phi'' = 6e-6 N lifts it."""
    deflection = at_rest(with_gravity(with_cubic_bearings(build())))
    system = full(CUBIC_AND_GRAVITY)
    wanted = dict(zip(system.labels, start(system)))
    lifted = 8.0 * 20e-6 * (8.0 * GRAVITY * 20e-6 / 0.04) / (8.0 * GRAVITY)
    assert lifted == pytest.approx(8e-8, rel=0.01)
    for key in ("x", "y", "z", "psi", "theta"):
        largest = max(abs(value) for label, value in wanted.items() if label.endswith(f".{'y' if key in 'xyz' else 'psi'}"))
        for station, place in PLACES.items():
            assert deflection[f"{place}.{key}"] == pytest.approx(wanted[f"{station}.{key}"], abs=2.0 * lifted * largest)
    for station in "AB":
        across = wanted[f"{station}.y"] - wanted[f"{station}.housing.y"]
        assert across < -1e-6
        assert deflection[f"{PLACES[station]}.across_y"] == pytest.approx(across, rel=2.0 * lifted)


def test_histories_of_all_coordinates_follow_the_reference_through_a_critical_speed() -> None:
    """From the static deflection at 360 rad/s, with gravity and cubic bearings, 0.03 s."""
    scene, system = with_gravity(with_cubic_bearings(build())), full(CUBIC_AND_GRAVITY)
    wanted = exponential(system, end=0.03, step=2.5e-5, state=start(system, 360.0), keep=4).states
    size = np.max(np.abs(wanted), axis=0)
    runs = []
    for step in (4e-6, 2e-6):
        solver = hm.Trapezoidal(step=step)
        response = hm.simulate(scene, 0.03, solver=solver, initial=at_rest(scene), initial_speed=360.0, progress=False)
        runs.append(states(response, system)[:: round(1e-4 / step)])
    coarse, fine = (np.max(np.abs(run - wanted) / size) for run in runs)
    assert math.log2(coarse / fine) == pytest.approx(2.0, abs=0.1)
    # each over its own largest value, also the axial motion of 1e-11 m that only the exact equations of a rotor have
    assert np.max(np.abs((4.0 * runs[1] - runs[0]) / 3.0 - wanted) / size) < 1e-6


# -- equations -----------------------------------------------------------------------------------------


def moment_of(network: Network, q: Mapping[str, float], v: Mapping[str, float]) -> Moment:
    """The network at a state of the reference."""
    known: list[dict[str, float]] = []
    for state in (q, v):
        named = {f"{PLACES[label.partition('.')[0]]}.{label.partition('.')[2]}": value for label, value in state.items()}
        named |= {name.removesuffix(".phi"): value for name, value in named.items() if name.endswith(".phi")}
        for bearing in BEARINGS:
            named |= {f"{bearing}.across_{axis}": named[f"{bearing}.{axis}"] - named[f"{bearing}.housing.{axis}"] for axis in "xy"}
        known.append({body.name: named[body.name] for body in network.bodies})
    return network.moment(np.float64(0.0), *known, {})


@pytest.mark.parametrize("name", ["m_ref full", "m_ref2 full", "m_ref full, bearings 1.2e7 N/m and 1e18 N/m3"])
def test_network_has_the_accelerations_and_the_kinetic_energy_of_the_reference_at_any_state(name: str) -> None:
    network, system = CASES[name].scene().network(), full(CASES[name].line)
    rng = np.random.default_rng(42)
    size = {"x": 1e-4, "y": 1e-4, "z": 1e-4, "psi": 1e-2, "theta": 1e-2, "phi": 3.0}
    scale = np.array([size[label.rpartition(".")[2]] for label in system.labels])
    spin = np.array([300.0 * label.endswith(".phi") for label in system.labels])
    for _ in range(5):
        q, v = scale * rng.normal(size=len(scale)), 300.0 * scale * rng.normal(size=len(scale)) + spin
        v[5] = 1000.0 + 3.0 * rng.normal()  # in the band of the drive
        moment = moment_of(network, dict(zip(system.labels, q)), dict(zip(system.labels, v)))
        found, wanted = network.accelerations(moment), dict(zip(system.labels, system.acceleration(q, v)))
        for station, place in PLACES.items():
            for key in size:
                ours = float(found[place if key == "phi" else f"{place}.{key}"])
                largest = max(abs(value) for label, value in wanted.items() if label.endswith(f".{key}"))
                assert ours == pytest.approx(wanted[f"{station}.{key}"], abs=1e-9 * largest)
        assert float(network.kinetic_energy(moment)) == pytest.approx(system.kinetic_energy(q, v), rel=1e-12)


# -- small motions ---------------------------------------------------------------------------------------


def linear_system(network: Network, lines: LineMatrices, speed: float) -> LineSystem:
    spins = {body.name for body in network.bodies if not body.lateral}
    return lines.at(dict.fromkeys(lines.names, 0.0), {name: speed if name in spins else 0.0 for name in lines.names})


def roots(system: LineSystem) -> np.ndarray:
    n = len(system.names)
    lower = -np.linalg.solve(system.mass, np.hstack([system.stiffness, system.damping]))
    found: np.ndarray = np.linalg.eigvals(np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), lower]))
    return found


LINEAR = ("m_ref full", "m_ref2 full")


def coasting(scene: hm.Scene) -> hm.Scene:
    """Balanced, and without its drive.

    A lean of 5e-4 rad moves the mean moment of inertia of rotor 1 by 1e-7, which the reference leaves out.
    """
    parts = {name: part for name, part in scene.parts.items() if name != "drive"}
    parts["rotor_1"] = parts["rotor_1"].replacing(eccentricity=0.0, tilt=0.0)
    return replace(scene, parts=parts, connections=[scene.connections[0][1:]])


@pytest.mark.parametrize("name", LINEAR)
@pytest.mark.parametrize("speed", [0.0, 500.0, 1000.0])
def test_damped_modes_are_those_of_the_reference(name: str, speed: float) -> None:
    network = coasting(CASES[name].scene()).network()
    found = [
        root for root in roots(linear_system(network, LineMatrices(network), speed)) if root.imag > 0.14 * abs(root) and root.imag > 1.0
    ]
    found = sorted((root for root in found if root.imag < 4000.0), key=lambda root: root.imag)
    wanted = values.load()[name]["modes"][f"{speed:.0f}"]
    assert [root.imag for root in found] == pytest.approx([mode["frequency"] for mode in wanted], rel=1e-8)
    # frequencies of a pair at rest are equal, and which is first does not matter: their damping is equal too
    assert [-root.real / abs(root) for root in found] == pytest.approx([mode["damping_ratio"] for mode in wanted], rel=1e-7)


@pytest.mark.parametrize("speed", [0.0, 300.0, 1000.0])
def test_undamped_frequencies_are_those_of_the_reference(speed: float) -> None:
    network = coasting(without_damping(build())).network()
    found = sorted(root.imag for root in roots(linear_system(network, LineMatrices(network), speed)) if root.imag > 1.0)
    wanted = [frequency for frequency, _ in reference_whirl.undamped_frequencies(full(UNDAMPED), speed) if frequency > 1.0]
    assert len(wanted) == 33, "34 coordinates, less free rotation"
    assert found == pytest.approx(wanted, rel=1e-8)


@pytest.mark.parametrize("name", LINEAR)
def test_undamped_critical_speeds_are_those_of_the_reference(name: str) -> None:
    """K Q = W^2 (M - i G) Q, with G from the damping matrix of the spinning undamped line at unit speed."""
    network = coasting(without_damping(CASES[name].scene())).network()
    system = linear_system(network, LineMatrices(network), 1.0)
    keep = [k for k, body in enumerate(network.bodies) if body.lateral and not body.name.endswith(".z")]
    at = np.ix_(keep, keep)
    squares = eig(system.stiffness[at], (system.mass - 1j * system.damping)[at], right=False)
    found = sorted(math.sqrt(square.real) for square in squares if 0.0 < square.real < 1500.0**2)
    assert found == pytest.approx([speed["undamped"] for speed in values.load()[name]["critical_speeds"]], rel=1e-8)


# -- energy ----------------------------------------------------------------------------------------------


def test_undamped_line_keeps_all_the_work_of_its_motor_as_kinetic_and_elastic_energy() -> None:
    scene = without_damping(build())
    response = hm.simulate(scene, values.END, solver=hm.Trapezoidal(step=1e-4, newton_tolerance=1e-8), progress=False)
    run = as_reference(response, UNDAMPED)
    assert run.work[-1] == pytest.approx(values.load()["m_ref full"]["work"], rel=1e-4)
    assert run.dissipated[-1] == 0.0
    assert abs(run.energy_error) < 1e-6
    # nearly all of the energy is that of the spin; what is left of it is small beside the vibration too
    vibration = run.system.potential_energy(run.states[-1, : len(run.system.labels)])
    assert abs(run.energy_error) * run.work[-1] < 0.01 * vibration


def test_damped_line_keeps_the_work_of_its_motor_less_the_heat() -> None:
    response, run = run_up("m_ref full", 1e-4)
    assert response.scene is not None
    assert abs(run.energy_error) < 1e-6
    assert run.dissipated[-1] > 10.0 * abs(run.energy_error) * run.work[-1]


def test_third_line_of_8_as_printed_makes_energy_out_of_nothing() -> None:
    """Jp phi'' + Jp psi' theta' = Mz takes the power Jp phi' psi' theta' without a counterpart; the package has no such term.

    T = Jt (psi'^2 + theta'^2)/2 + Jp phi'^2/2; the first two lines take -Jp phi' theta' psi' + Jp phi' psi' theta' = 0.
    """
    network = build().network()
    gyroscopes = [element for element in network.elements if isinstance(element, Gyroscope)]
    assert {gyroscope.spin for gyroscope in gyroscopes} == set(BEARINGS)
    for gyroscope in gyroscopes:
        moment = network.random_moment(np.random.default_rng(8), 50)
        torques = gyroscope.contribution(moment)
        assert set(torques) == {gyroscope.psi, gyroscope.theta}
        powers = {name: torque * moment.speed(name) for name, torque in torques.items()}
        largest = np.max(np.abs(powers[gyroscope.psi]))
        assert np.max(np.abs(sum(powers.values()))) <= 1e-15 * largest
        printed = -gyroscope.polar * moment.speed(gyroscope.psi) * moment.speed(gyroscope.theta) * moment.speed(gyroscope.spin)
        assert np.max(np.abs(printed)) == pytest.approx(largest)
