"""A symmetric matrix as a sum of springs: K = sum(k_n f_n f_n^T), with factors f_n that are cheap to multiply by.

A beam in one plane, whose matrix has 16 entries, is two springs: along theta_a - theta_b, and along
theta_a + theta_b - 2 (x_b - x_a)/L.  Source: for f in the range of a positive semidefinite K and k = 1/(f.K^+ f) the rest
K - k f f^T is positive semidefinite and has one rank less (Wedderburn's rank reduction).
"""

from __future__ import annotations

import functools
import itertools
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

NEGLIGIBLE = 1e-11
"""Relative size of what is rounding in a matrix whose diagonal is scaled to 1."""
DIGITS = 44
"""Binary digits of the entries of a matrix that count: rounding, 4e-14 of it, is far below what is negligible."""


@dataclass(frozen=True, eq=False)
class Spring:
    """k (f.q)^2 / 2 over the coordinates of a matrix."""

    stiffness: float
    factors: FloatArray


def springs(matrix: FloatArray) -> list[Spring] | None:
    """The springs of a positive semidefinite matrix without zero rows; None for any other matrix."""
    diagonal = np.diag(matrix)
    if not np.all(diagonal > 0.0):
        return None
    scale = 1.0 / np.sqrt(diagonal)
    rest = matrix * np.outer(scale, scale)
    if np.max(np.abs(rest - rest.T)) > NEGLIGIBLE:
        return None
    found: list[Spring] = []
    while np.max(np.abs(rest)) > NEGLIGIBLE:
        pivot = int(np.argmax(np.diag(rest)))
        column = rest[:, pivot]
        if np.max(np.abs(rest * rest[pivot, pivot] - np.outer(column, column))) <= NEGLIGIBLE:
            factors = _rounded(np.where(np.abs(column) < NEGLIGIBLE, 0.0, column / scale))
            stiffness = float(rest[pivot, pivot] / (scale[pivot] * factors[pivot]) ** 2)
            return [*found, Spring(stiffness, factors)]
        values, vectors = np.linalg.eigh(rest)
        if values[0] < -NEGLIGIBLE:
            return None
        kept = values > NEGLIGIBLE
        factors = _factors(rest, vectors[:, kept], scale)
        along = vectors[:, kept].T @ (scale * factors)
        stiffness = 1.0 / float(np.sum(along**2 / values[kept]))
        found.append(Spring(stiffness, factors))
        rest = rest - stiffness * np.outer(scale * factors, scale * factors)
    return found


def springs_of(matrix: FloatArray) -> tuple[Spring, ...] | None:
    """Likewise, found once for matrices that are multiples of each other: a section with another modulus, its damping."""
    size = float(matrix[0, 0])
    if not size > 0.0:
        return None
    mantissas, exponents = np.frexp(matrix / size)
    shape = np.ldexp(np.rint(np.ldexp(mantissas, DIGITS)), exponents - DIGITS) + 0.0  # without the sign of zeros
    found = _springs(len(matrix), shape.tobytes())
    return None if found is None else tuple([Spring(size * spring.stiffness, spring.factors) for spring in found])


@functools.lru_cache(maxsize=512)
def _springs(size: int, entries: bytes) -> tuple[Spring, ...] | None:
    found = springs(np.frombuffer(entries).reshape(size, size))
    return None if found is None else tuple(found)


def _factors(rest: FloatArray, span: FloatArray, scale: FloatArray) -> FloatArray:
    """Factors in the range of the scaled rest, the simplest there are."""
    simple = _simple(len(rest)) * scale
    outside = simple - (simple @ span) @ span.T
    within = np.sum(outside**2, axis=1) < NEGLIGIBLE * np.sum(simple**2, axis=1)
    if within.any():
        return np.asarray(_simple(len(rest))[int(np.argmax(within))])
    pivot = int(np.argmax(np.diag(rest)))
    return _rounded(np.where(np.abs(rest[:, pivot]) < NEGLIGIBLE, 0.0, rest[:, pivot] / scale))


@functools.cache
def _simple(n: int) -> FloatArray:
    """One coordinate, differences and sums of two, a row each."""
    one = np.eye(n)
    pairs = list(itertools.combinations(range(n), 2))
    return np.array([*one, *(one[i] + sign * one[j] for i, j in pairs for sign in (-1.0, 1.0))])


def _rounded(column: FloatArray) -> FloatArray:
    """Multiplied so that the most frequent magnitude is 1 (the last one, where two are as frequent), equal ones made equal."""
    sizes: list[float] = []
    group = np.full(len(column), -1)
    for k in np.flatnonzero(column):
        near = [n for n, size in enumerate(sizes) if abs(abs(column[k]) - size) < NEGLIGIBLE * size]
        if not near:
            sizes.append(abs(float(column[k])))
        group[k] = near[0] if near else len(sizes) - 1
    counts = [int(np.sum(group == n)) for n in range(len(sizes))]
    unit = max(range(len(sizes)), key=lambda n: (counts[n], n))
    ratios = np.array([size / sizes[unit] for size in sizes] + [0.0])
    ratios[unit] = 1.0
    return np.asarray(np.sign(column) * ratios[group])


def forget() -> None:
    """Let go of the springs that are kept for equal matrices."""
    _springs.cache_clear()
