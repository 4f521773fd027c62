"""Equations M a = f with a constant mass matrix, solved by recorded operations.

M = L D L^T in the order of the reverse Cuthill-McKee method, block by block; a coordinate that shares no mass is one
multiplication, and of a line of n stations every forward and backward step takes as many as the band of M is wide.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.groups import groups
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.tracked import Tracked, plain
from hdrive_mbs.tracked_arrays import is_tracked, pattern

FloatArray = npt.NDArray[np.float64]

NEGLIGIBLE = 1e-13
"""Relative size of what is rounding in a factor or an inverse of a matrix whose diagonal is scaled to 1."""


@dataclass(frozen=True, eq=False)
class _Factor:
    """A part of a mass matrix as L D L^T, its rows in their new order.

    order : rows of the part
    below, right : entries of L left of the diagonal in each row, and under it in each column: (other index, value)
    inverse : of the diagonal D, and ``root`` the matrix L D^(1/2)
    """

    order: tuple[int, ...]
    below: tuple[tuple[tuple[int, float], ...], ...]
    right: tuple[tuple[tuple[int, float], ...], ...]
    inverse: tuple[float, ...]
    root: FloatArray


@dataclass(frozen=True, eq=False)
class _Block:
    """A part of a mass matrix over named coordinates in the order of its factor.

    known : the factor of its plain numbers, where entries and inverse of the other one are tracked
    """

    names: tuple[str, ...]
    factor: _Factor
    known: _Factor


class ConstantMass:
    """A symmetric mass matrix over named coordinates, factorised."""

    def __init__(self, names: Sequence[str], matrix: FloatArray) -> None:
        self.names = tuple(names)
        self._blocks = [self._block(at, matrix) for at in groups(pattern(matrix) | np.eye(len(matrix), dtype=bool))]

    def _block(self, at: Sequence[int], matrix: FloatArray) -> _Block:
        part = matrix[np.array(at)[:, None], at]
        known = _factor(len(at), np.asarray(part, float).tobytes())
        if known is None:
            raise ParameterError(
                f"The masses of {', '.join(self.names[k] for k in at)} are not positive: give each of these places mass and inertia."
            )
        names = tuple([self.names[at[k]] for k in known.order])
        return _Block(names, _tracked(known, part) if is_tracked(part) else known, known)

    def solve(self, forces: Mapping[str, Value]) -> dict[str, Value]:
        """Accelerations of all coordinates; a missing force is zero."""
        found: dict[str, Value] = {}
        for block in self._blocks:
            factor = block.factor
            passed: list[Value] = []
            for name, row in zip(block.names, factor.below, strict=True):
                value = forces.get(name, 0.0)
                for j, entry in row:
                    value = value - entry * passed[j]
                passed.append(value)
            solved = [inverse * value for inverse, value in zip(factor.inverse, passed, strict=True)]
            for i in reversed(range(len(solved))):
                for j, entry in factor.right[i]:
                    solved[i] = solved[i] - entry * solved[j]
            found |= dict(zip(block.names, solved, strict=True))
        return found

    def column(self, force: Mapping[str, float]) -> dict[str, float]:
        """Accelerations from these forces alone, without those that are rounding."""
        found: dict[str, float] = {}
        for block in self._blocks:
            given = [force.get(name, 0.0) for name in block.names]
            if not any(given):
                continue
            kept = [(block.names[k], value) for k, value in _column(block.known, tuple([plain(value) for value in given]))]
            if block.factor is not block.known or any(type(value) is Tracked for value in given):
                solved = self.solve(dict(zip(block.names, given, strict=True)))
                kept = [(name, solved[name]) for name, _ in kept]
            found |= dict(kept)
        return found


@lru_cache(maxsize=1024)
def _factor(size: int, entries: bytes) -> _Factor | None:
    """Of a matrix; None where it is not positive definite."""
    matrix = np.frombuffer(entries).reshape(size, size)
    if size == 1 and matrix[0, 0] > 0.0:
        order, root = np.zeros(1, int), np.sqrt(matrix)
    else:
        order = _cuthill_mckee(matrix)
        try:
            root = np.linalg.cholesky(matrix[order[:, None], order])
        except np.linalg.LinAlgError:
            return None
    diagonal = np.diag(root)
    lower = root / diagonal
    lower[np.abs(root) < NEGLIGIBLE * diagonal[:, None]] = 0.0
    inverse = 1.0 / diagonal**2
    below = tuple(tuple((j, float(lower[i, j])) for j in np.flatnonzero(lower[i, :i]).tolist()) for i in range(size))
    right = tuple(tuple((j, float(lower[j, i])) for j in np.flatnonzero(lower[:, i]).tolist() if j > i) for i in range(size))
    return _Factor(tuple(order.tolist()), below, right, tuple(inverse.tolist()), lower / np.sqrt(inverse))


def _tracked(factor: _Factor, matrix: FloatArray) -> _Factor:
    """The factor of a matrix with tracked numbers from that of its plain ones: the same entries, worked out one by one.

    That it is positive for other numbers too is a comparison that is kept.
    """
    entries: dict[tuple[int, int], float] = {}
    pivots: list[float] = []
    for i, row in enumerate(factor.below):
        left: dict[int, float] = {}  # entries of the row times their pivots
        for j, _ in row:
            value = matrix.item(factor.order[i], factor.order[j])
            for k, part in left.items():
                if (j, k) in entries:
                    value = value - part * entries[j, k]
            left[j], entries[i, j] = value, value / pivots[j]
        pivot = matrix.item(factor.order[i], factor.order[i])
        for j, value in left.items():
            pivot = pivot - value * entries[i, j]
        if not pivot > 0.0:
            raise ArithmeticError(f"A pivot of a mass matrix that is positive came out as {pivot:g}.")
        pivots.append(pivot)
    below = tuple(tuple((j, entries[i, j]) for j, _ in row) for i, row in enumerate(factor.below))
    right = tuple(tuple((j, entries[j, i]) for j, _ in column) for i, column in enumerate(factor.right))
    return replace(factor, below=below, right=right, inverse=tuple(1.0 / pivot for pivot in pivots))


def _cuthill_mckee(matrix: FloatArray) -> npt.NDArray[np.intp]:
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import reverse_cuthill_mckee

    if len(matrix) == 1:
        return np.zeros(1, np.intp)
    return np.asarray(reverse_cuthill_mckee(csr_array(matrix), symmetric_mode=True), np.intp)


@lru_cache(maxsize=1024)
def _column(factor: _Factor, given: tuple[float, ...]) -> tuple[tuple[int, float], ...]:
    """Place and value of the accelerations from given forces."""
    root = factor.root
    solved = np.linalg.solve(root.T, np.linalg.solve(root, np.array(given)))
    size = np.abs(solved) * np.linalg.norm(root, axis=1)
    return tuple((k, value) for k, (value, s) in enumerate(zip(solved.tolist(), size, strict=True)) if s > NEGLIGIBLE * size.max())


def forget() -> None:
    """Let go of factors and columns that are kept for equal matrices."""
    _factor.cache_clear()
    _column.cache_clear()
