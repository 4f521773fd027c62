"""Arrays with tracked numbers in them: of objects, with which numpy works entry by entry; of floats where no number is tracked.

What numpy itself makes of tracked numbers is an array of floats, which has forgotten where they came from (tracked.py).  Entries that are
zero stay plain zeros here, whatever they are multiplied by.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from hdrive_mbs.tracked import Tracked, plain

ROUNDING = 1e-11
"""Relative difference up to which entries of an array are in proportion."""

FloatArray = npt.NDArray[np.float64]
"""Of objects too; ``is_tracked`` tells."""


def array_of(values: Any) -> FloatArray:
    """Numbers, or rows of numbers, as an array."""
    found = np.array(values, object)
    return found if any(type(item) is Tracked for item in found.flat) else found.astype(float)


def as_array(values: npt.ArrayLike) -> FloatArray:
    """An array of floats as it is, anything else as ``array_of`` makes it."""
    return values if isinstance(values, np.ndarray) and values.dtype == float else array_of(values)


def is_tracked(array: FloatArray) -> bool:
    """Whether there may be tracked numbers in it."""
    return array.dtype == object


def has_tracked(described: object) -> bool:
    """Whether a field of an object is a tracked number."""
    return any(type(value) is Tracked for value in vars(described).values())


def pattern(array: FloatArray) -> npt.NDArray[np.bool_]:
    """Where its entries are not zero.  Of tracked ones this is not kept: one that becomes zero is multiplied all the same."""
    return np.asarray(np.asarray(array, float) != 0.0)


def zeros(shape: tuple[int, ...], *, like: FloatArray) -> FloatArray:
    """Zeros that can be overwritten by entries of another array."""
    return np.full(shape, 0.0, like.dtype)


def diagonal(values: Any) -> FloatArray:
    """A square matrix with these numbers on its diagonal."""
    found = array_of(values)
    matrix = zeros((len(found), len(found)), like=found)
    matrix[np.arange(len(found)), np.arange(len(found))] = found
    return matrix


def scaled(factor: float, array: FloatArray) -> FloatArray:
    """An array times a number."""
    if type(factor) is not Tracked:
        return factor * array
    found = np.full(array.shape, 0.0, object)
    for at in np.argwhere(pattern(array)).tolist():
        found[tuple(at)] = factor * array.item(*at)
    return found


def largest(array: FloatArray) -> float:
    """The largest magnitude of its entries.  Of tracked ones it is that of the same entry later, whichever is the largest then."""
    place = np.argmax(np.abs(np.asarray(array, float)))
    return abs(array.ravel().item(int(place)))


def proportions(array: FloatArray, size: float) -> FloatArray:
    """Its entries over a size, as plain numbers; that tracked ones stay in proportion is a comparison that is kept.

    Raises ArithmeticError where they are not even now.
    """
    found: FloatArray = np.asarray(array, float) / plain(size)
    if is_tracked(array) or type(size) is Tracked:
        for entry, share in zip(array.ravel().tolist(), found.ravel().tolist(), strict=True):
            expected = share * size
            if share != 0.0 and not abs(entry - expected) <= ROUNDING * abs(expected):
                raise ArithmeticError(f"{entry:g} is not {share:g} of {size:g}.")
    return found


def congruent(matrix: FloatArray, arm: FloatArray) -> FloatArray:
    """arm^T matrix arm with an arm of plain numbers: a matrix over other coordinates, of which the arm makes its own."""
    if not is_tracked(matrix):
        return np.asarray(arm.T @ matrix @ arm)
    rows = [[(k, factor) for k, factor in enumerate(row) if factor != 0.0] for row in arm.tolist()]
    found = np.full((arm.shape[1],) * 2, 0.0, object)
    for i, j in np.argwhere(pattern(matrix)).tolist():
        for k, left in rows[i]:
            for n, right in rows[j]:
                found[k, n] = found[k, n] + left * right * matrix[i, j]
    return found


def added_at(matrix: FloatArray, at: npt.NDArray[np.intp], part: FloatArray) -> FloatArray:
    """The matrix with a part added in some rows and columns: the same array, or another one where the part has tracked numbers alone."""
    if is_tracked(part) and not is_tracked(matrix):
        matrix = matrix.astype(object)
    matrix[at[:, None], at] = matrix[at[:, None], at] + part
    return matrix
