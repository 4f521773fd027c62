"""How fast the fastest motion of a line is, and the longest step of the classical Runge-Kutta method for it."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

import hdrive_mbs as hm
from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices
from hdrive_mbs.analysis.whirl.rotor_point import rotor_point

ComplexArray = npt.NDArray[np.complex128]


def eigenvalues(scene: hm.Scene, speeds: tuple[float, ...] = (0.0, 1000.0)) -> ComplexArray:
    """All eigenvalues of the linearised line [1/s] at some speeds [rad/s]."""
    lines = LineMatrices(scene.network())
    found = []
    for speed in speeds:
        point = rotor_point(scene, speed, lines=lines)
        system = lines.at(point.angles, point.speeds, point.states)
        zero, one = np.zeros_like(system.mass), np.eye(len(system.mass))
        lower = -np.linalg.solve(system.mass, np.hstack([system.stiffness, system.damping]))
        found.append(np.linalg.eigvals(np.vstack([np.hstack([zero, one]), lower])))
    return np.concatenate(found)


def growth(z: ComplexArray) -> npt.NDArray[np.float64]:
    """|R(z)| of the classical Runge-Kutta method: R = 1 + z + z^2/2 + z^3/6 + z^4/24."""
    return np.asarray(np.abs(1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0)))))


def longest_step(values: ComplexArray) -> float:
    """The longest step [s] for which no decaying motion grows: |R(h lambda)| <= 1.

    Motions slower than a thousandth of the fastest are left out: rounding decides on the sign of a decay near zero.
    """
    fast = values[np.abs(values) > 1e-3 * np.max(np.abs(values))]
    low, high = 0.0, 4.0 / float(np.max(np.abs(fast)))
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if np.all(growth(middle * fast) <= 1.0 + 1e-9) else (low, middle)
    return low
