"""Starts of a law that differ in searched values alone, and what is run of them: where they begin, and a step away along coordinates."""

from __future__ import annotations

import copy
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.reach import Trials, hardly_reached
from hdrive_mbs.diagnosis.simulator import Simulator

FloatArray = npt.NDArray[np.float64]

BESIDE = 3
"""Differences that are run beside a first start: a run of four takes as long as one of one (``Processor.lanes``)."""
ORIGIN = -1
"""Stands for a start itself among the coordinates along which it was moved."""


class Starts:
    """Starts that differ in searched values alone, and what was run of them.

    origins : search coordinates of each start;  steps : of the differences, by coordinate
    found : for each start coordinate -> residuals a step away along it; None where it cannot be run
    skipped : trials in which the first of them does not show, which are not run for any of them
    """

    def __init__(self, starts: Sequence[Hypothesis], origins: Sequence[FloatArray], base: Fitted) -> None:
        self.hypothesis, self.starts, self.origins = starts[0], list(starts), list(origins)
        self.steps = self.hypothesis.steps(self.origins[0])
        known = {ORIGIN: base.residuals} if self.hypothesis.size == base.hypothesis.size else {}
        self.found: list[dict[int, FloatArray | None]] = [dict(known) for _ in starts]
        self.skipped: Trials = frozenset()
        self._base = base.residuals

    @property
    def choices(self) -> tuple[object, ...]:
        """What is not searched, alike in all of them: laws, places, orders."""
        return _all_choices(self.hypothesis)

    def run(self, simulator: Simulator, along: Sequence[int]) -> None:
        """Run the starts and what is a step away from them along some coordinates, as far as it has not been."""
        self._run(
            [(k, coordinate) for k, found in enumerate(self.found) for coordinate in (ORIGIN, *along) if coordinate not in found], simulator
        )

    def _run(self, asked: Sequence[tuple[int, int]], simulator: Simulator) -> None:
        """In trials that are skipped everything is as at the start, and that as in the base if it has not been run there."""
        points = [self._moved(k, coordinate) for k, coordinate in asked]
        kept = [self.found[k].get(ORIGIN) for k, _ in asked]
        instead = [self._base if item is None else item for item in kept]
        found = simulator.residuals(self.hypothesis, points, self.skipped, instead) if points else []
        for (k, coordinate), residuals in zip(asked, found, strict=True):
            self.found[k][coordinate] = residuals

    def run_first(self, simulator: Simulator, weights: FloatArray, along: Sequence[int] = ()) -> None:
        """Run the first start, and leave out from then on the trials in which it does not show.

        weights : of the fitted residuals of the base
        along : coordinates that will be asked for; differences along the first ones (BESIDE) are run beside it
        """
        if ORIGIN not in self.found[0]:
            self._run([(0, coordinate) for coordinate in (ORIGIN, *along[:BESIDE])], simulator)
            residuals = self.found[0][ORIGIN]
            if residuals is not None:
                self.skipped = hardly_reached(residuals[simulator.fit], self._base[simulator.fit], weights, simulator.spans)

    def _moved(self, k: int, coordinate: int) -> FloatArray:
        moved = self.origins[k].copy()
        if coordinate != ORIGIN:
            moved[coordinate] += self.steps[coordinate]
        return moved

    def some(self, kept: Sequence[int]) -> Starts:
        """Some of the starts, with what was run of them."""
        part = copy.copy(self)
        part.starts, part.origins = [self.starts[k] for k in kept], [self.origins[k] for k in kept]
        part.found = [self.found[k] for k in kept]
        return part


def alike(hypotheses: Sequence[Hypothesis]) -> list[list[Hypothesis]]:
    """Starts by what is not searched in them: their laws and choices."""
    groups: dict[object, list[Hypothesis]] = {}
    for hypothesis in hypotheses:
        groups.setdefault(_all_choices(hypothesis), []).append(hypothesis)
    return list(groups.values())


def _all_choices(hypothesis: Hypothesis) -> tuple[object, ...]:
    return tuple(_choices(item) for item in hypothesis.added)


def _choices(added: Added) -> tuple[object, ...]:
    searched = {path for unknown in added.unknowns for path in unknown.values([0.0] * unknown.size)}
    fields = ((name, value) for name, value, _ in added.effect.fields() if f"{added.name}.{name}" not in searched)
    return type(added.effect), added.at, added.name, *(f"{name}={value!r}" for name, value in fields)
