"""Speeds and orders as they are written on the command line."""

from __future__ import annotations

import re

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.units import to_si

_WITH_UNIT = re.compile(r"^[-+]?[\d.]+(?:[eE][-+]?\d+)?\s*[^\W\d_]")


def parse_speeds(option: str, text: str) -> npt.NDArray[np.float64]:
    """``0:1000:101`` (first, last, number), ``0 rpm:12000 rpm:101``, ``0:12000:101 rpm``, or ``100,200,400``; in rad/s.

    Raises ParameterError for anything else and for a range that does not rise.
    """
    parts = [part.strip() for part in text.split(":")]
    if len(parts) == 1:
        return np.array([_speed(option, text, item.strip(), "") for item in text.split(",")])
    if len(parts) != 3:
        raise _unreadable(option, text)
    number, _, unit = parts[2].partition(" ")
    try:
        count = int(number)
    except ValueError:
        raise _unreadable(option, text) from None
    first, last = (_speed(option, text, part, unit.strip()) for part in parts[:2])
    if count < 2:
        raise ParameterError(f"{option} {text!r}: {count} speeds are not a range; write at least 2.")
    if not last > first:
        raise ParameterError(f"{option} {text!r}: {last:g} rad/s is not above {first:g} rad/s. Write the lower speed first.")
    return np.linspace(first, last, count)


def _speed(option: str, whole: str, text: str, unit: str) -> float:
    try:
        value = float(text)
    except ValueError:
        if not _WITH_UNIT.match(text):
            raise _unreadable(option, whole) from None
        return to_si(text, "rad/s", option)
    if not np.isfinite(value):
        raise _unreadable(option, whole)
    return to_si(f"{value!r} {unit}", "rad/s", option) if unit else value


def _unreadable(option: str, text: str) -> ParameterError:
    return ParameterError(f"{option} {text!r}: write FIRST:LAST:COUNT in rad/s or with units, like 0:1000:101 or '0:12000:101 rpm'.")


def parse_orders(option: str, text: str) -> tuple[float, ...] | dict[str, tuple[float, ...]]:
    """``1,2`` of the reference shaft, or ``PLACE=1,2;PLACE=1``.  Raises ParameterError for anything else."""
    try:
        if "=" not in text:
            return tuple(float(item) for item in text.split(","))
        pairs = [part.split("=") for part in text.split(";")]
        return {place.strip(): tuple(float(item) for item in numbers.split(",")) for place, numbers in pairs}
    except ValueError:
        raise ParameterError(
            f"{option} {text!r}: write numbers with commas, like 1,2, or with places, like 'rotor_1=1,2;gear=2'."
        ) from None
