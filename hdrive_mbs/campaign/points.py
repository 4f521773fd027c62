"""The points of a campaign: name -> value, checked and in a form that always reads the same."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from hdrive_mbs.errors import ParameterError

Point = Mapping[str, Any]
"""Name -> number, text or switch."""


def grid(values: Mapping[str, Iterable[Any]]) -> tuple[dict[str, Any], ...]:
    """Every combination of the values, the last name running fastest.

    ``grid({"gear.ratio": (80, 100), "gear.damping": (10.0, 20.0)})`` has four points.
    """
    lists = {name: list(items) for name, items in values.items()}
    for name, items in lists.items():
        if not items:
            raise ParameterError(f"grid: {name!r} has no values; give at least one.")
    return tuple(dict(zip(lists, combination, strict=True)) for combination in itertools.product(*lists.values()))


def checked(points: Iterable[Point]) -> tuple[dict[str, Any], ...]:
    """Plain copies of the points.  Raises ParameterError for none, for unequal names and for values that no table can hold."""
    plain = []
    for number, point in enumerate(points):
        if not isinstance(point, Mapping):
            raise ParameterError(f"points[{number}] = {point!r}: must be a mapping like {{'gear.ratio': 100.0}}.")
        plain.append({str(name): _plain(f"points[{number}][{name!r}]", value) for name, value in point.items()})
    if not plain:
        raise ParameterError("points: a campaign needs at least one point.")
    for number, found in enumerate(plain):
        if set(found) != set(plain[0]):
            raise ParameterError(
                f"points[{number}] has {_listed(found)}, points[0] has {_listed(plain[0])}; each point needs the same names."
            )
    return tuple({name: found[name] for name in plain[0]} for found in plain)


def _listed(names: Iterable[str]) -> str:
    return ", ".join(names) or "no names"


def _plain(where: str, value: Any) -> Any:
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, (str, bool, int)) or (isinstance(value, float) and math.isfinite(value)):
        return value
    raise ParameterError(f"{where} = {value!r}: must be a finite number, a text, True or False.")


def parameter_columns(points: Sequence[Point]) -> dict[str, np.ndarray]:
    """Each name with its value at every point."""
    return {name: np.array([point[name] for point in points]) for name in points[0]}


def shown(point: Point) -> str:
    """A point in one line."""
    return ", ".join(f"{name} = {value:.6g}" if isinstance(value, float) else f"{name} = {value}" for name, value in point.items())
