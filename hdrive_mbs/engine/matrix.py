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
    return compact_alike(values)[0]


def compact_alike(*matrices: npt.NDArray[np.float64]) -> list[Any]:
    """Each matrix compact, all that are not zero in one form: exudyn wants stiffness and damping both dense or both sparse."""
    dense = any(np.count_nonzero(values) > DENSE * values.size for values in matrices)
    return [[] if not values.any() else values if dense else _sparse(values) for values in matrices]


def _sparse(values: npt.NDArray[np.float64]) -> Any:
    container = exu.MatrixContainer()
    container.SetWithSparseMatrix(csr_matrix(values), values.shape[0], values.shape[1], False)
    return container
