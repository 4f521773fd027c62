"""Gauss-Newton steps that stay within what is allowed."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.hypothesis import Hypothesis

FloatArray = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]


def bounded_step(
    hypothesis: Hypothesis, z: FloatArray, normal: FloatArray, slope: FloatArray, damping: float = 0.0, held: Mask | None = None
) -> FloatArray:
    """Solution d of (N + damping diag N) d = -slope in which what would leave its range stops at the edge, and the rest knows of it.

    normal : N, shape (n, n);  held : coordinates that stay where they are instead of going to the edge

    Coordinates are pinned for good within a step, so it is an approximation of the bounded least-squares solution.
    """
    scale = np.sqrt(np.where(np.diag(normal) > 0.0, np.diag(normal), 1.0))
    matrix = normal / np.outer(scale, scale) + (damping + 1e-12) * np.eye(len(scale))
    right = slope / scale
    free = np.ones(len(z), dtype=bool)
    move = np.zeros(len(z))
    while free.any():
        pinned = matrix[np.ix_(free, ~free)] @ (move * scale)[~free]
        move[free] = -solved(matrix[np.ix_(free, free)], right[free] + pinned) / scale[free]
        allowed = hypothesis.clipped(z + move) - z
        outside = free & (np.abs(allowed - move) > 1e-12)
        if not outside.any():
            break
        move[outside] = allowed[outside]
        if held is not None:
            move[outside & held] = 0.0
        free &= ~outside
    return move


def solved(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Least-norm solution; zero where the numbers are not finite."""
    if not (np.isfinite(matrix).all() and np.isfinite(right).all()):
        return np.zeros_like(right)
    try:
        return np.asarray(np.linalg.lstsq(matrix, right, rcond=1e-14)[0])
    except np.linalg.LinAlgError:
        return np.zeros_like(right)
