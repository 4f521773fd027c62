"""Following the roots of a line from speed to speed, through crossings."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from scipy.optimize import linear_sum_assignment

from hdrive_mbs.analysis.whirl.roots import FloatArray, Roots

IntArray = npt.NDArray[np.intp]

ALIKE = 0.7
"""Likeness (1 for the same root, 0 for another) from which a pair is beyond doubt; below it the step is halved."""

RELATED = 0.3
"""Likeness below which two roots are not the same, however small the step."""

UNRELATED = 1e-12
"""Likeness up to which two different roots have nothing to do with each other (forward and backward circles): rounding."""

HALVINGS = 10

JUMP = 0.3
"""Relative change of a root that is accepted where shapes say nothing after the last halving: a law that jumps with the speed."""

NONE = -1


def follow(tracker: ModeTracker, speeds: Sequence[float]) -> IntArray:
    """Which root is which branch: (speeds, branches), -1 where a branch does not exist.

    Branches are compared by their right and left shapes (``Roots.likeness``) across a step, which is halved up to ten
    times while a pair is in doubt or coupled roots seem to cross: two roots that come close and turn away exchange their
    shapes over a small range of speeds, and so keep their order; two that have nothing to do with each other cross.
    """
    here = tracker.roots(speeds[0])
    branch = np.arange(len(here.values))
    rows = [branch]
    count = len(branch)
    for a, b in pairwise(speeds):
        step = tracker.across(a, b)
        there = np.full(len(tracker.roots(b).values), NONE)
        for i, j in enumerate(step):
            if j != NONE:
                there[j] = branch[i]
        new = np.flatnonzero(there == NONE)
        there[new] = count + np.arange(len(new))
        count += len(new)
        branch = there
        rows.append(branch)
    table = np.full((len(speeds), count), NONE)
    for k, row in enumerate(rows):
        table[k, row] = np.arange(len(row))
    return table


class ModeTracker:
    """Pairs roots across a step of speed.

    solve : all roots at a speed
    wanted : how many of the lowest roots are followed;  certain : how many of them must be followed beyond doubt
    """

    def __init__(self, solve: Callable[[float], Roots], wanted: int, certain: int) -> None:
        self._solve, self._wanted, self._certain = solve, wanted, certain

    def roots(self, speed: float) -> Roots:
        """The roots that are followed."""
        return self._solve(speed).lowest(self._wanted)

    def across(self, a: float, b: float, halvings: int = HALVINGS) -> IntArray:
        """For each root at speed a, its index at speed b or -1."""
        pairs, in_doubt = matched(self.roots(a), self.roots(b), self._certain)
        if not in_doubt:
            return pairs
        if halvings == 0:
            return _with_nearest(pairs, self.roots(a), self.roots(b))
        middle = 0.5 * (a + b)
        first, second = self.across(a, middle, halvings - 1), self.across(middle, b, halvings - 1)
        return np.array([second[j] if j != NONE else NONE for j in first], dtype=np.intp)


def matched(a: Roots, b: Roots, certain: int) -> tuple[IntArray, bool]:
    """The partner in b of each root of a, or -1, and whether any of the ``certain`` lowest ones is in doubt."""
    pairs = np.full(len(a.values), NONE, dtype=np.intp)
    if not len(a.values) or not len(b.values):
        return pairs, False
    likeness = a.likeness(b)
    apart = np.abs(a.values[:, None] - b.values[None, :]) / np.abs(a.values)[:, None]
    cost = 1.0 - np.minimum(likeness, 1.0) + 0.01 * np.minimum(apart, 1.0)
    rows, columns = linear_sum_assignment(cost)
    related = likeness[rows, columns] > RELATED
    pairs[rows[related]] = columns[related]
    alike = (likeness > ALIKE) & (likeness < 1.0 / ALIKE)
    sure = alike[:certain].any(axis=1).all() and alike[:, :certain].any(axis=0).all()
    return pairs, not sure or _exchange(a, b, pairs, likeness, certain)


def _exchange(a: Roots, b: Roots, pairs: IntArray, likeness: FloatArray, certain: int) -> bool:
    """Whether two of the lowest roots that have anything to do with each other change places in frequency.

    Roots without any coupling cross; coupled ones come close, exchange their shapes over a range that may be much
    smaller than the step, and turn away.
    """
    here = np.flatnonzero(pairs[:certain] != NONE)
    there = pairs[here]
    before = np.sign(np.subtract.outer(a.values[here].imag, a.values[here].imag))
    after = np.sign(np.subtract.outer(b.values[there].imag, b.values[there].imag))
    between = likeness[np.ix_(here, there)]
    coupled = (between > UNRELATED) | (between.T > UNRELATED)
    return bool(np.any((before * after < 0.0) & coupled))


def _with_nearest(pairs: IntArray, a: Roots, b: Roots) -> IntArray:
    """Roots without a partner joined to the nearest without one, by size."""
    left, right = np.flatnonzero(pairs == NONE), np.setdiff1d(np.arange(len(b.values)), pairs)
    apart = np.abs(a.values[left][:, None] - b.values[right][None, :]) / np.abs(a.values[left])[:, None]
    rows, columns = linear_sum_assignment(apart)
    near = apart[rows, columns] < JUMP
    joined = pairs.copy()
    joined[left[rows[near]]] = right[columns[near]]
    return joined
