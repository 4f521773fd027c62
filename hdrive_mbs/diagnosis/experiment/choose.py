"""The plan of a menu that separates a group of causes best."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.experiment.detectability import ENOUGH, Predictions
from hdrive_mbs.diagnosis.experiment.limits import Limits, limits_of
from hdrive_mbs.diagnosis.experiment.menu import standard_menu
from hdrive_mbs.diagnosis.experiment.plan import Plan
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.result import Separation
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.errors import AnalysisError, ParameterError
from hdrive_mbs.records.record import Record

Label = tuple[str, str]
Report = Callable[[str, int, int], None]


@dataclass(frozen=True, eq=False)
class _Asked:
    """What all plans are asked about, see ``next_records``."""

    fits: Mapping[Label, Fitted]
    step: float | None
    every: int
    alone: bool


@dataclass(frozen=True, eq=False)
class _Item:
    """A plan and its trials on the bench."""

    plan: Plan
    trials: Sequence[Trial]


def next_records(
    bench: Bench,
    fits: Mapping[Label, Fitted],
    menu: Sequence[Plan] | None = None,
    *,
    records: Sequence[Record] = (),
    limits: Limits | None = None,
    step: float | None = None,
    every: int = 1,
    alone: bool = False,
    report: Report | None = None,
    team: Team | None = None,
) -> tuple[Separation, ...]:
    """How well each plan of a menu would tell the fitted causes apart, best first.

    fits : (effect, place) -> fitted, two at least
    menu : plans; if not given those of the bench, or the standard ones, within the limits, as long and as finely sampled as the
        longest record
    records : seen so far;  limits : those that these have kept, if not given
    step : of the integration [s]; half a sample if not given;  every : compare only each such sample
    alone : whether a planned record speaks alone, and not together with the records of the fits
    report : called with (stage, done, total);  team : whose processes share the plans, this one alone if not given

    A plan counts by its worst pair, which is the one that is named.  Plans that no fit can be run through are left out;
    raises AnalysisError where that leaves none, ParameterError for fewer than two fits or a menu that cannot be made up.
    """
    labels = tuple(fits)
    if len(labels) < 2:
        raise ParameterError(f"{len(labels)} fitted cause given; to tell causes apart takes two.")
    own = bench.menu() if menu is None else menu
    plans = _usual(bench, records, limits, step) if own is None else tuple(own)
    if not plans:
        raise ParameterError("The menu is empty: give a plan, or None for the standard ones.")
    said = partial(report or (lambda stage, done, total: None), "planning the next record")
    asked, items = _Asked(fits, step, every, alone), [_Item(plan, bench.planned(plan)) for plan in plans]
    answers = (team or Team(1)).map(_separated, asked, items, said)
    found = [item for item in answers if isinstance(item, Separation)]
    if not found:
        raise AnalysisError(f"No plan of the menu can be simulated: {answers[0]}")
    return tuple(sorted(found, key=lambda item: -item.detectability))


def separation(
    bench: Bench, fits: Mapping[Label, Fitted], plan: Plan, *, step: float | None = None, every: int = 1, alone: bool = False
) -> Separation:
    """The pair that a plan separates least, and how well.  Of pairs that it does not separate at all the one that differs least as fitted.

    Raises AnalysisError where a fit cannot be simulated through it.
    """
    return _separation(_Asked(fits, step, every, alone), _Item(plan, bench.planned(plan)))


def _separated(asked: _Asked, item: _Item) -> Separation | str:
    """Likewise; in words why not where a fit cannot be simulated."""
    try:
        return _separation(asked, item)
    except AnalysisError as error:
        return str(error)


def _separation(asked: _Asked, item: _Item) -> Separation:
    labels, step = tuple(asked.fits), asked.step or 0.5 * item.plan.every
    predictions = Predictions(item.trials, tuple(asked.fits.values()), step=step, every=asked.every)
    least, first, second = math.inf, 0, 1
    for i, j in predictions.nearest_first():
        least, first, second = min((least, first, second), (predictions.apart(i, j, alone=asked.alone), i, j))
        if least < ENOUGH:
            break
    return Separation(record=item.plan.name, first=labels[first], second=labels[second], detectability=least)


def _usual(bench: Bench, records: Sequence[Record], limits: Limits | None, step: float | None) -> tuple[Plan, ...]:
    if not records:
        raise ParameterError("Without a menu of plans the records seen so far are needed: their length and sampling are taken over.")
    longest = max(records, key=lambda item: item.duration)
    kept = limits_of(bench, records) if limits is None else limits
    return standard_menu(bench, kept, seconds=longest.duration + longest.step, every=longest.step, step=step)
