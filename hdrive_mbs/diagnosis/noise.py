"""Residuals made white: every sample then counts with variance 1, and an unknown offset costs nothing.

White noise v of variance V beside first-order coloured noise c, c' = a c + w, var c = C: the best prediction
of the next sample has the steady error variance S = P + V with P = a^2 P V/(P + V) + (1 - a^2) C, and the
innovations e = y - c^, c^' = a (c^ + P/S e) are white.  Source: steady Kalman filter of ARMA(1, 1), e.g. Anderson,
Moore, Optimal Filtering, 4.4.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
from scipy.signal import lfilter

from hdrive_mbs.diagnosis.measured import Measured

FloatArray = npt.NDArray[np.float64]


class Whitener:
    """Linear map of residuals in a channel's unit to samples of variance 1.

    used : samples that count, shape (n,); the offset is taken out over these
    every : keep only each such sample (of coloured noise after it has been made white)
    """

    def __init__(self, measured: Measured, used: npt.NDArray[np.bool_], every: int = 1) -> None:
        self._measured, self._used, self._every = measured, used[::every], every
        white, (sigma, kept) = measured.white**2, measured.coloured
        drift = (1.0 - kept**2) * sigma**2
        # a^2 P V/(P + V) + drift = P:  P^2 + P (V (1 - a^2) - drift) - drift V = 0
        linear = white * (1.0 - kept**2) - drift
        ahead = 0.5 * (-linear + math.sqrt(linear**2 + 4.0 * drift * white))
        self._scale = 1.0 / math.sqrt(ahead + white)
        self._kept, self._left = kept, kept * (1.0 - ahead / (ahead + white))
        self._ones = self._filtered(np.ones(len(used)))
        self._constant = self._ones * self._used
        power = float(self._constant @ self._constant)
        variance = measured.offset**2
        known = 0.0 if variance == 0.0 or power == 0.0 else 1.0 if math.isinf(variance) else 1.0 - 1.0 / math.sqrt(1.0 + variance * power)
        self._pull = known / power if power > 0.0 else 0.0

    def _filtered(self, values: FloatArray) -> FloatArray:
        if self._measured.coloured[0] == 0.0:
            return np.asarray(values[:: self._every] * self._scale)
        return np.asarray(lfilter([self._scale, -self._scale * self._kept], [1.0, -self._left], values)[:: self._every])

    def __call__(self, residuals: FloatArray) -> FloatArray:
        """Whitened residuals of the kept samples; those that do not count are whitened too, with the same offset.

        The square root of the covariance's inverse with the offset b ~ N(0, s^2) integrated out:
        1 - (1 - 1/sqrt(1 + s^2 w.w)) w w^T/(w.w) with the whitened constant w.
        """
        white = self._filtered(residuals)
        if self._pull == 0.0:
            return white
        white -= (white @ self._constant) * self._pull * self._ones
        return white
