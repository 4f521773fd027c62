"""Even times for a record, without aliases."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from hdrive_mbs.errors import ParameterError, RecordError
from hdrive_mbs.signals import FloatArray

if TYPE_CHECKING:
    from hdrive_mbs.records.record import Record

PASS = 0.8
"""Upper end of the pass band, as a share of half the new sampling rate."""

ATTENUATION = 80.0
"""Of what lies above half the new sampling rate [dB]."""


def resampled(record: Record, step: float) -> Record:
    """The record at even times from its first one on, ``step`` [s] apart.

    A finer step interpolates (monotone cubic, PCHIP).  A coarser one first passes each channel through a
    zero-phase low-pass (windowed sine cardinal, Kaiser window): what lies below 0.8 of the new Nyquist
    frequency stays, what lies above it, and would come back as something slow, is weakened by 80 dB.
    Before the first and after the last sample the filter sees the record mirrored in its end point, so
    that half a filter length at either end is less certain; steps and held commands are rounded.
    White noise falls with the band, and the noise of each channel is set accordingly.

    Raises RecordError for times out of order or values that are not finite.
    """
    if not step > 0.0 or not np.isfinite(step):
        raise ParameterError(f"Record {record.name!r}: step = {step:g} s must be greater than 0 s.")
    record.in_order("resampling")
    for channel in record:
        if not np.all(np.isfinite(channel.values)):
            raise RecordError(f"Record {record.name!r}: {channel.name!r} holds values that are not finite; repair it before resampling.")
    if step > record.duration:
        raise ParameterError(f"Record {record.name!r}: step = {step:g} s is longer than the record ({record.duration:g} s).")
    times = even_times(record, step)
    old = record.step
    if step <= old * (1.0 + 1e-9):
        values = {channel.name: at(record.times, channel.values, times) for channel in record}
        gain = 1.0
        note = f"interpolated from {old:.6g} s to {step:.6g} s (monotone cubic)"
    else:
        taps = low_pass(old, step)
        fine = record.times[0] + old * np.arange(int(np.floor(record.duration / old * (1.0 + 1e-12))) + 1)
        inside = np.minimum(fine, record.times[-1])
        values = {
            channel.name: at(inside, filtered(at(record.times, channel.values, inside), taps), np.minimum(times, inside[-1]))
            for channel in record
        }
        gain = float(np.sqrt(taps @ taps))
        note = (
            f"resampled from {old:.6g} s to {step:.6g} s after a zero-phase low-pass: unchanged up to {PASS * 0.5 / step:.6g} Hz, "
            f"-{ATTENUATION:g} dB from {0.5 / step:.6g} Hz; {(len(taps) // 2) * old:.3g} s at either end are less certain"
        )
    channels = {
        channel.name: channel.replacing(values=values[channel.name], noise=None if channel.noise is None else channel.noise * gain)
        for channel in record
    }
    return record.replacing(times=times, channels=channels, notes=(*record.notes, note))


def even_times(record: Record, step: float) -> FloatArray:
    """From the first time on, ``step`` apart, not beyond the last one."""
    count = int(np.floor(record.duration / step * (1.0 + 1e-12))) + 1
    return np.asarray(np.minimum(record.times[0] + step * np.arange(count), record.times[-1]), float)


def at(times: FloatArray, values: FloatArray, wanted: FloatArray) -> FloatArray:
    """Values at other times inside the span; exact at the given ones."""
    if len(times) == len(wanted) and np.array_equal(times, wanted):
        return values
    from scipy.interpolate import PchipInterpolator

    return np.asarray(PchipInterpolator(times, values)(wanted), float)


def low_pass(old: float, new: float) -> FloatArray:
    """Taps of the filter for a coarser step; symmetric, of sum 1."""
    from scipy.signal import firwin, kaiserord

    ratio = old / new  # new Nyquist frequency over the old one
    count, beta = kaiserord(ATTENUATION, (1.0 - PASS) * ratio)
    return np.asarray(firwin(count | 1, 0.5 * (1.0 + PASS) * ratio, window=("kaiser", beta)), float)


def filtered(values: FloatArray, taps: FloatArray) -> FloatArray:
    """Zero-phase convolution; beyond its ends the signal is mirrored in the end point (odd), as often as needed."""
    from scipy.signal import oaconvolve

    half = len(taps) // 2
    padded = np.pad(values, half, mode="reflect", reflect_type="odd") if len(values) > 1 else np.pad(values, half, mode="edge")
    return np.asarray(oaconvolve(padded, taps, mode="valid"), float)
