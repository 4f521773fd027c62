"""Steady operating points: where all torques balance while the train turns at constant speed."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq

from hdrive_mbs.components.load import Load
from hdrive_mbs.components.motor import Motor
from hdrive_mbs.errors import AnalysisError, ParameterError, PlaceError
from hdrive_mbs.expression import gradient
from hdrive_mbs.loads.constant import ConstantTorque
from hdrive_mbs.motors.ideal_speed import IdealSpeedMotor
from hdrive_mbs.motors.profiles.constant import ConstantSpeed
from hdrive_mbs.motors.profiles.profile import SpeedProfile
from hdrive_mbs.network.elements import AppliedTorque, Connection
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network
from hdrive_mbs.scene import Scene

FloatArray = npt.NDArray[np.float64]


SIZES = (0.05, -0.05, 1e-3, -1e-3)
"""Twists [rad] from which Newton's method starts where the first guesses do not lead to balance."""


@dataclass(frozen=True, kw_only=True)
class OperatingPoint:
    """A state in which the train turns steadily.

    motor_speed : speed of the driving motor [rad/s]
    angles, speeds : forward angle [rad] and speed [rad/s] of each body
    states : values of the first-order states
    torques : torque through each connection [N m]
    in_gap : connections whose tangent stiffness vanishes there (inside lost motion or backlash)
    at_corner : connections whose stiffness differs between the two sides of the point
    residual : largest torque that stays unbalanced, over the largest torque
    """

    motor_speed: float
    angles: Mapping[str, float]
    speeds: Mapping[str, float]
    states: Mapping[str, float]
    torques: Mapping[str, float]
    in_gap: tuple[str, ...]
    at_corner: tuple[str, ...]
    residual: float


def with_load(scene: Scene, torque: float) -> Scene:
    """The scene with a constant load torque [N m] in place of its load law."""
    loads = [name for name, part in scene.parts.items() if isinstance(part, Load)]
    if not loads:
        raise PlaceError(f"Scene {scene.name!r} has no Load part, so a load torque of {torque:g} N m has no place.")
    return scene.replacing({f"{loads[-1]}.torque": ConstantTorque(value=torque)})


def at_speed(scene: Scene, motor_speed: float | None) -> Scene:
    """The scene with its prescribed motor turning constantly: at motor_speed, else as it does at t = 0."""
    ideal = {name: part.characteristic for name, part in scene.parts.items() if isinstance(part, Motor)}
    motions = {name: motor.motion for name, motor in ideal.items() if isinstance(motor, IdealSpeedMotor)}
    if len(motions) != 1:
        return scene
    ((name, motion),) = motions.items()
    assert isinstance(motion, SpeedProfile)
    speed = float(gradient(motion.angle)(np.float64(0.0))) if motor_speed is None else motor_speed
    return scene.replacing({f"{name}.characteristic.motion": ConstantSpeed(value=speed)})


def operating_point(scene: Scene, *, motor_speed: float | None = None, torque: float | None = None) -> OperatingPoint:
    """Solve for the twists (and states) at which nothing accelerates against its neighbour.

    motor_speed : rad/s; None for the speed at which the motor balances the load (0 when the scene
        has no such speed)
    torque : load torque [N m] in place of the scene's load law at t = 0

    The motor's rotor is held at its angle 0 and turns at its speed: the load torque is carried by
    whatever holds it, so the point exists for any speed.  Loads that depend on time are taken at
    t = 0.  Raises AnalysisError when the torques cannot be balanced.
    """
    if torque is not None:
        scene = with_load(scene, torque)
    if motor_speed is not None and not np.isfinite(motor_speed):
        raise ParameterError(f"motor_speed = {motor_speed} rad/s: must be a finite number.")
    network = at_speed(scene, motor_speed).network().turning()
    if motor_speed is None and network.motions_drive:
        motor_speed = _prescribed_speed(network)
    if motor_speed is not None:
        return _balance(network, motor_speed)
    guess = _balanced_speed(network)
    if not network.motions_drive and (network.states or len(_holding(network)) < len(_connections(network))):
        with contextlib.suppress(AnalysisError):
            return _balance(network, guess, find_speed=True)
    return _balance(network, guess)


def _prescribed_speed(network: Network) -> float:
    """Motor speed that belongs to the first prescribed motion at t = 0 (0 for one that the ideal train does not turn)."""
    motion = next(motion for motion in network.motions if motion.name != "ground")
    return float(motion.sense * motion.speed(np.float64(0.0)) / motion.ratio) if motion.ratio else 0.0


def _check_prescribed(network: Network, speed: float) -> None:
    for motion in network.motions:
        given, wanted = float(motion.sense * motion.speed(np.float64(0.0))), motion.ratio * speed
        if abs(given - wanted) > 1e-6 * max(1.0, abs(wanted)):
            raise ParameterError(
                f"motor_speed = {speed:g} rad/s would turn {motion.name!r} at {wanted:g} rad/s, but its motion is prescribed with "
                f"{given:g} rad/s at t = 0. Leave motor_speed out, or change the motion."
            )


def _moment(network: Network, speed: float | FloatArray, angles: FloatArray, states: FloatArray) -> Moment:
    """The state of steady rotation; angles and states have a row each, of numbers or of trials at once."""
    bodies = network.bodies
    return network.moment(
        np.float64(0.0),
        {body.name: angle for body, angle in zip(bodies, angles, strict=True)},
        {body.name: np.multiply(body.sense * body.ratio, speed) for body in bodies},
        {state.name: value for state, value in zip(network.states, states, strict=True)},
    )


def _balance(network: Network, speed: float, *, find_speed: bool = False) -> OperatingPoint:
    """Newton's method for angles and states at a speed; with find_speed for the speed too.

    Then the reference body must balance as well, which takes the integral of a speed controller to
    the torque that it holds.
    """
    _check_prescribed(network, speed)
    bodies, states = network.bodies, network.states
    n = len(bodies)
    # a train that can turn as a whole is held at its reference body
    held = next((k for k, body in enumerate(bodies) if abs(body.ratio - 1.0) < 1e-9), 0)
    matrix = _factor_matrix(_holding(network), [body.name for body in bodies])
    anchored = np.linalg.matrix_rank(matrix, tol=1e-9) == n if len(matrix) else False
    free = [k for k in range(n) if anchored or k != held]
    start_states = np.array([state.initial for state in states])

    balanced = [*free, held] if find_speed and not anchored else free

    def split(x: FloatArray) -> tuple[float | FloatArray, FloatArray, FloatArray]:
        angles = np.zeros((n, *x.shape[1:]))
        angles[free] = x[: len(free)]
        return (x[-1], angles, x[len(free) : -1]) if find_speed else (speed, angles, x[len(free) :])

    def residual(x: FloatArray) -> FloatArray:
        """Of one x, or of one in each column."""
        at, angles, values = split(x)
        total = network.torques(_moment(network, at, angles, values))
        rows = [total[bodies[k].name] for k in balanced] + [total[state.name] for state in states]
        return np.array([np.broadcast_to(np.asarray(row, float), x.shape[1:]) for row in rows]).reshape(len(rows), *x.shape[1:])

    best: tuple[float, FloatArray] | None = None
    starts = [_stretched(network, free, 0.0), *_static_guess(network, free, speed), *(_stretched(network, free, size) for size in SIZES)]
    for start in starts:
        guess = np.concatenate([start, start_states, [speed] if find_speed else []])
        x, error = _newton(residual, guess)
        if best is None or error < best[0]:
            best = (error, x)
        if error < 1e-9:
            break
    assert best is not None
    found, angles, values = split(best[1])
    speed = float(found)
    moment = _moment(network, speed, angles, values)
    torques = {c.name: float(c.value(moment)) for c in _connections(network)}
    scale = max([abs(v) for v in torques.values()] + [1e-3])
    if best[0] > 1e-6 * scale:
        raise AnalysisError(
            f"No steady operating point at {speed:g} rad/s: {best[0]:.3g} N m stay unbalanced. "
            "Give another motor_speed or torque, or analyse a simulated state."
        )
    sides = {c.name: _one_sided_stiffness(c, moment) for c in _connections(network)}
    return OperatingPoint(
        motor_speed=speed,
        angles={body.name: float(a) for body, a in zip(bodies, angles, strict=True)},
        speeds={body.name: float(moment.speed(body.name)) for body in bodies},
        states={state.name: float(v) for state, v in zip(states, values, strict=True)},
        torques=torques,
        in_gap=tuple(name for name, (below, above) in sides.items() if below == above == 0.0),
        at_corner=tuple(name for name, (below, above) in sides.items() if abs(below - above) > 0.01 * max(abs(below), abs(above))),
        residual=best[0] / scale,
    )


def _connections(network: Network) -> list[Connection]:
    return [element for element in network.elements if isinstance(element, Connection)]


def _holding(network: Network) -> list[Connection]:
    """The connections whose torque depends on their stretch: a friction between two places holds nothing."""
    still = np.zeros(len(network.bodies))
    moment = _moment(network, 0.0, still, np.array([state.initial for state in network.states]))

    def torques(connection: Connection) -> set[float]:
        return {float(connection.torque(moment, size, 0.0)) for size in (0.0, *SIZES)}

    return [connection for connection in _connections(network) if len(torques(connection)) > 1]


def _factor_matrix(connections: Sequence[Connection], names: list[str]) -> FloatArray:
    return np.array([[c.factors.get(name, 0.0) for name in names] for c in connections])


def _stretched(network: Network, free: list[int], size: float) -> FloatArray:
    """Angles at which every connection is stretched by ``size`` (least squares)."""
    connections = _holding(network)
    if not connections or not free:
        return np.zeros(len(free))
    matrix = _factor_matrix(connections, [network.bodies[k].name for k in free])
    return np.asarray(np.linalg.lstsq(matrix, np.full(len(connections), size), rcond=None)[0], float)


def _static_guess(network: Network, free: list[int], speed: float) -> list[FloatArray]:
    """Angles from equilibrium and the inverse of each law: torques first, then twists (empty where a law never gets there)."""
    connections = _holding(network)
    if not connections or not free:
        return []
    moment = _moment(network, speed, np.zeros(len(network.bodies)), np.array([state.initial for state in network.states]))
    names = [network.bodies[k].name for k in free]
    applied = dict.fromkeys(names, 0.0)
    for element in network.elements:
        if isinstance(element, AppliedTorque) and element.coordinate in applied:
            applied[element.coordinate] += float(element.value(moment))
    matrix = _factor_matrix(connections, names)
    torques = np.linalg.lstsq(matrix.T, np.array(list(applied.values())), rcond=None)[0]
    twists = [_twist_of(connection, moment, float(torque)) for connection, torque in zip(connections, torques, strict=True)]
    if any(twist is None for twist in twists):
        return []
    return [np.asarray(np.linalg.lstsq(matrix, np.array(twists, float), rcond=None)[0], float)]


def _twist_of(connection: Connection, moment: Moment, torque: float) -> float | None:
    """Twist at rest at which the connection carries the torque, outwards from zero; None within 1 rad."""
    if torque == 0.0:
        return 0.0
    low, high = 0.0, float(np.copysign(1e-7, torque))
    while abs(high) < 1.0:
        if float(connection.torque(moment, high, 0.0)) * np.sign(torque) >= abs(torque):
            return float(brentq(lambda x: float(connection.torque(moment, x, 0.0)) - torque, low, high, xtol=1e-15))
        low, high = high, 1.5 * high
    return None


def _newton(function: Callable[[FloatArray], FloatArray], x: FloatArray, iterations: int = 60) -> tuple[FloatArray, float]:
    """Newton's method with least-squares steps and halving; returns x and the largest residual."""
    value = function(x)
    error = float(np.max(np.abs(value), initial=0.0))
    for _ in range(iterations):
        if error < 1e-11:
            break
        step = np.linalg.lstsq(_jacobian(function, x), -value, rcond=1e-14)[0]
        for _halving in range(30):
            trial = x + step
            new = function(trial)
            size = float(np.max(np.abs(new), initial=0.0))
            if np.isfinite(size) and size < error * (1.0 - 1e-4):
                break
            step = 0.5 * step
        else:
            break
        x, value, error = trial, new, size
    return x, error


def _jacobian(function: Callable[[FloatArray], FloatArray], x: FloatArray) -> FloatArray:
    """Central differences, all in one call; one by one where a law does not take arrays, or means something else with them."""
    steps = 1e-7 * np.maximum(np.abs(x), 1e-2)
    trials = x[:, None] + np.hstack([np.diag(steps), -np.diag(steps)])
    try:
        values = function(trials)
        for k in {0, len(x) - 1, 2 * len(x) - 1} if len(x) else ():
            if not np.allclose(values[:, k], function(trials[:, k]), rtol=1e-9, atol=1e-12, equal_nan=True):
                raise ValueError(k)
    except Exception:  # whatever the law raises, the calls below raise again if it is real
        values = np.stack([function(trial) for trial in trials.T], axis=1)
    return np.asarray((values[:, : len(x)] - values[:, len(x) :]) / (2.0 * steps))


def _one_sided_stiffness(connection: Connection, moment: Moment) -> tuple[float, float]:
    """Slope of the torque just below and just above the stretch [N m/rad]."""
    at, h = connection.stretch(moment), 1e-7
    below, here, above = (float(connection.torque(moment, at + d, 0.0)) for d in (-h, 0.0, h))
    return (here - below) / h, (above - here) / h


def _balanced_speed(network: Network) -> float:
    """Highest stable speed at which motor and load torques balance, else 0.

    All bodies turn at their ideal ratio, so that springs between them carry no power and the sum of ratio times
    torque vanishes: g(w) = sum(ratio_i T_i(w)) = 0 with falling g.  States are at rest for each speed where they come
    to rest (the torque behind a lag), else at their initial values (the integral of a controller).
    """
    zeros = np.zeros(len(network.bodies))
    states = np.array([state.initial for state in network.states])
    turning = {body.name: body.sense * body.ratio for body in network.bodies}

    def surplus(speed: float) -> float:
        total = network.torques(_moment(network, speed, zeros, _settled(network, speed, states)))
        return sum(factor * float(total[name]) for name, factor in turning.items())

    speeds = np.concatenate([[0.0], np.geomspace(1e-2, 1e4, 400)])
    values = np.array([surplus(speed) for speed in speeds])
    falling = np.nonzero((values[:-1] > 0.0) & (values[1:] <= 0.0))[0]
    if not len(falling):
        return 0.0
    last = int(falling[-1])
    return float(brentq(surplus, speeds[last], speeds[last + 1], xtol=1e-12, rtol=1e-14))


def _settled(network: Network, speed: float, initial: FloatArray) -> FloatArray:
    """States whose rates vanish at a speed with nothing twisted; the initial ones where there are none."""
    if not len(initial):
        return initial
    zeros = np.zeros(len(network.bodies))

    def rates(values: FloatArray) -> FloatArray:
        total = network.torques(_moment(network, speed, np.zeros((len(zeros), *values.shape[1:])), values))
        rows = [np.broadcast_to(np.asarray(total[state.name], float), values.shape[1:]) for state in network.states]
        return np.array(rows).reshape(values.shape)

    found, error = _newton(rates, initial, iterations=20)
    return found if error < 1e-9 else initial
