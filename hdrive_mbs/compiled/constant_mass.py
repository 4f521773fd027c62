"""Equations M a = f with a constant mass matrix, solved by recorded operations.

M = L D L^T in the order of the reverse Cuthill-McKee method, block by block; a coordinate that shares no mass is one
multiplication, and of a line of n stations every forward and backward step takes as many as the band of M is wide.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.groups import groups
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value

FloatArray = npt.NDArray[np.float64]

NEGLIGIBLE = 1e-13
"""Relative size of what is rounding in a factor or an inverse of a matrix whose diagonal is scaled to 1."""


@dataclass(frozen=True, eq=False)
class _Block:
    names: tuple[str, ...]
    lower: FloatArray
    """L, with 1 on its diagonal."""
    inverse: FloatArray
    """Of the diagonal D, shape (n,)."""


class ConstantMass:
    """A symmetric mass matrix over named coordinates, factorised."""

    def __init__(self, names: Sequence[str], matrix: FloatArray) -> None:
        self.names = tuple(names)
        self._blocks = [self._block(np.array(at), matrix) for at in groups((matrix != 0.0) | np.eye(len(matrix), dtype=bool))]

    def _block(self, at: npt.NDArray[np.intp], matrix: FloatArray) -> _Block:
        from scipy.sparse import csr_array
        from scipy.sparse.csgraph import reverse_cuthill_mckee

        order = at if len(at) == 1 else at[reverse_cuthill_mckee(csr_array(matrix[at[:, None], at]), symmetric_mode=True)]
        names = tuple(self.names[k] for k in order)
        part = matrix[order[:, None], order]
        try:
            root = np.sqrt(part) if len(at) == 1 and part[0, 0] > 0.0 else np.linalg.cholesky(part)
        except np.linalg.LinAlgError:
            raise ParameterError(
                f"The masses of {', '.join(names)} are not positive: give each of these places mass and inertia."
            ) from None
        diagonal = np.diag(root)
        lower = root / diagonal
        lower[np.abs(root) < NEGLIGIBLE * diagonal[:, None]] = 0.0
        return _Block(names, lower, 1.0 / diagonal**2)

    def solve(self, forces: Mapping[str, Value]) -> dict[str, Value]:
        """Accelerations of all coordinates; a missing force is zero."""
        found: dict[str, Value] = {}
        for block in self._blocks:
            n = len(block.names)
            passed: list[Value] = []
            for i, name in enumerate(block.names):
                value = forces.get(name, 0.0)
                for j in np.flatnonzero(block.lower[i, :i]):
                    value = value - float(block.lower[i, j]) * passed[j]
                passed.append(value)
            solved = [float(inverse) * value for inverse, value in zip(block.inverse, passed, strict=True)]
            for i in reversed(range(n)):
                for j in np.flatnonzero(block.lower[:, i]):
                    if j > i:
                        solved[i] = solved[i] - float(block.lower[j, i]) * solved[j]
            found |= dict(zip(block.names, solved, strict=True))
        return found

    def column(self, force: Mapping[str, float]) -> dict[str, float]:
        """Accelerations from these forces alone, without those that are rounding."""
        owners = [block for block in self._blocks if any(force.get(name, 0.0) != 0.0 for name in block.names)]
        found: dict[str, float] = {}
        for block in owners:
            root = block.lower / np.sqrt(block.inverse)
            given = np.array([force.get(name, 0.0) for name in block.names])
            solved = np.linalg.solve(root.T, np.linalg.solve(root, given))
            size = np.abs(solved) * np.linalg.norm(root, axis=1)
            found |= {name: float(a) for name, a, s in zip(block.names, solved, size, strict=True) if s > NEGLIGIBLE * size.max()}
        return found
