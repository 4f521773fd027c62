"""Where lines come to rest: lateral coordinates at which their accelerations vanish."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.lanes import Lanes
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.compiled.machine import processor
from hdrive_mbs.compiled.structure import Structure
from hdrive_mbs.compiled.time_inputs import Grid

FloatArray = npt.NDArray[np.float64]
Values = Mapping[str, float]

INSTANT = 1e-9
"""Time step [s] in which a line at rest gets the speed  acceleration * INSTANT: what it moves by meanwhile, 1e-17 m at 10 m/s^2, and
what damping takes of it, 1e-5 of it at 1e4/s, do not count."""
CHANGE = 1e-10
"""Of a coordinate [m, rad] for differences."""
TILT = 0.1
"""Distance [m] at which angular accelerations count beside linear ones."""
ENOUGH = 1e-8
"""Acceleration left over, relative to that in the undeformed place, at which a line counts as settled."""
NEWTON, DROPS = 25, (1e5, 1e4, 1e6)
"""Newton steps of a try, and springs per mass [1/s^2] that hold everything while it drops to where tries begin."""


def equilibria(lines: Sequence[CompiledLine], *, start: float = 0.0, angles: Values | None = None) -> list[dict[str, float]]:
    """Lateral coordinates of each line where it stays at rest: all speeds zero, spins at the given angles (0), states as they begin.

    Damped Newton's method with differences, all lanes at once: from the undeformed place, and where that fails (a
    bearing that hangs in its clearance, with no stiffness there) from where the weights drop the line against soft
    springs.  A line that does not settle keeps the place where least acceleration is left over.
    """
    groups: dict[Structure, list[int]] = {}
    for k, line in enumerate(lines):
        groups.setdefault(line.structure, []).append(k)
    found: dict[int, dict[str, float]] = {}
    width = processor().lanes
    for group in groups.values():
        for part in (group[first : first + width] for first in range(0, len(group), width)):
            some = _Settling([lines[k] for k in part], width, start, angles)
            found |= dict(zip(part, some.places(), strict=True))
    return [found[k] for k in range(len(lines))]


class _Settling:
    """Lines of one structure on their way to rest."""

    def __init__(self, lines: Sequence[CompiledLine], width: int, start: float, angles: Values | None) -> None:
        bodies = lines[0].network.bodies
        self.count, self.bodies = len(lines), len(bodies)
        self.at = np.array([k for k, body in enumerate(bodies) if body.lateral], int)
        self.names = [bodies[k].name for k in self.at]
        self.scale = np.array([1.0 if bodies[k].unit == "m" else TILT for k in self.at])
        self._lanes = Lanes([line.program for line in lines], width)
        initial = np.array([line.initial(angles, None, None) for line in lines], float)
        initial[:, self.at] = 0.0
        self._state = self._lanes.state(initial)
        self._moved = self._state[: initial.shape[1] * width].reshape(initial.shape[1], width)
        self._begin = self._moved.copy()
        self._grid, self._good = Grid(start, INSTANT, 1, 0, 1), self._lanes.counted()
        self._out = np.empty((len(self._lanes.structure.readings), width, 1))

    def places(self) -> list[dict[str, float]]:
        """Coordinates of each line."""
        n = len(self.at)
        if n == 0:
            return [{} for _ in range(self.count)]
        zero = np.zeros((self.count, n))
        whole = self._sizes(self._accelerations(zero))
        best, left = self._newton(zero)
        if np.any(left > ENOUGH * whole):
            first, slopes = self._accelerations(zero), self._slopes(zero)
            for held in DROPS:
                dropped = np.asarray(np.linalg.solve(held * np.eye(n) - slopes, first[..., None])[..., 0], float)
                place, over = self._newton(dropped)
                better = over < left
                best[better], left[better] = place[better], over[better]
                if not np.any(left > ENOUGH * whole):
                    break
        return [dict(zip(self.names, row, strict=True)) for row in best.tolist()]

    def _newton(self, q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The best places found from here, and what is left over there."""
        q = q.copy()
        force = self._accelerations(q)
        left = self._sizes(force)
        enough = ENOUGH * self._sizes(self._accelerations(0.0 * q))
        for _ in range(NEWTON):
            if np.all(left <= enough):
                break
            slopes = self._slopes(q)
            good = np.isfinite(slopes).all(axis=(1, 2)) & np.isfinite(force).all(axis=1)
            slopes[~good], force[~good] = -np.eye(len(self.at)), 0.0
            move = -_solved(slopes, force)
            share = np.ones(self.count)
            improved = np.zeros(self.count, bool)
            for _halving in range(8):
                tried = q + share[:, None] * move
                new = self._accelerations(tried)
                size = self._sizes(new)
                better = ~improved & (size < left)
                q[better], force[better], left[better] = tried[better], new[better], size[better]
                improved |= better
                if improved.all():
                    break
                share[~improved] *= 0.4
            if not improved.any():
                break
        return q, left

    def _accelerations(self, q: FloatArray) -> FloatArray:
        """Of the lateral coordinates of each line at rest in a place, shape (lines, n)."""
        self._moved[:] = self._begin
        self._moved[self.at, : self.count] = q.T
        self._lanes.run(self._state, self._grid, self._out, self._good, last=False)
        return np.asarray(self._moved[self.bodies + self.at, : self.count].T / INSTANT)

    def _slopes(self, q: FloatArray) -> FloatArray:
        """d(acceleration)/d(coordinate) of each line, shape (lines, n, n)."""
        n = len(self.at)
        here = self._accelerations(q)
        slopes = np.empty((self.count, n, n))
        for k in range(n):
            moved = q.copy()
            moved[:, k] += CHANGE
            slopes[:, :, k] = (self._accelerations(moved) - here) / CHANGE
        return slopes

    def _sizes(self, accelerations: FloatArray) -> FloatArray:
        found = np.sqrt(np.sum((accelerations * self.scale) ** 2, axis=1))
        return np.where(np.isfinite(found), found, np.inf)


def _solved(slopes: FloatArray, force: FloatArray) -> FloatArray:
    try:
        return np.asarray(np.linalg.solve(slopes, force[..., None])[..., 0])
    except np.linalg.LinAlgError:
        pairs = zip(slopes, force, strict=True)
        return np.array([np.linalg.lstsq(matrix, vector, rcond=1e-13)[0] for matrix, vector in pairs])
