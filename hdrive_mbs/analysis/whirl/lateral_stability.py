"""Whether whirl of a line dies out, and from which speed it does not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import eigh

from hdrive_mbs.analysis.unbalance.speed_line import SpeedLine

FloatArray = npt.NDArray[np.float64]

ROUNDING = 1e-10
"""Growth over the largest eigenvalue, and negative damping over the largest, that count as zero."""

SYMMETRIC = 1e-12
"""Difference of two entries opposite each other, over the root of the two on the diagonal, that counts as none."""

ALL_MODES = 60
"""Coordinates up to which stability is judged with all of them."""

LOW_MODES = 40
"""Modes of the undamped, still line in which a longer one is judged."""

MOST_SPEEDS = 41
"""Speeds at which a longer line is judged."""


@dataclass(frozen=True, kw_only=True)
class Instability:
    """A motion that grows: the lowest speed at which one was found, how fast it grows there and its frequency [rad/s].

    speed : where stability is lost [rad/s], or the first speed asked for
    growth : real part of the eigenvalue [1/s], somewhat above that speed
    """

    speed: float
    growth: float
    frequency: float


def instability(line: SpeedLine, speeds: FloatArray) -> Instability | None:
    """The first of the ascending speeds [rad/s] at which a motion grows, narrowed down; None for a stable line.

    With symmetric, positive definite stiffness and damping that takes energy nothing grows, whatever the gyroscopic
    terms (Kelvin, Tait and Chetaev), and no eigenvalue is calculated.  A line of more than 60 coordinates is judged
    at 41 speeds in its lowest 40 modes.
    """
    long = line.size > ALL_MODES
    chosen = speeds if not long or len(speeds) <= MOST_SPEEDS else speeds[np.linspace(0, len(speeds) - 1, MOST_SPEEDS).round().astype(int)]
    root = np.linalg.cholesky(line.mass)
    into = np.linalg.inv(root).T
    if long:
        middle = line.matrices(float(chosen[len(chosen) // 2]))[1]
        into = eigh(0.5 * (middle + middle.T), line.mass, subset_by_index=(0, LOW_MODES - 1))[1]
    previous: float | None = None
    for speed in chosen.tolist():
        growth, frequency = _growth(line, speed, into)
        if growth > 0.0:
            low, high = (speed, speed) if previous is None else (previous, speed)
            while high - low > 1e-6 * max(abs(low), abs(high)):
                middle_speed = 0.5 * (low + high)
                if _growth(line, middle_speed, into)[0] > 0.0:
                    high = middle_speed
                else:
                    low = middle_speed
            return Instability(speed=high, growth=growth, frequency=frequency)
        previous = speed
    return None


def _growth(line: SpeedLine, speed: float, into: FloatArray) -> tuple[float, float]:
    """Largest real part and its frequency in coordinates in which the mass is one; zero where nothing can grow."""
    plain = line.matrices(speed)
    damping, stiffness = (into.T @ matrix @ into for matrix in plain)
    drag = 0.5 * (damping + damping.T)
    if _is_symmetric(plain[1]) and float(np.linalg.eigvalsh(stiffness)[0]) > 0.0:
        lowest = float(np.linalg.eigvalsh(drag)[0])
        if lowest >= -ROUNDING * float(np.max(np.abs(drag), initial=0.0)):
            return 0.0, 0.0
    n, scale = len(stiffness), max(float(np.sqrt(np.max(np.abs(stiffness)))), 1e-300)
    values = np.linalg.eigvals(np.block([[np.zeros((n, n)), scale * np.eye(n)], [-stiffness / scale, -damping]]))
    worst = values[np.argmax(values.real)]
    if worst.real <= ROUNDING * float(np.max(np.abs(values))):
        return 0.0, 0.0
    return float(worst.real), float(abs(worst.imag))


def _is_symmetric(matrix: FloatArray) -> bool:
    size = np.sqrt(np.abs(np.diag(matrix)))
    return bool(np.all(np.abs(matrix - matrix.T) <= SYMMETRIC * np.outer(size, size)))
