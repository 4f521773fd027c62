"""Some causes of the best fit without the others, begun from its values where these leave less than they do by themselves.

A play beside a second one of next to nothing may come down where the first alone stays in a hollow, and then looks like two plays: in
s10 of round 1, whose label is not known here, a second play of 6e-7 rad stood beside one that left 1.77 by itself and 1.57 with it.  From
the values of both the first alone leaves as much as both, and a verdict has no second cause to claim.  A cause that does something is
missed there at once.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from hdrive_mbs.diagnosis.fit import Fitted, cost_of
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.tasks import Task, rivalling, run_task
from hdrive_mbs.diagnosis.verdict import TIED


def alone_again(fits: Mapping[int, Fitted], steps: int, share: float) -> dict[int, Task]:
    """By number of a fit with some of the causes of the best, which lies behind it, how it begins again from the best's values.

    steps, share : of these fits, see ``fit``
    """
    best = min(fits.values(), key=lambda item: item.cost, default=None)
    if best is None:
        return {}
    full, z = best.hypothesis.rescaled(best.z)
    tasks = {}
    for number, item in fits.items():
        added = _shared(full, item.hypothesis)
        if added and item.cost > best.cost + TIED and dict(item.hypothesis.loose) == dict(full.loose):
            hypothesis = replace(full, added=added)
            tasks[number] = Task(hypothesis, hypothesis.start(full.nominal_part(z)), None, steps, share, beat=rivalling(best))
    return tasks


def run_from_less(simulator: Simulator, task: Task, cost: float) -> Fitted | None:
    """A task where it begins with less than a cost, which is what a single run takes to tell; None where it does not."""
    [residuals] = simulator.residuals(task.hypothesis, [task.z])
    if not cost_of(simulator, task.hypothesis, residuals, task.z) < cost:
        return None
    return run_task(simulator, replace(task, residuals=residuals))


def _shared(best: Hypothesis, other: Hypothesis) -> tuple[Added, ...]:
    """The causes of the best that are all of another hypothesis, by law and place; none where that has one that the best has not."""
    wanted = [(type(item.effect), item.at) for item in other.added]
    found = tuple(item for item in best.added if (type(item.effect), item.at) in wanted)
    return found if len(found) == len(wanted) < len(best.added) else ()
