"""All fits of a case, from which its answer is drawn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from hdrive_mbs.diagnosis.again_elsewhere import again_elsewhere
from hdrive_mbs.diagnosis.all_samples import CANNOT_RUN, as_given, on_all_samples
from hdrive_mbs.diagnosis.at_the_place import at_the_place
from hdrive_mbs.diagnosis.candidates import Candidate
from hdrive_mbs.diagnosis.choosing import leaves
from hdrive_mbs.diagnosis.differences import jacobian, unseen_in
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.later import Later
from hdrive_mbs.diagnosis.located import Located, bends, located
from hdrive_mbs.diagnosis.nominal_again import nominal_again
from hdrive_mbs.diagnosis.pairs import causes_of, laws_of
from hdrive_mbs.diagnosis.search import Search, fit_nominal, search
from hdrive_mbs.diagnosis.second_cause import LEFT, second_cause, wants_second
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.stages import Report, under
from hdrive_mbs.diagnosis.suspects import suspects
from hdrive_mbs.diagnosis.tasks import Found, cheapest, proven, scored
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.tied_places import tied_places
from hdrive_mbs.diagnosis.together import Together
from hdrive_mbs.diagnosis.unknowns import Factor
from hdrive_mbs.diagnosis.verdict import TIED, left, takes_most
from hdrive_mbs.errors import AnalysisError

SINGLES = 3
"""Labels that are fitted on all samples at least."""
ALIKE = 6
"""Labels that the search cannot tell from the best, which are fitted on all samples besides: all stations of a line that is stiff in
torsion, say, where only some of them would be named as tied otherwise."""
RESERVE = 3
"""Further laws of one cause, and of two, that are fitted on all samples where those fitted there leave something."""
CLOSE = 0.02
"""Share of the best law's log odds within which another law of the same cause is fitted on all samples too."""


@dataclass(frozen=True, eq=False)
class Evidence:
    """What all fits of a case gave.

    fine : all samples;  nominal, null : the model as given and refitted, on these
    single : search for one cause;  pair : for a second one besides the best first, if that left something
    singles : the best labels on all samples, best first;  pairs : likewise with two causes; log odds over the null, with what no fit saw
    place : where the gap lies
    """

    fine: Simulator
    nominal: Fitted
    null: Fitted
    single: Search
    pair: Search | None
    singles: tuple[Found, ...]
    pairs: tuple[Found, ...]
    place: Located


def serious(labels: Sequence[Found]) -> tuple[Found, ...]:
    """The best labels, and those behind them that the search could not tell from the first, or that fit better than it does.

    What a law with more freedom is taken off for that weighs less where all samples speak: drag that warms, in a gap of 4e-4 of the mean
    square, was put to the flexspline with log odds of 2.9 for -4.0 of the motor, though less is left there, and with 122.3 and 122.0 on all
    samples nothing tells the two apart (an own case, `--bench drive --unlisted --cases 20 --seed 301`, c17).

    labels : the best law of each label, best first
    """
    if not labels:
        return ()
    best, *others = labels
    close = [item for item in others if item.log_odds > best.log_odds - TIED or item.fitted.chi_fit < best.fitted.chi_fit]
    chosen = [best, *close][:ALIKE]
    return tuple(item for item in labels if item in chosen or item in labels[:SINGLES])


def close_laws(found: Sequence[Found]) -> tuple[Found, ...]:
    """The next law of the best label, if the search could hardly tell it from the best: all samples may.

    found : fitted laws, best first
    """
    if not found:
        return ()
    best = found[0].suspect
    least = found[0].log_odds - max(TIED, CLOSE * found[0].log_odds)
    others = (item for item in found if item.suspect.label == best.label and item.suspect.law != best.law)
    return tuple(item for item in others if item.log_odds > least)[:1]


def in_reserve(found: Sequence[Found], told: Sequence[Found]) -> tuple[Found, ...]:
    """Further laws of what came out best, each at its best: the records that a search does not see may tell them apart.

    found : by the search;  told : what is fitted on all samples in any case, best first
    """
    if not told:
        return ()
    known = {laws_of(item.fitted.hypothesis) for item in told}
    laws: dict[frozenset[object], Found] = {}
    best = causes_of(min(told, key=lambda item: item.fitted.cost).fitted.hypothesis)
    for item in sorted(found, key=lambda item: item.fitted.cost):
        if causes_of(item.fitted.hypothesis) == best and laws_of(item.fitted.hypothesis) not in known:
            laws.setdefault(laws_of(item.fitted.hypothesis), item)
    return tuple(laws.values())[:RESERVE]


def _with(search_: Search, more: Sequence[Found]) -> Search:
    """A search that found some more."""
    found = sorted((*search_.found, *(scored(item, search_.base) for item in more)), key=lambda item: -item.log_odds)
    return replace(search_, found=tuple(found))


def _of_both(search_: Search, before: Sequence[Found]) -> Search:
    """With what another search had found, each law at a place at its best."""
    found = [scored(item, search_.base) for item in cheapest([*search_.found, *before])]
    return replace(search_, found=tuple(sorted(found, key=lambda item: -item.log_odds))) if before else search_


def _placed(fine: Simulator, factors: Sequence[Factor]) -> Located:
    """Where the gap of a rotor line lies, which is looked for from the data sheet.

    Raises AnalysisError where the nominal model cannot be simulated.
    """
    nominal = as_given(fine, Hypothesis(factors=tuple(factors)))
    if nominal is None:
        raise AnalysisError(CANNOT_RUN)
    return located(fine, nominal)


def _ask_where(team: Team, fine: Simulator, factors: Sequence[Factor]) -> Later | None:
    """Begin to look where the gap lies, beside the search: on rotor lines alone, which need neither a fit nor what a search finds."""
    return team.begin(_placed, fine, tuple(factors)) if bends(fine) else None


def _told_where(team: Team, place: Later, said: Report) -> Located:
    said("looking where the gap lies", 0, 1)
    found: Located = team.answer(place)
    said("looking where the gap lies", 1, 1)
    return found


def _unseen(simulator: Simulator, fitted: Fitted) -> dict[str, set[str]]:
    """By name of each nominal parameter the names of the trials in which it does not show."""
    columns = jacobian(simulator, fitted.hypothesis, fitted.z, fitted.residuals)
    found = unseen_in(simulator, fitted.hypothesis, fitted.z, fitted.residuals, columns)
    pairs = zip(fitted.hypothesis.factors, found, strict=True)
    return {factor.name: {simulator.trials[k].name for k in trials} for factor, trials in pairs}


def _there(
    team: Team, coarse: Simulator, null: Fitted, single: Search, place: Located | None, tried: Sequence[Candidate], said: Report
) -> tuple[Found, ...]:
    """What laws of the place of the gap explain of it, if the search left something."""
    if place is None or not leaves(min((left(item.fitted) for item in single.found), default=left(null)), null, LEFT):
        return ()
    if team.deadline.passed("laws at the place of the gap"):
        return ()
    return at_the_place(team, coarse, null, place, tried, partial(under, said, "at the place of the gap"))


def _first(
    team: Team,
    coarse: Simulator,
    fine: Simulator,
    factors: Sequence[Factor],
    groups: Mapping[str, Sequence[str]],
    tried: Sequence[Candidate],
    said: Report,
) -> tuple[Simulator, Simulator, Fitted, Search, Together]:
    """The nominal model and a search for one cause, with the records as they know what shows in which of them, and what pairs explain all.

    The model is fitted again where the search shows that it had ended in a hollow.  All is looked for again where most of what was left is
    taken by that, or more than by the best cause, and what was found before stays a candidate.
    """
    [null] = team.map(fit_nominal, coarse, [tuple(factors)], partial(said, "fitting the nominal model"))
    found: list[Found] = []
    while True:
        unseen = _unseen(coarse, null)
        coarse, fine = coarse.knowing(unseen), fine.knowing(unseen)
        together = Together(team, coarse, null)
        single = _of_both(search(team, coarse, null, groups, tried, explained=together.explain, report=said), found)
        found = list(single.found)
        before, better = null, nominal_again(team, coarse, null, single.found)
        if better is None:
            return coarse, fine, null, single, together
        null = better
        far = takes_most(left(before), left(null)) or null.cost < min(item.fitted.cost for item in found)
        if not far or team.deadline.passed("everything from the nominal model as fitted again"):
            return coarse, fine, null, _of_both(Search(null, (), single.looks), found), together


def gather(
    coarse: Simulator,
    fine: Simulator,
    factors: Sequence[Factor],
    groups: Mapping[str, Sequence[str]],
    tried: Sequence[Candidate],
    team: Team,
    report: Report | None = None,
) -> Evidence:
    """Fit the nominal model, single causes and, where these leave something, pairs.

    coarse : the records with every few samples, on which the search works

    Raises AnalysisError where the nominal model cannot be simulated.
    """
    said = report or (lambda stage, done, total: None)
    asked = _ask_where(team, fine, factors)
    coarse, fine, null, single, together = _first(team, coarse, fine, factors, groups, tried, said)
    place = None if asked is None else _told_where(team, asked, said)
    known = together.with_first(single.found[0] if single.found else None)
    there = () if known else _there(team, coarse, null, single, place, tried, said)
    single = _with(single, there)
    pair, double, others = second_cause(team, coarse, null, groups, tried, single, there, known, said)
    everything = suspects(null.hypothesis, groups, tried)
    if others and not team.deadline.passed("the best cause without the other one, at other places"):
        others = (*others, *again_elsewhere(team, coarse, null, everything, single.found[0] if single.found else None, others))
    single = _with(single, others)
    if double and not wants_second(null, single.found[0], int(np.count_nonzero(coarse.fit))):
        double = ()  # its second cause stood beside a wrong first one: had it been found at once, no other would have been looked for
    single = _with(single, tied_places(team, coarse, null, everything, single.found, serious(single.labels)))
    ones = (*serious(single.labels), *close_laws(single.found))
    more = in_reserve(single.found, ones), () if pair is None else in_reserve(pair.found, double)
    whole = *ones, *double, *more[0], *more[1]
    one, both, last_one = len(ones), len(ones) + len(double), len(ones) + len(double) + len(more[0])
    fits = [item.fitted for item in whole]
    last = on_all_samples(team, fine, null, fits[:both], place, partial(said, "all samples"), fits[both:])
    final = [
        None if fitted is None else proven(Found(item.suspect, fitted), last.refitted)
        for item, fitted in zip(whole, last.others, strict=True)
    ]
    singles, pairs = (*final[:one], *final[both:last_one]), (*final[one:both], *final[last_one:])
    singles, pairs = (tuple(sorted(filter(None, some), key=lambda item: -item.log_odds)) for some in (singles, pairs))
    return Evidence(fine, last.nominal, last.refitted, single, pair, singles, pairs, last.place)
