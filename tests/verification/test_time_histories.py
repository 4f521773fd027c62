"""Time histories on the engine against the reference train in scipy, for every law, motor and load."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from tests.verification import reference_laws as laws
from tests.verification.reference_train import BODIES, Reference, ReferenceTrain, integrate
from tests.verification.scenes import LOST_MOTION, SENSE, train

LIMIT = 1e-6
"""Largest difference over largest value, per channel."""
TIGHT = hm.DormandPrince(relative_tolerance=1e-11, absolute_tolerance=1e-13)
NAME_PLATE = {"power": 550.0, "speed": 1410.0 * math.pi / 30.0, "pole_pairs": 2, "frequency": 50.0, "breakdown": 2.4}
HALF_GAP = 0.5 * LOST_MOTION
LARGEST_TWIST = HALF_GAP + 23.5 / 3.2e4 + (98.0 - 23.5) / 6.4e4 + (137.0 - 98.0) / 11e4
"""Last row of Table 1: the twist at 137 N m [rad]."""

CATALOGUE = laws.catalogue_stiffness(lost_motion=LOST_MOTION, k1=3.2e4, k2=6.4e4, k3=11e4, t1=23.5, t2=98.0)


def fitted(powers: tuple[int, ...], start: float, shift: float = 0.0) -> np.ndarray:
    """Least squares of sum(c_p (phi - shift)^p) through the catalogue curve from ``start`` to 137 N m."""
    twist = np.linspace(start, LARGEST_TWIST, 1001)
    torque = np.array([CATALOGUE(x) for x in twist])
    x = (twist - shift) / LARGEST_TWIST
    found = np.linalg.lstsq(np.stack([x**p for p in powers], axis=1), torque, rcond=None)[0]
    return found / LARGEST_TWIST ** np.array(powers, float)


@dataclass(frozen=True)
class Case:
    """The same train twice.

    scene : what differs from scenes.train()
    reference : what differs from the reference with the catalogue law, Kloss and 20 + 5 sin(2 pi t)
    """

    scene: Callable[[], dict[str, Any]]
    reference: Callable[[], dict[str, Any]]
    duration: float = 0.1
    speed: float = 0.0
    lowering: str = "symbolic"
    jumps: bool = False
    """Whether the gear torque itself jumps at an edge of the law."""


def reference_of(case: Case) -> ReferenceTrain:
    parts = {"flexspline": CATALOGUE, "motor": laws.kloss(**NAME_PLATE), "load": laws.sine(20.0, 5.0, 1.0), "gap": LOST_MOTION}
    return ReferenceTrain(**(parts | case.reference()))


def differences(response: hm.Response, reference: Reference, *, jumps: bool = False) -> dict[str, float]:
    """Largest difference over largest value for angles and speeds of all bodies and the gear torque.

    jumps : leave out samples of the torque nearer than 1e-8 s to a passage over an edge of the law: where it
        jumps, two solutions that pass 1e-12 s apart differ by the whole jump
    """
    count = len(reference.times)
    passed = np.array([t for t, which, _, _ in reference.passages if which == 0])
    kept = np.ones(count, bool)
    if jumps and len(passed):
        kept = np.min(np.abs(reference.times[:, None] - passed[None, :]), axis=1) > 1e-8
    pairs = {"gear.torque": (response.values["gear.torque"][:count][kept], reference.torque[kept])}
    for name in BODIES:
        pairs[f"{name}.angle"] = (SENSE[name] * response.values[f"{name}.angle"][:count], reference.angles[name])
        pairs[f"{name}.speed"] = (SENSE[name] * response.values[f"{name}.speed"][:count], reference.speeds[name])
    return {name: float(np.max(np.abs(ours - theirs)) / np.max(np.abs(theirs))) for name, (ours, theirs) in pairs.items()}


def compared(case: Case) -> tuple[hm.Response, Reference]:
    response = hm.simulate(train(**case.scene()), case.duration, solver=TIGHT, initial_speed=case.speed)
    model = reference_of(case)
    return response, integrate(model, response.times, start=model.start(case.speed))


# -- flexspline laws ------------------------------------------------------------------------------------

LINEAR, CUBIC = fitted((1, 3), 0.0)
EDGE, SQUARE, CUBE = fitted((1, 2, 3), HALF_GAP, HALF_GAP)
TABLE_TWISTS = (0.0, 0.0011, 0.0014, 0.0019, 0.0024, 0.0036)
TABLE_TORQUES = (0.0, 0.4, 4.0, 20.0, 41.0, 132.0)
"""A made-up measurement with rounded gap."""


def smooth_law(twist: Any) -> Any:
    """A user's law in numpy: 9e4 N m/rad far out, 5e3 in the middle, smooth between."""
    return 5e3 * twist + 8.5e4 * (twist - 1.2e-3 * np.tanh(twist / 1.2e-3))


def unrecordable_law(twist: Any) -> float:
    """The same with 'if' and math: only a Python callback can run it."""
    x = float(twist)
    if x < 0.0:
        return -unrecordable_law(-x)
    return 5e3 * x + 8.5e4 * (x - 1.2e-3 * math.tanh(x / 1.2e-3))


def smooth_reference() -> laws.Pieces:
    return laws.Pieces((), (lambda x: 9e4 * x - 102.0 * math.tanh(x / 1.2e-3),))


def continuous_reference(positive: tuple[float, ...], negative: tuple[float, ...], end: float) -> laws.Pieces:
    """Cubics about the edges of the gap, tangents beyond +-end."""

    def side(k1: float, k2: float, k3: float) -> tuple[Callable[[float], float], Callable[[float], float]]:
        s_end = end - HALF_GAP
        cubic = laws.polynomial(0.0, k1, k2, k3)
        tangent = laws.line(end, cubic(s_end), k1 + 2.0 * k2 * s_end + 3.0 * k3 * s_end**2)
        return (lambda x: cubic(x - HALF_GAP)), tangent

    (up, up_line), (down, down_line) = side(*positive), side(*negative)
    return laws.Pieces(
        (-end, -HALF_GAP, HALF_GAP, end),
        (lambda x: -down_line(-x), lambda x: -down(-x), laws.polynomial(0.0), up, up_line),
    )


FLEXSPLINES = {
    "catalogue, damping also inside the gap": Case(dict, dict),
    "catalogue, no damping inside the gap": Case(
        lambda: {"damping_in_gap": False},
        lambda: {"damping_in_gap": False},
        jumps=True,
    ),
    "catalogue, load inside the gap torque": Case(
        lambda: {"load": hm.SineTorque(mean=4.0, amplitude=3.0, frequency=1.0)},
        lambda: {"load": laws.sine(4.0, 3.0, 1.0)},
    ),
    "catalogue, load inside the gap torque, no damping there": Case(
        lambda: {"load": hm.SineTorque(mean=4.0, amplitude=3.0, frequency=1.0), "damping_in_gap": False},
        lambda: {"load": laws.sine(4.0, 3.0, 1.0), "damping_in_gap": False},
        jumps=True,
    ),
    "catalogue, driven backwards by an overhauling load": Case(
        lambda: {"load": hm.ConstantTorque(value=-60.0)},
        lambda: {"load": laws.in_time(lambda t: -60.0)},
    ),
    "cubic": Case(
        lambda: {"stiffness": hm.CubicStiffness(linear=max(LINEAR, 0.0), cubic=CUBIC)},
        lambda: {"flexspline": laws.cubic_stiffness(max(LINEAR, 0.0), CUBIC), "gap": 0.0},
        duration=0.06,
    ),
    "continuous": Case(
        lambda: {"stiffness": hm.ContinuousStiffness(lost_motion=LOST_MOTION, edge_stiffness=EDGE, quadratic=SQUARE, cubic=CUBE)},
        lambda: {"flexspline": continuous_reference((EDGE, SQUARE, CUBE), (EDGE, SQUARE, CUBE), 1.0)},
        duration=0.06,
    ),
    "continuous, load inside the gap torque": Case(
        lambda: {
            "stiffness": hm.ContinuousStiffness(lost_motion=LOST_MOTION, edge_stiffness=EDGE, quadratic=SQUARE, cubic=CUBE),
            "load": hm.SineTorque(mean=4.0, amplitude=3.0, frequency=1.0),
        },
        lambda: {
            "flexspline": continuous_reference((EDGE, SQUARE, CUBE), (EDGE, SQUARE, CUBE), 1.0),
            "load": laws.sine(4.0, 3.0, 1.0),
        },
    ),
    "continuous, sides differ, along its tangents beyond 1.6e-3 rad, load alternates": Case(
        lambda: {
            "stiffness": hm.ContinuousStiffness(
                lost_motion=LOST_MOTION, edge_stiffness=EDGE, quadratic=SQUARE, cubic=CUBE, largest_twist=1.6e-3,
                negative_edge_stiffness=4e4, negative_quadratic=2e7, negative_cubic=-3e9,
            ),
            "load": hm.SineTorque(mean=0.0, amplitude=60.0, frequency=12.0),
        },
        lambda: {
            "flexspline": continuous_reference((EDGE, SQUARE, CUBE), (4e4, 2e7, -3e9), 1.6e-3),
            "load": laws.sine(0.0, 60.0, 12.0),
        },
    ),
    "table": Case(
        lambda: {"stiffness": hm.TableStiffness.mirrored(TABLE_TWISTS, TABLE_TORQUES)},
        lambda: {
            "flexspline": laws.table(
                (*(-x for x in reversed(TABLE_TWISTS[1:])), *TABLE_TWISTS),
                (*(-y for y in reversed(TABLE_TORQUES[1:])), *TABLE_TORQUES),
                hold=False,
            ),
            "gap": 0.0,
        },
    ),
    "plain Python function": Case(
        lambda: {"stiffness": smooth_law},
        lambda: {"flexspline": smooth_reference(), "gap": 0.0},
        duration=0.06,
    ),
    "plain Python function that can only be called back": Case(
        lambda: {"stiffness": unrecordable_law},
        lambda: {"flexspline": smooth_reference(), "gap": 0.0},
        duration=0.02,
        lowering="python",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", FLEXSPLINES)
def test_train_with_each_flexspline_law_follows_the_reference(name: str) -> None:
    case = FLEXSPLINES[name]
    with warnings.catch_warnings():
        warnings.simplefilter("error" if case.lowering == "symbolic" else "ignore", hm.LoweringWarning)
        response, reference = compared(case)
    assert response.lowering["gear"] == case.lowering
    worst = differences(response, reference, jumps=case.jumps)
    assert max(worst.values()) < LIMIT, worst
    if reference_of(case).edges[0]:
        assert any(which == 0 for _, which, _, _ in reference.passages)  # the law's kinks were really used


# -- motors ---------------------------------------------------------------------------------------------------

MOTOR_SPEEDS = (0.0, 40.0, 90.0, 125.0, 147.655, 157.08, 170.0)
MOTOR_TORQUES = (6.1, 5.2, 7.4, 8.6, 3.7, 0.0, -4.0)
"""An induction motor with a saddle, as in Fig. 4 of seed F; made-up numbers."""
SERVO = {"kp": 0.08, "ki": 0.6, "limit": 5.0, "wanted": 120.0, "ramp_time": 0.02}


def user_motor(speed: Any) -> Any:
    """A user's motor: torque falls linearly with speed."""
    return 6.0 - 0.05 * speed


MOTORS = {
    "Kloss near its rated point": Case(dict, dict, speed=145.0),
    "torque-speed table, ends held": Case(
        lambda: {"motor": hm.TorqueSpeedTable(speeds=MOTOR_SPEEDS, torques=MOTOR_TORQUES)},
        lambda: {"motor": laws.in_speed(laws.table(MOTOR_SPEEDS, MOTOR_TORQUES, hold=True))},
    ),
    "torque-speed table, end lines go on": Case(
        lambda: {"motor": hm.TorqueSpeedTable(speeds=MOTOR_SPEEDS[:-1], torques=MOTOR_TORQUES[:-1], extrapolate=True)},
        lambda: {"motor": laws.in_speed(laws.table(MOTOR_SPEEDS[:-1], MOTOR_TORQUES[:-1], hold=False))},
        speed=165.0,
    ),
    "servo with PI control that saturates": Case(
        lambda: {
            "motor": hm.ServoMotor(
                torque_limit=SERVO["limit"], proportional_gain=SERVO["kp"], integral_gain=SERVO["ki"],
                reference=hm.SpeedRamp(start=0.0, end=SERVO["wanted"], duration=SERVO["ramp_time"]),
            )
        },
        lambda: {"motor": laws.servo(**SERVO)},
    ),
    "ideal speed": Case(
        lambda: {"motor": hm.IdealSpeedMotor(motion=hm.SpeedRamp(start=0.0, end=150.0, duration=0.08))},
        lambda: {"motor": laws.speed_ramp(end=150.0, duration=0.08)},
    ),
    "inverter ramp": Case(
        lambda: {
            "motor": hm.InverterMotor.ramped(
                ramp_time=0.1, rated_power=550.0, rated_speed=NAME_PLATE["speed"], pole_pairs=2.0, breakdown_ratio=2.4
            )
        },
        lambda: {"motor": laws.inverter(**NAME_PLATE, ramp_time=0.1)},
    ),
    "plain Python function": Case(
        lambda: {"motor": user_motor},
        lambda: {"motor": laws.in_speed(lambda w: 6.0 - w / 20.0)},
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", MOTORS)
def test_train_with_each_motor_follows_the_reference(name: str) -> None:
    case = MOTORS[name]
    response, reference = compared(case)
    worst = differences(response, reference)
    if name == "ideal speed":
        # a prescribed rotor agrees to rounding; its torque is what the motion takes
        assert worst["motor.angle"] < 1e-14
        needed = _ideal_torque(reference)
        inside = np.abs(response.times - 0.08) > 1e-9  # the set acceleration jumps there
        assert np.max(np.abs(response.values["motor.torque"] - needed)[inside]) < LIMIT * np.max(np.abs(needed))
    assert max(worst.values()) < LIMIT, worst
    if name.startswith("servo"):
        assert {region for _, which, _, region in reference.passages if which == 2} >= {1, 2}  # in and out of the limit
        integral = response.values["motor.integral"]
        assert np.max(np.abs(integral - reference.states[:, 0])) < LIMIT * np.max(np.abs(integral))


def _ideal_torque(reference: Reference) -> np.ndarray:
    """J_s w' + T_in with w' = 150/0.08 rad/s^2 during the ramp; from (1)."""
    inertia, ramp = 1.5e-3 + 0.5e-5, 150.0 / 0.08
    twist = reference.angles["motor"] - reference.angles["gear.wave_generator"]
    rate = reference.speeds["motor"] - reference.speeds["gear.wave_generator"]
    return inertia * np.where(reference.times < 0.08, ramp, 0.0) + 1e4 * twist + 0.05 * rate


# -- loads ------------------------------------------------------------------------------------------------------

LOAD_TIMES = (0.01, 0.03, 0.05, 0.09, 0.2)
LOAD_TORQUES = (2.0, 30.0, -10.0, 25.0, 40.0)
LOAD_SPEEDS = (-1.0, 0.0, 0.4, 0.8, 1.2)
LOAD_SPEED_TORQUES = (-3.0, 6.0, 14.0, 20.0, 35.0)

LOADS = {
    "constant": Case(
        lambda: {"load": hm.ConstantTorque(value=15.0)},
        lambda: {"load": laws.in_time(lambda t: 15.0)},
    ),
    "start-up ramp to 10 N m in 0.5 s": Case(
        lambda: {"load": hm.RampTorque(start=0.0, end=10.0, duration=0.5)},
        lambda: {"load": laws.in_time(laws.table((0.0, 0.5), (0.0, 10.0), hold=True))},
        duration=0.55,
    ),
    "table over time": Case(
        lambda: {"load": hm.TableTorque(times=LOAD_TIMES, torques=LOAD_TORQUES)},
        lambda: {"load": laws.in_time(laws.table(LOAD_TIMES, LOAD_TORQUES, hold=True))},
    ),
    "table over speed": Case(
        lambda: {"load": hm.TorqueSpeedLoad(speeds=LOAD_SPEEDS, torques=LOAD_SPEED_TORQUES, symmetry="none")},
        lambda: {"load": laws.in_speed(laws.table(LOAD_SPEEDS, LOAD_SPEED_TORQUES, hold=True))},
    ),
    "quadratic in speed": Case(
        lambda: {"load": hm.QuadraticLoad(coefficient=12.0)},
        lambda: {"load": laws.in_speed(laws.Pieces((0.0,), (laws.polynomial(0.0, 0.0, -12.0), laws.polynomial(0.0, 0.0, 12.0))))},
    ),
    "plain Python function of time, angle and speed": Case(
        lambda: {"load": lambda time, angle, speed: 8.0 + 30.0 * np.sin(9.0 * angle) + 4.0 * speed + 20.0 * time},
        lambda: {"load": laws.Drive(torque=lambda t, q, w, z, region: 8.0 + 30.0 * math.sin(9.0 * q) + 4.0 * w + 20.0 * t)},
    ),
}


@pytest.mark.parametrize("name", LOADS)
def test_train_with_each_load_follows_the_reference(name: str) -> None:
    response, reference = compared(LOADS[name])
    worst = differences(response, reference)
    assert max(worst.values()) < LIMIT, worst


# -- the equations themselves, and the reference itself ---------------------------------------------------------------

EVERY = {f"flexspline: {k}": v for k, v in FLEXSPLINES.items()} | {f"motor: {k}": v for k, v in MOTORS.items()} | {
    f"load: {k}": v for k, v in LOADS.items()
}  # fmt: skip


@pytest.mark.parametrize("name", EVERY)
def test_right_hand_sides_agree_at_random_states(name: str) -> None:
    case = EVERY[name]
    model, network = reference_of(case), train(**case.scene()).network()
    bodies = [body.name for body in network.bodies]
    places = {body: k for k, place in enumerate(BODIES) for body in bodies if network.places[place] == body}
    rng = np.random.default_rng(7)
    for _ in range(200):
        t, twist = float(rng.uniform(0.0, 0.3)), float(rng.uniform(-4e-3, 4e-3))
        q_fs = float(rng.uniform(-0.1, 0.1))
        q_wg = 100.0 * (q_fs + twist)
        w = rng.uniform(-200.0, 200.0, 4) * np.array([1.0, 1.0, 0.01, 0.01])
        if model.motor.motion is not None:
            region = model.regions(t, [0.0] * 8)[1:]
            q_s, w[0], _ = model.motor.motion(t, region)
            q_wg = q_s + float(rng.uniform(-1e-3, 1e-3))
            q_fs = q_wg / 100.0 - twist
        else:
            q_s = q_wg + float(rng.uniform(-1e-3, 1e-3))
        states = rng.uniform(-20.0, 20.0, len(model.motor.start))
        y = np.array([q_s, q_wg, q_fs, q_fs + float(rng.uniform(-1e-3, 1e-3)), *w, *states])
        moment = network.moment(
            t,
            {body: y[k] for body, k in places.items()},
            {body: y[4 + k] for body, k in places.items()},
            {state.name: states[k] for k, state in enumerate(network.states)},
        )
        ours, theirs = network.accelerations(moment), model.right_side(t, y)
        for body, k in places.items():
            # rounding of the twists (1e-16 of the angle) times the stiffness over the inertia
            slack = 1e-12 * abs(theirs[4 + k]) + 4e-16 * (1e4 * abs(q_wg) / 1.7e-4 + 2e5 * abs(q_fs) / 4e-4)
            assert abs(ours[body] - theirs[4 + k]) <= slack, (body, ours[body], theirs[4 + k])
        for k, state in enumerate(network.states):
            assert ours[state.name] == pytest.approx(theirs[8 + k], rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("name", ["flexspline: catalogue, no damping inside the gap", "motor: servo with PI control that saturates"])
@pytest.mark.parametrize(("method", "relative"), [("LSODA", 1e-12), ("Radau", 1e-10)])
def test_reference_agrees_with_another_integrator(name: str, method: str, relative: float) -> None:
    model = reference_of(EVERY[name])
    times = np.linspace(0.0, 0.03, 301)
    one, other = integrate(model, times), integrate(model, times, method=method, relative=relative, absolute=relative * 1e-2)
    scale = np.max(np.abs(one.torque))
    assert np.max(np.abs(one.torque - other.torque)) < 0.1 * LIMIT * scale
    for body in BODIES:
        assert np.max(np.abs(one.speeds[body] - other.speeds[body])) < 0.1 * LIMIT * np.max(np.abs(one.speeds[body]))
    assert [passage[1:] for passage in one.passages] == [passage[1:] for passage in other.passages]
