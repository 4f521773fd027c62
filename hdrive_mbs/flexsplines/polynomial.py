"""Polynomials of one side of a stiffness curve: value, tangent continuation, smallest slope."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.polynomial import polynomial

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value


def continued(size: Value, coefficients: Sequence[float], end: float | None) -> Value:
    """sum(c_k x^k), coefficients in rising order; beyond ``end`` its tangent there."""
    if end is None:
        return _horner(size, coefficients)
    inside = np.minimum(size, end)
    return _horner(inside, coefficients) + _horner(end, _slope(coefficients)) * (size - inside)


def _horner(x: Value, coefficients: Sequence[float]) -> Value:
    result: Value = 0.0
    for coefficient in reversed(coefficients):
        result = result * x + coefficient
    return result


def _slope(coefficients: Sequence[float]) -> list[float]:
    return [k * coefficient for k, coefficient in enumerate(coefficients)][1:]


def smallest_slope(coefficients: Sequence[float], start: float, end: float | None) -> tuple[float, float]:
    """Smallest slope on [start, end] (to infinity for None) and where it is.

    Exact: the slope is looked at in the ends and where its own derivative is zero.
    """
    slope = np.trim_zeros(np.array(_slope(coefficients)), "b")
    if len(slope) < 2:
        return (float(slope[0]) if len(slope) else 0.0), start
    if end is None and slope[-1] < 0.0:
        return -math.inf, math.inf
    roots = polynomial.polyroots(polynomial.polyder(slope)) if len(slope) > 2 else np.zeros(0)
    turning = [float(root.real) for root in roots if abs(root.imag) <= 1e-9 * abs(root)]
    last = math.inf if end is None else end
    places = [start, *([] if end is None else [end]), *(x for x in turning if start < x < last)]
    values = [float(polynomial.polyval(x, slope)) for x in places]
    lowest = int(np.argmin(values))
    return values[lowest], places[lowest]


def check_rising(owner: str, coefficients: Sequence[float], start: float, end: float | None, *, offset: float = 0.0) -> None:
    """Raise ParameterError where the torque falls with the twist.

    offset : what to add to x to name the twist in the message; a slope of -1e-9 of the largest
    slope term counts as zero, which is the rounding of a fit that lies on this limit.
    """
    lowest, where = smallest_slope(coefficients, start, end)
    reach = start if end is None else end
    scale = max((abs(c) * reach**k for k, c in enumerate(_slope(coefficients))), default=0.0)
    if lowest < -1e-9 * scale:
        place = "for large twists" if math.isinf(where) else f"at a twist of {where + offset:.4g} rad"
        shown = "" if math.isinf(lowest) else f" ({lowest:.4g} N m/rad)"
        raise ParameterError(
            f"{owner}: the torque falls with rising twist {place}{shown}; it must rise. Change the coefficients or give "
            "largest_twist, the twist up to which they hold; beyond it the law goes on along its tangent."
        )
