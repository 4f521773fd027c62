"""Which records a change shows in: the others need no run for it.

How a shaft turns is compared by itself (see trial.py), and what bends a rotor line hardly shows there; drags and inertias about
the axis hardly show in what shakes.  A column of a Jacobian is zero there, as far as the answer can tell:

    |c_t|_W s < SEEN and |c_t^T W r_t| s < SEEN

with the part c_t of the column and r_t of the residuals that belong to a trial, the weights W of the misfit, and the standard
deviation s of the coordinate, all others free: over all that it may reasonably move, the trial's logarithm of the likelihood
changes by less than SEEN.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
Trials = frozenset[int]

SEEN = 0.1
"""Change of the residuals, in standard deviations of all noise of a trial, that counts: 0.005 of the logarithm of the likelihood."""
SINGLY = 0.03
"""Likewise for one of many coordinates, which are checked together."""
PART = 1e-4
"""Share of the square of a change that counts, where the size of the change is not known yet."""
RIDGE = 1e-12
"""Of the largest eigenvalue of a scaled curvature: the least one that is reckoned with."""


def deviations(normal: FloatArray) -> FloatArray:
    """Standard deviation of each coordinate, all others free, from J^T W J + P, shape (size, size); infinite where nothing holds it."""
    size = np.sqrt(np.diag(normal))
    held = size > 0.0
    found = np.full(len(normal), np.inf)
    if held.any():
        scale = size[held]
        values, vectors = np.linalg.eigh(normal[np.ix_(held, held)] / np.outer(scale, scale))
        found[held] = np.sqrt(np.sum(vectors**2 / np.maximum(values, RIDGE * values[-1]), axis=1)) / scale
    return found


def is_unseen(change: FloatArray, weights: FloatArray, residuals: FloatArray, limit: float = SEEN) -> bool:
    """Whether a change of residuals hardly counts, all three over the samples of some trials."""
    weighted = weights * change
    return bool(weighted @ change <= limit**2 and abs(weighted @ residuals) <= limit)


def missed(
    columns: FloatArray, weights: FloatArray, residuals: FloatArray, normal: FloatArray, parts: Sequence[slice]
) -> tuple[Trials, ...]:
    """Of each coordinate the trials in which it does not show; none for one that shows nowhere.

    columns : J, shape (n, size);  weights, residuals : (n,);  normal : J^T W J + P;  parts : samples of each trial
    """
    spreads = deviations(normal)
    found = []
    for k, spread in enumerate(spreads):
        seen = [
            not np.isfinite(spread) or not is_unseen(spread * columns[part, k], weights[part], residuals[part], SINGLY) for part in parts
        ]
        found.append(frozenset(number for number, shows in enumerate(seen) if not shows) if any(seen) else frozenset())
    return tuple(found)


def hardly_reached(changed: FloatArray, base: FloatArray, weights: FloatArray, parts: Sequence[slice]) -> Trials:
    """Trials whose part of a change of residuals is so small that with the change as large as all others ask for it would not count.

    changed, base, weights : (n,);  parts : samples of each trial
    """
    change = changed - base
    by_part = np.array([float(weights[part] @ change[part] ** 2) for part in parts])
    along = np.array([float((weights[part] * change[part]) @ base[part]) for part in parts])
    total = float(by_part.sum())
    small = (by_part <= PART * total) & (along**2 <= SEEN**2 * total)
    return frozenset(np.flatnonzero(small).tolist()) if total > 0.0 else frozenset()
