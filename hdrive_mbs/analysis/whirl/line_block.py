"""Independent groups of coordinates of a line, and the roots of one group."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.linalg import solve_triangular
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from hdrive_mbs.analysis.whirl.free_motions import free_motions
from hdrive_mbs.analysis.whirl.roots import ComplexArray, FloatArray, Roots, solve_roots
from hdrive_mbs.analysis.whirl.spinning_line import SpinningLine
from hdrive_mbs.errors import AnalysisError

IndexArray = npt.NDArray[np.intp]


def line_blocks(line: SpinningLine) -> list[LineBlock]:
    """Bending, torsion and axial motion apart, where nothing couples them; both bending planes together, as orbits are of both."""
    couplings = line.couplings.astype(float)
    index = {name: k for k, name in enumerate(line.names)}
    for spin in line.ratios:
        station = [index[name] for name in (f"{spin}.{key}" for key in ("x", "y", "psi", "theta")) if name in index]
        couplings[np.ix_(station, station)] = 1.0
    count, label = connected_components(csr_array(couplings), directed=False)
    return [LineBlock(line, np.flatnonzero(label == k)) for k in range(count)]


class LineBlock:
    """M q'' + D(W) q' + K(W) q = 0 of coordinates that nothing couples to any other.

    index : of its n coordinates in the line
    is_constant : whether nothing in it depends on the speed
    """

    def __init__(self, line: SpinningLine, index: IndexArray) -> None:
        self.line, self.index = line, index
        self._at = np.ix_(index, index)
        self.names = tuple(line.names[k] for k in index)
        self.mass = line.mass[self._at]
        self._affine: tuple[FloatArray, ...] | None = None
        if line.is_affine:
            self._affine = tuple(matrix[self._at] for matrix in (*line.at(0.0), *line.slopes(0.0)))
        self.is_constant = self._affine is not None and not any(matrix.any() for matrix in self._affine[2:])

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return len(self.index)

    def cholesky(self) -> FloatArray:
        """L of M = L L'.  Raises AnalysisError where a motion has no positive inertia."""
        try:
            return np.asarray(np.linalg.cholesky(self.mass), float)
        except np.linalg.LinAlgError:
            raise AnalysisError(
                f"The mass matrix of {', '.join(self.names[:6])}{' ...' if self.size > 6 else ''} is not positive definite, so modes are "
                "not defined. Give every place there mass and moments of inertia."
            ) from None

    def at(self, speed: float) -> tuple[FloatArray, FloatArray]:
        """D and K, (n, n)."""
        if self._affine is None:
            damping, stiffness = self.line.at(speed)
            return damping[self._at], stiffness[self._at]
        damping, stiffness, damping_slope, stiffness_slope = self._affine
        return damping + speed * damping_slope, stiffness + speed * stiffness_slope

    def slopes(self, speed: float) -> tuple[FloatArray, FloatArray]:
        """dD/dW and dK/dW, (n, n)."""
        if self._affine is None:
            damping, stiffness = self.line.slopes(speed)
            return damping[self._at], stiffness[self._at]
        return self._affine[2], self._affine[3]

    @property
    def affine(self) -> tuple[FloatArray, ...] | None:
        """D0, K0, D1, K1 where D = D0 + W D1 and K = K0 + W K1."""
        return self._affine


class BlockModel:
    """A block in coordinates p with q = V p and V'M V = 1: the whole block, or a part of its motions.

    basis : V, (n, m); by default a square one, with which nothing is left out
    whirl : Hermitian form over q that is positive for forward whirl
    """

    def __init__(self, block: LineBlock, whirl: ComplexArray, basis: FloatArray | None = None) -> None:
        self.block = block
        self.is_whole = basis is None
        if basis is None:
            basis = solve_triangular(block.cholesky(), np.eye(block.size), lower=True).T
        self.basis = basis
        self._whirl = np.asarray(basis.T @ whirl @ basis, complex)
        self._affine = None if block.affine is None else tuple(self.project(matrix) for matrix in block.affine)
        self._free: FloatArray | None = None
        self._solved: dict[float, Roots] = {}
        self._last: tuple[FloatArray, FloatArray, Roots] | None = None

    def project(self, matrix: FloatArray) -> FloatArray:
        """V' A V."""
        return np.asarray(self.basis.T @ matrix @ self.basis, float)

    def at(self, speed: float) -> tuple[FloatArray, FloatArray]:
        """V' D V and V' K V."""
        if self._affine is None:
            damping, stiffness = self.block.at(speed)
            return self.project(damping), self.project(stiffness)
        damping, stiffness, damping_slope, stiffness_slope = self._affine
        return damping + speed * damping_slope, stiffness + speed * stiffness_slope

    def slopes(self, speed: float) -> tuple[FloatArray, FloatArray]:
        """V' dD/dW V and V' dK/dW V."""
        if self._affine is None:
            damping, stiffness = self.block.slopes(speed)
            return self.project(damping), self.project(stiffness)
        return self._affine[2], self._affine[3]

    def solve(self, speed: float) -> Roots:
        """All roots at a speed, solved once."""
        key = 0.0 if self.block.is_constant else speed
        if key not in self._solved:
            damping, stiffness = self.at(key)
            last = self._last
            if last is None or not (np.array_equal(damping, last[0]) and np.array_equal(stiffness, last[1])):
                last = damping, stiffness, solve_roots(damping, stiffness, self._free_at(key), lambda: self.slopes(key), self._whirl)
            self._last, self._solved[key] = last, last[2]
        return self._solved[key]

    def _free_at(self, speed: float) -> FloatArray:
        affine = self.block.affine
        if affine is not None and not affine[3].any():
            if self._free is None:
                self._free = self._into(free_motions(affine[1]))
            return self._free
        return self._into(free_motions(self.block.at(speed)[1]))

    def _into(self, motions: FloatArray) -> FloatArray:
        return self.basis.T @ self.block.mass @ motions if motions.size else np.zeros((self.basis.shape[1], 0))

    def shapes(self, roots: Roots) -> ComplexArray:
        """Right eigenvectors over the block's coordinates, (n, k)."""
        return np.asarray(self.basis @ roots.right)
