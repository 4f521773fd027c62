"""A second cause where one leaves something: beside the best one, in place of it, and what each of the two is worth without the other."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from hdrive_mbs.diagnosis.both_moved import both_moved
from hdrive_mbs.diagnosis.candidates import Candidate
from hdrive_mbs.diagnosis.choosing import enough
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.joined import joined, settles
from hdrive_mbs.diagnosis.nearly import nearly_right
from hdrive_mbs.diagnosis.pair_laws import with_other_laws
from hdrive_mbs.diagnosis.pairs import alone, contenders, moved, swapped
from hdrive_mbs.diagnosis.recast import recast
from hdrive_mbs.diagnosis.search import Depth, Search, search
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.stages import Report, under
from hdrive_mbs.diagnosis.suspects import Label, Suspect, suspects
from hdrive_mbs.diagnosis.tasks import Found
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.verdict import LITTLE, left, of_one_family, taken, takes_most

LEFT = LITTLE
"""Mean square left by the best single cause, on what its fit saw and did not see, that is worth all that is done for a second one;
more beside a strong one (``enough``).  In our own third drive set a lag beside a drag left 1.19 and 1.48 of 46, and was not looked for
at 1.2.  Also what the best pair has to leave for its causes to be exchanged in place, however strong they are."""
SLIGHT = 1.03
"""Likewise, above which a second one is looked for at all: of 48 right single causes of our own rotor sets 9 to 14, opened, 42 leave
1.014 at most in the search and six whose laws are not exact 1.06 and more (tests/unit/test_verdict_constants.py), and a mass that swings
on a support beside a bow left 1.07 of 400 (c03 of the thirteenth).  Up to LEFT the search for it goes on only with one that takes most of
that (``takes_most``)."""
SCATTER = 4.0
"""Standard deviations of the mean square of noise, sqrt(2/n) of n samples, that it has to lie above 1 besides, up to LEFT: in 750
samples of a real axis (KUKA KR300) a delay left 1.05, of which a second one of 0.1 ms took all."""
TAKEN = 0.05
"""Share of the nominal model's cost above that of noise that the best single cause has to take away before a second one is looked
for: beside one that explains next to nothing a second would be another first.  Also of the first one's cost above that of noise, which
a second has to take away before the first is looked for again beside it."""
SHALLOW = Depth(brief=(4, 6), laws=1, kept=(2, 3), serious=2)
"""Of the search for a second cause."""
GLANCE = replace(SHALLOW, held=False)
"""Likewise beside a first one that leaves little: what is missing has bent little then."""
NOTICED = 0.2
"""Share of the logarithm of what the first cause leaves, or of its misfit above noise, that the best pair has to take before its causes are
exchanged and told by other laws.  Of the logarithm, in 23 cases with two causes of our own drive sets 17 to 23 and rotor sets 21 to 24 the
best pair of a search took 0.42 or more, and in seven of eleven with one cause 0.18 or less.  Where a search misses the right second cause
its best pair may take less too: 0.19 in c09 of our own twenty-sixth rotor set.  Of the misfit, which counts stretches that fit badly by
their logarithm: where a few of these rule the mean square, a right second cause took 0.03 and 0.11 of the one and 0.27 of the other (c04
of our own thirty-second drive set, c19 of the thirty-first; tests/unit/test_pair_constants.py)."""
AGAIN = 0.5
"""Share of the logarithm of what a law that is nearly right may leave, above which a pair has the first cause looked for again beside the
second: it may have stood for another one.  A rub beside a hardening bearing left 1.03 of 5.0 on all samples, where a mass that swings on
the support, beside the bearing, leaves noise (c19 of our own twenty-ninth rotor set, labels open).  Of 51 right pairs of our own sets
whose fits are kept 39 leave less than this bound, 41 less than the whole; of five answers of two causes of which one is wrong none and
three (tests/unit/test_pair_constants.py)."""
LABELS = 3
"""Single causes that stand in for the first one of the best pair."""


def wants_second(null: Fitted, first: Found, samples: int) -> bool:
    """Whether the best single cause explains something and leaves something.

    samples : fitted ones; noise alone costs half of their number
    """
    return first.log_odds > TAKEN * max(null.cost - 0.5 * samples, 0.0) and left(first.fitted) > slight(null, samples)


def slight(null: Fitted, samples: int) -> float:
    """Mean square that is little and still not noise."""
    return min(max(SLIGHT, 1.0 + SCATTER * math.sqrt(2.0 / samples)), enough(null, LEFT))


def nearly_all(gap: float) -> float:
    """Mean square that two right causes leave at most, as a rule.

    gap : mean square that the refitted nominal model leaves
    """
    return float(max(SLIGHT, nearly_right(gap) ** AGAIN))


def second_cause(
    team: Team,
    coarse: Simulator,
    null: Fitted,
    groups: Mapping[str, Sequence[str]],
    tried: Sequence[Candidate],
    single: Search,
    there: Sequence[Found],
    known: Sequence[Found],
    said: Report,
) -> tuple[Search | None, tuple[Found, ...], tuple[Found, ...]]:
    """Where one cause leaves something: a search for a second one, pairs that may be the best, and the causes of the best one alone.

    Causes that are known are put together first, the best of these pairs is told by other laws, and a second one is searched for where
    none of them explains the rest; one phenomenon at two places does not count, which may stand for a richer law of it and for another
    cause (c16 of our own fourteenth drive set, labels open: friction at both ends of a stiff shaft for friction and drag).

    there : single causes at the place of the gap;  known : pairs with the best single cause, if they have been put together already
    """
    first = single.found[0] if single.found else None
    samples = int(np.count_nonzero(coarse.fit))
    if first is None or not wants_second(null, first, samples):
        return None, (), ()
    if team.deadline.passed("a second cause"):
        return None, (), ()
    rivals = {item.suspect.label: item for item in (*single.labels[1:], *there[:1])}
    together = list(known) or joined(team, coarse, first, tuple(rivals.values()))
    pair = None
    much = left(first.fitted) > enough(null, LEFT)
    little = enough(null, LEFT) if much else slight(null, samples)
    settled = any(settles(item, first, little) for item in together)
    everything = suspects(null.hypothesis, groups, tried)
    told: tuple[Found, ...] = ()
    if not settled and much:
        told = _joined_by_other_laws(team, coarse, together, first, everything)
        together = [*told, *together]
        settled = bool(told) and left(told[0].fitted) < little and not of_one_family(told[0])
    if not settled and not (together and team.deadline.passed("a second cause among everything")):
        depth = SHALLOW if much else GLANCE
        pair = search(team, coarse, first.fitted, groups, tried, depth=depth, report=partial(under, said, "second cause"))
        together = [*pair.found, *together]
    if not together:
        return pair, (), ()
    best = min(together, key=lambda item: item.fitted.cost)
    if not (_is_noticed(best, first, samples) if much else takes_most(left(first.fitted), left(best.fitted))):
        return pair, (), ()
    said("exchanging causes of the best pair", 0, 1)
    exchanged = (
        []
        if team.deadline.passed("causes of the pair exchanged")
        else swapped(team, coarse, best, first.suspect.label, single.labels[:LABELS])
    )
    known = [*together, *exchanged]
    found = contenders(team, coarse, known, first)
    causes = found[0].fitted.hypothesis.labels
    if not told or _laws(found[0]) != _laws(told[0]):
        found = _told_by_other_laws(team, coarse, found, first, everything)
    others = alone(team, coarse, found[0], everything, first)
    gained = first.fitted.cost - found[0].fitted.cost
    again = left(found[0].fitted) > nearly_all(null.chi_fit) and gained > TAKEN * max(first.fitted.cost - 0.5 * samples, 0.0)
    again = again and not _is_one(found[0])  # the first would be looked for beside itself
    if again and not team.deadline.passed("the first cause again beside the second"):
        # the first cause was chosen while the second was missing
        for item in (item for item in others if item.suspect.label == found[0].suspect.label):
            more = search(team, coarse, item.fitted, groups, tried, depth=SHALLOW, report=partial(under, said, "first cause again"))
            found = contenders(team, coarse, [*found, *more.found], first)
        if found[0].fitted.hypothesis.labels != causes:
            found = _told_by_other_laws(team, coarse, found, first, everything)
    found = _exchanged_in_place(team, coarse, found, first, everything)
    pairs = _elsewhere(team, coarse, found, first, tried, everything)
    others += alone(team, coarse, pairs[0], everything, first, {item.suspect.label for item in others})
    return pair, pairs, tuple(others)


def _is_noticed(pair: Found, first: Found, samples: int) -> bool:
    """Whether a pair takes enough of what a first cause leaves that leaves much; samples : fitted ones, noise alone costs half of them."""
    gained = first.fitted.cost - pair.fitted.cost
    return taken(left(first.fitted), left(pair.fitted)) > NOTICED or gained > NOTICED * (first.fitted.cost - 0.5 * samples)


def _elsewhere(
    team: Team,
    coarse: Simulator,
    found: tuple[Found, ...],
    first: Found,
    tried: Sequence[Candidate],
    everything: Sequence[Suspect],
) -> tuple[Found, ...]:
    """With the causes of the best pair at other places, one of them or both."""
    if team.deadline.passed("causes of the pair at other places"):
        return contenders(team, coarse, found, first)
    others = (*moved(team, coarse, found, tried), *both_moved(team, coarse, found, tried, everything))
    return contenders(team, coarse, [*found, *others], first)


def _is_one(pair: Found) -> bool:
    """Whether its causes are one phenomenon at one place."""
    full = pair.fitted.hypothesis
    return len(full.added) > 1 and len(full.labels) == 1 and not full.loose


def _laws(pair: Found) -> frozenset[tuple[Label, str]]:
    """Its causes with the laws that tell them."""
    return frozenset((item.label, type(item.effect).__name__) for item in pair.fitted.hypothesis.added)


def _joined_by_other_laws(
    team: Team, coarse: Simulator, together: Sequence[Found], first: Found, everything: Sequence[Suspect]
) -> tuple[Found, ...]:
    """The best of the causes that were put together, by other laws of both, where the second takes as much as is followed up; best first.

    Before all is searched for another second one, which takes many times as long: a loose foot, put beside a clearance on it with the law
    that leads its family, took half of the logarithm of what the clearance left, and with another law the rest (c09 of our own
    twenty-sixth rotor set, labels open).
    """
    best = min(together, key=lambda item: item.fitted.cost, default=None)
    if best is None or of_one_family(best) or taken(left(first.fitted), left(best.fitted)) <= NOTICED:
        return ()
    return _told_by_other_laws(team, coarse, contenders(team, coarse, together, first), first, everything)


def _told_by_other_laws(
    team: Team, coarse: Simulator, found: tuple[Found, ...], first: Found, everything: Sequence[Suspect]
) -> tuple[Found, ...]:
    """Where the best pair leaves something, however strong its causes are: with other laws of them.

    Before anything else is looked for: a search beside a wrong law takes longer than all laws, and finds what stands for the right one.
    """
    if left(found[0].fitted) <= LEFT or team.deadline.passed("other laws at the places of the pair"):
        return found
    return contenders(team, coarse, [*found, *with_other_laws(team, coarse, found, everything)], first)


def _exchanged_in_place(
    team: Team, coarse: Simulator, found: tuple[Found, ...], first: Found, everything: Sequence[Suspect]
) -> tuple[Found, ...]:
    """Where the best pair leaves something, however strong its causes are: with other causes at their places, and with other laws of
    those."""
    told = found[0].fitted.hypothesis.labels
    if left(found[0].fitted) <= LEFT or team.deadline.passed("other causes at the places of the pair"):
        return found
    found = contenders(team, coarse, [*found, *recast(team, coarse, found, everything)], first)
    return found if found[0].fitted.hypothesis.labels == told else _told_by_other_laws(team, coarse, found, first, everything)
