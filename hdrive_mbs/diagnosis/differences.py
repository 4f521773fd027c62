"""Jacobians of residuals by differences, each column run through the records that it shows in.

A forward difference over h is wrong by h/2 of the second derivative.  Of a drive bench a unit of one coordinate changes the residuals by a
root of their sum of squares of 42,000, and some direction in which parameters nearly cancel bears 1.3: small errors of large columns make
it point elsewhere, and fits crawl along bent valleys.  Short differences lose it in rounding, which a motor's angle gathers over a record.
With differences that change the residuals by 0.1 to 1 fits come within 1.3 of the least cost; as long as ``step`` they end 52 and
56 above it, and at 0.03 one is 7 above and takes twice as long (benchmarks/differences).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.normal_equations import STRETCH, normal_equations
from hdrive_mbs.diagnosis.reach import Trials, deviations, is_unseen, missed
from hdrive_mbs.diagnosis.simulator import AT_ONCE, Simulator

FloatArray = npt.NDArray[np.float64]

CHANGE, CAUTIOUS = 5.0, 0.15
"""Change of the residuals (root of their sum of squares) that a difference along an axis of a metric makes, and share of the longest step
it may take."""
SHORT = 0.3
"""The same of a difference along a coordinate, where it is known how much that shows."""
FIRST, SHORTEST = 3e-3, 1e-4
"""Shares of a coordinate's ``step``: of a difference where that is not known, and of the shortest one."""


def jacobian(
    simulator: Simulator,
    hypothesis: Hypothesis,
    z: FloatArray,
    residuals: FloatArray,
    metric: FloatArray | None = None,
    unseen: Sequence[Trials] = (),
    sizes: FloatArray | None = None,
) -> FloatArray:
    """d residuals/dz over the fitted samples, shape (n, size), by differences; a column that cannot be run is zero.

    metric : J^T W J + P of a point nearby.  The differences are then taken along its axes, each as long as it takes to
        change the residuals by CHANGE: what hardly shows gets a long step, and is not buried under the errors of what
        shows most.
    unseen : without a metric, of each coordinate the trials in which it is not believed to show.  That is checked for all of them at
        once; the column is zero there.
    sizes : without a metric, what a unit of each coordinate changed the residuals by at a point nearby (root of the sum of squares)
    """
    if metric is None:
        return _Differences(simulator, hypothesis, z, residuals, sizes).columns(unseen or [frozenset()] * len(z))
    base = residuals[simulator.fit]
    directions = _axes(hypothesis, z, metric)
    points = _turned_where_clipped(hypothesis, z, directions)
    if not all(_is_allowed(hypothesis, point) for point in points):
        return jacobian(simulator, hypothesis, z, residuals)
    changes = np.zeros((len(z), len(base)))
    for first in range(0, len(points), AT_ONCE):
        for k, item in enumerate(simulator.residuals(hypothesis, points[first : first + AT_ONCE]), first):
            if item is None:
                return jacobian(simulator, hypothesis, z, residuals)
            np.subtract(item[simulator.fit], base, out=changes[k])
    for first in range(0, len(base), STRETCH):
        some = changes[:, first : first + STRETCH]
        some[:] = np.linalg.solve(directions.T, some)
    return changes.T


def believed(simulator: Simulator, hypothesis: Hypothesis) -> list[Trials]:
    """Of each coordinate the trials in which it is not believed to show, by what the simulator was told of nominal parameters."""
    nominal = [simulator.unseen.get(item.name, frozenset()) for item in hypothesis.factors]
    return nominal + [frozenset()] * (hypothesis.size - len(nominal))


def unseen_in(
    simulator: Simulator, hypothesis: Hypothesis, z: FloatArray, residuals: FloatArray, columns: FloatArray
) -> tuple[Trials, ...]:
    """Of each coordinate the trials in which it does not show, by the Jacobian's columns at a point."""
    fitted = residuals[simulator.fit]
    weights = simulator.blocks.weights(fitted)
    normal = normal_equations(columns, weights, fitted)[0] + np.diag(hypothesis.curvatures(z))
    return missed(columns, weights, fitted, normal, simulator.spans)


class _Differences:
    """Columns of a Jacobian along the coordinates, from a point."""

    def __init__(
        self, simulator: Simulator, hypothesis: Hypothesis, z: FloatArray, residuals: FloatArray, sizes: FloatArray | None
    ) -> None:
        self._simulator, self._hypothesis, self._z, self._residuals = simulator, hypothesis, z, residuals
        self._fitted = residuals[simulator.fit]
        self._directions = np.diag(lengths(hypothesis.steps(z), sizes))
        self._points = _turned_where_clipped(hypothesis, z, self._directions)
        self._rows = np.zeros((len(z), len(self._fitted)))
        self._all = frozenset(range(len(simulator.spans)))

    def columns(self, unseen: Sequence[Trials]) -> FloatArray:
        """Shape (n, size)."""
        groups: dict[Trials, list[int]] = {}
        for k, trials in enumerate(unseen):
            groups.setdefault(trials, []).append(k)
        groups = {trials: some for trials, some in groups.items() if len(some) > 1 and trials != self._all}
        alone = [k for k in range(len(self._z)) if not any(k in some for some in groups.values())]
        self._run(alone, frozenset())
        for trials, some in groups.items():
            self._run(some, trials)
        self._rows /= np.diag(self._directions)[:, None]
        for trials, some in groups.items():
            if not self._hardly_show(some, trials):
                self._rows[some] *= np.diag(self._directions)[some, None]
                self._run(some, self._all - trials)
                self._rows[some] /= np.diag(self._directions)[some, None]
        return self._rows.T

    def _run(self, some: Sequence[int], skipped: Trials) -> None:
        """Differences along some coordinates, but for trials that are skipped."""
        simulator = self._simulator
        kept = [part for number, part in enumerate(simulator.spans) if number not in skipped]
        for first in range(0, len(some), AT_ONCE):
            few = some[first : first + AT_ONCE]
            found = simulator.residuals(self._hypothesis, [self._points[k] for k in few], skipped, [self._residuals] * len(few))
            for k, item in zip(few, found, strict=True):
                if item is not None:
                    change = item[simulator.fit]
                    change -= self._fitted
                    for part in kept:
                        self._rows[k, part] = change[part]

    def _hardly_show(self, some: Sequence[int], trials: Trials) -> bool:
        """Whether all of them moved by a standard deviation change next to nothing in some trials."""
        simulator, hypothesis = self._simulator, self._hypothesis
        weights = simulator.blocks.weights(self._fitted)
        normal = normal_equations(self._rows.T, weights, self._fitted)[0] + np.diag(hypothesis.curvatures(self._z))
        moves = np.minimum(deviations(normal), hypothesis.reaches(self._z))
        moved = self._z.copy()
        moved[some] += (moves * np.sign(np.diag(self._directions)))[some]
        [item] = simulator.residuals(hypothesis, [hypothesis.clipped(moved)], self._all - trials, [self._residuals])
        return item is not None and is_unseen(item[simulator.fit] - self._fitted, weights, self._fitted)


def lengths(steps: FloatArray, sizes: FloatArray | None) -> FloatArray:
    """Of differences along coordinates with these steps, where a unit of each changes the residuals by this much, if that is known."""
    if sizes is None:
        return FIRST * steps
    known = sizes > 0.0
    return np.where(known, np.clip(SHORT / np.where(known, sizes, 1.0), SHORTEST * steps, steps), FIRST * steps)


def _turned_where_clipped(hypothesis: Hypothesis, z: FloatArray, directions: FloatArray) -> list[FloatArray]:
    """The ends of differences from a point; those that are not allowed go the other way, in the directions too."""
    points = []
    for k in range(len(z)):
        if not _is_allowed(hypothesis, z + directions[:, k]):
            directions[:, k] *= -1.0
        points.append(z + directions[:, k])
    return points


def _is_allowed(hypothesis: Hypothesis, point: FloatArray) -> bool:
    return bool(np.allclose(hypothesis.clipped(point), point, rtol=0.0, atol=1e-14))


def _axes(hypothesis: Hypothesis, z: FloatArray, metric: FloatArray) -> FloatArray:
    """Axes of a metric as columns, each of length CHANGE in it or as far as a cautious step goes."""
    scale = np.sqrt(np.maximum(np.diag(metric), 1e-300))
    values, vectors = np.linalg.eigh(metric / np.outer(scale, scale))
    values = np.maximum(values, 1e-12 * values[-1])
    axes = vectors / scale[:, None] * (CHANGE / np.sqrt(values))
    longest = np.max(np.abs(axes) / (CAUTIOUS * hypothesis.reaches(z))[:, None], axis=0)
    return np.asarray(axes / np.maximum(longest, 1.0))
