"""A few motions of a large block that hold its lowest modes at all speeds, checked against the whole block."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.linalg import cho_factor, cho_solve, eigh, solve_triangular
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

from hdrive_mbs.analysis.whirl.free_motions import free_motions
from hdrive_mbs.analysis.whirl.line_block import BlockModel, LineBlock
from hdrive_mbs.analysis.whirl.roots import ComplexArray, FloatArray, Roots

TOLERANCE = 1e-10
"""Estimated error of a root over its size beyond which the basis is extended."""

DISTINCT = 1e-9
"""Part of a motion outside the basis, over the motion, from which it counts as a new one."""

ROUNDS = 12


def reduced_model(block: LineBlock, whirl: ComplexArray, speeds: Sequence[float], wanted: int) -> BlockModel:
    """A model whose ``wanted`` lowest roots agree with those of the whole block at the speeds.

    Starts with the modes at rest, exact roots of the whole block at a few speeds follow (right and left shapes), and
    more of them wherever the residual in the whole block says that a root is not good enough.  A block that this does not
    make much smaller is kept whole.
    """
    whole = _Whole(block)
    rest = whole.modes_at_rest(speeds[0], 3 * wanted + 12)
    wide = [rest, *whole.answers(speeds, rest[:, : wanted + 2])]
    kept = [rest[:, : wanted + 2], free_motions(block.at(speeds[0])[1])]
    first = BlockModel(block, whirl, whole.basis(wide))
    for speed in dict.fromkeys((speeds[0], speeds[-1])):
        kept += whole.exact_shapes(speed, first, first.solve(speed).lowest(wanted))
    model = BlockModel(block, whirl, whole.basis(kept))
    for _ in range(ROUNDS):
        if model.basis.shape[1] > 0.7 * block.size:
            return BlockModel(block, whirl)
        worst = _worst(whole, model, speeds, wanted)
        if worst is None:
            return model
        speed, roots = worst
        kept += whole.exact_shapes(speed, model, roots)
        model = BlockModel(block, whirl, whole.basis(kept))
    return BlockModel(block, whirl)


def _worst(whole: _Whole, model: BlockModel, speeds: Sequence[float], wanted: int) -> tuple[float, Roots] | None:
    """The speed with the largest estimated error and its roots; None where all are good."""
    step = max(1, len(speeds) // 8)
    coarse = [*speeds[::step], speeds[-1]]
    for chosen in (coarse, speeds):
        errors = [whole.errors(speed, model, model.solve(speed).lowest(wanted)) for speed in chosen]
        largest = [float(np.max(error, initial=0.0)) for error in errors]
        k = int(np.argmax(largest))
        if largest[k] > TOLERANCE:
            return chosen[k], model.solve(chosen[k]).lowest(wanted)
    return None


class _Whole:
    """The whole block with sparse matrices."""

    def __init__(self, block: LineBlock) -> None:
        self.block = block
        self._mass = csc_array(block.mass)
        self._lower = block.cholesky()
        self._stiff: tuple[FloatArray, bool] | None = None

    def modes_at_rest(self, speed: float, count: int) -> FloatArray:
        """Lowest undamped modes of the symmetric part of the stiffness, (n, count), of unit mass."""
        stiffness = self.block.at(speed)[1]
        symmetric = 0.5 * (stiffness + stiffness.T)
        last = min(count, self.block.size) - 1
        values, vectors = eigh(symmetric, self.block.mass, subset_by_index=(0, last))
        shift = max(float(np.median(np.abs(values))), float(np.finfo(float).tiny))
        self._stiff = cho_factor(symmetric + (shift + max(0.0, -2.0 * float(values[0]))) * self.block.mass)
        return np.asarray(vectors, float)

    def answers(self, speeds: Sequence[float], motions: FloatArray) -> list[FloatArray]:
        """How the block yields to the forces that damping, gyroscopic moments and unsymmetric stiffness put on motions."""
        assert self._stiff is not None
        found = []
        for speed in dict.fromkeys((speeds[0], speeds[-1])):
            damping, stiffness = self.block.at(speed)
            for matrix in (damping, stiffness - stiffness.T):
                if matrix.any():
                    found.append(cho_solve(self._stiff, matrix @ motions))
        return found

    def basis(self, motions: Sequence[FloatArray]) -> FloatArray:
        """Distinct directions among the motions, orthonormal in the mass, (n, m)."""
        scaled = self._lower.T @ np.hstack(motions)
        size = np.linalg.norm(scaled, axis=0)
        left, sizes, _ = np.linalg.svd(scaled[:, size > 0.0] / size[size > 0.0], full_matrices=False)
        return np.asarray(solve_triangular(self._lower, left[:, sizes > DISTINCT * sizes[0]], lower=True, trans="T"), float)

    def exact_shapes(self, speed: float, model: BlockModel, roots: Roots) -> list[FloatArray]:
        """Real and imaginary parts of right and left shapes, improved by inverse iteration in the whole block."""
        found = []
        shapes = zip(roots.values.tolist(), (model.basis @ roots.right).T, (model.basis @ roots.left).T, strict=True)
        matrices = tuple(csc_array(matrix) for matrix in (self.block.mass, *self.block.at(speed)))
        for value, x, y in shapes:
            right, left = _improved(value, x, y, matrices)
            found += [right.real, right.imag, left.real, left.imag]
        return [np.array(found).T] if found else []

    def errors(self, speed: float, model: BlockModel, roots: Roots) -> FloatArray:
        """Estimated |error| of each root over its size:  |l* S r / (y* Q' x)|.

        r = Q x and l = Q* y are the residuals in the whole block of Q = lambda^2 M + lambda D + K; they have no part in the
        basis, where Q is close to the stiffness S (with a shift), whose inverse is taken.
        """
        assert self._stiff is not None
        damping, stiffness = (csc_array(matrix) for matrix in self.block.at(speed))
        x, y = model.basis @ roots.right, model.basis @ roots.left
        right = np.asarray(self._mass @ (x * roots.values**2) + damping @ (x * roots.values) + stiffness @ x)
        conj = roots.values.conj()
        left = np.asarray(self._mass @ (y * conj**2) + damping.T @ (y * conj) + stiffness.T @ y)
        return np.asarray(np.abs(np.sum(left.conj() * cho_solve(self._stiff, right), axis=0)) / np.abs(roots.values))


def _improved(value: complex, x: ComplexArray, y: ComplexArray, matrices: tuple[csc_array, ...]) -> tuple[ComplexArray, ComplexArray]:
    """Right and left shape of the root next to a value by inverse iteration with Rayleigh's quotient."""
    mass, damping, stiffness = matrices
    for _ in range(4):
        try:
            factors: Any = splu(csc_array(value**2 * mass + value * damping + stiffness))
        except RuntimeError:  # singular to the last digit: the root itself
            break
        slope = csc_array(2.0 * value * mass + damping)
        x = factors.solve(slope @ x)
        y = factors.solve(slope.conj().T @ y, trans="H")
        x, y = x / np.linalg.norm(x), y / np.linalg.norm(y)
        # y* (l^2 M + l D + K) x = 0
        near = np.roots([complex(np.sum(y.conj() * np.asarray(matrix @ x))) for matrix in matrices])
        if not len(near) or not np.all(np.isfinite(near)):
            break
        old, value = value, complex(near[np.argmin(np.abs(near - value))])
        if abs(value - old) <= 1e-12 * abs(value):
            break
    return x, y
