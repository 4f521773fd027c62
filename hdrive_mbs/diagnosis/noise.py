"""Residuals made white: every sample then counts with variance 1, and an unknown offset costs nothing.

White noise v of variance V beside first-order coloured noise c, c' = a c + w, var c = C: the best prediction
of the next sample has the steady error variance S = P + V with P = a^2 P V/(P + V) + (1 - a^2) C, and the
innovations e = y - c^, c^' = a (c^ + P/S e) are white.  At the first sample nothing is known of c but its variance C, which
is C - P more than the steady filter takes it for; that excess, a deviation that dies out as a^k, is one direction of all samples
that varies more than the others, and is shrunk accordingly.  Source: steady Kalman filter of ARMA(1, 1), e.g. Anderson, Moore,
Optimal Filtering, 4.4; its start: own derivation.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.measured import Measured

FloatArray = npt.NDArray[np.float64]


class Whitener:
    """Linear map of residuals in a channel's unit to samples of variance 1.

    used : samples that count, shape (n,); the offset is taken out over these
    every : keep only each such sample (of coloured noise after it has been made white)
    steady : the filter alone, the same at all samples, as if there had been samples before the first
    """

    def __init__(self, measured: Measured, used: npt.NDArray[np.bool_], every: int = 1, *, steady: bool = False) -> None:
        self._measured, self._used, self._every = measured, used[::every], every
        white, (sigma, kept) = measured.white**2, measured.coloured
        drift = (1.0 - kept**2) * sigma**2
        # a^2 P V/(P + V) + drift = P:  P^2 + P (V (1 - a^2) - drift) - drift V = 0
        linear = white * (1.0 - kept**2) - drift
        ahead = 0.5 * (-linear + math.sqrt(linear**2 + 4.0 * drift * white))
        self._scale = 1.0 / math.sqrt(ahead + white)
        self._kept, self._left = kept, kept * (1.0 - ahead / (ahead + white))
        self._start: _Spread | None = None
        if sigma > 0.0 and not steady:
            dying = np.power(kept, np.arange(len(used), dtype=float))
            self._start = _Spread(self._filtered(dying), self._used, sigma**2 - ahead)
        self._offset = _Spread(self._filtered(np.ones(len(used))), self._used, measured.offset**2)

    def _filtered(self, values: FloatArray) -> FloatArray:
        """Innovations of the kept samples over their standard deviation."""
        if self._measured.coloured[0] == 0.0:
            return np.asarray(values[:: self._every] * self._scale)
        from scipy.signal import lfilter  # takes as long to import as numpy and most of scipy

        white = np.asarray(lfilter([self._scale, -self._scale * self._kept], [1.0, -self._left], values)[:: self._every])
        return white if self._start is None else self._start.shrunk(white)

    def __call__(self, residuals: FloatArray) -> FloatArray:
        """Whitened residuals of the kept samples; those that do not count are whitened too, with the same offset."""
        return self._offset.shrunk(self._filtered(residuals))


class _Spread:
    """A direction w of white samples along which they vary by s^2 w.w more.

    The square root of the covariance's inverse: 1 - (1 - 1/sqrt(1 + s^2 w.w)) w w^T/(w.w).

    whole : w, shape (n,);  used : samples that count;  variance : s^2; inf where nothing is known of it
    """

    def __init__(self, whole: FloatArray, used: npt.NDArray[np.bool_], variance: float) -> None:
        self._whole, self._own = whole, whole * used
        power = float(self._own @ self._own)
        free = max(variance, 0.0) * power if power > 0.0 else 0.0
        self._pull = 0.0 if free == 0.0 else (1.0 - 1.0 / math.sqrt(1.0 + free)) / power

    def shrunk(self, white: FloatArray) -> FloatArray:
        """The samples with variance 1 along it too."""
        return white if self._pull == 0.0 else white - (white @ self._own) * self._pull * self._whole
