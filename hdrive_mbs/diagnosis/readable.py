"""Numbers with their units and intervals, as an engineer writes them."""

from __future__ import annotations

import math
from collections.abc import Sequence

SCALED = {"m": (("m", 1.0), ("mm", 1e-3), ("um", 1e-6), ("nm", 1e-9)), "rad": (("rad", 1.0), ("mrad", 1e-3), ("urad", 1e-6))}
"""Units that are shown in a smaller one where the value is small."""


def scale(unit: str, largest: float) -> tuple[str, float]:
    """(unit, its size in SI) in which values up to ``largest`` need no power of ten."""
    steps = SCALED.get(unit)
    if steps is None or not math.isfinite(largest) or largest == 0.0:
        return unit, 1.0
    return next(((name, size) for name, size in steps if abs(largest) >= 0.1 * size), steps[-1])


def digits(value: float, significant: int = 4) -> str:
    """``value`` with so many significant digits; "-" for what is not there."""
    if math.isnan(value):
        return "-"
    if math.isinf(value):
        return "infinite" if value > 0.0 else "-infinite"
    if value == 0.0:
        return "0"
    if 1e-3 <= abs(value) < 1e6:
        places = max(significant - 1 - math.floor(math.log10(abs(value))), 0)
        return f"{float(f'{value:.{significant}g}'):.{places}f}"
    return f"{value:.{significant}g}"


def with_unit(value: float, unit: str, significant: int = 4) -> str:
    """``2.031 mrad``; no unit for a pure number."""
    name, size = scale(unit, value)
    return digits(value / size, significant) + (f" {name}" if name not in ("", "1") and not math.isnan(value) else "")


def interval(value: float, low: float, high: float, unit: str = "") -> str:
    """``2.03 (1.98 to 2.08) N m``, rounded so that the width of the interval keeps two digits; "no interval" where there is none."""
    name, size = scale(unit, value)
    tail = f" {name}" if name not in ("", "1") and not math.isnan(value) else ""
    if not (math.isfinite(low) and math.isfinite(high)):
        return "-" if math.isnan(value) else f"{digits(value / size)}{tail} (no interval)"
    numbers = _rounded((value / size, low / size, high / size), (high - low) / size)
    return f"{numbers[0]} ({numbers[1]} to {numbers[2]}){tail}"


def _rounded(values: Sequence[float], width: float) -> list[str]:
    largest = max((abs(value) for value in values if math.isfinite(value)), default=0.0)
    if not (largest > 0.0 and width > 0.0):
        return [digits(value) for value in values]
    last = max(math.floor(math.log10(width)) - 1, math.floor(math.log10(largest)) - 6)
    if not 1e-3 <= largest < 1e6:
        return [f"{value:.{max(math.floor(math.log10(largest)) - last, 1)}e}" for value in values]
    return [f"{round(value, -last):.{max(-last, 0)}f}" if math.isfinite(value) else digits(value) for value in values]


def named(name: str) -> str:
    """``coulomb_friction`` -> ``coulomb friction``."""
    return name.replace("_", " ")


def listed(items: Sequence[str], last: str = "and") -> str:
    """``a, b and c``."""
    return items[0] if len(items) == 1 else f"{', '.join(items[:-1])} {last} {items[-1]}" if items else "none"


def percent(share: float) -> str:
    """``99.7 %``: never rounded up to 100, nor down to 0."""
    if math.isnan(share):
        return "-"
    value = 100.0 * share
    if 0.0 < value < 1.0:
        return "under 1 %"
    if 99.99 <= value < 100.0:
        return "over 99.99 %"
    places = 0 if value < 99.0 else 1 if value < 99.9 else 2
    return f"{math.floor(value * 10.0**places) / 10.0**places:.{places}f} %" if 0.0 < value < 100.0 else f"{value:.0f} %"


def probability(value: float) -> str:
    """Two digits; neither 1.00 nor 0.00, for nothing is certain."""
    if math.isnan(value):
        return "-"
    return "> 0.99" if value >= 0.995 else "< 0.01" if value < 0.005 else f"{value:.2f}"
