"""Time histories: measured and simulated signals share this one type."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import AnalysisError, ParameterError
from hdrive_mbs.summary import Summary

FloatArray = npt.NDArray[np.float64]

ROUNDING = 1e-9
"""Of the largest time: how far times may lie outside the span.  A million steps added up are off by 1e-10 at most."""


@dataclass(frozen=True, eq=False)
class TimeHistory:
    """Values of one quantity at increasing, not necessarily even times.

    name, unit : what it is, in which unit
    times : s, shape (n,), strictly increasing
    values : shape (n,)
    slope : time derivative at the same times, shape (n,), where it is known exactly; else None

    Raises ParameterError for arrays of different length or times that do not increase.
    """

    name: str
    unit: str
    times: FloatArray
    values: FloatArray
    slope: FloatArray | None = None

    def __post_init__(self) -> None:
        if self.times.ndim != 1 or self.times.shape != self.values.shape:
            raise ParameterError(f"{self.name}: times {self.times.shape} and values {self.values.shape} must be equally long and flat.")
        if len(self.times) > 1 and not np.all(np.diff(self.times) > 0.0):
            first = int(np.argmax(np.diff(self.times) <= 0.0))
            raise ParameterError(f"{self.name}: time must increase, but t[{first + 1}] = {self.times[first + 1]:g} s does not.")

    def __len__(self) -> int:
        return len(self.times)

    def __repr__(self) -> str:
        head = f"TimeHistory {self.name!r} [{self.unit}]: {len(self)} values"
        if not len(self):
            return head
        span = f"{self.times[0]:.6g} s to {self.times[-1]:.6g} s"
        return f"{head} from {span}, {np.min(self.values):.6g} to {np.max(self.values):.6g} {self.unit}"

    def at(self, times: npt.ArrayLike) -> FloatArray:
        """Values at other times by cubic Hermite interpolation.

        Uses the exact slope where there is one (error of order h^4), else monotone slopes
        (PCHIP, order h^2).  Raises AnalysisError outside the recorded span, by more than times that were added up are off.
        """
        from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

        wanted = np.asarray(times, float)
        slack = ROUNDING * max(abs(float(self.times[0])), abs(float(self.times[-1])))
        if wanted.size and (wanted.min() < self.times[0] - slack or wanted.max() > self.times[-1] + slack):
            raise AnalysisError(
                f"{self.name} is recorded from {self.times[0]:g} s to {self.times[-1]:g} s; "
                f"asked for {wanted.min():g} s to {wanted.max():g} s."
            )
        wanted = np.clip(wanted, self.times[0], self.times[-1])
        if len(self.times) == 1:
            return np.full(wanted.shape, self.values[0])
        if self.slope is not None:
            return np.asarray(CubicHermiteSpline(self.times, self.values, self.slope)(wanted), float)
        return np.asarray(PchipInterpolator(self.times, self.values)(wanted), float)

    def resampled(self, step: float) -> TimeHistory:
        """The history at even times, step [s] apart."""
        if not step > 0.0:
            raise ParameterError(f"{self.name}: step = {step:g} s must be greater than 0 s.")
        count = int(np.floor((self.times[-1] - self.times[0]) / step * (1.0 + 1e-12))) + 1
        even = np.minimum(self.times[0] + step * np.arange(count), self.times[-1])
        return TimeHistory(self.name, self.unit, even, self.at(even))

    def between(self, start: float, end: float) -> TimeHistory:
        """The part with start <= t <= end [s]."""
        inside = (self.times >= start) & (self.times <= end)
        if not inside.any():
            raise AnalysisError(f"{self.name} has no sample between {start:g} s and {end:g} s.")
        slope = None if self.slope is None else self.slope[inside]
        return TimeHistory(self.name, self.unit, self.times[inside], self.values[inside], slope)

    def summary(self) -> Summary:
        """Smallest, largest, time-weighted mean and rms, and last value, by name: min, max, mean, rms, final."""
        t, y = self.times, self.values
        span = float(t[-1] - t[0])
        mean = float(np.trapezoid(y, t) / span) if span > 0.0 else float(y[0])
        rms = float(np.sqrt(np.trapezoid(y * y, t) / span)) if span > 0.0 else abs(float(y[0]))
        return Summary(self.unit, {"min": float(y.min()), "max": float(y.max()), "mean": mean, "rms": rms, "final": float(y[-1])})
