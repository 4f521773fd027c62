"""Rotor lines as machine code: the equations against the exact ones, runs against the engine, steps against theory."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import numpy.typing as npt
import pytest

import hdrive_mbs as hm
from hdrive_mbs.analysis.initial_values import initial_values
from hdrive_mbs.analysis.time_response import channel_of
from hdrive_mbs.compiled import springs as springs_
from hdrive_mbs.compiled.constant_mass import ConstantMass
from hdrive_mbs.compiled.idle_coordinates import idle_coordinates, without_idle
from hdrive_mbs.compiled.line import CompiledLine, CompiledRun
from hdrive_mbs.compiled.linear_forces import linear_forces
from hdrive_mbs.compiled.rotor_equations import coupled_accelerations
from hdrive_mbs.compiled.springs import springs, springs_of
from hdrive_mbs.compiled.step_limit import longest_step
from hdrive_mbs.errors import ParameterError, PlaceError, SimulationError
from hdrive_mbs.network.matrix_element import MatrixElement
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network
from hdrive_mbs.shafts.beam import Beam
from models import rotor_bench, two_rotor_line
from tests.unit.rotor_scenes import MASS, POLAR, STIFFNESS, constant, jeffcott
from tests.unit.test_rotor_whirl import UNBALANCED, geared

FloatArray = npt.NDArray[np.float64]
SAMPLE = rotor_bench.SAMPLE_TIME


def heavy_line() -> hm.Scene:
    """Two rotors on a shaft with mass: constant masses far from diagonal."""
    heavy = {f"section_{k}.density": 7850.0 for k in (1, 2, 3, 4)} | {f"section_{k}.elements": 2.0 for k in (1, 2, 3, 4)}
    return two_rotor_line.build().replacing(heavy)


def measured_spin(record: str) -> hm.Scene:
    """The bench with its drive end on the angle that its controller would give it."""
    angles, _, _ = rotor_bench.held_control(record, rotor_bench.undriven(record))
    return rotor_bench.build(record, spin=(rotor_bench.sample_times(record), angles[:-1]))


def with_part(scene: hm.Scene, part: hm.Component, *joined: str) -> hm.Scene:
    """The scene with one more part, joined to these."""
    more = [("more", *joined)] if joined else []
    return hm.Scene(name="more", parts={**scene.parts, "more": part}, connections=[*scene.connections, *more])


SCENES = {
    "bench": rotor_bench.build("run_up"),
    "bench with its spin prescribed": measured_spin("run_up"),
    "two rotors": two_rotor_line.build(),
    "two rotors in cubic bearings": two_rotor_line.build(cubic=1e14),
    "heavy shaft": heavy_line(),
    "condensed bearings": two_rotor_line.build("improved"),
    "backwards through a gear, with a lever": geared(UNBALANCED),
    "an inertia that only turns with the rotor": with_part(jeffcott(), hm.Inertia(inertia=0.02), "disc"),
}


def whirling(network: Network, tilt: float, count: int = 6, *, seed: int = 1) -> Moment:
    """Lateral motions of about ``tilt`` [m, rad] at 500 rad/s, twists that accelerate the spins, nearly no axial motion."""
    rng = np.random.default_rng(seed)
    lateral = {body.name for body in network.bodies if body.lateral}
    size = {body.name: tilt * (1e-6 if body.name.endswith(".z") else 1.0) for body in network.bodies}
    turned = rng.uniform(0.0, 2.0 * np.pi, count)
    angles = {name: size[name] * rng.normal(size=count) if name in lateral else turned + 1e-5 * rng.normal(size=count) for name in size}
    speeds = {
        name: 500.0 * (size[name] * rng.normal(size=count) if name in lateral else 1.0 + 0.01 * rng.normal(size=count)) for name in size
    }
    states = {state.name: rng.normal(size=count) for state in network.states}
    return network.moment(np.linspace(0.5, 1.0, count), angles, speeds, states)


def differences(network: Network, tilt: float) -> dict[str, float]:
    """Largest difference of accelerations to the exact ones, by kind, relative to the largest one of that kind."""
    moment = whirling(network, tilt)
    exact, found = network.accelerations(moment), coupled_accelerations(network, moment)
    assert list(found) == list(exact)
    kinds: dict[str, list[str]] = {}
    for body in network.bodies:
        if not body.name.endswith(".z"):
            kinds.setdefault("spin" if not body.lateral else body.unit, []).append(body.name)
    return {
        kind: max(float(np.max(np.abs(found[n] - exact[n]))) for n in names) / max(float(np.max(np.abs(exact[n]))) for n in names)
        for kind, names in kinds.items()
    }


# -- the equations -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SCENES)
def test_what_the_equations_leave_out_falls_with_the_square_of_the_tilts(name: str) -> None:
    network = SCENES[name].network()
    assert network.is_coupled
    large, small = differences(network, 1e-3), differences(network, 1e-4)
    # products of two normal deviates reach 6, and a few of them meet; a rotor that is not round differs at any tilt
    round_ = max(
        (abs(rotor.body.inertia[0][0] - rotor.body.inertia[1][1]) / rotor.body.transverse for rotor in network.rotors), default=0.0
    )
    leaning = max((abs(rotor.body.product_unbalance) / rotor.body.transverse for rotor in network.rotors), default=0.0)
    for kind in large:
        for tilt, found in ((1e-3, large[kind]), (1e-4, small[kind])):
            assert found < 20.0 * tilt * (tilt + leaning) + 2.0 * round_ + 1e-12, (kind, tilt)


def test_an_upright_rotor_with_a_large_static_unbalance_accelerates_exactly() -> None:
    # m e^2/Jp = 3e-5 here: an equation for the spin without the reaction of the unbalance would be wrong by as much
    network = jeffcott(eccentricity=4e-4, angle=0.7).network()
    moment = whirling(network, 1e-4)
    upright = {name: values * (not name.endswith(("psi", "theta"))) for name, values in moment.angles.items()}
    still = {name: values * (not name.endswith(("psi", "theta"))) for name, values in moment.speeds.items()}
    moment = Moment(time=moment.time, angles=upright, speeds=still, states={})
    exact, found = network.accelerations(moment), coupled_accelerations(network, moment)
    for name in ("disc.x", "disc.y", "disc"):
        np.testing.assert_allclose(found[name], exact[name], rtol=1e-12, err_msg=name)


def test_a_rotor_that_is_far_from_round_is_refused() -> None:
    # (Jxx - Jyy)/Jt = (1 - Jp/Jt) sin^2 0.05 = -1.7e-3
    with pytest.raises(ParameterError, match=r"Rotor 'disc' is not round.*Give it less tilt or eccentricity, or simulate it on the engine"):
        CompiledLine(jeffcott(tilt=0.05).network(), [])


def test_a_mass_that_joins_a_spin_to_lateral_motion_is_refused() -> None:
    network = jeffcott().network()
    joined = MatrixElement("odd", ("disc", "disc.x"), np.array([[0.0, 1e-3], [1e-3, 0.0]]), np.zeros((2, 2)), np.zeros((2, 2)))
    with pytest.raises(ParameterError, match=r"Masses join the spin of 'disc' to disc\.x"):
        CompiledLine(dataclasses.replace(network, elements=(*network.elements, joined)), [])


def test_masses_that_differ_in_x_and_y_under_an_unbalance_are_refused() -> None:
    network = jeffcott().network()
    # m e^2 = 2e-8 kg m^2 of 0.01: with twice the mass in x the share that turns with the spin is 1e-6 of it
    sideways = MatrixElement("rail", ("disc.x",), np.array([[2.0 * MASS]]), np.zeros((1, 1)), np.zeros((1, 1)))
    with pytest.raises(ParameterError, match="moves masses that differ in x and y"):
        CompiledLine(dataclasses.replace(network, elements=(*network.elements, sideways)), [])


def test_unbalances_that_shake_each_other_through_a_shared_mass_are_refused() -> None:
    # m e = 1.6e-3 and 3e-4 kg m; the inverse of [[8, 1], [1, 3]] kg has 1/23 beside its diagonal: 2.1e-8 kg m^2 of 7.35e-3
    large = two_rotor_line.build().replacing({"rotor_1.eccentricity": 2e-4, "rotor_2.eccentricity": 1e-4}).network()
    between, zero = np.array([[0.0, 1.0], [1.0, 0.0]]), np.zeros((2, 2))
    shared = [MatrixElement(f"shared_{d}", (f"rotor_1.{d}", f"rotor_2.{d}"), between, zero, zero) for d in "xy"]
    with pytest.raises(ParameterError, match=r"unbalance of 'rotor_.' shakes the other rotors through shared masses"):
        CompiledLine(dataclasses.replace(large, elements=(*large.elements, *shared)), [])


# -- matrices ----------------------------------------------------------------------------------------------

BEAM = Beam(
    length=0.3,
    area=4e-4,
    second_moment=1.2e-8,
    polar_moment=2.4e-8,
    youngs_modulus=2.1e11,
    shear_modulus=8e10,
    density=0.0,
    shear_area=3e-4,
)


def random_matrix(rng: np.random.Generator, n: int, rank: int) -> FloatArray:
    """Positive semidefinite, with sizes from 1e-3 to 1e3."""
    factor = rng.normal(size=(n, rank)) * 10.0 ** rng.uniform(-1.5, 1.5, (n, 1))
    return np.asarray(factor @ factor.T)


def test_a_beam_in_one_plane_is_two_springs() -> None:
    plane = BEAM.stiffness()[np.ix_([0, 4, 6, 10], [0, 4, 6, 10])]
    found = springs(plane)
    assert found is not None
    assert [np.count_nonzero(spring.factors) for spring in found] == [2, 4]
    assert sorted(np.abs(found[1].factors)) == pytest.approx([1.0, 1.0, 2.0 / BEAM.length, 2.0 / BEAM.length])
    bending = BEAM.youngs_modulus * BEAM.second_moment / BEAM.length
    assert found[0].stiffness == pytest.approx(bending)  # pure bending: M = E I (theta_b - theta_a)/L
    np.testing.assert_allclose(sum(s.stiffness * np.outer(s.factors, s.factors) for s in found), plane, rtol=1e-12)


@pytest.mark.parametrize(("n", "rank"), [(1, 1), (2, 1), (4, 2), (5, 3), (6, 6)])
def test_springs_are_the_matrix_again(n: int, rank: int) -> None:
    matrix = random_matrix(np.random.default_rng(n), n, rank)
    found = springs(matrix)
    assert found is not None
    assert len(found) == rank
    scale = np.sqrt(np.outer(np.diag(matrix), np.diag(matrix)))
    assert np.max(np.abs(sum(s.stiffness * np.outer(s.factors, s.factors) for s in found) - matrix) / scale) < 1e-10


@pytest.mark.parametrize("matrix", [np.array([[1.0, 0.5], [-0.5, 1.0]]), np.array([[1.0, 2.0], [2.0, 1.0]]), np.diag([1.0, -1.0])])
def test_a_matrix_without_springs_has_none(matrix: FloatArray) -> None:
    assert springs(matrix) is None


@pytest.mark.parametrize("ratio", [1.0, 3.7e-5, 1.02])
def test_springs_of_a_multiple_are_those_of_the_matrix(ratio: float) -> None:
    matrix = random_matrix(np.random.default_rng(8), 4, 2)
    found, again = springs_of(ratio * matrix), springs_of(4.0 * ratio * matrix)
    assert found is not None
    assert again is not None
    assert all(a.factors is b.factors for a, b in zip(found, again, strict=True))  # found once
    scale = np.sqrt(np.outer(np.diag(matrix), np.diag(matrix)))
    made = sum(spring.stiffness * np.outer(spring.factors, spring.factors) for spring in found)
    assert np.max(np.abs(made - ratio * matrix) / scale) < 1e-10 * ratio


def test_springs_of_a_matrix_do_not_depend_on_what_came_before() -> None:
    """A multiple differs by rounding in its shape: found first or second, each has the same springs to the last digit."""
    for seed in range(20):
        matrix = random_matrix(np.random.default_rng(seed), 4, 2)
        pair = matrix, 1.02 * matrix
        found = {}
        for order in ((0, 1), (1, 0)):
            springs_._springs.cache_clear()
            found[order] = {k: springs_of(pair[k]) for k in order}
        for k in (0, 1):
            first, second = found[0, 1][k], found[1, 0][k]
            assert first is not None
            assert second is not None
            assert [item.stiffness for item in first] == [item.stiffness for item in second]
            np.testing.assert_array_equal([item.factors for item in first], [item.factors for item in second])


def test_forces_of_all_kinds_of_matrices_are_those_of_the_matrices() -> None:
    rng = np.random.default_rng(4)
    names = tuple("abcdef")
    zero = np.zeros((6, 6))
    beam = np.zeros((6, 6))
    beam[:4, :4] = BEAM.stiffness()[np.ix_([1, 3, 7, 9], [1, 3, 7, 9])]
    whirling_ = np.array([[3.0, 2.0], [-2.0, 3.0]])
    elements = [
        MatrixElement("proportional", names, zero, 2e-4 * beam, beam),
        MatrixElement("dense", names, zero, random_matrix(rng, 6, 6), random_matrix(rng, 6, 4)),
        MatrixElement("damper", ("b", "e"), zero[:2, :2], np.array([[2.0, -2.0], [-2.0, 2.0]]), zero[:2, :2]),
        MatrixElement("crossed", ("c", "f"), zero[:2, :2], whirling_, whirling_.T),
        MatrixElement("negative", ("a",), zero[:1, :1], zero[:1, :1], np.array([[-7.0]])),
    ]
    moment = Moment(time=0.0, angles=dict(zip(names, rng.normal(size=6))), speeds=dict(zip(names, rng.normal(size=6))), states={})
    found = linear_forces(elements, moment, {"a": 5.0, "g": 1.0})
    wanted = {"a": 5.0, "g": 1.0}
    for element in elements:
        for name, force in element.contribution(moment).items():
            wanted[name] = wanted.get(name, 0.0) + force
    assert found == pytest.approx(wanted, rel=1e-10)


def test_accelerations_from_a_mass_matrix_solve_it() -> None:
    rng = np.random.default_rng(5)
    matrix = np.zeros((8, 8))
    for at in ([0, 3, 5], [3, 5, 7], [1, 2]):  # two groups, and one coordinate alone
        matrix[np.ix_(at, at)] += random_matrix(rng, len(at), len(at))
    matrix[4, 4], matrix[6, 6] = 3.0, 0.5
    names = tuple("abcdefgh")
    force = dict(zip(names, rng.normal(size=8)))
    mass = ConstantMass(names, matrix)
    wanted = dict(zip(names, np.linalg.solve(matrix, [force[name] for name in names])))
    assert mass.solve(force) == pytest.approx(wanted, rel=1e-9)
    alone = mass.column({"h": 2.0})
    assert set(alone) == set("adfh")
    assert [alone.get(name, 0.0) for name in names] == pytest.approx(2.0 * np.linalg.inv(matrix)[:, 7], rel=1e-9)


def test_a_coordinate_without_mass_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"masses of .* are not positive"):
        ConstantMass(("a", "b"), np.ones((2, 2)))


def test_lines_with_other_numbers_share_their_code() -> None:
    rng = np.random.default_rng(6)
    structures = set()
    for _ in range(4):
        changed = {name: rotor_bench.NOMINAL[name] * math.exp(3.0 * sigma * rng.normal()) for name, sigma in rotor_bench.KNOWLEDGE.items()}
        structures.add(CompiledLine(rotor_bench.build("steps", **changed).network(), ["rotor_1.x"]).structure)
    assert len(structures) == 1


# -- runs --------------------------------------------------------------------------------------------------


def compiled(scene: hm.Scene, channels: tuple[str, ...], samples: int, every: float, step: float, start: dict | None = None) -> CompiledRun:  # type: ignore[type-arg]
    network = scene.network()
    begin = start or {}
    given = initial_values(network, begin.get("initial_speed", 0.0), begin.get("initial", {}))
    return CompiledLine(without_idle(network, begin.get("initial")), channels).run(samples, every, step=step, **given)


LATERAL = ("rotor_1.x", "rotor_1.y", "rotor_2.x", "rotor_2.y")
TILTS = ("rotor_1.psi", "rotor_1.theta", "rotor_2.psi", "rotor_2.theta")
HOUSINGS = tuple(f"bearing_{k}.housing.{d}_acceleration" for k in (1, 2) for d in "xy")


def assert_equal(run: CompiledRun, engine: hm.Response, *kinds: tuple[str, ...]) -> None:
    """Within 1e-6 of the largest amplitude of each kind of channel."""
    for kind in kinds:
        size = max(float(np.max(np.abs(run.values[name]))) for name in kind)
        assert size > 0.0
        for name in kind:
            np.testing.assert_allclose(run.values[name], engine.at(name, run.times), rtol=0.0, atol=1e-6 * size, err_msg=name)


def test_a_blow_on_the_bench_is_that_of_the_engine_and_the_method_of_order_four() -> None:
    scene, start = rotor_bench.build("bump"), rotor_bench.start("bump")
    channels = (*LATERAL, *TILTS, *HOUSINGS, "bearing_1.angle", "hammer.force_x")
    runs = [compiled(scene, channels, 600, SAMPLE, SAMPLE / n, start) for n in (3, 6, 12)]
    for name in ("rotor_1.x", "rotor_2.x", "rotor_2.theta"):
        coarse, fine = (float(np.max(np.abs(runs[k].values[name] - runs[k + 1].values[name]))) for k in (0, 1))
        assert math.log2(coarse / fine) == pytest.approx(4.0, abs=0.3), name
        assert fine / 15.0 < 1e-7 * float(np.max(np.abs(runs[1].values[name])))
    engine = hm.simulate(scene, 599 * SAMPLE, solver=hm.RungeKutta4(step=SAMPLE / 12.0), **start)
    assert_equal(runs[2], engine, LATERAL, TILTS, HOUSINGS, ("bearing_1.angle",), ("hammer.force_x",))


@pytest.mark.parametrize("scene", [rotor_bench.build("steps"), measured_spin("steps")], ids=["controlled", "prescribed"])
def test_the_bench_at_speed_is_that_of_the_engine(scene: hm.Scene) -> None:
    start = rotor_bench.start("steps")
    channels = (*LATERAL, *TILTS, *HOUSINGS, "rotor_1.speed", "bearing_2.acceleration")
    run = compiled(scene, channels, 400, SAMPLE, SAMPLE / 6.0, start)
    engine = hm.simulate(scene, 399 * SAMPLE, solver=rotor_bench.SOLVER, **start)
    assert_equal(run, engine, LATERAL, TILTS, HOUSINGS, ("rotor_1.speed",), ("bearing_2.acceleration",))


def test_a_prescribed_spin_has_the_speed_and_acceleration_of_its_law() -> None:
    amplitude, pace = 0.3, 40.0
    scene = hm.Scene(
        name="nodding",
        parts={
            "motor": hm.Motor(inertia=0.01, characteristic=hm.IdealSpeedMotor(motion=lambda t: 100.0 * t + amplitude * np.sin(pace * t))),
            "shaft": hm.Shaft(stiffness=1e6, damping=100.0),
            "disc": hm.Rotor(mass=MASS, polar_inertia=POLAR, transverse_inertia=0.006, eccentricity=1e-4),
            "bearing": hm.Bearing(law=hm.LinearBearing.isotropic(radial=STIFFNESS, damping=25.0, axial=1e5, tilt=5e3)),
        },
        connections=[("motor", "shaft", "disc", "bearing")],
    )
    run = compiled(scene, ("motor.angle", "motor.speed", "motor.acceleration"), 50, 1e-3, 1e-4, {"initial_speed": 112.0})
    np.testing.assert_allclose(run.values["motor.speed"], 100.0 + amplitude * pace * np.cos(pace * run.times), rtol=1e-12)
    np.testing.assert_allclose(run.values["motor.acceleration"], -amplitude * pace**2 * np.sin(pace * run.times), rtol=1e-12, atol=1e-9)


def test_an_unknown_channel_is_refused_with_those_there_are() -> None:
    with pytest.raises(PlaceError, match=r"No channel 'disc\.x_speed'.*disc\.x_acceleration"):
        CompiledLine(jeffcott().network(), ["disc.x_speed"])


# -- axial motion and other coordinates that nothing moves ---------------------------------------------------


def test_axial_motion_that_nothing_excites_is_left_out_without_a_trace() -> None:
    scene, start = rotor_bench.build("steps"), rotor_bench.start("steps")
    network = scene.network()
    assert idle_coordinates(network, start["initial"]) == tuple(f"{name}.z" for name in rotor_bench.POSITIONS)
    given = initial_values(network, start["initial_speed"], start["initial"])
    channels = (*LATERAL, "rotor_1.speed", "rotor_2.z")
    whole, less = (CompiledLine(item, channels).run(200, SAMPLE, step=SAMPLE / 6.0, **given) for item in (network, without_idle(network)))
    for name in channels[:-1]:
        np.testing.assert_allclose(less.values[name], whole.values[name], rtol=1e-12, atol=1e-18, err_msg=name)
    assert not less.values["rotor_2.z"].any()


def test_axial_motion_from_its_initial_value_is_kept() -> None:
    network = jeffcott(constant(0.0)).network()
    start = {"disc.z": 1e-4}
    assert idle_coordinates(network) == ("disc.z",)
    assert idle_coordinates(network, start) == ()
    assert without_idle(network, start) is network
    run = CompiledLine(network, ["disc.z"]).run(200, 1e-4, step=2e-5, angles=start)
    # m z'' + 10 z' + 1e5 z = 0
    decay = 10.0 / (2.0 * MASS)
    pace = math.sqrt(1e5 / MASS - decay**2)
    wanted = 1e-4 * np.exp(-decay * run.times) * (np.cos(pace * run.times) + decay / pace * np.sin(pace * run.times))
    np.testing.assert_allclose(run.values["disc.z"], wanted, rtol=0.0, atol=1e-4 * 1e-9)


def test_only_what_nothing_moves_is_idle() -> None:
    balanced = jeffcott(eccentricity=0.0)
    assert idle_coordinates(balanced.network()) == ("disc.x", "disc.y", "disc.z", "disc.psi", "disc.theta")
    assert idle_coordinates(with_part(balanced, hm.Gravity()).network()) == ("disc.x", "disc.z", "disc.psi", "disc.theta")
    # a law moves what it pushes at: a cubic bearing x and y, not the axis
    assert idle_coordinates(two_rotor_line.build(cubic=1e14).network()) == tuple(f"{name}.z" for name in two_rotor_line.POSITIONS)


# -- steps -------------------------------------------------------------------------------------------------


def oscillator(damping: float = 0.0) -> hm.Scene:
    """Two equal inertias on a spring: w = sqrt(2 k/J)."""
    parts = {"motor": hm.Inertia(inertia=0.02), "shaft": hm.Shaft(stiffness=1e4, damping=damping), "load": hm.Inertia(inertia=0.02)}
    return hm.Scene(name="oscillator", parts=parts, connections=[("motor", "shaft", "load")])


def test_the_longest_step_of_a_vibration_and_of_a_decay_are_those_of_theory() -> None:
    # |1 + z + z^2/2 + z^3/6 + z^4/24| = 1 at z = i sqrt(8) and z = -2.785293563405
    assert longest_step(oscillator().network(), margin=1.0) == pytest.approx(math.sqrt(8.0) / 1000.0, rel=1e-4)
    assert longest_step(oscillator().network(), margin=0.5) == pytest.approx(math.sqrt(2.0) / 1000.0, rel=1e-4)
    # J q'' + d q' + k q = 0 far over its critical damping: the fast root is -2 d/J (1 - J k/(2 d^2) ...)
    root = -0.5 * 2e5 - math.sqrt(0.25 * 2e5**2 - 1e6)
    assert longest_step(oscillator(2000.0).network(), margin=1.0) == pytest.approx(-2.785293563405 / root, rel=1e-4)


LAG = 2.5e-4
"""Of a torque behind its command [s]: its rate -1/LAG is the fastest there is."""


def driven() -> hm.Scene:
    parts = {
        "motor": hm.Motor(inertia=0.02, characteristic=constant(1.0)),
        "shaft": hm.Shaft(stiffness=1e4),
        "load": hm.Inertia(inertia=0.02),
    }
    return hm.Scene(name="driven", parts=parts, connections=[("motor", "shaft", "load")])


def lagging() -> hm.Scene:
    return driven().with_effect(hm.ActuatorLag(time_constant=LAG), at="motor")


def test_the_longest_step_of_a_state_is_that_of_its_rate() -> None:
    assert longest_step(lagging().network(), margin=1.0) == pytest.approx(2.785293563405 * LAG, rel=1e-4)


@pytest.mark.parametrize("scene", [oscillator(0.2), lagging(), jeffcott(constant(0.0))], ids=["a vibration", "a state", "a rotor"])
def test_a_step_beyond_the_longest_one_grows_and_one_below_does_not(scene: hm.Scene) -> None:
    network = scene.network()
    limit = longest_step(network, margin=1.0)
    line = CompiledLine(network, [channel_of(body, "speed") for body in network.bodies])
    start = {body.name: 1e-6 * (-1.0) ** k for k, body in enumerate(network.bodies)}

    def largest(step: float) -> float:
        try:
            return max(float(np.max(np.abs(values))) for values in line.run(3000, step, step=step, speeds=start).values.values())
        except SimulationError:
            return math.inf

    assert largest(0.98 * limit) < 1e6
    assert largest(1.02 * limit) == math.inf or largest(1.02 * limit) > 1e12


def test_the_step_of_the_bench_is_set_by_axial_vibration_that_nothing_excites() -> None:
    network = rotor_bench.build("steps").network()
    whole, less = (longest_step(item, margin=1.0) for item in (network, without_idle(network)))
    assert SAMPLE / 5.0 < whole < SAMPLE / 4.0
    assert SAMPLE / 3.0 < less < SAMPLE / 2.0


@pytest.mark.parametrize("margin", [0.0, 1.5])
def test_a_margin_that_is_none_is_refused(margin: float) -> None:
    with pytest.raises(ParameterError, match="margin"):
        longest_step(oscillator().network(), margin=margin)
