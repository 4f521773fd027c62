"""How well any smooth model of its axis could explain a measured column: the noise that a diagnosis of real data needs.

An encoder of 24 bits sees every imperfection of the machine around it, so its own noise is no scale for a model's misfit:
with it every law is refused and log odds of thousands mean nothing.  What no function of the axis' own motion and load can
explain is the discrepancy of the whole class of models (Kennedy, O'Hagan, J. R. Statist. Soc. B 63 (2001) 425).  It is
estimated here without any of the laws that are tried: by a regression on a rich basis, each stretch of the record left out
in turn, so what the basis merely learns by heart does not count.  The errors of neighbouring samples are alike; white noise
beside first-order coloured noise takes that into account, or ten correlated samples would count as ten proofs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

STRETCHES = 20
"""Parts of a record that are left out in turn."""
RIDGE = 1e-3
"""Of the regression, relative to the mean square of each standardised column: keeps what hardly varies from growing."""


@dataclass(frozen=True)
class Floor:
    """White noise, and coloured noise with what a sample keeps of the one before; standard deviations in the column's unit."""

    white: float
    coloured: float
    kept: float

    @property
    def total(self) -> float:
        """Standard deviation of both."""
        return float(np.hypot(self.white, self.coloured))


def floor(records: Sequence[tuple[FloatArray, FloatArray]]) -> Floor:
    """The floor of one column.

    records : for each record the column and the basis at its samples, shapes (n,) and (n, m).  All share the regression;
        each has a constant of its own
    """
    values = np.concatenate([own - own.mean() for own, _ in records])
    basis = np.concatenate([own - own.mean(axis=0) for _, own in records])
    part = np.concatenate([np.arange(len(own)) * STRETCHES // len(own) for own, _ in records])
    left = np.zeros(len(values))
    for k in range(STRETCHES):
        out = part == k
        left[out] = values[out] - basis[out] @ _weights(basis[~out], values[~out])
    return fitted_noise(np.split(left, np.cumsum([len(own) for own, _ in records])[:-1]))


def _weights(basis: FloatArray, values: FloatArray) -> FloatArray:
    scale = np.maximum(basis.std(axis=0), 1e-300)
    known = basis / scale
    normal = known.T @ known / len(known) + RIDGE * np.eye(known.shape[1])
    return np.asarray(np.linalg.solve(normal, known.T @ values / len(known)) / scale)


def fitted_noise(residuals: Sequence[FloatArray]) -> Floor:
    """White and first-order coloured noise with the autocovariances at lags 0, 1 and 2 .. 5 of residuals.

    c_k = C a^k for k > 0 and c_0 = C + V, so a is the mean ratio of neighbouring c_k and C = c_1/a.
    """
    covariances = np.zeros(6)
    for values in residuals:
        centred = values - values.mean()
        covariances += [float(centred[: len(centred) - k] @ centred[k:]) / len(centred) / len(residuals) for k in range(6)]
    later = covariances[1:]
    if later[0] <= 0.0:
        return Floor(float(np.sqrt(covariances[0])), 0.0, 0.0)
    kept = float(np.clip(np.sum(later[1:] * later[:-1]) / np.sum(later[:-1] ** 2), 0.0, 0.995))
    coloured = min(later[0] / kept, 0.995 * covariances[0]) if kept > 0.0 else 0.0
    return Floor(float(np.sqrt(covariances[0] - coloured)), float(np.sqrt(coloured)), kept)


def basis_of(angle: FloatArray, speed: FloatArray, acceleration: FloatArray, *others: FloatArray) -> FloatArray:
    """Columns in which smooth models of one axis are nearly linear: powers of motion, steps at reversals, turns, what else acts."""
    slowest = 0.02 * float(np.abs(speed).max())
    columns = [angle, angle**2, np.sin(angle), np.cos(angle), speed, speed * np.abs(speed), acceleration, acceleration * angle]
    columns += [np.tanh(speed / (slowest * k)) for k in (1.0, 3.0, 10.0)] + [speed**3]
    for other in others:
        reversal = 0.02 * float(np.abs(other).max()) or 1.0
        columns += [other, other * np.abs(other), other * np.tanh(speed / slowest), *(np.tanh(other / (reversal * k)) for k in (1.0, 5.0))]
    return np.column_stack(columns)
