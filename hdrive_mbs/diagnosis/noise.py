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
        self._key = measured.white, measured.coloured, measured.offset, used.tobytes()

    def _filtered(self, values: FloatArray) -> FloatArray:
        """Innovations of the kept samples over their standard deviation."""
        if self._measured.coloured[0] == 0.0:
            return np.asarray(values[:: self._every] * self._scale)
        from scipy.signal import lfilter  # takes as long to import as numpy and most of scipy

        white = np.asarray(lfilter([self._scale, -self._scale * self._kept], [1.0, -self._left], values)[:: self._every])
        return white if self._start is None else self._start.shrunk(white)

    def __call__(self, residuals: FloatArray, free: Free | None = None) -> FloatArray:
        """Whitened residuals of the kept samples; those that do not count are whitened too, with the same offset.

        free : courses of which the residuals hold nobody knows how much: they are taken out over the samples that count, and what is
            left counts for so much more as that takes degrees of freedom
        """
        white = self._offset.shrunk(self._filtered(residuals))
        return white if free is None else free.across(self._key, self, self._used).left(white)


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


ROUNDED = 1e-10
"""Square of a singular value, over the largest one, below which a course is one of the others."""
FADED = 1e-9
"""Share of their largest value below which courses have died out."""


class Free:
    """Courses of which residuals hold nobody knows how much.

    courses : shape (n, courses)
    """

    def __init__(self, courses: FloatArray) -> None:
        self._courses = courses
        self._known: dict[object, _Across] = {}

    def across(self, key: object, whiten: Whitener, used: npt.NDArray[np.bool_]) -> _Across:
        """What leaves them out of white samples: the same for columns of equal noise.

        key : what tells whiteners apart;  used : samples that count
        """
        if key not in self._known:
            self._known[key] = _Across(np.array([whiten(np.ascontiguousarray(course)) for course in self._courses.T]).T, used)
        return self._known[key]


class _Across:
    """What is left of samples across directions along which anything may lie.

    whole : shape (n, directions), white;  used : samples that count
    """

    def __init__(self, whole: FloatArray, used: npt.NDArray[np.bool_]) -> None:
        there = np.flatnonzero(np.max(np.abs(whole), axis=1, initial=0.0) > FADED * np.max(np.abs(whole), initial=0.0))
        self._rows = slice(int(there[0]), int(there[-1]) + 1) if len(there) else slice(0, 0)
        whole, self._used = whole[self._rows], used[self._rows]
        own = whole * self._used[:, None]
        squares, mix = np.linalg.eigh(own.T @ own)
        kept = squares > ROUNDED * squares[-1:]
        self._across = whole @ (mix[:, kept] / np.sqrt(squares[kept]))  # of length 1 and at right angles on the samples that count
        samples = int(np.count_nonzero(used))
        self._scale = math.sqrt(samples / max(samples - int(np.count_nonzero(kept)), 1))

    def left(self, white: FloatArray) -> FloatArray:
        """The samples without their part along these directions, with variance 1 on the average."""
        part = white[self._rows]
        found = self._scale * white
        found[self._rows] -= self._scale * (self._across @ (self._across.T @ (part * self._used)))
        return np.asarray(found)
