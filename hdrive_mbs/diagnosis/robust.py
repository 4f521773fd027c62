"""A misfit whose scale is unknown wherever the model is wrong.

The residuals fall into blocks (stretches of a column of a record).  Where a block's mean square q is above 1, its noise
is taken as unknown and fitted: its cost n q/2 becomes n (1 + log q)/2, the likelihood with the most probable scale.
Quiet stretches then hold the parameters while a resonance that the model lacks cannot pull them away, and the cost
turns into the plain sum of squares as the model becomes right.

Source: iterated reweighting of a concave function of the sum of squares (majorise and minimise), e.g. Huber, Ronchetti,
Robust Statistics, 7.8, with one scale per block.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


class Blocks:
    """Blocks of fitted samples.

    number : block of each sample, shape (n,), from 0
    """

    def __init__(self, number: npt.NDArray[np.int64]) -> None:
        self._number = number
        self._count = np.maximum(np.bincount(number), 1)

    def mean_squares(self, residuals: FloatArray) -> FloatArray:
        """q of each block."""
        return np.asarray(np.bincount(self._number, residuals**2, minlength=len(self._count)) / self._count)

    def cost(self, residuals: FloatArray) -> float:
        """Sum over the blocks of n q/2, or n (1 + log q)/2 where q > 1."""
        q = self.mean_squares(residuals)
        return 0.5 * float(self._count @ np.where(q > 1.0, 1.0 + np.log(np.maximum(q, 1.0)), q))

    def weights(self, residuals: FloatArray) -> FloatArray:
        """1/max(1, q) of each sample: of its square in the sum that has the same slope as the cost."""
        return np.asarray(1.0 / np.maximum(self.mean_squares(residuals), 1.0))[self._number]
