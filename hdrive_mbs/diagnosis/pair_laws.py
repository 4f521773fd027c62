"""Two causes at once: the best pair with other laws of its causes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hdrive_mbs.diagnosis.from_the_best import values_of, with_values
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.pairs import replaced
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import PARAMETER, Suspect
from hdrive_mbs.diagnosis.tasks import Found
from hdrive_mbs.diagnosis.team import Team


def with_other_laws(team: Team, simulator: Simulator, pairs: Sequence[Found], everything: Sequence[Suspect]) -> list[Found]:
    """The best pair with each of its causes told by the other laws of it, from the values found and from the law's own.

    The law of the first cause was chosen while the second was missing, and a search for the second looks at one law of each.  In our own
    fourteenth drive set (c16, labels open) friction with presliding stood for one without it, and the drag beside it for what that left.

    pairs : at least one, fitted to the end;  everything : suspects without causes beside them
    """
    laws = [item for item in everything if item.law != PARAMETER]

    def told_otherwise(full: Hypothesis, k: int) -> Iterator[Added]:
        mine = full.added[k]
        values = values_of(mine.effect)
        for item in laws:
            if item.label == mine.label and item.law != type(mine.effect).__name__:
                own = item.all[0].added[-1].effect
                yield from (Added(effect, mine.at, mine.name) for effect in dict.fromkeys((with_values(own, values), own)))

    return replaced(team, simulator, pairs, told_otherwise, by_law=True)
