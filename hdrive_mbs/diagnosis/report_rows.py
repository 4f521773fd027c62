"""Tables of a diagnosis, as texts: what the text report and the page in a browser both show."""

from __future__ import annotations

import math
from dataclasses import dataclass

from hdrive_mbs.diagnosis import sentences
from hdrive_mbs.diagnosis.readable import digits, interval, probability, with_unit
from hdrive_mbs.diagnosis.result import Cause, Diagnosis, Estimate, Gap, Misfit

TOP = 8
"""Rows of the ranking that are shown."""


@dataclass(frozen=True, kw_only=True)
class Table:
    """Heads and rows of texts.

    words : leading columns that hold words; the others hold numbers and stand to the right
    free : whether the last column is running text without a head
    """

    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    words: int = 1
    free: bool = False


def gap_name(gap: Gap) -> str:
    """What a gap is about."""
    return ", ".join(part for part in (gap.record, gap.column) if part) or "all together"


def gap_table(diagnosis: Diagnosis) -> Table:
    """Root mean squares in standard deviations of the noise."""
    rows = tuple(
        (gap_name(gap), *(interval(item.value, item.low, item.high) for item in _steps(gap)), digits(gap.floor, 3))
        for gap in diagnosis.gaps
    )
    return Table(heads=_heads(diagnosis), rows=rows)


def unit_table(diagnosis: Diagnosis) -> Table:
    """The same in the columns' units; nothing of all columns together, which have no common unit."""
    rows = tuple(_in_unit(gap) for gap in diagnosis.gaps if gap.column)
    return Table(heads=_heads(diagnosis), rows=rows)


def _heads(diagnosis: Diagnosis) -> tuple[str, ...]:
    return ("record, column", "nominal", "refitted", "with cause" if diagnosis.causes else "final", "noise")


def _steps(gap: Gap) -> tuple[Misfit, Misfit, Misfit]:
    return gap.nominal, gap.refit, gap.effect


def _in_unit(gap: Gap) -> tuple[str, ...]:
    size = gap.noise
    values = (interval(size * item.value, size * item.low, size * item.high, gap.unit) for item in _steps(gap))
    return (gap_name(gap), *values, with_unit(size * gap.floor, gap.unit, 3))


def ranking_table(diagnosis: Diagnosis, top: int = TOP) -> Table:
    """What was fitted, most probable first."""
    rows = tuple(
        (
            sentences.label(item.effect, item.at),
            item.law,
            probability(item.probability),
            digits(item.log_odds, 3),
            digits(item.fit, 3),
            digits(item.held_out, 3),
        )
        for item in diagnosis.ranking[:top]
    )
    return Table(heads=("cause", "law", "probability", "log odds", "fit", "held out"), rows=rows, words=2)


def cause_table(cause: Cause) -> Table:
    """Identified parameters of a cause."""
    rows = [(item.name, sentences.estimate_text(item), before(item), item.doc) for item in cause.parameters]
    if any(row[2] for row in rows):
        return Table(heads=("identified", "value (95 % interval)", "before", ""), rows=tuple(rows), words=4, free=True)
    short = tuple((name, value, doc) for name, value, _, doc in rows)
    return Table(heads=("identified", "value (95 % interval)", ""), rows=short, words=3, free=True)


def before(item: Estimate) -> str:
    """Nominal value of a parameter and how far it went; empty for one that had none."""
    z = sentences.moved(item)
    return "" if math.isnan(z) else f"{with_unit(item.nominal, item.unit)}, moved {z:+.1f} sigma"


def parameter_table(diagnosis: Diagnosis, beyond: float = 0.0) -> Table:
    """Nominal parameters before and after the fit, the furthest first.

    beyond : only those that moved further [standard deviations of their tolerance]; all at 0
    """
    rows = tuple(
        (
            item.name,
            with_unit(item.nominal, item.unit),
            sentences.estimate_text(item).replace(" from these records", ""),
            "-" if math.isnan(z) else f"{z:+.1f} sigma",
            item.doc,
        )
        for item, z in sentences.by_distance(diagnosis)
        if not beyond or abs(z) > beyond
    )
    return Table(heads=("parameter", "nominal", "refitted (95 % interval)", "moved", ""), rows=rows, words=5, free=True)
