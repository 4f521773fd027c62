"""Units of a file -> SI, with the spellings of loggers and a refusal of what is ambiguous."""

from __future__ import annotations

import difflib
import functools
import re
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.errors import UnitError
from hdrive_mbs.signals import FloatArray
from hdrive_mbs.units import base_powers, factor, prefix_and_unit

LONGEST = 200
"""Characters of a unit."""

SI_UNITS = (
    "1", "s", "1/s", "Hz",
    "rad", "rad/s", "rad/s^2", "rad/s^3", "rad/m",
    "m", "m/s", "m/s^2", "m/s^3", "1/m", "m^2", "m^3", "m^3/s",
    "kg", "kg m", "kg m^2", "kg/s", "kg/m^3",
    "N", "N/s", "N/m", "N s/m", "N m", "N m/s", "N m/rad", "N m s/rad", "Pa", "Pa s", "J", "W",
    "K", "K/s", "A", "A/s", "V", "V/s", "ohm", "H", "F", "C", "T", "Wb", "N m/A", "V s/rad",
)  # fmt: skip
"""Units that a channel can have inside."""
READ_AT_ONCE = frozenset(SI_UNITS) - {"N s/m", "W", "N m/A"}
"""Those that are what they say, without those whose powers an earlier one has: pint, which takes longer to load than a record to read, is
not asked."""

AMBIGUOUS = {
    "g": "'g' is the gram; an acceleration in multiples of gravity is 'g_0', a mass 'gram'",
    "mil": "'mil' is an angle to some and 0.001 inch to others; write 'milliradian' or 'thou'",
    "1/min": "'1/min' does not say what is counted; write 'rpm' for revolutions",
    "count": "a count is no physical quantity; write its size, like '3.83e-4 rad'",
    "counts": "a count is no physical quantity; write its size, like '3.83e-4 rad'",
    "c": "'C' is the coulomb; write 'degC' for a temperature or 'coulomb'",
}
"""Texts that have more than one meaning in records, in lower case."""

PREFIXED = {
    **dict.fromkeys(("kilo", "mega", "giga", "milli", "micro", "nano", "pico", "centi"), (
        "meter", "gram", "second", "newton", "pascal", "radian", "degree", "hertz", "joule", "watt", "watt_hour", "volt", "ampere",
        "ohm", "henry", "farad", "coulomb", "tesla", "weber", "kelvin", "bar", "force_gram", "revolutions_per_minute", "liter", "strain",
        "standard_gravity",
    )),
    "hecto": ("pascal",),
    "deci": ("meter", "newton"),
}  # fmt: skip
"""Prefix -> units that bear it in records: pint knows the decigrain too, but whoever writes 'dgr' means 'deg'."""
USUAL = ("deg", "rad", "mrad", "urad", "arcmin", "rpm", "mm", "um", "cm", "ms", "us", "kN", "mN", "kg", "bar", "kPa", "MPa", "mA", "mV")
"""Units that a slip may have meant."""

_SPELLINGS = (
    (re.compile(r"[₂²]"), "^2"),
    (re.compile(r"³"), "^3"),
    (re.compile(r"[µμ]"), "u"),
    (re.compile(r"[·⋅]"), "*"),
    (re.compile(r"\b([munkM]?N)(c?m|mm)(s?)\b"), lambda m: "*".join(part for part in m.groups() if part)),
    (re.compile(r"\bkgm"), "kg*m"),
    (re.compile(r"\b(s|m|rad|deg)([23])\b"), r"\1^\2"),
    (re.compile(r"\b(?:rev|r|U)/(?:min|mn)\b"), "rpm"),
    (re.compile(r"\brev\b"), "revolution"),
    (re.compile(r"\bdps\b"), "deg/s"),
)
_PER_MINUTE = re.compile(r"(?:1\s*)?/\s*min|min\s*\^?\s*-\s*1|1\s*/\s*minute")
_SCALED = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*\*?\s*([^\W\d].*|[%°].*)")


@dataclass(frozen=True)
class Conversion:
    """value in SI = factor * number + offset."""

    unit: str
    factor: float
    offset: float = 0.0

    def apply(self, numbers: FloatArray) -> FloatArray:
        """Numbers of the file in SI."""
        if self.factor == 1.0 and self.offset == 0.0:
            return numbers
        with np.errstate(over="ignore", invalid="ignore"):  # what is not finite is found and told of later
            return numbers * self.factor + self.offset


def conversion(text: str, where: str) -> Conversion:
    """How numbers with that unit become SI; ``"3.83e-4 rad"`` (the size of one count) is a unit too.

    Raises UnitError for a unit that is unknown, ambiguous or measures nothing that a record can hold.
    """
    given = text.strip()
    if len(given) > LONGEST:
        raise UnitError(f"{where}: unit {given[:40]!r}... cannot be read: it has {len(given)} characters.")
    scaled = _SCALED.fullmatch(given)
    if scaled and not given.startswith("1/"):
        size = float(scaled.group(1))
        inner = conversion(scaled.group(2), where)
        if inner.offset or size == 0.0:
            raise UnitError(f"{where}: unit {text!r} cannot be scaled; write it as a size and a unit, like '3.83e-4 rad'.")
        return Conversion(inner.unit, inner.factor * size)
    if given in ("1", "-", "none", "dimensionless"):
        return Conversion("1", 1.0)
    if given.lower() in ("degc", "°c", "deg c", "celsius"):
        return Conversion("K", 1.0, 273.15)
    meaning = AMBIGUOUS.get("1/min" if _PER_MINUTE.fullmatch(given) else given if given == "g" else given.lower() if given != "G" else "")
    if meaning is not None:
        raise UnitError(f"{where}: unit {text!r} is ambiguous: {meaning}.")
    if given in READ_AT_ONCE:
        return Conversion(given, 1.0)
    spelled = given
    for pattern, replacement in _SPELLINGS:
        spelled = pattern.sub(replacement, spelled)
    for name in re.findall(r"[^\W\d]+", spelled):
        prefix, base = prefix_and_unit(name)
        if prefix and base not in PREFIXED.get(prefix, ()):
            near = difflib.get_close_matches(name, USUAL, 1, 0.6)
            meant = f" Did you mean {near[0]!r}?" if near else ""
            raise UnitError(f"{where}: unit {text!r} would be a {prefix}{base}, in which nobody records.{meant}")
    unit = _si_of(spelled, where)
    if unit is None:
        raise UnitError(
            f"{where}: unit {text!r} measures nothing that a record of a drive or rotor holds; it needs one like rad, N m or m/s^2."
        )
    return Conversion(unit, factor(spelled, unit, where))


@functools.cache
def _si_of(given: str, where: str) -> str | None:
    powers = base_powers(given, where)
    if re.search(r"hertz|hz", given, re.I):
        return "Hz" if powers == {"second": -1.0} else None
    if re.search(r"joule|\b[kM]?J\b|watt.*hour|[kM]?Wh", given):
        return "J" if powers == _powers()["J"] else None
    return next((unit for unit, known in _powers().items() if known == powers and unit not in ("Hz", "J")), None)


@functools.cache
def _powers() -> dict[str, dict[str, float]]:
    return {unit: {} if unit == "1" else base_powers(unit, unit) for unit in SI_UNITS}


def is_unit(text: str) -> bool:
    """Whether a text can be read as a unit (ambiguous ones count: they are refused where they are used)."""
    try:
        conversion(text, "")
    except UnitError as error:
        return "ambiguous" in str(error)
    return True
