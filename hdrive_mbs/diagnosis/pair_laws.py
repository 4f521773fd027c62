"""Two causes at once: the best pair with other laws of its causes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hdrive_mbs.diagnosis.from_the_best import values_of, with_choices, with_values
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.other_starts import farthest
from hdrive_mbs.diagnosis.pairs import replaced
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import PARAMETER, Suspect
from hdrive_mbs.diagnosis.tasks import Found
from hdrive_mbs.diagnosis.team import Team


def with_other_laws(team: Team, simulator: Simulator, pairs: Sequence[Found], everything: Sequence[Suspect]) -> list[Found]:
    """The best pair with each of its causes told by the other laws of it.

    They begin with the values found, with those of ``Effect.elsewhere`` and ``Effect.telling``, and with their own: the first ones and
    those farthest from what was found, which may be a sharp friction where a smooth one acts.

    The law of the first cause was chosen while the second was missing, and a search for the second looks at one law of each.  In our own
    fourteenth drive set (c16, labels open) friction with presliding stood for one without it, and the drag beside it for what that left; in
    the twenty-second (c24, labels open) an error of order 6 for the third harmonic of order 2, which lacks its harmonics.

    pairs : at least one, fitted to the end;  everything : suspects without causes beside them
    """
    return replaced(team, simulator, pairs, lambda full, k: told_otherwise(full, k, everything), by_law=True)


def told_otherwise(full: Hypothesis, k: int, everything: Sequence[Suspect]) -> Iterator[Added]:
    """Cause number k of a hypothesis by the other laws of it."""
    mine = full.added[k]
    found = mine.effect, *mine.effect.elsewhere()
    for item in everything:
        if item.law != PARAMETER and item.label == mine.label and item.law != type(mine.effect).__name__:
            own = [start.added[-1].effect for start in item.all]
            held = [with_values(with_choices(own[0], effect), values_of(effect)) for effect in found]
            told = own[0].telling(mine.effect)
            yield from (Added(effect, mine.at, mine.name) for effect in dict.fromkeys((*held, *told, own[0], farthest(held[0], own))))
