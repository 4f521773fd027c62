"""The best laws again from other values of what decides whether they show: a hollow of one value ends a fit far from the records.

A crack that the bending moment shuts is open by half whatever its side where the moment over which it shuts is large, so from the wrong
side a fit ends there.  In our own seventh rotor set (c06, labels open) such a fit left 20; turned by half a turn, with all else as it
was, two steps led to 3.3 and eight to 1.17.  Hollows that a law knows of itself, like those of a second resonance, it names
(``Effect.elsewhere``).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Collection, Sequence

from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis, searched_fields
from hdrive_mbs.diagnosis.suspects import PARAMETER, Label, Suspect
from hdrive_mbs.diagnosis.tasks import FINE, FIRST, Found, Task
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.errors import ParameterError

LAWS = 3
"""Laws of the best label that begin elsewhere again."""
MOST = 7
"""Other starts of each, the nearest ones."""


def from_other_starts(
    found: Sequence[Found], everything: Sequence[Suspect], done: Collection[tuple[Label, str]] = (), *, near: bool = False
) -> list[tuple[Suspect, Task]]:
    """Laws of the best label with other start values in what may hold them in a hollow, and what was found for all else: first steps.

    found : fitted laws, best first;  done : laws at places that this was asked of before
    near : only in the hollows that the laws themselves name beside what was found
    """
    if not found or found[0].suspect.law == PARAMETER:
        return []
    alike = [item for item in found if item.suspect.label == found[0].suspect.label][:LAWS]
    starts_of = {(suspect.label, suspect.law): suspect.all for suspect in everything}
    tasks = []
    for item in alike:
        key = item.suspect.label, item.suspect.law
        if key in done or key not in starts_of or not item.fitted.hypothesis.added:
            continue
        hypothesis, z = item.fitted.hypothesis.rescaled(item.fitted.z)
        *before, last = hypothesis.added
        beyond = [] if near else others(last.effect, [start.added[-1].effect for start in starts_of[key]])
        for effect in (*last.effect.elsewhere(), *beyond):
            changed = Hypothesis(hypothesis.factors, (*before, Added(effect, last.at, last.name)), hypothesis.loose)
            tasks.append((item.suspect, Task(changed, changed.start(hypothesis.nominal_part(z)), None, FIRST, FINE)))
    return tasks


def going_on(begun: Sequence[Found], most: int, steps: int) -> list[Found]:
    """Of laws that have done their first steps the cheapest, and of the rest the one that would come lowest if each of so many steps
    gained what its last one did.

    From a hollow in which a rub at a wrong angle had become strong and sharp, two led back to nothing, and the one that came to the right
    angle stood above them still and fell fastest: the recovery in tests/unit/test_other_starts.py, on machines whose rounding leads there.
    """
    ranked = sorted(begun, key=lambda item: item.fitted.cost)
    return [*ranked[:most], *sorted(ranked[most:], key=lambda item: _heading(item, steps))[:1]]


def _heading(item: Found, steps: int) -> float:
    """The cost to which so many steps lead that each gain what the last one did."""
    costs = item.fitted.history
    return costs[-1] - steps * (costs[-2] - costs[-1]) if len(costs) > 1 else item.fitted.cost


def others(effect: Effect, starts: Sequence[Effect]) -> list[Effect]:
    """An effect with other values in its decisive fields, one or several of them, nearest first.

    Each of these fields keeps what it has or takes one of its values but the nearest.  What is not allowed and all beyond the
    first few are left out.

    starts : of its search, which are thinned out: where the law itself names values, all of these count
    """
    kind, shapes = type(effect), searched_fields(type(effect))
    ways = []
    for name in [name for name in kind.decisive if name in shapes]:
        values = kind.starts.get(name) or tuple(dict.fromkeys(getattr(start, name) for start in starts))
        there = sorted((_apart(effect, name, value, shapes[name].unit), value) for value in values)
        ways.append([(0.0, {}), *((far, {name: value}) for far, value in there[1:])])
    combined = [_together(some) for some in itertools.product(*ways)]
    made = []
    for _, changes in sorted(combined, key=lambda item: item[0])[1 : MOST + 1]:
        try:
            made.append(effect.replacing(**changes))
        except ParameterError:
            continue
    return made


def farthest(effect: Effect, starts: Sequence[Effect]) -> Effect:
    """Of the starts of an effect's law the one that is farthest from it in the searched fields for which the law names values."""
    shapes = searched_fields(type(effect))
    names = [name for name in type(effect).starts if name in shapes]
    return max(starts, key=lambda start: sum(_apart(effect, name, getattr(start, name), shapes[name].unit) for name in names))


def _together(steps: Sequence[tuple[float, dict[str, float]]]) -> tuple[float, dict[str, float]]:
    """How far steps lead together, and what they change."""
    return math.hypot(*(far for far, _ in steps)), {name: value for _, changes in steps for name, value in changes.items()}


def _apart(effect: Effect, name: str, value: float, unit: str) -> float:
    """How far a field is from a value: of an angle the shorter way round, of a size by its logarithm."""
    own = float(getattr(effect, name))
    if unit == "rad":
        return abs(math.remainder(own - value, math.pi if name in type(effect).half_turn else math.tau))
    return abs(math.log(own / value)) if own > 0.0 and value > 0.0 else abs(own - value)
