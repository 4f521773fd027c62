"""Readings of a column that stands still: one sample after the other says the same.

Rounding acts as an error of a step's width that is new in each sample while the quantity moves on.  At rest it is one error, of
any size up to half a step, and stays: were every sample counted, a law that moves the resting place by a part of a step would take
all of it away and seem to be proven by thousands of samples.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.measured import Measured

FloatArray = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

LONG = 32
"""Equal readings in a row, at least, that are a rest: slow motion gives some in a row too, and turns."""
COARSE = 2.0
"""Steps of rounding over the other noise, at least: noise of more changes the reading at rest as well."""


def repeated(measured: Measured, values: FloatArray, every: int = 1) -> Mask:
    """Samples that repeat an earlier one of the same rest, shape (n,).

    every : only each such sample is used, so that one of these is kept in each rest that has one
    """
    again = np.zeros(len(values), bool)
    if not measured.resolution > COARSE * max(measured.noise, measured.coloured[0]):
        return again
    edges = np.flatnonzero(np.diff(values) != 0.0) + 1
    starts, ends = np.concatenate([[0], edges]), np.concatenate([edges, [len(values)]])
    long = ends - starts >= LONG
    for first, last in zip(starts[long], ends[long], strict=True):
        again[first:last] = True
        kept = -(-first // every) * every
        again[kept if kept < last else first] = False
    return again
