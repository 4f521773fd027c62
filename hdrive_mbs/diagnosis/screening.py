"""Quick looks at candidates: one joint step from the fitted nominal model, at every start of its shapes.

An effect begins at the low end of its strengths, where it hardly changes anything; the differences to the nominal run
are its columns beside the nominal Jacobian, and one joint step of all parameters gives the strengths that the records
ask for.  That step is then run, so what counts is a true misfit and not a linear promise.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.simulator import Simulator

FloatArray = npt.NDArray[np.float64]

SHRINKS = (1.0, 0.4, 0.1)
"""Of the linear step, tried side by side."""


@dataclass(frozen=True, eq=False)
class Look:
    """What one start of a hypothesis gave: its best point and the cost there, residuals included."""

    hypothesis: Hypothesis
    z: FloatArray
    cost: float
    residuals: FloatArray


class Screen:
    """The fitted nominal model with its Jacobian, from which all candidates are looked at."""

    def __init__(self, simulator: Simulator, null: Fitted, columns: FloatArray) -> None:
        self.simulator, self.null, self.columns = simulator, null, columns
        self._weights = simulator.blocks.weights(null.residuals[simulator.fit])
        self._weighted = columns * self._weights[:, None]
        self._normal = self._weighted.T @ columns

    def look(self, hypotheses: Sequence[Hypothesis]) -> Look | None:
        """The best of several starts; None where none of them can be run."""
        best: Look | None = None
        for look in self._looks(hypotheses):
            if best is None or look.cost < best.cost:
                best = look
        return best

    def _looks(self, hypotheses: Sequence[Hypothesis]) -> Iterator[Look]:
        for hypothesis in hypotheses:
            start = hypothesis.start(self.null.hypothesis.nominal_part(self.null.z))
            base, columns = self._base(hypothesis, start)
            if base is None:
                continue
            points = self._steps(hypothesis, start, base, columns)
            for point, residuals in zip(points, self.simulator.residuals(hypothesis, points), strict=True):
                if residuals is not None:
                    misfit = self.simulator.blocks.cost(residuals[self.simulator.fit])
                    yield Look(hypothesis, point, misfit + hypothesis.prior_cost(point), residuals)

    def _base(self, hypothesis: Hypothesis, start: FloatArray) -> tuple[FloatArray | None, FloatArray]:
        """Residuals at the start, and the Jacobian's columns of everything but the nominal parameters."""
        first = hypothesis.nominal_size
        steps = hypothesis.steps(start)
        points = [start]
        for k in range(first, hypothesis.size):
            moved = start.copy()
            moved[k] += steps[k]
            points.append(moved)
        found = self.simulator.residuals(hypothesis, points) if hypothesis.added else [self.null.residuals]
        base = found[0]
        if base is None:
            return None, np.zeros((0, 0))
        fitted = base[self.simulator.fit]
        columns = np.zeros((hypothesis.size - first, len(fitted)))
        for k, item in enumerate(found[1:]):
            if item is not None:
                columns[k] = (item[self.simulator.fit] - fitted) / steps[first + k]
        return fitted, columns.T

    def _steps(self, hypothesis: Hypothesis, start: FloatArray, base: FloatArray, columns: FloatArray) -> list[FloatArray]:
        first = hypothesis.nominal_size
        wide = np.array([hypothesis.loose.get(item.name, 1.0) for item in hypothesis.factors])
        normal = np.zeros((hypothesis.size, hypothesis.size))
        normal[:first, :first] = self._normal * np.outer(wide, wide)
        weighted = columns * self._weights[:, None]
        slope = np.concatenate([wide * (self._weighted.T @ base), weighted.T @ base])
        cross = (self._weighted.T @ columns) * wide[:, None]
        normal[:first, first:], normal[first:, :first], normal[first:, first:] = cross, cross.T, weighted.T @ columns
        normal += np.diag(hypothesis.precisions)
        slope += hypothesis.precisions * start
        move = bounded_step(normal, slope, hypothesis, start)
        return [hypothesis.clipped(start + shrink * move) for shrink in SHRINKS]


def bounded_step(normal: FloatArray, slope: FloatArray, hypothesis: Hypothesis, start: FloatArray) -> FloatArray:
    """The Gauss-Newton step with coordinates that would leave what is allowed held at their start, one after the other."""
    free = np.ones(len(start), dtype=bool)
    move = np.zeros(len(start))
    for _ in range(len(start)):
        at = np.flatnonzero(free)
        system = normal[np.ix_(at, at)]
        scale = np.sqrt(np.maximum(np.diag(system), 1e-300))
        scaled = system / np.outer(scale, scale) + 1e-9 * np.eye(len(at))
        move = np.zeros(len(start))
        move[at] = -np.linalg.solve(scaled, slope[at] / scale) / scale
        limited = np.array([k >= hypothesis.nominal_size and move[k] < 0.0 for k in range(len(start))])
        wrong = limited & free & (hypothesis.clipped(start + move) > start + move) & (hypothesis.precisions == 0.0)
        if not wrong.any():
            return move
        free &= ~wrong
    return move
