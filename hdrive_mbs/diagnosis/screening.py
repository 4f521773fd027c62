"""Quick looks at candidates: one joint step from the fitted nominal model, at every start of its shapes.

An effect begins at the low end of its strengths, where it hardly changes anything; the differences to the nominal run
are its columns beside the nominal Jacobian, and one joint step of all parameters gives the strengths that the records
ask for.  That step is then run, so what counts is a true misfit and not a linear promise.

A shape s of an effect of strength a shows in the records about as a f(s): its column at the start is a_0 df/ds, and the
step that it gets is good for a_0.  Where the strength grows to g a_0 in the same step, the same change of the records takes
1/g of it, so steps with shapes held back by g are run as well.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.bounded import bounded_step
from hdrive_mbs.diagnosis.fit import AS_PROMISED, Fitted
from hdrive_mbs.diagnosis.hypothesis import Hypothesis, start_of
from hdrive_mbs.diagnosis.normal_equations import promised
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.starts import ORIGIN, Starts, alike
from hdrive_mbs.diagnosis.unknowns import Strength, Vector

FloatArray = npt.NDArray[np.float64]

PARTS = (1.0, 0.4, 0.1)
"""Of the linear step: the whole, and what is run side by side where that falls short of its promise (AS_PROMISED)."""
FOLLOWED, DIRECTED = 6, 3
"""Starts of a law at a place that are looked at with all that is searched of it; of one that begins with an amplitude and a phase,
which the records answer linearly, so that what each promises is known.  As many again, as long as others promise more than these bring."""
PROMISING = 20.0
"""Log-likelihood that others have to promise then, at least.  In our own twelfth drive set (c11, labels open) an error of order three of
the output promised 870, as the sixth of ten starts, and brought 5060; the first three promised 1380 to 3230 and brought 175 at most."""
FAINTEST, WITHIN = 50.0, 0.1
"""Log-likelihood of a gap, at least, and the share of it that a start may cost, which goes with the square of its size.  From starts with
four times its compliance a crack was not seen (our own open rotor set of seed 1801, c05: the refitted model leaves 1.010)."""
CHOICES, RIVAL = 3, 0.5
"""Values of what is not searched, orders say, that are looked at once more, and share of the best one's gain that each has to have:
in an open case of a ripple beside a misalignment the right order had 0.66 of what a wrong one had."""
RUN_WHOLE = 3
"""Looks that may be run through trials that were left out: the first one whose cost then is that of a run below what others promise."""


@dataclass(frozen=True, eq=False)
class _Step:
    """A joint step from a start, whose cost is known, with what it is promised to lower that by."""

    start: Hypothesis
    origin: FloatArray
    move: FloatArray
    cost: float
    promised: float

    def end(self, hypothesis: Hypothesis) -> FloatArray:
        """Where all of it ends."""
        return hypothesis.clipped(self.origin + self.move)


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
        """The best of several starts; None where none of them can be run.

        Of many, those are looked at whole whose first size promises most with all else as it begins, and others that promise more than
        these bring.
        """
        first = self.null.hypothesis.size
        groups = [Starts(some, [self._start(start, some[0]) for start in some], self.null) for some in alike(hypotheses)]
        most = DIRECTED if all(_is_directed(group.hypothesis, first) for group in groups) else FOLLOWED
        for group in groups:
            all_kept = len(hypotheses) <= most
            self._begin_fainter(group, range(first, group.hypothesis.size) if all_kept else _promising(group.hypothesis, first))
        looks = self._best_looks(groups) if len(hypotheses) <= most else self._as_promised(groups, most)
        if len(groups) > 1:
            looks += self._once_more(looks)
        best = self._best_whole(heapq.nsmallest(RUN_WHOLE, looks, key=lambda pair: pair[0].cost))
        if best is None:
            return None
        hypothesis, z = best.hypothesis.rescaled(best.z)
        return Look(hypothesis, z, best.cost, best.residuals, best.start)

    def _once_more(self, looks: Sequence[tuple[Look, Starts]]) -> list[tuple[Look, Starts]]:
        """Looks from the best ones of those choices that are not searched: what is not chosen here is never fitted.

        One step of five coordinates is no judge between two orders of a ripple: the right one may be some way off still.
        """
        before = self.null.cost
        best: dict[object, tuple[Look, Starts]] = {}
        for look, group in sorted(looks, key=lambda pair: pair[0].cost):
            best.setdefault(group.choices, (look, group))
        ranked = list(best.values())
        rivals = [pair for pair in ranked[:CHOICES] if before - pair[0].cost > RIVAL * (before - ranked[0][0].cost)]
        found = []
        for look, group in rivals if len(rivals) > 1 else []:
            closer = Starts([look.start], [look.z], self.null)
            closer.skipped = group.skipped
            closer.found[0][ORIGIN] = look.residuals
            found += [(item, closer) for item in self._looks(closer)]
        return found

    def _best_whole(self, looks: Sequence[tuple[Look, Starts]]) -> Look | None:
        """The best with all trials run, those that were left out only for looks that are the best as far as is known.

        looks : cheapest first
        """
        known: list[Look] = []
        for look, group in looks:
            if known and min(item.cost for item in known) <= look.cost:
                break
            whole = self._whole(look, group)
            known += [] if whole is None else [whole]
        return min(known, key=lambda item: item.cost, default=None)

    def _whole(self, look: Look, group: Starts) -> Look | None:
        """With the trials that were left out run too; None where they cannot be."""
        if not group.skipped:
            return look
        others = frozenset(range(len(self.simulator.spans))) - group.skipped
        [residuals] = self.simulator.residuals(look.hypothesis, [look.z], others, [look.residuals])
        return None if residuals is None else self._look(look.hypothesis, look.z, residuals, look.start)

    def _begin_fainter(self, group: Starts, along: Sequence[int] = ()) -> None:
        """Starts whose size alone changes the records by more than the whole gap begin at a part of it, which the gap has room for.

        along : coordinates that will be asked for
        """
        group.run_first(self.simulator, self._weights, along)
        group.run(self.simulator, ())
        fit = self.simulator.fit
        before = self.simulator.blocks.cost(self.null.residuals[fit])
        gap = max(before - 0.5 * int(np.count_nonzero(fit)), FAINTEST)
        leading = _leading(group.hypothesis, self.null.hypothesis.size)
        for k, found in enumerate(group.found):
            residuals = found[ORIGIN]
            grown = 0.0 if residuals is None else self.simulator.blocks.cost(residuals[fit]) - before
            if grown > gap:
                group.origins[k][leading] *= math.sqrt(WITHIN * gap / grown)
                found.clear()

    def _as_promised(self, groups: Sequence[Starts], most: int) -> list[tuple[Look, Starts]]:
        """Looks from the starts whose first size, with what adds to it, promises most, and as long as these bring less than others promise,
        from the next ones."""
        ranked = []
        for group in groups:
            along = _promising(group.hypothesis, self.null.hypothesis.size)
            group.run(self.simulator, along)
            ranked += [(self._promise(group, k, along), group, k) for k in range(len(group.starts))]
        ranked.sort(key=lambda item: -item[0])
        looks: list[tuple[Look, Starts]] = []
        while ranked:
            chosen = [(group, [k for _, of, k in ranked[:most] if of is group]) for group in groups]
            looks += self._best_looks([group.some(kept) for group, kept in chosen if kept])
            brought = max((self.null.cost - look.cost for look, _ in looks), default=0.0)
            ranked = [item for item in ranked[most:] if item[0] > max(brought, PROMISING)]
        return looks

    def _best_looks(self, groups: Sequence[Starts]) -> list[tuple[Look, Starts]]:
        """The best looks from the starts of each group."""
        looks = []
        for group in groups:
            looks += heapq.nsmallest(RUN_WHOLE, ((look, group) for look in self._looks(group)), key=lambda pair: pair[0].cost)
        return looks

    def _promise(self, group: Starts, k: int, along: Sequence[int]) -> float:
        """By how much the misfit falls if all goes on as it begins along some coordinates, with the base's parameters free to follow;
        nothing along one that would have to become negative."""
        if group.found[k][ORIGIN] is None or not along:
            return 0.0
        base, columns = self._columns(group, k, along)
        weighted = columns * self._weights[:, None]
        cross = self._weighted.T @ columns
        freed = np.linalg.lstsq(self._normal + np.diag(self.null.hypothesis.precisions), cross, rcond=1e-14)[0]
        slope = weighted.T @ base - freed.T @ (self._weighted.T @ base)
        move = -np.linalg.lstsq(weighted.T @ columns - freed.T @ cross, slope, rcond=1e-12)[0]
        return 0.0 if len(along) == 1 and move[0] <= 0.0 else -0.5 * float(slope @ move)

    def _looks(self, group: Starts) -> Iterator[Look]:
        """Looks from starts that differ in searched values alone: all of them are run side by side.

        The whole step first: where it lowers the cost about as the Jacobian promises, its parts are not run.
        """
        hypothesis = group.hypothesis
        own = range(self.null.hypothesis.size, hypothesis.size)
        group.run(self.simulator, own)
        steps = [self._step_from(group, k, own) for k in range(len(group.starts)) if group.found[k][ORIGIN] is not None]
        whole = list(self._run(group, [step.end(hypothesis) for step in steps], [step.start for step in steps]))
        yield from (look for look in whole if look is not None)
        short = [
            step for step, look in zip(steps, whole, strict=True) if look is None or step.cost - look.cost < AS_PROMISED * step.promised
        ]
        points = [(step, point) for step in short for point in self._parts(step, hypothesis)]
        found = self._run(group, [point for _, point in points], [step.start for step, _ in points])
        yield from (look for look in found if look is not None)

    def _parts(self, step: _Step, hypothesis: Hypothesis) -> list[FloatArray]:
        """Where parts of a step end, and the step held back with its parts."""
        held_back = [part * move for move in self._held_back(hypothesis, step.origin, step.move) for part in PARTS]
        return [hypothesis.clipped(step.origin + move) for move in (*(part * step.move for part in PARTS[1:]), *held_back)]

    def _step_from(self, group: Starts, k: int, own: Sequence[int]) -> _Step:
        hypothesis, origin, residuals = group.hypothesis, group.origins[k], group.found[k][ORIGIN]
        assert residuals is not None
        normal, slope = self._system(hypothesis, origin, *self._columns(group, k, own))
        move = self._step(hypothesis, origin, normal, slope)
        cost = self.simulator.blocks.cost(residuals[self.simulator.fit]) + hypothesis.prior_cost(origin)
        return _Step(group.starts[k], origin, move, cost, promised(hypothesis.clipped(origin + move) - origin, normal, slope))

    def _held_back(self, hypothesis: Hypothesis, origin: FloatArray, step: FloatArray) -> Iterator[FloatArray]:
        """The same step with all of the effect that was added last but its first strength divided by what that grows."""
        own = self.null.hypothesis.size
        sizes = _sizes(hypothesis, own)
        if not sizes:
            return
        first = sizes[0][1]
        before, after = (float(np.linalg.norm(point[first])) for point in (origin, origin + step))
        if after > before > 0.0:
            shares = np.where(np.arange(len(step)) < own, 1.0, before / after)
            shares[first] = 1.0
            yield step * shares

    def _run(self, group: Starts, points: Sequence[FloatArray], begun: Sequence[Hypothesis]) -> Iterator[Look | None]:
        """Looks at points, None where one cannot be run; trials in which the effect does not show follow the parameters of the base as
        its Jacobian says."""
        hypothesis = group.hypothesis
        expected = [self._expected(hypothesis, point) for point in points] if group.skipped else []
        found = self.simulator.residuals(hypothesis, points, group.skipped, expected) if points else []
        for point, start, residuals in zip(points, begun, found, strict=True):
            yield None if residuals is None else self._look(hypothesis, point, residuals, start)

    def _look(self, hypothesis: Hypothesis, z: FloatArray, residuals: FloatArray, start: Hypothesis) -> Look:
        misfit = self.simulator.blocks.cost(residuals[self.simulator.fit])
        return Look(hypothesis, z, misfit + hypothesis.prior_cost(z), residuals, start)

    def _expected(self, hypothesis: Hypothesis, z: FloatArray) -> FloatArray:
        """Residuals of the base with its parameters moved, by its Jacobian; those that no fit sees as they are."""
        base, fit = self.null, self.simulator.fit
        moved = z[: base.hypothesis.size] - self._start(hypothesis)[: base.hypothesis.size]
        residuals = base.residuals.copy()
        residuals[fit] += self.columns @ (self._widened(hypothesis) * moved)
        return residuals

    def _widened(self, hypothesis: Hypothesis) -> FloatArray:
        """By how much a coordinate of the base moves for one of a hypothesis in which some parameters are loose."""
        loose = self.null.hypothesis.loose
        wide = np.ones(self.null.hypothesis.size)
        wide[: hypothesis.nominal_size] = [hypothesis.loose.get(f.name, 1.0) / loose.get(f.name, 1.0) for f in hypothesis.factors]
        return wide

    def _columns(self, group: Starts, k: int, along: Sequence[int]) -> tuple[FloatArray, FloatArray]:
        """Fitted residuals at a start, and the Jacobian's columns along some coordinates; zero where they could not be run."""
        fit = self.simulator.fit
        origin = group.found[k][ORIGIN]
        assert origin is not None
        fitted = origin[fit]
        columns = np.zeros((len(along), len(fitted)))
        for row, coordinate in zip(columns, along, strict=True):
            item = group.found[k][coordinate]
            if item is not None:
                row[:] = (item[fit] - fitted) / group.steps[coordinate]
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

    def _system(self, hypothesis: Hypothesis, start: FloatArray, base: FloatArray, columns: FloatArray) -> tuple[FloatArray, FloatArray]:
        """J^T W J + P and J^T W r + P z at a start."""
        first, wide = self.null.hypothesis.size, self._widened(hypothesis)
        normal = np.zeros((hypothesis.size, hypothesis.size))
        normal[:first, :first] = self._normal * np.outer(wide, wide)
        weighted = columns * self._weights[:, None]
        slope = np.concatenate([wide * (self._weighted.T @ base), weighted.T @ base])
        cross = (self._weighted.T @ columns) * wide[:, None]
        normal[:first, first:], normal[first:, :first], normal[first:, first:] = cross, cross.T, weighted.T @ columns
        return normal + np.diag(hypothesis.precisions), slope + hypothesis.precisions * start

    @staticmethod
    def _step(hypothesis: Hypothesis, start: FloatArray, normal: FloatArray, slope: FloatArray) -> FloatArray:
        sizes = (np.arange(len(start)) >= hypothesis.nominal_size) & (hypothesis.precisions == 0.0)
        return bounded_step(hypothesis, start, normal, slope, held=sizes)


def _sizes(hypothesis: Hypothesis, first: int) -> list[tuple[Strength | Vector, slice]]:
    """Sizes of effects, and where they sit among the search coordinates, from a first one on."""
    pairs = zip(hypothesis.unknowns, hypothesis.slices, strict=True)
    return [(unknown, part) for unknown, part in pairs if part.start >= first and isinstance(unknown, Strength | Vector)]


def _leading(hypothesis: Hypothesis, first: int) -> list[int]:
    """Coordinates of the first size from there on."""
    return [k for _, part in _sizes(hypothesis, first)[:1] for k in range(part.start, part.stop)]


def _promising(hypothesis: Hypothesis, first: int) -> list[int]:
    """Coordinates of the first size from there on, and of what adds to it: an error of the output of order two promised less than others of
    wrong orders as long as its zero was held (c05 of our own twenty-first drive set, labels open)."""
    added = {f"{item.name}.{name}" for item in hypothesis.added for name in item.effect.additive}
    pairs = zip(hypothesis.unknowns, hypothesis.slices, strict=True)
    more = [k for unknown, part in pairs if part.start >= first and unknown.path in added for k in range(part.start, part.stop)]
    return [*_leading(hypothesis, first), *more]


def _is_directed(hypothesis: Hypothesis, first: int) -> bool:
    """Whether the first size from there on has an amplitude and a phase."""
    return any(isinstance(unknown, Vector) for unknown, _ in _sizes(hypothesis, first)[:1])
