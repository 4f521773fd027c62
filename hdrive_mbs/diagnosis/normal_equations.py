"""J^T W J and J^T W r in stretches of samples, so that no second Jacobian is held beside the first; what they promise of a step."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

STRETCH = 16_384
"""Samples at a time."""


def normal_equations(columns: FloatArray, weights: FloatArray, residuals: FloatArray) -> tuple[FloatArray, FloatArray]:
    """J^T W J, shape (size, size), and J^T W r, shape (size,).

    columns : J, shape (n, size);  weights : diagonal of W, shape (n,);  residuals : r, shape (n,)
    """
    size = columns.shape[1]
    curvature, slope = np.zeros((size, size)), np.zeros(size)
    for first in range(0, len(columns), STRETCH):
        some = slice(first, first + STRETCH)
        weighted = columns[some] * weights[some, None]
        curvature += weighted.T @ columns[some]
        slope += weighted.T @ residuals[some]
    return curvature, slope


def promised(move: FloatArray, normal: FloatArray, slope: FloatArray) -> float:
    """What the quadratic model says that a step lowers the cost by.

    move : d, shape (size,);  normal : J^T W J + P, shape (size, size);  slope : J^T W r + P z, shape (size,)
    """
    return -float(slope @ move) - 0.5 * float(move @ normal @ move)
