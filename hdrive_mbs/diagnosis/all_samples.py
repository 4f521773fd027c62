"""The last fits of a case, on all samples, and where its gap lies."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from hdrive_mbs.diagnosis.choosing import SEEN, beyond
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.from_its_values import from_its_values
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.located import Located, located
from hdrive_mbs.diagnosis.search import HOPS
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.tasks import FINE, NEAR, Task, further, rivalling, run_task
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.errors import AnalysisError
from hdrive_mbs.freed_memory import trim

Work = Callable[[Simulator], Any]

LAST, LONG = 4, 20
"""Steps that these fits may take, and those of the best."""
ROUNDS = 2
"""In which fits begin again from the values of the best one."""
EXACT = 1e-6
"""Relative change of the cost that ends them where little is left."""
CANNOT_RUN = "The nominal scene cannot be simulated through all of the records; look at its start values and inputs."


@dataclass(frozen=True, eq=False)
class Last:
    """nominal, refitted : the model as given and refitted

    others : in the order asked for, those in reserve last; None where one cannot be run or was not needed
    """

    nominal: Fitted
    refitted: Fitted
    others: tuple[Fitted | None, ...]
    place: Located


def as_given(fine: Simulator, nominal: Hypothesis) -> Fitted | None:
    """The nominal model as its data sheet says; None where it cannot be run."""
    return run_task(fine, Task(nominal, np.zeros(nominal.size), None, 0, 1.0))


def on_all_samples(
    team: Team,
    fine: Simulator,
    null: Fitted,
    found: Sequence[Fitted],
    place: Located | None,
    said: Callable[[int, int], None],
    reserve: Sequence[Fitted] = (),
) -> Last:
    """Fit on from where a search on fewer samples came to, side by side: the best first, and the others as far as they may catch up.

    The law of the best at the places of others is fitted there from its values too (from_its_values.py).

    null : the nominal model, refitted;  found : with one cause or several;  place : where the gap lies, if that is known already
    reserve : what is fitted where the best of these leaves something, and more than it left on fewer samples

    Raises AnalysisError where the nominal model cannot be simulated.
    """
    tasks = _of_found(found, null.chi_fit < NEAR)
    order = sorted(range(len(found)), key=lambda k: found[k].cost)
    best, rest = order[:1], order[1:]
    whole = 2 + len(found)
    work: list[Work] = [partial(as_given, nominal=null.hypothesis), *(partial(run_task, task=tasks[k]) for k in best)]
    again = team.begin(_done, fine, partial(run_task, task=_of_nominal(null)))  # beside all the others, which do not ask for it
    nominal, *leading = team.map(_done, fine, work, lambda done, total: said(done, whole))
    if nominal is None:
        raise AnalysisError(CANNOT_RUN)
    others = dict(zip(best, leading, strict=True))
    beat = next((rivalling(item) for item in leading if item is not None), None)
    work = [partial(run_task, task=replace(tasks[k], beat=beat)) for k in rest]
    others |= dict(zip(rest, team.map(_done, fine, work, lambda done, total: said(1 + len(best) + done, whole)), strict=True))
    others |= _from_reserve(team, fine, others, dict(enumerate(reserve, len(found))))
    others |= _levelled(team, fine, others, {k for k, task in enumerate(tasks) if task.steps < LONG})
    refitted = team.answer(again)
    said(whole, whole)
    if refitted is None:
        raise AnalysisError(CANNOT_RUN)
    if place is None:
        team.dismiss()  # it is the last that they do, and a localisation needs the memory
        place = located(fine, refitted)
    return Last(nominal, refitted, tuple(others.get(k) for k in range(len(found) + len(reserve))), place)


def _from_reserve(
    team: Team, fine: Simulator, fits: Mapping[int, Fitted | None], reserve: Mapping[int, Fitted]
) -> dict[int, Fitted | None]:
    """Fits of those in reserve that left less on fewer samples than the best does on all, where it leaves something.

    Records that a search does not see may tell laws apart that are alike in the others: a bearing that drives whirl left 1.005 with a law
    of its onset and 1.002 with one of its cycle, and on all samples 1.46 and 1.001 (c16 of our own thirty-fourth rotor set, labels open,
    each fitted without the other; by a script that is not kept).
    """
    best = min(filter(None, fits.values()), key=lambda item: item.cost, default=None)
    if best is None or best.chi_fit < SEEN:
        return {}
    asked = {k: item for k, item in reserve.items() if item.chi_fit < best.chi_fit}
    work = [partial(run_task, task=Task(item.hypothesis, item.z, None, LONG, EXACT, beat=rivalling(best))) for item in asked.values()]
    return dict(zip(asked, team.map(_done, fine, work), strict=True))


def _levelled(team: Team, fine: Simulator, fits: Mapping[int, Fitted | None], brief: Collection[int]) -> dict[int, Fitted]:
    """The fits, the best one to its end, and others with its laws from its values where they come down farther from there than they had.

    Again where one of these is the best then.

    brief : numbers of those that had few steps
    """
    ran = {number: item for number, item in fits.items() if item is not None}
    for _ in range(min(ROUNDS, len(ran))):
        best = min(ran, key=lambda number: ran[number].cost)
        if best in brief and not ran[best].converged:
            ran[best] = run_task(fine, further(ran[best], LONG, EXACT)) or ran[best]
        tasks = from_its_values(ran, LONG, EXACT)
        found = team.map(_done, fine, [partial(run_task, task=task) for task in tasks.values()])
        ran |= {k: item for k, item in zip(tasks, found, strict=True) if item is not None and item.cost < ran[k].cost}
        if min(ran, key=lambda number: ran[number].cost) == best:
            break
    return ran


def _done(fine: Simulator, work: Work) -> Any:
    """The answer to some work; what is freed of it does not add to what the next takes, since all processes are at their largest here."""
    found = work(fine)
    trim()
    return found


def _of_nominal(null: Fitted) -> Task:
    near = null.chi_fit < NEAR
    return Task(null.hypothesis, null.z, None, LONG, EXACT if near else FINE, hops=HOPS if near else 0)


def _of_found(found: Sequence[Fitted], near: bool) -> list[Task]:
    """Of what a search found, how far each is fitted.

    The same effect at another place is fitted to its end where it had not come there: a neighbour of the right place is as good
    as fits as it does, halfway.

    near : whether the nominal model leaves so little that everything is worth a long fit
    """
    leader = min(found, key=lambda item: item.cost, default=None)
    tasks = []
    for item in found:
        rivals = leader is not None and item.cost < rivalling(leader)
        elsewhere = leader is not None and not item.converged and item.chi_fit < NEAR and _families(item) == _families(leader)
        steps = LONG if rivals or elsewhere or near else 1 if leader is not None and beyond(item, leader) else LAST
        sharp = EXACT if item.chi_fit < NEAR else FINE
        tasks.append(Task(item.hypothesis, item.z, None, steps, sharp, hops=HOPS if rivals or elsewhere else 0))
    return tasks


def _families(fitted: Fitted) -> list[str]:
    return sorted(item.effect.family for item in fitted.hypothesis.added)
