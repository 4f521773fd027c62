"""The branches of one block of coordinates over a grid of speeds."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.linalg import eigh

from hdrive_mbs.analysis.whirl.line_block import BlockModel, LineBlock
from hdrive_mbs.analysis.whirl.mode_tracking import NONE, IntArray, ModeTracker, follow
from hdrive_mbs.analysis.whirl.reduced_basis import reduced_model
from hdrive_mbs.analysis.whirl.roots import ComplexArray, FloatArray, Roots

FEWEST = 6
"""Branches that are followed at least where no number is given."""

ATTEMPTS = 6

DENSE_LIMIT = 40
"""Coordinates up to which the whole block is solved at every speed."""

MARGIN = 4
"""Roots followed beyond those that are needed, so that a branch may leave the lowest ones and come back."""

OVERDAMPS = 0.9
"""A branch that ends with at least this damping ratio has become overdamped; another one has left the lowest roots."""


class BlockBranches:
    """Roots of a block at the speeds, joined to branches.

    needed : number of lowest branches that must be complete; None: all that come below ``highest``
    highest : |lambda| up to which branches matter where needed is None [rad/s]
    values : lambda of each branch, (s, b), NaN where it does not exist
    """

    def __init__(
        self,
        block: LineBlock,
        whirl: ComplexArray,
        speeds: FloatArray,
        *,
        needed: int | None,
        highest: float,
        report: Callable[[], None] = lambda: None,
    ) -> None:
        self.block, self.speeds = block, speeds
        self._whirl, self._report = whirl, report
        self._grid = [float(speed) for speed in speeds]
        self._slopes: list[ComplexArray] | None = None
        self._whole = BlockModel(block, whirl)
        wanted = needed if needed is not None else max(FEWEST, self._guess(highest))
        for _ in range(ATTEMPTS):
            self.model = self._model(wanted + MARGIN)
            solved = [self._solved(speed) for speed in self._grid]
            within = max(int(np.sum(np.abs(roots.values) < highest)) for roots in solved) if needed is None else 0
            if within > wanted:
                wanted = within
                continue
            self.tracker = ModeTracker(self.model.solve, wanted + MARGIN, wanted)
            self.table = follow(self.tracker, self._grid)
            self.values = self._values(solved)
            if self._is_complete(wanted if needed is None else needed):
                break
            wanted += MARGIN

    def _solved(self, speed: float) -> Roots:
        roots = self.model.solve(speed)
        self._report()
        return roots

    def _guess(self, highest: float) -> int:
        """Undamped modes at rest below a frequency."""
        stiffness = self.block.at(self._grid[0])[1]
        return len(eigh(0.5 * (stiffness + stiffness.T), self.block.mass, eigvals_only=True, subset_by_value=(-np.inf, highest**2)))

    def _model(self, wanted: int) -> BlockModel:
        if self.block.is_constant or self.block.size <= max(DENSE_LIMIT, 4 * wanted):
            return self._whole
        return reduced_model(self.block, self._whirl, self._grid, wanted)

    def _values(self, solved: list[Roots]) -> ComplexArray:
        values = np.full(self.table.shape, complex(np.nan, np.nan))
        for row, roots in enumerate(solved):
            there = self.table[row] != NONE
            values[row, there] = roots.values[self.table[row, there]]
        return values

    def _is_complete(self, needed: int) -> bool:
        """Whether the lowest branches exist throughout, but for being overdamped."""
        for branch in self.lowest(needed):
            there = np.flatnonzero(self.table[:, branch] != NONE)
            ends = [k for k in (there[0], there[-1]) if k not in (0, len(self._grid) - 1)]
            values = self.values[ends, branch]
            if np.any(-values.real < OVERDAMPS * np.abs(values)):
                return False
        return True

    def lowest(self, count: int) -> IntArray:
        """The branches with the smallest |lambda| anywhere, in the order of the table."""
        smallest = np.nanmin(np.abs(self.values), axis=0) if self.values.size else np.zeros(0)
        return np.sort(np.argsort(smallest, kind="stable")[:count])

    def roots(self, row: int) -> Roots:
        """All roots at a speed of the grid."""
        return self.model.solve(self._grid[row])

    def shapes(self, row: int, branches: IntArray) -> ComplexArray:
        """Shapes over the block's coordinates at a speed of the grid, (n, branches that exist there)."""
        return np.asarray(self.model.basis @ self.roots(row).right[:, self.table[row, branches]])

    def slopes(self, branch: int) -> ComplexArray | None:
        """d(lambda)/d(speed) at the speeds where that costs nothing: a line that is linear in the speed."""
        if self.block.affine is None:
            return None
        if self._slopes is None:
            self._slopes = [roots.slopes(*self.model.slopes(0.0)) for roots in (self.tracker.roots(speed) for speed in self._grid)]
        column = self.table[:, branch]
        return np.array([slopes[k] if k != NONE else complex(np.nan, np.nan) for slopes, k in zip(self._slopes, column, strict=True)])

    def at(self, branch: int, speed: float) -> tuple[complex, ComplexArray] | None:
        """lambda and shape of a branch between two speeds of the grid; None where it does not exist."""
        above = int(np.searchsorted(self.speeds, speed, side="right"))
        for row in (above - 1, above):
            if 0 <= row < len(self._grid) and self.table[row, branch] != NONE:
                index = self._continued(row, self.table[row, branch], speed)
                if index != NONE:
                    roots = self.model.solve(speed)
                    return complex(roots.values[index]), np.asarray(self.model.basis @ roots.right[:, index : index + 1])
        return None

    def _continued(self, row: int, index: int, speed: float) -> int:
        """What a root at a speed of the grid is at another speed, or -1."""
        start = self._grid[row]
        if speed == start:
            return index
        if speed > start:
            return int(self.tracker.across(start, speed)[index])
        back = np.flatnonzero(self.tracker.across(speed, start) == index)
        return int(back[0]) if len(back) else NONE
