"""Steady rotation of a rotor line: static deflection under weight and bearing forces at a speed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.operating_point import at_speed, operating_point
from hdrive_mbs.analysis.whirl.following_states import FollowingStates
from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices
from hdrive_mbs.errors import AnalysisError
from hdrive_mbs.scene import Scene

FloatArray = npt.NDArray[np.float64]
_Vector = Callable[[FloatArray], FloatArray]

TOLERANCE = 1e-10
"""Unbalanced force over the largest force involved at which the deflection counts as found."""
REACH = 1e-6
"""Displacements and tilts [m, rad] over which forces are differenced through states that follow them."""


@dataclass(frozen=True)
class RotorPoint:
    """A state of steady rotation: forward angles, speeds and states by coordinate, and the speed of the reference shaft."""

    speed: float
    angles: Mapping[str, float]
    speeds: Mapping[str, float]
    states: Mapping[str, float]


def rotor_point(scene: Scene, speed: float, *, lines: LineMatrices | None = None, start: RotorPoint | None = None) -> RotorPoint:
    """Static deflection and twist while everything turns at its ideal ratio of the reference speed [rad/s].

    lines : the linearised line, if it is built already;  start : a state to begin with (a neighbouring speed)

    Rotors count as balanced, loads and motor as at t = 0.  Raises AnalysisError when forces cannot be balanced (a
    shaft that nothing holds, a journal bearing without load).
    """
    turning = at_speed(scene, speed)
    network = turning.network()
    lines = lines if lines is not None and lines.network is network else LineMatrices(network)
    twist = operating_point(turning, motor_speed=speed)
    spins = {body.name: body for body in network.bodies if not body.lateral}
    speeds = {name: body.sense * body.ratio * speed for name, body in spins.items()}
    angles = {name: twist.angles.get(name, 0.0) for name in spins}
    lateral = [k for k, body in enumerate(network.bodies) if body.lateral]
    names = [lines.names[k] for k in lateral]
    at_rest = dict.fromkeys(names, 0.0)

    following = FollowingStates(network)
    held = {state.name: state.initial for state in network.states} | dict(twist.states)

    def state(q: FloatArray) -> tuple[dict[str, float], dict[str, float], Mapping[str, float]]:
        placed, moving = {**angles, **dict(zip(names, q.tolist(), strict=True))}, {**speeds, **at_rest}
        return placed, moving, {**held, **following.at_rest(placed, moving, held)} if following else held

    def unbalanced(q: FloatArray) -> FloatArray:
        return lines.forces(*state(q))[lateral]

    def slope(q: FloatArray) -> FloatArray:
        stiffness = lines.at(*state(q)).stiffness[np.ix_(lateral, lateral)]
        return stiffness - _through(q, lambda at: lines.forces(*state(q)[:2], state(at)[2])[lateral]) if following else stiffness

    q = np.array([start.angles[name] if start is not None else 0.0 for name in names])
    scale = max(1.0, *(float(np.max(np.abs(unbalanced(at)), initial=0.0)) for at in (q, 0.0 * q)))  # of the weights too
    q, force = _balanced(q, unbalanced, slope, TOLERANCE * scale)
    if float(np.linalg.norm(force)) > 1e-6 * scale:
        q, force = _held_then_released(np.zeros(len(names)), unbalanced, slope, scale)
    if float(np.linalg.norm(force)) > 1e-6 * scale:
        worst = names[int(np.argmax(np.abs(force)))]
        raise AnalysisError(
            f"No static deflection of {scene.name!r} at {speed:g} rad/s: {float(np.max(np.abs(force))):.3g} N or N m stay unbalanced "
            f"at {worst!r}. "
            "Something has to hold every place laterally there: bearings for each shaft, a motor's beyond a coupling too; give weight "
            "(a Gravity part) to bearings that need a load."
        )
    return RotorPoint(speed, *state(q))


def _through(q: FloatArray, forces: _Vector) -> FloatArray:
    """d(forces)/dq of what follows q in states, by differences that are as long as displacements of lines are."""
    steps = REACH * np.eye(len(q))
    return np.array([(forces(q + step) - forces(q - step)) / (2.0 * REACH) for step in steps]).T


def _balanced(q: FloatArray, unbalanced: _Vector, slope: _Vector, enough: float) -> tuple[FloatArray, FloatArray]:
    """Newton's method with halved steps; returns the last displacements and the force left over."""
    force = unbalanced(q)
    for _ in range(100):
        size = float(np.linalg.norm(force))
        if size <= enough:
            break
        step = np.linalg.lstsq(slope(q), force, rcond=1e-13)[0]
        for _halving in range(40):
            trial = q + step
            new = unbalanced(trial)
            if np.all(np.isfinite(new)) and np.linalg.norm(new) < size * (1.0 - 1e-6):
                break
            step = 0.5 * step
        else:
            break
        q, force = trial, new
    return q, force


def _held_then_released(q: FloatArray, unbalanced: _Vector, slope: _Vector, scale: float) -> tuple[FloatArray, FloatArray]:
    """Equilibrium of a line that lies in its clearances: springs to the ground at every coordinate, then softer and softer ones."""
    for soft in scale / 1e-5 * 10.0 ** -np.arange(0.0, 14.0):
        held = soft * np.eye(len(q))
        q, _ = _balanced(q, lambda at: unbalanced(at) - held @ at, lambda at: slope(at) + held, TOLERANCE * scale)  # noqa: B023
    return _balanced(q, unbalanced, slope, TOLERANCE * scale)
