"""Lengths in a unit that needs no power of ten."""

from __future__ import annotations

from hdrive_mbs.plots.look import unit_text

STEPS = ((0.5, 1.0, "m"), (0.5e-3, 1e3, "mm"), (1e-7, 1e6, "\u00b5m"), (0.0, 1e9, "nm"))


def shown_unit(unit: str, largest: float) -> tuple[float, str]:
    """Factor and unit in which values up to ``largest`` are drawn: m, mm, \u00b5m or nm for a length, else the unit itself."""
    if unit != "m" or not largest > 0.0:
        return 1.0, unit_text(unit)
    return next((factor, name) for above, factor, name in STEPS if largest > above)
