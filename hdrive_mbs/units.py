"""Units at the door: text with a unit -> SI number, through pint."""

from __future__ import annotations

import functools
import math
import re
from typing import Any

from hdrive_mbs.errors import UnitError

_UNIT = re.compile(r"(?:\s*(?:[^\W\d]\w*+|[%°1]|[*/·()])(?:\s*(?:\*\*|\^)\s*[+-]?\d{1,2}(?![\w.]))?)+\s*")
"""Names, signs and small whole powers: all that a unit needs (pint would work out ``9**9**9`` for ever)."""

_NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*)")


@functools.cache
def _registry() -> Any:
    import pint

    return pint.UnitRegistry()


def to_si(text: str, unit: str, where: str) -> float:
    """``"9 arcmin"`` with unit ``"rad"`` -> 0.002618.

    Raises UnitError when the number or unit cannot be read, or the unit measures something else.
    """
    match = _NUMBER.fullmatch(text.strip())
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
    if given == unit:  # also of a unit that is only a name, like N/m^n
        return 1.0
    import pint

    registry = _registry()
    target = "dimensionless" if unit == "1" else unit
    if len(given) > 100 or _UNIT.fullmatch(given) is None:
        raise UnitError(f"{where}: unit {given[:40]!r} cannot be read; use for instance {unit}.")
    try:
        value = float(registry.Quantity(1.0, given).to(target).magnitude)
        at_zero = float(registry.Quantity(0.0, given).to(target).magnitude)
        mixed = any(_cycles(registry, a) and _radians(registry, b) for a, b in ((given, target), (target, given)))
    except pint.DimensionalityError:
        raise UnitError(f"{where}: unit {given!r} does not fit; it must be convertible to {unit}.") from None
    except Exception as error:  # pint raises many kinds for text it cannot parse
        reason = f" ({error})" if str(error) else ""
        raise UnitError(f"{where}: unit {given!r} is not known{reason}; use for instance {unit}.") from None
    if mixed:
        raise UnitError(f"{where}: {given!r} and {unit} differ by 2 pi (Hz counts turns, rad/s radians); write it in {unit}.")
    if at_zero != 0.0:
        raise UnitError(f"{where}: unit {given!r} is not proportional to {unit} (it is a level or has an offset); write it in {unit}.")
    if not math.isfinite(value):
        raise UnitError(f"{where}: unit {given!r} has no finite factor to {unit}.")
    return value


def base_powers(given: str, where: str) -> dict[str, float]:
    """Powers of the base units of a unit, radians counted as one: ``"rpm"`` -> {"radian": 1, "second": -1}.

    Raises UnitError when the unit cannot be read.
    """
    registry = _registry()
    if len(given) > 100 or _UNIT.fullmatch(given) is None:
        raise UnitError(f"{where}: unit {given[:40]!r} cannot be read.")
    try:
        base = registry.get_base_units(registry.parse_units(given))[1]
    except Exception as error:  # pint raises many kinds for text it cannot parse
        reason = f" ({error})" if str(error) else ""
        raise UnitError(f"{where}: unit {given!r} is not known{reason}.") from None
    return {name: float(power) for name, power in base._units.items() if power}


def prefix_and_unit(name: str) -> tuple[str, str]:
    """``"dgr"`` -> ("deci", "grain"); the prefix is empty for a unit that has a name of its own, both for one that is not known."""
    found = _registry().parse_unit_name(name)
    return next(((prefix, unit) for prefix, unit, _ in found if not prefix), (found[0][0], found[0][1]) if found else ("", ""))


def _cycles(registry: Any, unit: str) -> bool:
    return any(name.endswith("hertz") for name in registry.parse_units(unit)._units)


def _radians(registry: Any, unit: str) -> bool:
    return "radian" in registry.get_base_units(registry.parse_units(unit))[1]._units
