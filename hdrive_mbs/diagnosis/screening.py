"""Quick looks at candidates: one joint step from the fitted nominal model, at every start of its shapes.

An effect begins at the low end of its strengths, where it hardly changes anything; the differences to the nominal run
are its columns beside the nominal Jacobian, and one joint step of all parameters gives the strengths that the records
ask for.  That step is then run, so what counts is a true misfit and not a linear promise.

A shape s of an effect of strength a shows in the records about as a f(s): its column at the start is a_0 df/ds, and the
step that it gets is good for a_0.  Where the strength grows to g a_0 in the same step, the same change of the records takes
1/g of it, so steps with shapes held back by g are run as well.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.bounded import bounded_step
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis, start_of
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.unknowns import Strength, Vector

FloatArray = npt.NDArray[np.float64]

PARTS = (1.0, 0.4, 0.1)
"""Of the linear step, run side by side: three cost little more than one, and need no other machine code."""


@dataclass(frozen=True, eq=False)
class Look:
    """What one start of a hypothesis gave: its best point and the cost there, residuals included.

    start : the hypothesis with the start values that led there
    """

    hypothesis: Hypothesis
    z: FloatArray
    cost: float
    residuals: FloatArray
    start: Hypothesis


class Screen:
    """A fitted model, nominal or with causes already, and its Jacobian, from which all candidates are looked at."""

    def __init__(self, simulator: Simulator, null: Fitted, columns: FloatArray) -> None:
        self.simulator, self.null, self.columns = simulator, null, columns
        self._weights = simulator.blocks.weights(null.residuals[simulator.fit])
        self._weighted = columns * self._weights[:, None]
        self._normal = self._weighted.T @ columns

    def look(self, hypotheses: Sequence[Hypothesis]) -> Look | None:
        """The best of several starts; None where none of them can be run."""
        best: Look | None = None
        for some in _alike(hypotheses):
            for look in self._looks(some):
                if best is None or look.cost < best.cost:
                    best = look
        if best is None:
            return None
        hypothesis, z = best.hypothesis.rescaled(best.z)
        return Look(hypothesis, z, best.cost, best.residuals, best.start)

    def _looks(self, starts: Sequence[Hypothesis]) -> Iterator[Look]:
        """Looks from starts that differ in searched values alone: all of them are run side by side."""
        hypothesis = starts[0]
        first = self.null.hypothesis.size
        steps = hypothesis.steps(self._start(hypothesis))
        origins = [self._start(start, hypothesis) for start in starts]
        points = []
        for origin in origins:
            points.append(origin)
            for k in range(first, hypothesis.size):
                moved = origin.copy()
                moved[k] += steps[k]
                points.append(moved)
        each = 1 + hypothesis.size - first
        found = self.simulator.residuals(hypothesis, points) if each > 1 else [self.null.residuals] * len(points)
        proposed: list[FloatArray] = []
        begun: list[Hypothesis] = []
        for number, origin in enumerate(origins):
            own = found[number * each : (number + 1) * each]
            if own[0] is not None:
                step = self._step(hypothesis, origin, *self._columns(own, steps[first:]))
                moves = [part * move for move in (step, *self._held_back(hypothesis, origin, step)) for part in PARTS]
                proposed += [hypothesis.clipped(origin + move) for move in moves]
                begun += [starts[number]] * len(moves)
        yield from self._run(hypothesis, proposed, begun)

    def _held_back(self, hypothesis: Hypothesis, origin: FloatArray, step: FloatArray) -> Iterator[FloatArray]:
        """The same step with all of the effect that was added last but its first strength divided by what that grows."""
        own = self.null.hypothesis.size
        pairs = zip(hypothesis.unknowns, hypothesis.slices, strict=True)
        strengths = [part for unknown, part in pairs if part.start >= own and isinstance(unknown, Strength | Vector)]
        if not strengths:
            return
        first = strengths[0]
        before, after = (float(np.linalg.norm(point[first])) for point in (origin, origin + step))
        if after > before > 0.0:
            shares = np.where(np.arange(len(step)) < own, 1.0, before / after)
            shares[first] = 1.0
            yield step * shares

    def _run(self, hypothesis: Hypothesis, points: Sequence[FloatArray], begun: Sequence[Hypothesis]) -> Iterator[Look]:
        found = self.simulator.residuals(hypothesis, points) if points else []
        for point, start, residuals in zip(points, begun, found, strict=True):
            if residuals is not None:
                misfit = self.simulator.blocks.cost(residuals[self.simulator.fit])
                yield Look(hypothesis, point, misfit + hypothesis.prior_cost(point), residuals, start)

    def _columns(self, found: Sequence[FloatArray | None], steps: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Fitted residuals at a start, and the Jacobian's columns of everything that the base has not."""
        assert found[0] is not None
        fitted = found[0][self.simulator.fit]
        columns = np.zeros((len(steps), len(fitted)))
        for k, item in enumerate(found[1:]):
            if item is not None:
                columns[k] = (item[self.simulator.fit] - fitted) / steps[k]
        return fitted, columns.T

    def _start(self, start: Hypothesis, hypothesis: Hypothesis | None = None) -> FloatArray:
        """The base's parameters, and the start values of what is added to it, in the scales of a hypothesis."""
        base = self.null
        given = hypothesis or start
        z = given.start(base.hypothesis.nominal_part(base.z))
        z[base.hypothesis.nominal_size : base.hypothesis.size] = base.z[base.hypothesis.nominal_size :]
        if given is not start:
            at = base.hypothesis.size
            for item, scaled in zip(start.added[len(base.hypothesis.added) :], given.added[len(base.hypothesis.added) :], strict=True):
                for unknown in scaled.unknowns:
                    z[at : at + unknown.size] = start_of(unknown, item.effect, item.name)
                    at += unknown.size
        return z

    def _step(self, hypothesis: Hypothesis, start: FloatArray, base: FloatArray, columns: FloatArray) -> FloatArray:
        first, base_loose = self.null.hypothesis.size, self.null.hypothesis.loose
        wide = np.ones(first)
        wide[: hypothesis.nominal_size] = [hypothesis.loose.get(f.name, 1.0) / base_loose.get(f.name, 1.0) for f in hypothesis.factors]
        normal = np.zeros((hypothesis.size, hypothesis.size))
        normal[:first, :first] = self._normal * np.outer(wide, wide)
        weighted = columns * self._weights[:, None]
        slope = np.concatenate([wide * (self._weighted.T @ base), weighted.T @ base])
        cross = (self._weighted.T @ columns) * wide[:, None]
        normal[:first, first:], normal[first:, :first], normal[first:, first:] = cross, cross.T, weighted.T @ columns
        normal += np.diag(hypothesis.precisions)
        slope += hypothesis.precisions * start
        sizes = (np.arange(len(start)) >= hypothesis.nominal_size) & (hypothesis.precisions == 0.0)
        return bounded_step(hypothesis, start, normal, slope, held=sizes)


def _alike(hypotheses: Sequence[Hypothesis]) -> list[list[Hypothesis]]:
    """Starts by what is not searched in them: their laws and choices."""
    groups: dict[object, list[Hypothesis]] = {}
    for hypothesis in hypotheses:
        groups.setdefault(tuple(_choices(item) for item in hypothesis.added), []).append(hypothesis)
    return list(groups.values())


def _choices(added: Added) -> tuple[object, ...]:
    searched = {path for unknown in added.unknowns for path in unknown.values([0.0] * unknown.size)}
    fields = ((name, value) for name, value, _ in added.effect.fields() if f"{added.name}.{name}" not in searched)
    return type(added.effect), added.at, added.name, *(f"{name}={value!r}" for name, value in fields)
