"""Two causes at once: the best single cause together with those of the others that take most beside it."""

from __future__ import annotations

from collections.abc import Sequence

from hdrive_mbs.diagnosis.ground import screen_from
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.screening import Screen
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import PARAMETER, renamed
from hdrive_mbs.diagnosis.tasks import FINE, Found, Task, run_task, those_that_ran
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.verdict import left, of_one_family

JOINED = 3
"""Other single causes that the best one is joined with: those whose looks from its fit come out best.  What is missing beside a strong
cause shows little without it: of 22 pairs that were found in our own drive sets 17 to 23 and rotor sets 21 to 23, the second cause was
among the next three labels of the search for a single one in twelve, and the fifth to thirteenth label in the others
(tests/unit/test_pair_constants.py)."""
CLEAR = 0.02
"""Share of what the best single cause leaves above noise: a pair that leaves less of it is not bettered by another second cause, only by
other laws of its two.  In the same sets and rotor set 24, twelve second causes that were there left 0.0135 at most in a search and the
others 0.0245 and more.  Of those that were not there two left less than 0.0376: a play at the output shaft in place of the gear's lost
motion (0.0055; the search took it as well) and a kinematic error that was there alone, beside an error of an encoder (0.0002; each of the
two is tried alone afterwards; tests/unit/test_pair_constants.py)."""
TOGETHER = 5
"""Joint steps of two causes that are put together."""


def joined(team: Team, simulator: Simulator, first: Found, others: Sequence[Found]) -> list[Found]:
    """The best single cause together with the JOINED others that a look from its fit shows most of, from where these looks end, and with
    the one that came next alone.

    A look begins at the values that the other was found with alone, which may be bent by having to stand for both, and where its law begins
    in a search.  It may show nothing of a contact beside another one, where a fit comes down to it all the same: of a loose foot beside a
    clearance on it, which came next alone (c09 of our own twenty-sixth rotor set, labels open).

    others : single causes, fitted, of labels of their own, best first
    """
    base = first.fitted.hypothesis
    if base.is_nominal:
        return []
    rest = [item for item in others if item.suspect.label != first.suspect.label]
    if not rest:
        return []
    looks = team.map(Screen.look, screen_from(simulator, first.fitted), [_beside(base, item) for item in rest])
    shown = [(item, look) for item, look in zip(rest, looks, strict=True) if look is not None]
    best = sorted(shown, key=lambda pair: pair[1].cost)[:JOINED]
    best += [(item, look) for item, look in shown if item is rest[0] and not any(item is other for other, _ in best)]
    tasks = [Task(look.hypothesis, look.z, look.residuals, TOGETHER, FINE) for _, look in best]
    return those_that_ran([item.suspect for item, _ in best], team.map(run_task, simulator, tasks))


def settles(pair: Found, first: Found, little: float) -> bool:
    """Whether no other second cause needs to be looked for: a pair that is not one phenomenon twice leaves little, or little of what the
    best single cause does."""
    after, before = left(pair.fitted), left(first.fitted)
    return not of_one_family(pair) and (after < little or after - 1.0 < CLEAR * (before - 1.0))


def _beside(base: Hypothesis, other: Found) -> tuple[Hypothesis, ...]:
    """Another cause beside a base: as it was found alone, and where its law begins."""
    found, _ = other.fitted.hypothesis.rescaled(other.fitted.z)
    if other.suspect.law == PARAMETER:
        return (Hypothesis(base.factors, base.added, {**base.loose, **found.loose}),)
    starts = (found.added[-1], *(start.added[-1] for start in other.suspect.first))
    return tuple(Hypothesis(base.factors, (*base.added, renamed(added, base)), base.loose) for added in starts)
