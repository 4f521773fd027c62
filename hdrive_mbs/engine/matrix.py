"""Constant matrices in the form that costs exudyn least."""

from __future__ import annotations

from typing import Any

import exudyn as exu
import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_matrix

DENSE = 0.5
"""Share of entries above which a dense matrix is faster (the two planes of a round shaft do not meet: 0.3)."""


def compact(values: npt.NDArray[np.float64]) -> Any:
    """Nothing for zeros, a sparse container where most entries are zero, else the matrix itself."""
    if not values.any():
        return []
    if np.count_nonzero(values) > DENSE * values.size:
        return values
    container = exu.MatrixContainer()
    container.SetWithSparseMatrix(csr_matrix(values), values.shape[0], values.shape[1], False)
    return container
