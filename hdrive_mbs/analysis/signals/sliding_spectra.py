"""Spectra of pieces of a record: the common part of spectrogram and waterfall."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hdrive_mbs.analysis.signals.plane_signal import PlaneSignal
from hdrive_mbs.analysis.signals.windows import Window
from hdrive_mbs.errors import AnalysisError, ParameterError
from hdrive_mbs.signals import FloatArray

MOST_VALUES = 40_000_000
"""Lines of all pieces together."""

PADDING = 4
"""Length of the transform over that of a piece."""


@dataclass(frozen=True, eq=False)
class SlidingSpectra:
    """Amplitudes 0-peak of each piece.

    lines : periods per unit of the axis (per second or per revolution), negative ones first where the signal is complex
    amplitude : shape (pieces, lines); the line at 0 holds the size of the mean
    """

    lines: FloatArray
    amplitude: FloatArray


def piece_samples(name: str, own: FloatArray, length: float, step: float | None, usual: float = 0.05) -> int:
    """Samples in a piece: as asked for, else as close as that quantile of the steps of the record."""
    if step is not None:
        if not step > 0.0:
            raise ParameterError(f"step = {step:g}: must be greater than 0.")
        count = round(length / step)
    else:
        spacing = float(np.quantile(np.abs(np.diff(own)), usual)) if len(own) > 1 else length
        count = int(np.ceil(length / spacing * (1.0 - 1e-9)))
    if count < 8:
        raise AnalysisError(f"{name}: {count} samples in a piece are too few for a spectrum; take longer pieces or a smaller step.")
    return count


def sliding_spectra(signal: PlaneSignal, times: FloatArray, span: float, window: Window, sense: float = 1.0) -> SlidingSpectra:
    """Spectra of pieces that are sampled evenly on an axis of length ``span`` each.

    times : s, shape (pieces, samples)
    sense : -1 mirrors x + i y, so that positive lines run in the sense of a shaft that turns about -z

    A sine of amplitude A shows A (one-sided); of  x + i y = p exp(i w t) + n exp(-i w t)  the line at +w shows |p| and
    the one at -w shows |n|.  The coherent gain of the window is taken out.  The pieces are padded with zeros to four
    times their length: lines lie four times as close as the resolution 1/span, so that a frequency between them reads
    at most 1 % low (Hann).  The weighted mean is taken off before and stands at line 0.
    """
    pieces, count = times.shape
    if times.size * PADDING > MOST_VALUES:
        raise AnalysisError(f"{pieces} pieces of {count} samples are too much; take fewer or shorter pieces, or a larger step.")
    values = signal.at(times.ravel()).reshape(times.shape)
    weights = window.values(count) / (count * window.coefficients[0])
    mean = values @ weights
    shaken = (values - mean[:, None]) * weights
    length = PADDING * count
    if signal.plane:
        amplitude = np.abs(np.fft.fft(shaken if sense > 0.0 else shaken.conj(), length, axis=1))
        amplitude[:, 0] = np.abs(mean)
        return SlidingSpectra(np.fft.fftshift(np.fft.fftfreq(length, span / count)), np.fft.fftshift(amplitude, axes=1))
    amplitude = 2.0 * np.abs(np.fft.rfft(np.asarray(shaken, float), length, axis=1))
    amplitude[:, 0] = np.abs(mean)
    return SlidingSpectra(np.fft.rfftfreq(length, span / count), amplitude)
