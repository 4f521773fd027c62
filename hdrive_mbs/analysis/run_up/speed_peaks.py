"""Peaks of an amplitude over the speed of a run: the largest, and one at each critical speed."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicHermiteSpline

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

PROMINENCE = 0.1
"""Smallest prominence of a peak, as a share of its own height."""

LOWEST = 0.01
"""Smallest height of a peak, as a share of the largest."""

WIDTH = 1.25
"""Peaks closer than this many times sqrt(2 pi/a) are one: the time in which the angle and a^2/2 part by half a turn and more."""

POINTS = 64
"""Points between two samples at which the interpolated motion is searched."""


class SpeedPeak(NamedTuple):
    """A local maximum over a run.

    speed : of the rotor at that time, true sense [rad/s]
    amplitude : 0-peak [m]
    time : s
    prominence : how far the envelope falls on the lower side before a larger peak comes [m]
    critical : the critical speed [rad/s, of the reference shaft] that was passed last before it, NaN for none
    """

    speed: float
    amplitude: float
    time: float
    prominence: float
    critical: float


class Whirl:
    """Distance |z - z0| of a point from a place z0 (fixed or slowly moving), refined between samples.

    times : s;  places, rates : x + i y [m] and its derivative [m/s], relative to z0
    """

    def __init__(self, times: FloatArray, places: ComplexArray, rates: ComplexArray) -> None:
        self.times, self.places, self.rates = times, places, rates
        self.distance = np.abs(places)

    def maximum(self, first: int = 0, last: int | None = None) -> tuple[float, float]:
        """Time [s] and largest distance [m] near the samples first .. last - 1, with the motion as cubic Hermite curve."""
        k = first + int(np.argmax(self.distance[first:last]))
        low, high = max(k - 1, 0), min(k + 1, len(self.times) - 1)
        if low == high:
            return float(self.times[k]), float(self.distance[k])
        curve = CubicHermiteSpline(self.times[low : high + 1], self.places[low : high + 1], self.rates[low : high + 1])
        t = np.linspace(self.times[low], self.times[high], 2 * POINTS + 1)
        size = np.abs(curve(t))
        m = int(np.argmax(size))
        if not 0 < m < len(t) - 1:
            return float(t[m]), float(size[m])
        left, top, right = size[m - 1 : m + 2]
        bend = left - 2.0 * top + right
        shift = 0.5 * (left - right) / bend if bend < 0.0 else 0.0
        return float(t[m] + shift * (t[1] - t[0])), float(top - 0.25 * (left - right) * shift)


def speed_peaks(
    whirl: Whirl, angle: FloatArray, reference: FloatArray, criticals: FloatArray, speed_at: Callable[[float], float]
) -> tuple[SpeedPeak, ...]:
    """Peaks of the envelope in the order of time; the ends of the run are none.

    angle : of the rotor at the samples [rad];  speed_at : its speed at any time [rad/s]
    reference, criticals : speed of the reference shaft at the samples, critical speeds of it [rad/s]

    The envelope is the largest distance of each half revolution, then of each span of 1.25 sqrt(2 pi/a), a the mean
    angular acceleration of the run.  Two critical speeds that are passed within such a span cannot be told apart, and
    the beats after a critical speed, of free whirl against the forced one, are shorter (the first takes 0.8 sqrt(2 pi/a)).
    """
    from scipy.signal import find_peaks  # takes as long to import as numpy and most of scipy

    half_turns = np.floor(np.abs(angle - angle[0]) / math.pi).astype(int)
    starts = np.concatenate([[0], np.nonzero(np.diff(half_turns))[0] + 1])
    if len(starts) < 5:
        return ()
    tops = np.maximum.reduceat(whirl.distance, starts)
    times = whirl.times[starts]
    envelope = _largest_within(times, tops, 0.5 * WIDTH * _fresnel_time(whirl.times, reference))
    floor = LOWEST * float(envelope.max())
    found, shape = find_peaks(envelope, height=floor, prominence=floor, plateau_size=1)
    ends = np.append(starts, len(whirl.times))
    peaks = []
    for k, prominence, left, right in zip(found, shape["prominences"], shape["left_edges"], shape["right_edges"], strict=True):
        height = float(envelope[k])
        if prominence < PROMINENCE * height:
            continue
        inside = np.nonzero(tops[left : right + 1] == height)[0]
        at = int(left + inside[0]) if len(inside) else int(k)
        time, amplitude = whirl.maximum(int(ends[at]), int(ends[at + 1]))
        sample = int(np.searchsorted(whirl.times, time))
        peaks.append(SpeedPeak(speed_at(time), amplitude, time, float(prominence), _passed(criticals, reference, sample)))
    return tuple(peaks)


def _fresnel_time(times: FloatArray, speed: FloatArray) -> float:
    """sqrt(2 pi/a) with the mean acceleration between the slowest and the fastest moment; a tenth of the run at most."""
    low, high = int(np.argmin(np.abs(speed))), int(np.argmax(np.abs(speed)))
    longest = 0.1 * float(times[-1] - times[0])
    change, span = abs(abs(speed[high]) - abs(speed[low])), abs(float(times[high] - times[low]))
    return min(math.sqrt(2.0 * math.pi * span / change), longest) if change > 0.0 and span > 0.0 else longest


def _largest_within(times: FloatArray, values: FloatArray, reach: float) -> FloatArray:
    """Largest value no further than ``reach`` [s] away, by doubling: maxima of 2^j neighbours joined two at a time."""
    first = np.searchsorted(times, times - reach, side="left")
    last = np.searchsorted(times, times + reach, side="right")
    result = np.empty_like(values)
    levels = [values]
    while 2 ** len(levels) <= int(np.max(last - first)):
        half = 2 ** (len(levels) - 1)
        levels.append(np.maximum(levels[-1][:-half], levels[-1][half:]))
    level = np.floor(np.log2(last - first)).astype(int)
    for j in np.unique(level):
        at = level == j
        result[at] = np.maximum(levels[j][first[at]], levels[j][last[at] - 2**j])
    return result


def _passed(criticals: FloatArray, reference: FloatArray, sample: int) -> float:
    """The critical speed that the reference shaft crossed last before a sample."""
    best, when = math.nan, -1
    size = np.abs(reference[: sample + 1])
    for critical in criticals:
        crossings = np.nonzero((size[1:] >= critical) != (size[:-1] >= critical))[0]
        if len(crossings) and crossings[-1] > when:
            best, when = float(critical), int(crossings[-1])
    return best
