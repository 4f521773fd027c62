"""Two causes at once: the best pair with another cause in place of one of its two, at the same place."""

from __future__ import annotations

from collections.abc import Sequence

from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.pairs import gone_on
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import PARAMETER, Suspect, renamed, simplest
from hdrive_mbs.diagnosis.tasks import FINE, FIRST, Found, Task, run_task, those_that_ran
from hdrive_mbs.diagnosis.team import Team


def recast(team: Team, simulator: Simulator, pairs: Sequence[Found], everything: Sequence[Suspect]) -> list[Found]:
    """The best pair with each of its causes replaced by those of other families at its place, one simple law each.

    What a cause was taken for, while the other one was missing, is often wrong where its place is right: in our own twelfth drive set (c03,
    labels open) drag of the load beside friction of the mesh was taken for friction of the load that drifts, which leaves a mean square of
    18, and drag itself showed little from the parameters that either cause had bent alone.

    pairs : at least one, fitted to the end;  everything : suspects without causes beside them
    """
    best = min(pairs, key=lambda item: item.fitted.cost)
    full, z = best.fitted.hypothesis.rescaled(best.fitted.z)
    tasks, whose = [], []
    for k, mine in enumerate(full.added):
        rest = Hypothesis(full.factors, (*full.added[:k], *full.added[k + 1 :]), full.loose)
        for suspect in simplest([item for item in everything if item.law != PARAMETER and item.label[1] == mine.at]):
            if suspect.label in full.labels:
                continue
            added = renamed(suspect.first[0].added[-1], rest)
            hypothesis = Hypothesis(full.factors, (*full.added[:k], added, *full.added[k + 1 :]), full.loose)
            tasks.append(Task(hypothesis, hypothesis.start(full.nominal_part(z)), None, FIRST, FINE))
            is_second = k == len(full.added) - 1 and best.suspect.law != PARAMETER
            whose.append(Suspect(suspect.label, suspect.law, (hypothesis,), (hypothesis,)) if is_second else best.suspect)
    return gone_on(team, simulator, those_that_ran(whose, team.map(run_task, simulator, tasks)), best)
