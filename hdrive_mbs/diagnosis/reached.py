"""How far the parts of a rotor line go, for laws that show only beyond some distance from the axis.

A rub shows where a rotor goes farther than its gap, so a search that begins with one it does not reach sees nothing of it, and one that
begins with much less sees another rub: the gap that a faint rub has lies close below the largest distance, whatever that is on a machine.
"""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from functools import cached_property

import numpy as np

from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.locate.motion import Motion, motion_of
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.errors import ParameterError


class Reached:
    """How far places go in the run of a model through the records of a simulator.

    fitted : on this simulator
    """

    def __init__(self, simulator: Simulator, fitted: Fitted) -> None:
        self._simulator, self._fitted = simulator, fitted
        self._known: dict[str, float] = {}

    def __call__(self, place: str) -> float:
        """Largest distance [m] of a place from the axis of the line without load; 0 where it does not move across the axis."""
        if place not in self._known:
            self._known[place] = max((_distance(motion, place) for motion in self._motions), default=0.0)
        return self._known[place]

    @cached_property
    def _motions(self) -> list[Motion]:
        fitted = self._fitted
        return [motion_of(self._simulator, k, fitted.hypothesis, fitted.z) for k in range(len(self._simulator.trials))]


def _distance(motion: Motion, place: str) -> float:
    names = [f"{place}.{way}" for way in "xy"]
    if not set(names) <= {channel.name for channel in motion.network.channels}:
        return 0.0
    x, y = (motion.reading(name) for name in names)
    return float(np.max(np.hypot(x, y)))


def reaches(hypothesis: Hypothesis) -> bool:
    """Whether the effect that was added last shows only beyond some distance."""
    return bool(hypothesis.added and type(hypothesis.added[-1].effect).reaches)


def begun_near(starts: Sequence[Hypothesis], reached: Reached) -> tuple[Hypothesis, ...]:
    """The same starts, and those of them that begin with the first one's distance with shares of the largest one instead
    (``Effect.reaches``), as far as they are allowed."""
    kind = type(starts[0].added[-1].effect)
    more = []
    for name, shares in kind.reaches.items():
        first = getattr(starts[0].added[-1].effect, name)
        for start in starts:
            *before, last = start.added
            if getattr(last.effect, name) != first:
                continue
            for share in shares:
                with contextlib.suppress(ParameterError):  # it does not move, or farther than the law is meant for
                    effect = last.effect.replacing(**{name: share * reached(last.at)})
                    more.append(Hypothesis(start.factors, (*before, Added(effect, last.at, last.name)), start.loose))
    return (*starts, *more)
