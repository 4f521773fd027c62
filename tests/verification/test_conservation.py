"""Energy, angular momentum and power: what no train may create or lose."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

import hdrive_mbs as hm
from tests.verification import reference_laws as laws
from tests.verification.reference_train import ReferenceTrain
from tests.verification.scenes import LOST_MOTION, SENSE, catalogue, train
from tests.verification.test_solver_order import CUBIC, LINEAR, SPEED
from tests.verification.test_solver_order import scene as smooth_train

EDGE = 0.5 * LOST_MOTION
RATIO = 100.0
K_IN, K_OUT = 1e4, 5.1913e4


def isolated(stiffness: object, *, damping: float = 0.0, spline_inertia: float = 0.0, sense: str = "opposite") -> hm.Scene:
    """The train of seed F without motor torque and load; its circular spline is held unless it has an inertia."""
    parts: dict[str, hm.Component] = {
        "motor": hm.Inertia(inertia=1.5e-3),
        "input_shaft": hm.Shaft(stiffness=K_IN, damping=0.002 * damping, inertia=1e-5),
        "gear": hm.HarmonicDrive(
            ratio=RATIO, stiffness=stiffness, damping=damping, wave_generator_inertia=1.69e-4, flexspline_inertia=4e-4,
            circular_spline_inertia=spline_inertia, output_sense=sense,
        ),
        "output_shaft": hm.Shaft(stiffness=K_OUT, damping=0.25 * damping, inertia=2.465e-5),
        "load": hm.Inertia(inertia=0.5),
    }  # fmt: skip
    connections = [("motor", "input_shaft", "gear", "output_shaft", "load")]
    if spline_inertia > 0.0:
        parts["housing"] = hm.Inertia(inertia=1e-9)  # a flange with nothing on it is held by the ground
        connections.append(("gear.circular_spline", "housing"))
    return hm.Scene(name="isolated train", parts=parts, connections=connections)


# -- energy --------------------------------------------------------------------------------------------


def catalogue_energy(x: np.ndarray) -> np.ndarray:
    """Integral of (7)-(10): half the change of stiffness at each corner times the distance beyond it squared."""
    first = EDGE + 23.5 / 3.2e4
    corners = ((EDGE, 3.2e4), (first, 3.2e4), (first + 74.5 / 6.4e4, 4.6e4))
    return sum(0.5 * k * np.maximum(np.abs(x) - corner, 0.0) ** 2 for corner, k in corners)


def outside(terms: dict[int, float]) -> Callable[[np.ndarray], np.ndarray]:
    """Integral of sum(c_p x^p) from the edge of the gap to |x|; zero inside."""

    def energy(x: np.ndarray) -> np.ndarray:
        size = np.maximum(np.abs(x), EDGE)
        return sum(c / (p + 1) * (size ** (p + 1) - EDGE ** (p + 1)) for p, c in terms.items())

    return energy


TABLE = ((0.0, 0.0011, 0.0014, 0.0019, 0.0036), (0.0, 0.4, 4.0, 20.0, 132.0))


def table_energy(x: np.ndarray) -> np.ndarray:
    """Trapezoids up to |x|."""
    twists, torques = np.array(TABLE[0]), np.array(TABLE[1])
    done = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(twists) * (torques[1:] + torques[:-1]))])
    k = np.clip(np.searchsorted(twists, np.abs(x), side="right") - 1, 0, len(twists) - 2)
    here = torques[k] + (np.abs(x) - twists[k]) * (torques[k + 1] - torques[k]) / (twists[k + 1] - twists[k])
    return done[k] + 0.5 * (np.abs(x) - twists[k]) * (torques[k] + here)


LAWS: dict[str, tuple[Callable[[], object], Callable[[np.ndarray], np.ndarray]]] = {
    "catalogue": (catalogue, catalogue_energy),
    "cubic": (
        lambda: hm.CubicStiffness(linear=2e3, cubic=3e9),
        lambda x: 0.5 * 2e3 * x**2 + 0.25 * 3e9 * x**4,
    ),
    "continuous": (
        lambda: hm.ContinuousStiffness(lost_motion=LOST_MOTION, edge_stiffness=2.5e4, quadratic=1.4e7, cubic=4.6e8),
        lambda x: sum(c / (p + 1) * np.maximum(np.abs(x) - EDGE, 0.0) ** (p + 1) for p, c in {1: 2.5e4, 2: 1.4e7, 3: 4.6e8}.items()),
    ),
    "table": (lambda: hm.TableStiffness.mirrored(*TABLE), table_energy),
    "jump, torque": (
        lambda: hm.JumpTorqueStiffness(lost_motion=LOST_MOTION, linear=0.0, cubic=3e9),
        outside({3: 3e9}),
    ),
    "jump, stiffness": (
        lambda: hm.JumpSecantStiffness(lost_motion=LOST_MOTION, linear=4.4e6, cubic=5.3e11),
        outside({2: 4.4e6, 4: 5.3e11}),
    ),
}


def total_energy(response: hm.Response, elastic: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    inertias = {body.name: body.inertia for body in response.scene.network().bodies}
    kinetic = sum(0.5 * inertia * response.values[f"{name}.speed"] ** 2 for name, inertia in inertias.items())
    shafts = 0.5 * K_IN * response.values["input_shaft.twist"] ** 2 + 0.5 * K_OUT * response.values["output_shaft.twist"] ** 2
    return kinetic + shafts + elastic(response.values["gear.twist"])


def allowed_drift(response: hm.Response, solver: hm.DormandPrince) -> float:
    """What the local errors of all steps may change the energy by.

    One step leaves an error of at most  absolute + relative |y_i|  in coordinate i (Exudyn accepts it
    for that; sqrt(n) should its norm be a mean square), and dE = sum(J_i w_i dw_i - T_i dq_i).
    """
    bodies = response.scene.network().bodies
    total = np.zeros(len(response.times))
    for body in bodies:
        angle, speed = (np.abs(response.values[f"{body.name}.{q}"]) for q in ("angle", "speed"))
        pull = body.inertia * np.abs(response.values[f"{body.name}.acceleration"])
        total += body.inertia * speed * (solver.absolute_tolerance + solver.relative_tolerance * speed)
        total += pull * (solver.absolute_tolerance + solver.relative_tolerance * angle)
    return math.sqrt(2.0 * len(bodies)) * float(np.sum(total))


@pytest.mark.parametrize("name", LAWS)
def test_energy_of_an_undamped_unloaded_train_is_constant(name: str) -> None:
    build, elastic = LAWS[name]
    solver = hm.DormandPrince(relative_tolerance=1e-10, absolute_tolerance=1e-12)
    # the load swings against the rest: through the gap and 50 N m or more to both sides of it
    response = hm.simulate(isolated(build()), 0.1, solver=solver, initial={"load.speed": 0.5})
    twist = response.values["gear.twist"]
    assert np.min(twist) < -EDGE
    assert np.max(twist) > EDGE
    assert np.max(np.abs(response.values["gear.torque"])) > 50.0
    energy = total_energy(response, elastic)
    allowed = allowed_drift(response, solver)
    assert energy[0] == pytest.approx(0.5 * (0.5 + 0.5 * 2.465e-5) * 0.5**2, rel=1e-12)
    assert np.max(np.abs(energy - energy[0])) < allowed
    assert allowed < 1e-4 * energy[0]  # the bound says something


def test_drift_of_the_energy_falls_with_the_tolerance() -> None:
    build, elastic = LAWS["catalogue"]
    drifts = []
    for tolerance in (1e-6, 1e-8, 1e-10):
        solver = hm.DormandPrince(relative_tolerance=tolerance, absolute_tolerance=1e-2 * tolerance)
        energy = total_energy(hm.simulate(isolated(build()), 0.1, solver=solver, initial={"load.speed": 0.5}), elastic)
        drifts.append(np.max(np.abs(energy - energy[0])))
    # a hundred times tighter each time; at least ten times less drift
    assert drifts[1] < 0.1 * drifts[0]
    assert drifts[2] < 0.1 * drifts[1]


def test_trapezoidal_rule_keeps_the_energy_of_a_linear_train_exactly() -> None:
    # Newmark with beta = 1/4, gamma = 1/2 conserves E of M q'' + K q = 0 for any step; Newton is solved to 1e-10
    k = 3.2e4
    scene = isolated(hm.CubicStiffness(linear=k, cubic=0.0))
    response = hm.simulate(scene, 0.1, solver=hm.Trapezoidal(step=2e-4), initial={"load.speed": 0.5})
    energy = total_energy(response, lambda x: 0.5 * k * x**2)
    assert np.max(np.abs(energy - energy[0])) < 1e-10 * len(energy) * energy[0]


# -- angular momentum ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("sense", ["opposite", "same"])
def test_angular_momentum_of_an_isolated_train_with_a_free_circular_spline_is_constant(sense: str) -> None:
    # true sense about the common axis; dampers and the mesh are internal, whatever the ratio
    solver = hm.DormandPrince(relative_tolerance=1e-10, absolute_tolerance=1e-12)
    scene = isolated(catalogue(), damping=20.0, spline_inertia=0.02, sense=sense)
    response = hm.simulate(scene, 0.1, solver=solver, initial={"load.speed": 1.0, "motor.speed": -30.0})
    bodies = scene.network().bodies
    assert len(bodies) == 5
    speeds = {body.name: response.values[f"{body.name}.speed"] for body in bodies}
    momentum = sum(body.inertia * speeds[body.name] for body in bodies)
    step = sum(b.inertia * (solver.absolute_tolerance + solver.relative_tolerance * np.max(np.abs(speeds[b.name]))) for b in bodies)
    allowed = math.sqrt(2.0 * len(bodies)) * len(response.times) * step
    assert np.max(np.abs(momentum - momentum[0])) < allowed
    # there is something to conserve: the parts exchange far more than the allowed drift
    exchanged = max(body.inertia * np.ptp(speeds[body.name]) for body in bodies)
    assert exchanged > 1e3 * allowed


def simpson(times: np.ndarray, values: np.ndarray) -> tuple[float, float]:
    """Integral over even times, and the size of its error from the rule with twice the step (divided by 15)."""
    h = (times[-1] - times[0]) / (len(times) - 1)

    def rule(y: np.ndarray, step: float) -> float:
        return float(step / 3.0 * (y[0] + y[-1] + 4.0 * np.sum(y[1:-1:2]) + 2.0 * np.sum(y[2:-1:2])))

    fine, coarse = rule(values, h), rule(values[::2], 2.0 * h)
    return fine, abs(fine - coarse) / 15.0


@pytest.fixture(scope="module")
def driven() -> hm.Response:
    """A damped, driven, loaded train with smooth laws at 4001 even times (Runge-Kutta error below 1e-10)."""
    return hm.simulate(smooth_train(), 0.04, solver=hm.RungeKutta4(step=1e-5), initial_speed=SPEED)


def test_change_of_angular_momentum_is_the_impulse_of_motor_load_and_housing(driven: hm.Response) -> None:
    v = driven.values
    inertias = {body.name: body.inertia for body in driven.scene.network().bodies}
    momentum = sum(inertia * v[f"{name}.speed"] for name, inertia in inertias.items())
    # the load resists forward, that is along the motor's sense; the held circular spline takes (1 + 1/u) T
    torque = v["motor.torque"] - SENSE["load"] * v["load.torque"] - v["gear.housing_torque"]
    impulse, error = simpson(driven.times, torque)
    largest = np.max(np.abs(v["gear.housing_torque"])) * 0.04
    allowed = error + 1e-9 * largest
    assert allowed < 1e-6 * largest
    assert momentum[-1] - momentum[0] == pytest.approx(impulse, rel=0.0, abs=allowed)
    # without the reaction of the housing the balance is far off
    without, _ = simpson(driven.times, torque + v["gear.housing_torque"])
    assert abs(momentum[-1] - momentum[0] - without) > 100.0 * allowed


def test_change_of_energy_is_the_work_of_motor_load_and_dampers(driven: hm.Response) -> None:
    v = driven.values
    inertias = {body.name: body.inertia for body in driven.scene.network().bodies}
    energy = sum(0.5 * inertia * v[f"{name}.speed"] ** 2 for name, inertia in inertias.items())
    energy = energy + 0.5 * 900.0 * v["input_shaft.twist"] ** 2 + 0.5 * 2.1e4 * v["output_shaft.twist"] ** 2
    energy = energy + 0.5 * LINEAR * v["gear.twist"] ** 2 + 0.25 * CUBIC * v["gear.twist"] ** 4
    power = v["motor.torque"] * v["motor.speed"] - v["load.torque"] * SENSE["load"] * v["load.speed"]
    heat = 0.02 * v["input_shaft.twist_rate"] ** 2 + 2.0 * v["gear.twist_rate"] ** 2 + 3.0 * v["output_shaft.twist_rate"] ** 2
    work, error = simpson(driven.times, power - heat)
    lost, _ = simpson(driven.times, heat)
    allowed = error + 1e-9 * float(np.max(energy))
    assert lost > 100.0 * allowed
    assert energy[-1] - energy[0] == pytest.approx(work, rel=0.0, abs=allowed)


# -- at any moment -------------------------------------------------------------------------------------------------


def test_power_balances_at_random_moments() -> None:
    load = hm.SineTorque(mean=20.0, amplitude=5.0, frequency=1.0)
    friction = hm.CoulombStribeckFriction(coulomb=2.0, breakaway=3.0)
    network = train(load=load, damping_in_gap=False).with_effect(friction, at="load").network()
    model = ReferenceTrain(
        flexspline=laws.catalogue_stiffness(lost_motion=LOST_MOTION, k1=3.2e4, k2=6.4e4, k3=11e4, t1=23.5, t2=98.0),
        motor=laws.kloss(power=550.0, speed=1410.0 * math.pi / 30.0, pole_pairs=2, frequency=50.0, breakdown=2.4),
        load=laws.sine(20.0, 5.0, 1.0), damping_in_gap=False, gap=LOST_MOTION,
    )  # fmt: skip
    rng = np.random.default_rng(11)
    for _ in range(300):
        t, twist, q_fs = float(rng.uniform(0.0, 2.0)), float(rng.uniform(-4e-3, 4e-3)), float(rng.uniform(-0.1, 0.1))
        q_wg = RATIO * (q_fs + twist)
        q = np.array([q_wg + rng.uniform(-1e-3, 1e-3), q_wg, q_fs, q_fs + rng.uniform(-1e-3, 1e-3)])
        w = rng.uniform(-200.0, 200.0, 4) * np.array([1.0, 1.0, 0.01, 0.01])
        names = list(SENSE)
        moment = network.moment(t, dict(zip(names, q)), dict(zip(names, w)), {})
        rates, inertias = network.accelerations(moment), {body.name: body.inertia for body in network.bodies}
        kinetic = sum(inertias[name] * w[k] * rates[name] for k, name in enumerate(names))
        # what the package says each element takes
        taken = network.power_taken(moment)
        size = sum(abs(value) for value in taken.values())
        assert abs(kinetic + sum(taken.values())) < 1e-11 * size
        # and the same from (1)-(4): drive - load - power into each elastic element - friction
        x = (q[0] - q[1], q[1] / RATIO - q[2], q[2] - q[3])
        v = (w[0] - w[1], w[1] / RATIO - w[2], w[2] - w[3])
        through = (1e4 * x[0] + 0.05 * v[0], model.mesh_torque(x[1], v[1]), 5.1913e4 * x[2] + 5.0 * v[2])
        # friction: tanh(w/0.01) (2 + (3 - 2) exp(-w^2)) with its default speeds
        drag = math.tanh(w[3] / 0.01) * (2.0 + math.exp(-(w[3] ** 2)))
        region = model.regions(t, [*q, *w])
        drive = model.motor.torque(t, q[0], w[0], (), region[1:]) * w[0]
        expected = drive - model.load.torque(t, q[3], w[3], (), ()) * w[3] - drag * w[3] - sum(a * b for a, b in zip(through, v))
        assert abs(kinetic - expected) < 1e-11 * size


@pytest.mark.parametrize("sense", ["opposite", "same"])
def test_reactions_of_the_mesh_sum_to_zero_and_do_no_work_in_rigid_motion(sense: str) -> None:
    scene = isolated(lambda twist: 3e4 * twist, damping=20.0, spline_inertia=0.02, sense=sense)
    network = scene.network()
    sign = -1.0 if sense == "opposite" else 1.0
    i = sign * RATIO
    senses = {body.name: float(body.sense) for body in network.bodies}
    mesh = network.connection("gear")
    rng = np.random.default_rng(5)
    housing_channel = next(channel for channel in network.channels if channel.name == "gear.housing_torque")
    for _ in range(50):
        angles = {name: float(rng.normal()) for name in senses}
        speeds = {name: float(rng.normal()) for name in senses}
        moment = network.moment(0.0, angles, speeds, {})
        true = {name: senses[name] * value for name, value in mesh.contribution(moment).items()}
        assert len(true) == 3
        assert abs(sum(true.values())) < 1e-12 * max(map(abs, true.values()))
        # virtual work: in any motion with w_fs = w_wg/i + (1 - 1/i) w_cs the three torques do no work
        body_of = network.places
        torques = {place: true[body_of[place]] for place in ("gear.wave_generator", "gear.flexspline", "gear.circular_spline")}
        w_wg, w_cs = rng.normal(size=2)
        w_fs = w_wg / i + (1.0 - 1.0 / i) * w_cs
        work = torques["gear.wave_generator"] * w_wg + torques["gear.flexspline"] * w_fs + torques["gear.circular_spline"] * w_cs
        assert abs(work) < 1e-12 * max(map(abs, torques.values()))
        # size: T along the flexspline, T/u on the wave generator, (1 + 1/u) T or (1 - 1/u) T on the circular spline
        through = float(mesh.value(moment))
        assert torques["gear.wave_generator"] == pytest.approx(-through / RATIO, rel=1e-12)
        assert torques["gear.flexspline"] == pytest.approx(sign * through, rel=1e-12)
        assert torques["gear.circular_spline"] == pytest.approx(-sign * (1.0 - sign / RATIO) * through, rel=1e-12)
        assert float(housing_channel.read(moment)) == pytest.approx(torques["gear.circular_spline"], rel=1e-12)
