"""Two clocks of one run: their offset and drift, from a channel that both records have."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from hdrive_mbs.errors import AnalysisError, ParameterError
from hdrive_mbs.records.finding import Finding
from hdrive_mbs.signals import FloatArray

if TYPE_CHECKING:
    from hdrive_mbs.records.record import Record

LIKE = 0.9
"""Correlation of the two channels, after matching, below which they are not the same signal."""

STRETCHES = 8
"""Parts of the record in which the offset is followed for a first guess of the drift."""

MOST_SAMPLES = 200_000


@dataclass(frozen=True, kw_only=True)
class ClockMatch:
    """time of the reference = time of the other + offset + drift * (time of the other - middle).

    offset : s, at ``middle``; positive when the other clock is behind
    drift : s per s
    offset_error, drift_error : one standard deviation, for noise that is white
    correlation : of the two channels after matching
    """

    channel: str
    offset: float
    drift: float
    offset_error: float
    drift_error: float
    middle: float
    correlation: float

    def to_reference(self, times: FloatArray) -> FloatArray:
        """Times of the other clock as the reference clock would show them."""
        return times + self.offset + self.drift * (times - self.middle)

    def __str__(self) -> str:
        return (
            f"by {self.channel}: offset {self.offset:.6g} s (+- {self.offset_error:.2g} s) at {self.middle:.6g} s, "
            f"drift {1e6 * self.drift:.4g} us/s (+- {1e6 * self.drift_error:.2g} us/s), correlation {self.correlation:.4f}"
        )


def clock_match(
    reference: Record, other: Record, channel: str, other_channel: str | None = None, *, largest_offset: float | None = None
) -> ClockMatch:
    """Offset and drift between the clocks of two records that measured one quantity.

    channel, other_channel : its name in each of them (the same if only one is given)
    largest_offset : s; half the shorter record if not given

    Increments of both channels are cross-correlated for the offset to one sample, in eight stretches for
    a first drift; then offset, drift, scale and bias that make ``reference`` fit ``other`` are found by
    least squares (Gauss-Newton on a smoothing cubic), which resolves a fraction of a sample.  The clocks
    are taken to run evenly: jumps or a changing drift are not followed, and show in the correlation.
    Raises AnalysisError when the two are not alike (correlation under 0.9) or do not move.
    """
    other_channel = other_channel or channel
    one, two = reference[channel], other[other_channel]
    if one.unit != two.unit:
        raise ParameterError(f"{one.name!r} is in {one.unit} and {two.name!r} in {two.unit}; clocks are compared by one quantity.")
    x, y = reference.history(channel), other.history(other_channel)
    # times count from the start of each record: an angle that grows or a clock since 1970 costs no digits
    step = max(reference.step, other.step)
    if largest_offset is None:
        largest_offset = 0.5 * min(reference.duration, other.duration) + abs(float(x.times[0] - y.times[0]))
    even = _even(x.times, x.values, step), _even(y.times, y.values, step)
    lag = _lag(np.diff(even[0]), np.diff(even[1]), step, float(y.times[0] - x.times[0]), largest_offset)
    if lag is None:
        raise AnalysisError(
            f"{one.name!r} of {reference.name!r} and {two.name!r} of {other.name!r} do not move together; clocks need a channel that moves."
        )
    middle, offset, drift = _first_guess(x.times, x.values, y.times, y.values, step, lag)
    match = _refined(x.times, x.values, y.times, y.values, middle, offset, drift, channel)
    if match.correlation < LIKE:
        raise AnalysisError(
            f"{one.name!r} of {reference.name!r} and {two.name!r} of {other.name!r} are not alike "
            f"(correlation {match.correlation:.3f}, needed {LIKE:g}); name a channel that both measure."
        )
    return match


def aligned(record: Record, match: ClockMatch) -> Record:
    """The record with the times of the reference clock; listed among its repairs."""
    finding = Finding(kind="clock", channel="", where="", repaired=True, text=f"times corrected to the reference clock {match}")
    return record.replacing(times=match.to_reference(record.times), repairs=(*record.repairs, finding), origin=record.origin)


def clock_finding(reference: Record, other: Record) -> Finding | None:
    """A finding when the clocks of two sensor sets of a run differ by what a common channel can show; else None."""
    pairs = [
        (mine.name, theirs.name)
        for mine in reference
        for theirs in other
        if mine.unit == theirs.unit and (mine.name == theirs.name or (mine.quantity is not None and mine.quantity == theirs.quantity))
    ]
    for mine_name, other_name in pairs:
        try:
            match = clock_match(reference, other, mine_name, other_name, largest_offset=0.1 * min(reference.duration, other.duration))
        except (AnalysisError, ValueError):  # a record out of order has findings of its own
            continue
        ends = match.to_reference(other.times[[0, -1]]) - other.times[[0, -1]]
        worst = float(np.max(np.abs(ends)))
        error = match.offset_error + match.drift_error * 0.5 * other.duration
        if worst > max(5.0 * error, 0.1 * min(reference.step, other.step)):
            return Finding(
                kind="clock",
                channel=other_name,
                where="",
                blocks=True,
                text=(
                    f"its clock differs from that of {reference.name!r} by {ends[0]:.4g} s at the start "
                    f"and {ends[1]:.4g} s at the end ({match}); "
                    f"aligned(record, clock_match(reference, record, {mine_name!r}, {other_name!r})) corrects its times"
                ),
            )
        return None
    return None


def _even(times: FloatArray, values: FloatArray, step: float) -> FloatArray:
    count = min(int((times[-1] - times[0]) / step) + 1, MOST_SAMPLES)
    return np.asarray(np.interp(times[0] + step * np.arange(count), times, values), float)


def _lag(one: FloatArray, two: FloatArray, step: float, start_apart: float, largest: float) -> float | None:
    """What has to be added to the times of ``two`` so that it fits ``one``, to one step; None if nothing moves."""
    if len(one) < 8 or len(two) < 8 or np.ptp(one) == 0.0 or np.ptp(two) == 0.0:
        return None
    from scipy.signal import correlate, correlation_lags

    # increments without their mean: of a constant speed nothing is left that could be matched
    product = np.abs(correlate(one - one.mean(), two - two.mean(), method="fft"))
    lags = correlation_lags(len(one), len(two)) * step - start_apart
    allowed = np.abs(lags) <= largest + step
    return float(lags[allowed][int(np.argmax(product[allowed]))]) if allowed.any() else None


def _first_guess(
    x_times: FloatArray, x: FloatArray, y_times: FloatArray, y: FloatArray, step: float, lag: float
) -> tuple[float, float, float]:
    """Middle, offset there and drift: offsets of stretches of the other record, joined by the median of their slopes."""
    start, end = max(x_times[0], y_times[0] + lag), min(x_times[-1], y_times[-1] + lag)
    middle = 0.5 * float(start + end) - lag
    edges = np.linspace(start - lag, end - lag, STRETCHES + 1)
    wide = max(8.0 * step, 2e-3 * (end - start))
    centres, offsets = [], []
    for first, last in itertools.pairwise(edges):
        here = (y_times >= first) & (y_times <= last)
        there = (x_times >= first + lag - wide) & (x_times <= last + lag + wide)
        if here.sum() < 16 or there.sum() < 16:
            continue
        piece = _even(y_times[here], y[here], step)
        around = _even(x_times[there], x[there], step)
        found = _lag(np.diff(around), np.diff(piece), step, float(y_times[here][0] - x_times[there][0]), abs(lag) + wide)
        if found is not None and abs(found - lag) <= wide:
            centres.append(0.5 * float(first + last))
            offsets.append(found)
    if len(centres) < 3:
        return middle, lag, 0.0
    slopes = [(offsets[j] - offsets[i]) / (centres[j] - centres[i]) for i in range(len(centres)) for j in range(i + 1, len(centres))]
    drift = float(np.median(slopes))
    return middle, float(np.median([offset - drift * (centre - middle) for centre, offset in zip(centres, offsets, strict=True)])), drift


def _smooth(times: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray, float]:
    """Even times, values smoothed just enough that noise does not outweigh the slope of the signal, and that noise.

    A cubic is fitted over as many samples as the signal needs to move by five times the noise (Savitzky and
    Golay).  The standard deviation of white noise is that of the second differences over sqrt(6).
    """
    from scipy.signal import savgol_filter

    step = float(np.median(np.diff(times)))
    even = times[0] + step * np.arange(int((times[-1] - times[0]) / step) + 1)
    samples = np.interp(even, times, values)
    noise = float(np.std(np.diff(samples, 2))) / np.sqrt(6.0)
    length = 1
    while length < len(samples) // 10 and np.mean((samples[length:] - samples[:-length]) ** 2) < 52.0 * noise**2:
        length *= 2
    if length < 4:
        return even, samples, 0.0
    smoothed = np.asarray(savgol_filter(samples, 2 * length + 1, 3), float)
    return even, smoothed, float(np.std(samples - smoothed))


def _refined(
    x_times: FloatArray, x: FloatArray, y_times: FloatArray, y: FloatArray, middle: float, offset: float, drift: float, channel: str
) -> ClockMatch:
    """Least squares in offset, drift, scale and bias: other(t) = scale * reference(t + offset + drift (t - middle)) + bias."""
    from scipy.interpolate import CubicSpline

    even, smoothed, noise = _smooth(x_times, x)
    spline = CubicSpline(even, smoothed)
    slope = spline.derivative()
    errors = (float("inf"), float("inf"))
    correlation, scale = 0.0, 1.0
    for _ in range(30):
        shifted = y_times + offset + drift * (y_times - middle)
        inside = (shifted >= even[0]) & (shifted <= even[-1])
        if inside.sum() < 16:
            break
        t, measured = y_times[inside] - middle, y[inside]
        rate = scale * slope(shifted[inside])
        design = np.column_stack((rate, rate * t, spline(shifted[inside]), np.ones(len(t))))
        sizes = np.linalg.norm(design, axis=0)
        if not np.all(sizes > 0.0):
            break
        solution = np.linalg.lstsq(design / sizes, measured, rcond=1e-12)[0] / sizes
        rest = measured - design @ solution
        power = float(rest @ rest) / max(len(rest) - 4, 1)
        # noise of the reference acts like noise of the other, with the density of its samples
        shared = (
            1.0 + (solution[2] * noise) ** 2 * float(np.median(np.diff(x_times))) / (power * float(np.median(np.diff(y_times))))
            if power
            else 1.0
        )
        covariance = np.linalg.pinv((design / sizes).T @ (design / sizes)) * power * shared
        offset, drift, scale = offset + float(solution[0]), drift + float(solution[1]), float(solution[2])
        errors = (float(np.sqrt(covariance[0, 0])) / sizes[0], float(np.sqrt(covariance[1, 1])) / sizes[1])
        total = measured - measured.mean()
        correlation = float(np.sqrt(max(0.0, 1.0 - float(rest @ rest) / float(total @ total)))) if np.any(total) else 0.0
        if abs(solution[0]) < 0.01 * errors[0] and abs(solution[1]) < 0.01 * errors[1]:
            break
    return ClockMatch(
        channel=channel, offset=offset, drift=drift, offset_error=errors[0], drift_error=errors[1], middle=middle, correlation=correlation
    )
