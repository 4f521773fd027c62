"""Damped roots of q'' + D q' + K q = 0 with right and left eigenvectors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import eig

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

OVERDAMPED = 0.999
"""Damping ratio from which a motion counts as one that does not oscillate: it falls by 1e-61 within a turn."""

RESOLVED = 1e-10
"""Share of the largest |lambda| below which a root is rounding: rigid motion that nothing resists."""

TOGETHER = (1e-13, 1e-9)
"""Roots closer than these shares of the largest |lambda| and of their own count as one multiple root, or closer than 2 n times the rounding
of the largest, for n states: each of two equal ones may be off by about n times it, as a rule of thumb for backward stable solvers.  The
first two of a shaft of 97 stations on bearings of 1e14 N/m (tests/verification/test_published_rotors.py) were 1360 times it apart with
scipy 1.14.0, n = 776, by a script that is not kept."""

APART = 1e-8
"""Difference of d(lambda)/d(speed) from which a multiple root parts with the speed."""


Slopes = Callable[[], tuple[FloatArray, FloatArray]]


@dataclass(frozen=True, eq=False)
class Roots:
    """The oscillating roots, ascending in |lambda|, and what else there is.

    values : lambda, (k,), with Im > 0
    right, left : x and y, (m, k):  (lambda^2 + lambda D + K) x = 0,  y* (lambda^2 + lambda D + K) = 0,  y* (2 lambda + D) x = 1
    left_damping : y* D, (k, m)
    decay : -Re(lambda) of the motions that do not oscillate [1/s], ascending
    free : number of motions without stiffness
    """

    values: ComplexArray
    right: ComplexArray
    left: ComplexArray
    left_damping: ComplexArray
    decay: FloatArray
    free: int

    def lowest(self, count: int) -> Roots:
        """The same with the ``count`` lowest oscillating roots only."""
        if count >= len(self.values):
            return self
        kept = slice(0, count)
        return Roots(self.values[kept], self.right[:, kept], self.left[:, kept], self.left_damping[kept], self.decay, self.free)

    def likeness(self, other: Roots) -> FloatArray:
        """|G|, (k, k'): 1 for the same root a small step on, 0 for any other one.

        At one speed y_i* ((lambda_i + lambda_j) + D) x_j vanishes for i != j, also with gyroscopic moments, damping and
        unsymmetric stiffness.  G is this product across two speeds times the one with both exchanged, so it does not
        depend on the scaling of the shapes.
        """
        total = self.values[:, None] + other.values[None, :]
        there = total * (self.left.conj().T @ other.right) + self.left_damping @ other.right
        back = total.T * (other.left.conj().T @ self.right) + other.left_damping @ self.right
        return np.asarray(np.abs(there * back.T))

    def slopes(self, damping_slope: FloatArray, stiffness_slope: FloatArray) -> ComplexArray:
        """d(lambda)/d(speed) = -y* (lambda D' + K') x, (k,)."""
        moved = damping_slope @ (self.right * self.values) + stiffness_slope @ self.right
        return np.asarray(-np.sum(self.left.conj() * moved, axis=0))


def solve_roots(
    damping: FloatArray,
    stiffness: FloatArray,
    free: FloatArray,
    slopes: Slopes,
    whirl: ComplexArray,
) -> Roots:
    """All roots of lambda^2 + lambda D + K (unit mass).

    free : motions without stiffness, (m, r); nothing depends on how far they have gone, so only their speeds count:
        kept in, each would be a double zero that rounding splits into a pair that looks like a slow mode
    slopes : gives dD/dW and dK/dW;  whirl : Hermitian form that is positive for forward whirl.  They choose the shapes
        of multiple roots: those into which the root parts as the speed grows, and backward before forward
    """
    m, r = free.shape
    elastic = np.linalg.qr(free, mode="complete")[0][:, r:] if r else np.eye(m)
    matrix = np.block([[np.zeros((m - r, m - r)), elastic.T], [-stiffness @ elastic, -damping]])
    values, left, right = eig(matrix, left=True, right=True)
    largest = float(np.max(np.abs(values), initial=0.0))
    size = np.abs(values)
    resolved = size > RESOLVED * largest
    swings = np.abs(values.real) < OVERDAMPED * size
    decay = np.sort(-values[resolved & ~swings].real)
    oscillating = resolved & swings & (values.imag > 0.0)
    order = np.flatnonzero(oscillating)[np.argsort(size[oscillating], kind="stable")]
    found = values[order]
    x, y = right[m - r :, order] / found, left[m - r :, order]
    x = x / np.linalg.norm(x, axis=0)
    _part_multiple_roots(found, x, y, damping, slopes, whirl, largest)
    product = np.sum(y.conj() * (2.0 * found * x + damping @ x), axis=0)
    y = y / np.where(product == 0.0, 1.0, product).conj()
    return Roots(found, x, y, y.conj().T @ damping, decay, r)


def _part_multiple_roots(
    values: ComplexArray,
    x: ComplexArray,
    y: ComplexArray,
    damping: FloatArray,
    slopes: Slopes,
    whirl: ComplexArray,
    largest: float,
) -> None:
    """Choose shapes in the space of each multiple root (in place)."""
    start = 0
    near = max(TOGETHER[0], 4 * len(damping) * float(np.finfo(float).eps)) * largest
    for end in range(1, len(values) + 1):
        if end < len(values):
            gap = abs(values[end] - values[start])
            if gap <= near + TOGETHER[1] * abs(values[start]):
                continue
        if end - start > 1:
            here = slice(start, end)
            x[:, here], y[:, here] = _parted(complex(np.mean(values[here])), x[:, here], y[:, here], damping, slopes, whirl)
        start = end


def _parted(
    value: complex,
    x: ComplexArray,
    y: ComplexArray,
    damping: FloatArray,
    slopes: Slopes,
    whirl: ComplexArray,
) -> tuple[ComplexArray, ComplexArray]:
    """Bases of the same spaces: parted by d(lambda)/d(speed), then by the sense of whirl."""
    product = y.conj().T @ (2.0 * value * x + damping @ x)
    if np.linalg.cond(product) > 1e6:  # a defective root: there is no basis
        return x, y
    damping_slope, stiffness_slope = slopes()
    moved = -(y.conj().T @ (value * (damping_slope @ x) + stiffness_slope @ x))
    rates, mix = np.linalg.eig(np.linalg.solve(product, moved))
    order = np.lexsort((rates.real, rates.imag))
    rates, x = rates[order], x @ mix[:, order]
    start = 0
    for end in range(1, len(rates) + 1):
        if end < len(rates) and abs(rates[end] - rates[start]) <= APART * max(1.0, abs(rates[start])):
            continue
        if end - start > 1:
            basis = np.linalg.qr(x[:, start:end])[0]
            x[:, start:end] = basis @ np.linalg.eigh(basis.conj().T @ whirl @ basis)[1]
        start = end
    x = x / np.linalg.norm(x, axis=0)
    again = y.conj().T @ (2.0 * value * x + damping @ x)
    return x, y @ np.linalg.inv(again).conj().T
