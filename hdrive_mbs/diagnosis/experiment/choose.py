"""The plan of a menu that separates a group of causes best."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.experiment.detectability import ENOUGH, Predictions
from hdrive_mbs.diagnosis.experiment.limits import Limits, limits_of
from hdrive_mbs.diagnosis.experiment.menu import standard_menu
from hdrive_mbs.diagnosis.experiment.plan import Plan
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.result import Separation
from hdrive_mbs.errors import AnalysisError, ParameterError
from hdrive_mbs.records.record import Record

Label = tuple[str, str]
Report = Callable[[str, int, int], None]


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
) -> tuple[Separation, ...]:
    """How well each plan of a menu would tell the fitted causes apart, best first.

    fits : (effect, place) -> fitted, two at least
    menu : plans; if not given those of the bench, or the standard ones, within the limits, as long and as finely sampled as the
        longest record
    records : seen so far;  limits : those that these have kept, if not given
    step : of the integration [s]; half a sample if not given;  every : compare only each such sample
    alone : whether a planned record speaks alone, and not together with the records of the fits

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
    found: list[Separation] = []
    failures: list[str] = []
    for k, plan in enumerate(plans):
        if report is not None:
            report("planning the next record", k, len(plans))
        try:
            found.append(separation(bench, fits, plan, step=step, every=every, alone=alone))
        except AnalysisError as error:
            failures.append(str(error))
    if not found:
        raise AnalysisError(f"No plan of the menu can be simulated: {failures[0]}")
    return tuple(sorted(found, key=lambda item: -item.detectability))


def separation(
    bench: Bench, fits: Mapping[Label, Fitted], plan: Plan, *, step: float | None = None, every: int = 1, alone: bool = False
) -> Separation:
    """The pair that a plan separates least, and how well.  Of pairs that it does not separate at all the one that differs least as fitted.

    Raises AnalysisError where a fit cannot be simulated through it.
    """
    labels = tuple(fits)
    predictions = Predictions(bench.planned(plan), tuple(fits.values()), step=step or 0.5 * plan.every, every=every)
    least, first, second = math.inf, 0, 1
    for i, j in predictions.nearest_first():
        least, first, second = min((least, first, second), (predictions.apart(i, j, alone=alone), i, j))
        if least < ENOUGH:
            break
    return Separation(record=plan.name, first=labels[first], second=labels[second], detectability=least)


def _usual(bench: Bench, records: Sequence[Record], limits: Limits | None, step: float | None) -> tuple[Plan, ...]:
    if not records:
        raise ParameterError("Without a menu of plans the records seen so far are needed: their length and sampling are taken over.")
    longest = max(records, key=lambda item: item.duration)
    kept = limits_of(bench, records) if limits is None else limits
    return standard_menu(bench, kept, seconds=longest.duration + longest.step, every=longest.step, step=step)
