"""A cause that came out best only without the one it was found beside: at its other places."""

from __future__ import annotations

from collections.abc import Sequence

from hdrive_mbs.diagnosis.choosing import above_noise, beyond
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.from_the_best import elsewhere
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import Suspect
from hdrive_mbs.diagnosis.tasks import Found, further, rivalling, run_task, those_that_ran
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.verdict import left


def again_elsewhere(
    team: Team, simulator: Simulator, base: Fitted, everything: Sequence[Suspect], first: Found | None, others: Sequence[Found]
) -> tuple[Found, ...]:
    """The best of other single causes at its other places, where it is better than the one that a search had found first.

    A search tries the one that it found first there; what takes its place later was looked for beside it, at places that suit what is left
    by it.  An output shaft that creeps was taken for a mass that swings on the load, an input shaft that creeps was found beside that and
    left 1.25 without it, and at the output shaft, where no fit of the law had been begun, it leaves 1.00 (an own case,
    `--bench drive --unlisted --cases 20 --seed 301`, c16).

    base : the refitted nominal model;  everything : suspects without causes beside them;  first : the cause that a search had found first
    """
    best = min(others, key=lambda item: item.fitted.cost, default=None)
    if best is None or (first is not None and best.fitted.cost >= first.fitted.cost) or left(best.fitted) <= above_noise(simulator):
        return ()
    asked = elsewhere(best, base, everything, simulator)
    begun = those_that_ran([suspect for suspect, _ in asked], team.map(run_task, simulator, [task for _, task in asked]))
    near = [item for item in begun if not beyond(item.fitted, best.fitted)]
    tasks = [further(item.fitted, beat=rivalling(best.fitted)) for item in near]
    return tuple(those_that_ran([item.suspect for item in near], team.map(run_task, simulator, tasks)))
