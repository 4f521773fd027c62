"""Tables in laws: checks, and straight lines between the points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Expression, Value
from hdrive_mbs.expression.by_identity import ByIdentity
from hdrive_mbs.quantities import Described


def check_table(law: Described, x: str, y: str) -> None:
    """Raise ParameterError unless the fields x and y are of one length, at least 2, and x rises."""
    owner = type(law).__name__
    xs, ys = getattr(law, x), getattr(law, y)
    if len(xs) != len(ys) or len(xs) < 2:
        raise ParameterError(f"{owner} has {len(xs)} {x} and {len(ys)} {y}; it needs the same number of both, at least 2.")
    unit = next(metadata["quantity"].unit for name, _, metadata in law.fields() if name == x)
    for i in range(1, len(xs)):
        if xs[i] <= xs[i - 1]:
            raise ParameterError(
                f"{owner}.{x}[{i}] = {xs[i]:g} {unit} does not rise above {x}[{i - 1}] = {xs[i - 1]:g} {unit}; "
                "sort the table and keep one value for each."
            )


def lines(x: Value, xs: Sequence[float], ys: Sequence[float]) -> Value:
    """Straight lines between the points; the first and the last one go on beyond the table."""
    first, last = (ys[1] - ys[0]) / (xs[1] - xs[0]), (ys[-1] - ys[-2]) / (xs[-1] - xs[-2])
    return np.interp(x, xs, ys) + first * np.minimum(x - xs[0], 0.0) + last * np.maximum(x - xs[-1], 0.0)


FloatArray = npt.NDArray[np.float64]

EDGE = 1e-3
"""Length of the edge between two held values, over the shortest time that one is held."""


def held(x: Value, xs: Sequence[float], ys: Sequence[float]) -> Value:
    """Each value from its own point to the next one; before the first point the first value.

    A change is a steep line centred on its point, where the mean of both values stands: so a solver whose steps
    meet the points adds up exactly what was held.
    """
    corners = _known.of(xs, ys, lambda: _corners(xs, ys))
    return np.interp(x, *(corners.recorded if isinstance(x, Expression) else corners.arrays))


@dataclass(frozen=True, eq=False)
class _Corners:
    """Ends of the edges and the values there; as tuples for a law that is recorded, which reads the same ones once."""

    arrays: tuple[FloatArray, FloatArray]
    recorded: tuple[tuple[float, ...], tuple[float, ...]]


_known: ByIdentity[_Corners] = ByIdentity(16)


def _corners(xs: Sequence[float], ys: Sequence[float]) -> _Corners:
    points, values = np.asarray(xs, float), np.asarray(ys, float)
    half = 0.5 * EDGE * float(np.min(np.diff(points)))
    corners: FloatArray = np.column_stack((points[1:] - half, points[1:] + half)).ravel()
    between: FloatArray = np.repeat(values, 2)[1:-1]
    return _Corners((corners, between), (tuple(corners.tolist()), tuple(between.tolist())))
