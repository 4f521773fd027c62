"""A converged solution of the train, and the error of another one against it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import BPoly

import hdrive_mbs as hm
from benchmarks.speed.right_sides import FloatArray, compiled_right_side, numba_or_none, python_right_side

STIFF_START = 0.1
"""s: until here the mode at 8000 rad/s, excited by the start, is resolved by 1e-5 s; it decays with 176 1/s."""


@dataclass(frozen=True)
class Reference:
    """scipy's DOP853 at 1e-12, joined by quintic Hermite pieces through its angles, speeds and accelerations.

    agreement : largest scaled difference to scipy's Radau at 1e-11, a method of another family
    """

    angles: BPoly
    speeds: BPoly
    sizes: FloatArray
    agreement: float

    def error(self, times: FloatArray, states: FloatArray) -> float:
        """max over the bodies' angles and speeds of max|difference| / max|channel|, at the given times."""
        exact = np.concatenate([self.angles(times), self.speeds(times)], axis=1).T
        worst = np.max(np.abs(states - exact), axis=1) / self.sizes
        return float(np.max(worst)) if np.isfinite(worst).all() else float("inf")


def reference(scene: hm.Scene, duration: float) -> Reference:
    """Integrate the train twice, by two families of methods, and compare."""
    long = duration > 0.1  # then compiling pays
    right = compiled_right_side(scene) if long and numba_or_none() is not None else python_right_side(scene)
    times, states = _integrate(right, duration, "DOP853", 1e-12, 1e-14, (1e-5, 3e-5))
    accelerations = np.array([right(t, y) for t, y in zip(times.tolist(), states.T, strict=True)])[:, 4:]
    angles = BPoly.from_derivatives(times, np.stack([states[:4].T, states[4:].T, accelerations], axis=1))
    found = Reference(angles, angles.derivative(), np.max(np.abs(states), axis=1), 0.0)
    other = _integrate(right, duration, "Radau", 1e-11, 1e-13, (np.inf, np.inf))
    return Reference(found.angles, found.speeds, found.sizes, found.error(*other))


def _integrate(
    right: Callable[..., object], duration: float, method: str, relative: float, absolute: float, max_steps: tuple[float, float]
) -> tuple[FloatArray, FloatArray]:
    times, states = [np.zeros(1)], [np.zeros((8, 1))]
    middle = min(STIFF_START, 0.5 * duration)
    for start, end, max_step in ((0.0, middle, max_steps[0]), (middle, duration, max_steps[1])):
        part = solve_ivp(right, (start, end), states[-1][:, -1], method=method, rtol=relative, atol=absolute, max_step=max_step)
        assert part.success, part.message
        times.append(part.t[1:])
        states.append(part.y[:, 1:])
    return np.concatenate(times), np.concatenate(states, axis=1)
