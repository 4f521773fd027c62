"""The laws of the best fit at the places of others, begun from its values.

Friction at either end of a stiff shaft has valleys with hollows: with the law that was put there in c04 of our own twenty-fifth drive set
(labels open) the motor, whose it is, led the search and stopped on all samples 490 behind the wave generator, which had come to the bottom
of its own valley.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.tasks import Task, is_hopeless, rivalling
from hdrive_mbs.diagnosis.verdict import TIED


def from_its_values(fits: Mapping[int, Fitted], steps: int, share: float) -> dict[int, Task]:
    """By number of a fit with the laws of the best at other places, which lies behind it, how it is fitted again from the best's values.

    Not one that cannot be told from the best anyhow (TIED), or that is hopeless beside it.  Each is given up where it does not catch up.

    steps, share : of these fits, see ``fit``
    """
    best = min(fits.values(), key=lambda item: item.cost, default=None)
    behind = {number: item for number, item in fits.items() if best is not None and _is_behind(item, best)}
    if best is None or not behind:
        return {}
    full, z = best.hypothesis.rescaled(best.z)
    tasks = {}
    for number, item in behind.items():
        places = zip(full.added, item.hypothesis.added, strict=True)
        hypothesis = replace(full, added=tuple(replace(mine, at=other.at, name=other.name) for mine, other in places))
        tasks[number] = Task(hypothesis, hypothesis.start(full.nominal_part(z)), None, steps, share, beat=rivalling(best))
    return tasks


def _is_behind(item: Fitted, best: Fitted) -> bool:
    """Whether a fit with the laws of the best, elsewhere, can be told from it and may still come near."""
    if item.cost <= best.cost + TIED or is_hopeless(item.chi_fit, best.chi_fit):
        return False
    mine, its = item.hypothesis, best.hypothesis
    return bool(mine.added) and _laws(mine) == _laws(its) and mine.labels != its.labels and dict(mine.loose) == dict(its.loose)


def _laws(hypothesis: Hypothesis) -> list[type]:
    return [type(item.effect) for item in hypothesis.added]
