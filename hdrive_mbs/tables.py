"""Tables in laws: checks, and straight lines between the points."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
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
