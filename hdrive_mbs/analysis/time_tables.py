"""How long a step may be so that no point of a table over time is stepped over."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from hdrive_mbs.engine.solvers import DormandPrince, Solver
from hdrive_mbs.quantities import Described
from hdrive_mbs.scene import Scene

SHORTEST = 1e-6
"""A step is not limited below this share of the run: the impulse of a shorter pulse changes nothing that is seen."""


def longest_step(scene: Scene, duration: float) -> float:
    """Half the shortest time over three neighbouring points of any table over time [s]; infinite without a table.

    A pulse in a table is at least three points wide; a single steep edge is not a pulse and sets no limit.
    The stages of DormandPrince are at most half a step apart, so several of them fall into every pulse.
    """
    shortest = math.inf
    for times, periodic in _time_tables(scene):
        if periodic:
            times = np.append(times, times[-1] + times[1] - times[0])
        widths = times[2:] - times[:-2]
        met = widths if periodic else widths[(times[:-2] < duration) & (times[2:] > 0.0)]
        shortest = min(shortest, 0.5 * float(np.min(met, initial=math.inf)))
    return max(shortest, SHORTEST * duration)


def for_tables(solver: Solver, scene: Scene, duration: float) -> Solver:
    """The solver with its longest step short enough for the tables of the scene; a constant step stays as it is."""
    if isinstance(solver, DormandPrince):
        limit = longest_step(scene, duration)
        if limit < solver.max_step:
            return solver.replacing(max_step=limit)
    return solver


def _time_tables(scene: Scene) -> Iterator[tuple[np.ndarray, bool]]:
    """Every field in s with three points or more, and whether its owner repeats it."""
    stack: list[Described] = [*scene.parts.values(), *(placed.effect for placed in scene.effects)]
    while stack:
        owner = stack.pop()
        for _, value, metadata in owner.fields():
            quantity = metadata.get("quantity")
            if isinstance(value, Described):
                stack.append(value)
            elif quantity is not None and quantity.sequence and quantity.unit == "s" and len(value) > 2:
                yield np.asarray(value), bool(getattr(owner, "periodic", False))
