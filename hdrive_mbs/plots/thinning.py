"""Long histories for the eye: the smallest and largest value of each pixel column are kept."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

COLUMNS = 1500
"""More than a picture of usual size has pixels across."""


def thinned(x: FloatArray, y: FloatArray, columns: int = COLUMNS) -> tuple[FloatArray, FloatArray]:
    """At most two points per column, so that peaks stay and files stay small."""
    if len(x) <= 2 * columns:
        return x, y
    place = np.minimum(((x - x[0]) / (x[-1] - x[0]) * columns).astype(int), columns - 1)
    starts = np.concatenate([[0], np.nonzero(np.diff(place))[0] + 1])
    low, high = np.minimum.reduceat(y, starts), np.maximum.reduceat(y, starts)
    keep = {0, len(x) - 1}
    for first, last, small, large in zip(starts, np.append(starts[1:], len(x)), low, high, strict=True):
        part = y[first:last]
        keep.add(int(first + np.argmax(part == small)))
        keep.add(int(first + np.argmax(part == large)))
    index = np.array(sorted(keep))
    return x[index], y[index]
