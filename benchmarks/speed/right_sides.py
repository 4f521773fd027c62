"""The train's right-hand side by hand: with numpy, in plain scalar Python, and compiled by numba.

Seed F (1)-(4) with its misprints corrected, catalogue stiffness (7)-(10), Kloss's motor and a
sinusoidal load, written as one would for scipy: no numpy on scalars, constants bound once, the
pieces of the stiffness chosen by ``if``.  y = (q1 .. q4, w1 .. w4): motor, wave generator,
flexspline, machine, counted forward.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

import hdrive_mbs as hm

FloatArray = npt.NDArray[np.float64]
BODIES = ("motor", "gear.wave_generator", "gear.flexspline", "load")


def numba_or_none() -> Any:
    """numba, or None where it is not installed (it is in the extra ``bench``)."""
    try:
        import numba
    except ImportError:
        return None
    return numba


def scalar_right_side(scene: hm.Scene) -> Callable[..., tuple[float, ...]]:
    """f(t, q1 .. w4) -> the eight derivatives.  Plain Python that numba compiles too."""
    motor, gear, machine = scene.parts["motor"], scene.parts["gear"], scene.parts["load"]
    input_shaft, output_shaft = scene.parts["input_shaft"], scene.parts["output_shaft"]
    curve, law, load = motor.characteristic, gear.stiffness, machine.torque
    if not isinstance(law, hm.PiecewiseLinearStiffness) or not isinstance(curve, hm.AsynchronousMotor) or load.phase != 0.0:
        raise ValueError("the hand-written right-hand side is for the train of models/harmonic_drive_train.py only")
    j1 = motor.inertia + 0.5 * input_shaft.inertia
    j2 = gear.wave_generator_inertia + 0.5 * input_shaft.inertia
    j3 = gear.flexspline_inertia + 0.5 * output_shaft.inertia
    j4 = machine.inertia + 0.5 * output_shaft.inertia
    k_in, b_in, k_out, b_out = input_shaft.stiffness, input_shaft.damping, output_shaft.stiffness, output_shaft.damping
    u, b_fs = gear.ratio, gear.damping
    k1, k2, k3, t1, t2 = law.stiffness_1, law.stiffness_2, law.stiffness_3, law.torque_1, law.torque_2
    edge = 0.5 * law.lost_motion
    corner1 = edge + t1 / k1
    corner2 = corner1 + (t2 - t1) / k2
    # Kloss: M = 2 M_b s_b s / (s^2 + s_b^2), s = 1 - w/w_s
    w_s = 2.0 * math.pi * curve.line_frequency / curve.pole_pairs
    s_b = (1.0 - curve.rated_speed / w_s) * (curve.breakdown_ratio + math.sqrt(curve.breakdown_ratio**2 - 1.0))
    top, s_b2 = 2.0 * curve.breakdown_ratio * curve.rated_power / curve.rated_speed * s_b, s_b * s_b
    mean, swing, omega = load.mean, load.amplitude, 2.0 * math.pi * load.frequency
    sin = math.sin

    def right(
        t: float, q1: float, q2: float, q3: float, q4: float, w1: float, w2: float, w3: float, w4: float
    ) -> tuple[float, float, float, float, float, float, float, float]:
        slip = 1.0 - w1 / w_s
        t_in = k_in * (q1 - q2) + b_in * (w1 - w2)
        twist = q2 / u - q3
        size = abs(twist)
        if size <= edge:
            elastic = 0.0
        elif size <= corner1:
            elastic = k1 * (size - edge)
        elif size <= corner2:
            elastic = t1 + k2 * (size - corner1)
        else:
            elastic = t2 + k3 * (size - corner2)
        if twist < 0.0:
            elastic = -elastic
        mesh = elastic + b_fs * (w2 / u - w3)
        t_out = k_out * (q3 - q4) + b_out * (w3 - w4)
        return (
            w1,
            w2,
            w3,
            w4,
            (top * slip / (slip * slip + s_b2) - t_in) / j1,
            (t_in - mesh / u) / j2,
            (mesh - t_out) / j3,
            (t_out - mean - swing * sin(omega * t)) / j4,
        )

    return right


def python_right_side(scene: hm.Scene) -> Callable[[float, FloatArray], tuple[float, ...]]:
    """f(t, y) in plain Python.  One ``tolist`` first: arithmetic on numpy scalars would cost twice as much."""
    right = scalar_right_side(scene)
    return lambda t, y: right(t, *y.tolist())


def numpy_right_side(scene: hm.Scene) -> Callable[[float, FloatArray], FloatArray]:
    """f(t, y) with arrays, np.interp and np.concatenate, as most people write it for solve_ivp."""
    motor, gear, machine = scene.parts["motor"], scene.parts["gear"], scene.parts["load"]
    input_shaft, output_shaft = scene.parts["input_shaft"], scene.parts["output_shaft"]
    law, load, curve = gear.stiffness, machine.torque, motor.characteristic
    ends = 0.5 * np.array([input_shaft.inertia, input_shaft.inertia, output_shaft.inertia, output_shaft.inertia])
    inertia = np.array([motor.inertia, gear.wave_generator_inertia, gear.flexspline_inertia, machine.inertia]) + ends
    edge = 0.5 * law.lost_motion
    corners = edge + np.cumsum([0.0, law.torque_1 / law.stiffness_1, (law.torque_2 - law.torque_1) / law.stiffness_2, 1.0])
    torques = np.array([0.0, law.torque_1, law.torque_2, law.torque_2 + law.stiffness_3])
    w_s = 2.0 * np.pi * curve.line_frequency / curve.pole_pairs
    s_b = (1.0 - curve.rated_speed / w_s) * (curve.breakdown_ratio + np.sqrt(curve.breakdown_ratio**2 - 1.0))
    breakdown = curve.breakdown_ratio * curve.rated_power / curve.rated_speed

    def right(t: float, y: FloatArray) -> FloatArray:
        q, w = y[:4], y[4:]
        slip = 1.0 - w[0] / w_s
        m_motor = 2.0 * breakdown * s_b * slip / (slip**2 + s_b**2)
        m_load = load.mean + load.amplitude * np.sin(2.0 * np.pi * load.frequency * t)
        t_in = input_shaft.stiffness * (q[0] - q[1]) + input_shaft.damping * (w[0] - w[1])
        twist, rate = q[1] / gear.ratio - q[2], w[1] / gear.ratio - w[2]
        mesh = np.sign(twist) * np.interp(np.abs(twist), corners, torques) + gear.damping * rate
        t_out = output_shaft.stiffness * (q[2] - q[3]) + output_shaft.damping * (w[2] - w[3])
        torque = np.array([m_motor - t_in, t_in - mesh / gear.ratio, mesh - t_out, t_out - m_load])
        return np.concatenate((w, torque / inertia))

    return right


def compiled_right_side(scene: hm.Scene) -> Callable[[float, FloatArray], FloatArray]:
    """f(t, y) compiled by numba."""
    numba = numba_or_none()
    right = numba.njit(scalar_right_side(scene))

    @numba.njit
    def function(t: float, y: FloatArray) -> FloatArray:
        out = np.empty(8)
        out[0], out[1], out[2], out[3], out[4], out[5], out[6], out[7] = right(t, y[0], y[1], y[2], y[3], y[4], y[5], y[6], y[7])
        return out

    function(0.0, np.zeros(8))
    return function
