"""Where a branch of a Campbell diagram meets an order line, or zero damping."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq

from hdrive_mbs.analysis.drive_train.campbell import ExcitationOrder
from hdrive_mbs.errors import ParameterError, unknown_place
from hdrive_mbs.network.network import Network

FloatArray = npt.NDArray[np.float64]

Function = Callable[[float], float]


def order_lines(network: Network, orders: Sequence[float] | Mapping[str, Sequence[float]]) -> list[ExcitationOrder]:
    """Excitation orders: numbers per turn of the reference shaft, or place -> numbers per turn of that place.

    Raises ParameterError for an order that is not a number greater than 0, PlaceError for an unknown place.
    """
    ratios = {body.name: body.ratio for body in network.bodies if not body.lateral}
    ratios |= {motion.name: motion.ratio for motion in network.motions}
    if not isinstance(orders, Mapping):
        reference = next((name for name, ratio in ratios.items() if abs(ratio - 1.0) < 1e-9), next(iter(ratios)))
        orders = {reference: orders}
    lines = []
    for place, numbers in orders.items():
        if place not in network.places or network.places[place] not in ratios:
            raise unknown_place("place", place, [name for name, node in network.places.items() if node in ratios])
        slope = abs(ratios[network.places[place]])
        try:
            values = np.atleast_1d(np.asarray(numbers, float))
        except (TypeError, ValueError):
            values = np.array([np.nan])
        if values.ndim != 1 or not all(np.isfinite(values)) or not all(values > 0.0):
            raise ParameterError(f"orders of {place!r} = {numbers!r}: each must be a number greater than 0, per turn of the place.")
        lines += [ExcitationOrder(order=float(number), place=place, slope=float(number) * slope) for number in values]
    return lines


def zeros(speeds: FloatArray, values: FloatArray, exact: Function, slopes: FloatArray | None = None) -> Iterator[float]:
    """Speeds at which a function is zero.

    values : at the speeds (NaN where it does not exist)
    exact : the function between two speeds of the list
    slopes : its derivatives at the speeds, if known; then a double crossing within one step is found too
    """
    for k in range(len(speeds) - 1):
        a, b = float(speeds[k]), float(speeds[k + 1])
        if values[k] == 0.0:
            yield a
        if not np.isfinite(values[k] + values[k + 1]):
            continue
        if values[k] * values[k + 1] < 0.0:
            yield _zero(exact, a, b)
        elif slopes is not None and values[k] * values[k + 1] > 0.0:
            turn = _turning_point(a, b, values[k], values[k + 1], slopes[k], slopes[k + 1])
            if turn is not None and exact(turn) * values[k] < 0.0:
                yield _zero(exact, a, turn)
                yield _zero(exact, turn, b)
    if len(speeds) and values[-1] == 0.0:
        yield float(speeds[-1])


def _zero(exact: Function, a: float, b: float) -> float:
    return float(brentq(exact, a, b, xtol=1e-12 * max(1.0, abs(a), abs(b)), rtol=1e-13))


def _turning_point(a: float, b: float, start: float, end: float, first: float, last: float) -> float | None:
    """Where the cubic through both ends with their slopes comes beyond zero, if it does; None otherwise."""
    if not start * first < 0.0 or not end * last > 0.0:  # towards zero and away from it again
        return None
    h = b - a
    square, cube = 3.0 * (end - start) - h * (2.0 * first + last), 2.0 * (start - end) + h * (first + last)
    cubic = [cube, square, h * first, start]
    inside = [float(s) for s in np.roots(np.polyder(cubic)).real if 0.0 < float(s) < 1.0]
    beyond = [s for s in inside if float(np.polyval(cubic, s)) * start < 0.0]
    return a + h * beyond[0] if beyond else None
