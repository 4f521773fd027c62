"""Units at the door: text with a unit -> SI number, through pint."""

from __future__ import annotations

import functools
import math
import re
from typing import Any

from hdrive_mbs.errors import UnitError

_NUMBER = re.compile(r"^\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*$")


@functools.cache
def _registry() -> Any:
    import pint

    return pint.UnitRegistry()


def to_si(text: str, unit: str, where: str) -> float:
    """``"9 arcmin"`` with unit ``"rad"`` -> 0.002618.

    Raises UnitError when the number or unit cannot be read, or the unit measures something else.
    """
    match = _NUMBER.match(text)
    if match is None:
        raise UnitError(f"{where} = {text!r}: write a number and a unit, like '1.5 {unit}'.")
    number, given = float(match.group(1)), match.group(2)
    if not given:
        if unit == "1":
            return number
        raise UnitError(f"{where} = {text!r} has no unit; it must be convertible to {unit}, like '{match.group(1)} {unit}'.")
    return number * factor(given, unit, where)


@functools.cache
def factor(given: str, unit: str, where: str) -> float:
    """What a value in ``given`` is multiplied with to be in ``unit`` (SI)."""
    import pint

    registry = _registry()
    target = "dimensionless" if unit == "1" else unit
    try:
        value = registry.Quantity(1.0, given).to(target).magnitude
    except pint.DimensionalityError:
        raise UnitError(f"{where}: unit {given!r} does not fit; it must be convertible to {unit}.") from None
    except Exception as error:  # pint raises many kinds for text it cannot parse
        raise UnitError(f"{where}: unit {given!r} is not known ({error}); use for instance {unit}.") from None
    if not math.isfinite(float(value)):
        raise UnitError(f"{where}: unit {given!r} has no finite factor to {unit}.")
    return float(value)
