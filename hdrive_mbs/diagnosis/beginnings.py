"""Starts of laws with a period, moved to the periods that stand out in what is left, and to others close by.

A peak is not quite the period: while the speed passes a resonance the phase of the response turns, which moves the peak by
parts of what the records can tell apart, and by less than that a law is out of step at the end of a record.
"""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Mapping, Sequence

from hdrive_mbs.diagnosis.force_orders import StandsOut
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.errors import ParameterError

MANY, FEW = 12, 2
"""Starts of a law that are made, about, and periods that are tried at least."""

ASIDE = (-0.75, -0.5, -0.25, 0.25, 0.5, 0.75)
"""Of the width that the longest record can tell apart: how far from a peak is tried besides."""


def is_periodic(hypothesis: Hypothesis) -> bool:
    """Whether the effect that was added last has a period to begin at."""
    return bool(hypothesis.added and type(hypothesis.added[-1].effect).periodic)


def begun_at(starts: Sequence[Hypothesis], periods: StandsOut) -> tuple[Hypothesis, ...]:
    """The same starts with the periods of the effect that was added last at those that stand out; as they are where none do."""
    if not is_periodic(starts[0]):
        return tuple(starts)
    kind = type(starts[0].added[-1].effect)
    quantities = {item.name: item.metadata["quantity"] for item in dataclasses.fields(kind) if item.name in kind.periodic}
    found = {name: periods.standing_out(over, *quantities[name].typical) for name, over in kind.periodic.items()}
    found = {name: values for name, values in found.items() if values}
    combinations = [dict(zip(found, values, strict=True)) for values in itertools.product(*found.values())]
    others = {start.added[-1].effect.replacing(**combinations[0]): start for start in starts}  # starts that differ in the rest
    made = []
    for values in combinations[: max(FEW, MANY // len(others))]:
        for effect, start in others.items():
            *before, last = start.added
            added = Added(effect.replacing(**values), last.at, last.name)
            made.append(Hypothesis(start.factors, (*before, added), start.loose))
    return tuple(made)


def widths_of(hypothesis: Hypothesis, periods: StandsOut) -> dict[str, float]:
    """What the records can tell apart of each period of the effect that was added last."""
    return {name: periods.width(over) for name, over in type(hypothesis.added[-1].effect).periodic.items()}


def beside(start: Hypothesis, widths: Mapping[str, float]) -> tuple[Hypothesis, ...]:
    """A start with each period of the effect that was added last moved by parts of these widths; as far as it may go."""
    *before, last = start.added
    made = []
    for name, width in widths.items():
        value = float(getattr(last.effect, name))
        for part in ASIDE:
            try:
                effect = last.effect.replacing(**{name: value + part * width})
            except ParameterError:
                continue
            made.append(Hypothesis(start.factors, (*before, Added(effect, last.at, last.name)), start.loose))
    return tuple(made)
