"""Motions that no spring resists: a line that turns or slides as a whole."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.linalg.lapack import dgecon, dgetrf

FloatArray = npt.NDArray[np.float64]

FREE = 1e-13
"""A motion is free where the stiffness, each coordinate scaled to 1 on the diagonal, is below this share of the largest.

Rounding leaves about 1e-15 of an exact zero; a shaft of 100 elements on soft bearings comes down to 1e-10.
"""


def free_motions(stiffness: FloatArray) -> FloatArray:
    """Columns that span the null space of K, (n, r); K may be unsymmetric."""
    n = len(stiffness)
    diagonal = np.abs(np.diag(stiffness))
    scale = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    scaled = scale[:, None] * stiffness * scale
    factors, _, singular = dgetrf(scaled)
    if singular == 0:
        reciprocal, _ = dgecon(factors, np.linalg.norm(scaled, 1))
        if reciprocal > 1e3 * FREE:
            return np.zeros((n, 0))
    _, sizes, rows = np.linalg.svd(scaled)
    return np.asarray(scale[:, None] * rows[sizes <= FREE * sizes[0]].T, float)
