"""Two causes at once: the best pair with another cause in place of one of its two, at the same place."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.pairs import replaced
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import PARAMETER, Suspect, renamed, simplest
from hdrive_mbs.diagnosis.tasks import Found
from hdrive_mbs.diagnosis.team import Team


def recast(team: Team, simulator: Simulator, pairs: Sequence[Found], everything: Sequence[Suspect]) -> list[Found]:
    """The best pair with each of its causes replaced by those of other families at its place: one simple law each, from its first start.

    What a cause was taken for, while the other one was missing, may be wrong where its place is right: in our own twelfth drive set (c03,
    labels open) a friction of the load that drifts stood for its drag beside friction of the mesh, and left a mean square of 18.

    pairs : at least one, fitted to the end;  everything : suspects without causes beside them
    """
    laws = simplest([item for item in everything if item.law != PARAMETER])

    def at_its_place(full: Hypothesis, k: int) -> Iterator[Added]:
        rest = Hypothesis(full.factors, (*full.added[:k], *full.added[k + 1 :]), full.loose)
        return (renamed(item.first[0].added[-1], rest) for item in laws if item.label[1] == full.added[k].at)

    return replaced(team, simulator, pairs, at_its_place)
