"""Amplitude spectrum of a signal over frequency."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from hdrive_mbs.analysis.result import Result
from hdrive_mbs.analysis.signals.source import MeasuredChannels, Source, readable
from hdrive_mbs.analysis.signals.windows import line_amplitudes, local_maxima, window_named
from hdrive_mbs.analysis.time_response import Response
from hdrive_mbs.errors import AnalysisError, ParameterError
from hdrive_mbs.printed_table import PrintedTable
from hdrive_mbs.scene import Scene
from hdrive_mbs.signals import FloatArray, TimeHistory

ROUNDING = 1e-9
"""Of a record's length: a solver that adds up its steps ends this far from where it was told to, at most."""
MOST_SAMPLES = 2**20
"""Limit of the automatic number of samples."""


class FrequencyPeak(NamedTuple):
    """A line of a spectrum: frequency [rad/s] and amplitude, 0-peak."""

    frequency: float
    amplitude: float


@dataclass(frozen=True, kw_only=True, eq=False)
class Spectrum(Result):
    """One-sided amplitude spectrum; every amplitude is 0-peak.

    channel, unit : of the signal and of its amplitudes
    frequency : rad/s, shape (m,), from 0 to half the sampling frequency; ``hertz`` is the same in Hz
    amplitude : 0-peak, shape (m,); the line at 0 rad/s holds the size of the mean
    phase : of a cosine, at the start of the span [rad]
    mean : of the signal
    window : name of the window; its coherent gain is taken out
    start, end : the span analysed [s]
    samples : number of evenly spaced samples
    """

    channel: str
    unit: str
    frequency: FloatArray
    amplitude: FloatArray
    phase: FloatArray
    mean: float
    window: str
    start: float
    end: float
    samples: int

    @property
    def hertz(self) -> FloatArray:
        """The lines in Hz."""
        return self.frequency / (2.0 * np.pi)

    @property
    def resolution(self) -> float:
        """Distance of two lines [rad/s]: 2 pi over the span."""
        return 2.0 * np.pi / (self.end - self.start)

    def peaks(self, count: int = 10, *, above: float = 0.01) -> tuple[FrequencyPeak, ...]:
        """The largest maxima, largest first, with frequency and amplitude interpolated between lines.

        above : smallest amplitude that counts, as a share of the largest
        """
        found = local_maxima(self.amplitude, window_named(self.window), count, above)
        return tuple(FrequencyPeak(position * self.resolution, height) for position, height in found)

    def tables(self) -> tuple[PrintedTable, ...]:
        """The largest lines."""
        rows = tuple((peak.frequency, peak.frequency / (2.0 * np.pi), peak.amplitude) for peak in self.peaks())
        span = f"{self.start:g} to {self.end:g} s, lines {self.resolution:.4g} rad/s apart, {self.window}"
        notes = (f"mean {self.mean:.6g} {self.unit}; {span}",)
        heads = ("frequency [rad/s]", "frequency [Hz]", f"amplitude 0-peak [{self.unit}]")
        return (PrintedTable(title=f"largest lines of {self.channel}", heads=heads, rows=rows, notes=notes),)

    def columns(self) -> dict[str, np.ndarray]:
        return {
            "frequency [rad/s]": self.frequency,
            "frequency [Hz]": self.hertz,
            f"{self.channel} amplitude 0-peak [{self.unit}]": self.amplitude,
            "phase [rad]": self.phase,
        }


def spectrum(
    source: Source,
    channel: str | None = None,
    *,
    window: str = "hann",
    start: float | None = None,
    end: float | None = None,
    step: float | None = None,
) -> Spectrum:
    """Amplitude spectrum (0-peak) of a channel of a response or of a record, or of a time history.

    window : "hann", "rectangular", "hamming", "blackman" or "flat_top"
    start, end : part of the record to analyse [s]; all of it if not given
    step : sampling step [s]; if not given, that of an evenly sampled record, else half the
        shortest usual step of the solver

    The signal of a response is put on even times by ``Response.at``: Hermite interpolation of angles,
    speeds and states (order 4), the laws for torques.  A single time history without slope (a measured
    one) reads low where a period has few samples: 4 % at five.  A sine whose frequency falls on a line shows its
    amplitude exactly; between two lines the Hann window shows up to 15 % less, which ``peaks``
    corrects.  A part that grows or changes frequency during the span shows its average only (see
    ``order_spectrum`` for a run-up).  Raises AnalysisError for a span of less than 4 samples.
    """
    history, scene = chosen_history(source, channel)
    shape = window_named(window)
    begin, finish = chosen_span(history, start, end)
    count = sample_count(history.name, history.between(begin, finish).times, finish - begin, step)
    spacing = (finish - begin) / count
    values = values_at(source, history, begin + spacing * np.arange(count, dtype=float))
    amplitude, phase = line_amplitudes(values, shape)
    return Spectrum(
        scene=scene,
        status=folding_note(amplitude, f"{np.pi / spacing:.4g} rad/s", "give a smaller step"),
        settings={"window": window, "start": begin, "end": finish, "step": spacing},
        channel=history.name,
        unit=history.unit,
        frequency=(2.0 * np.pi / (finish - begin)) * np.arange(len(amplitude), dtype=np.float64),
        amplitude=amplitude,
        phase=phase,
        mean=float(np.mean(values)),
        window=window,
        start=begin,
        end=finish,
        samples=count,
    )


def chosen_history(given: Source | MeasuredChannels, channel: str | None) -> tuple[TimeHistory, Scene | None]:
    """The time history meant, and the scene it comes from."""
    source = readable(given)
    if isinstance(source, TimeHistory):
        if channel is not None and channel != source.name:
            raise ParameterError(f"The time history is {source.name!r}, not {channel!r}; leave the channel out.")
        return source, None
    if channel is None:
        what = "record" if isinstance(source, MeasuredChannels) else "response"
        raise ParameterError(f"Name the channel to analyse. The {what} has: {', '.join(source.channels)}.")
    return source[channel], source.scene


def values_at(source: Source | MeasuredChannels, history: TimeHistory, times: FloatArray) -> FloatArray:
    """The history at even times; of a response by its laws at the interpolated state."""
    return source.at(history.name, times) if isinstance(source, Response) else history.at(times)


def chosen_span(history: TimeHistory, start: float | None, end: float | None) -> tuple[float, float]:
    """Start and end of the part to analyse [s], checked against the record."""
    first, last = float(history.times[0]), float(history.times[-1])
    begin = first if start is None else float(start)
    finish = last if end is None else float(end)
    rounding = ROUNDING * (last - first)
    if not first - rounding <= begin < finish <= last + rounding:
        raise AnalysisError(
            f"{history.name} is recorded from {first:g} s to {last:g} s; cannot analyse it from {begin:g} s to {finish:g} s."
        )
    return max(begin, first), min(finish, last)


def sample_count(name: str, positions: FloatArray, span: float, step: float | None, what: str = "s") -> int:
    """Number of even samples over a span: as asked for, as recorded, or by the recorder's short steps."""
    if step is not None:
        if not step > 0.0:
            raise ParameterError(f"step = {step:g} {what} must be greater than 0 {what}.")
        count = round(span / step)
    else:
        steps = np.abs(np.diff(positions))
        if len(steps) and np.ptp(steps) <= 1e-6 * np.mean(steps):
            count = round(span / float(np.mean(steps)))
        elif len(steps):
            usual = float(np.quantile(steps, 0.05))
            count = 2 ** int(np.ceil(np.log2(min(max(2.0 * span / usual, 256.0), MOST_SAMPLES))))
        else:
            count = 0
    if count < 4:
        raise AnalysisError(
            f"{name}: {count} samples between start and end are too few for a spectrum; take a longer span or a smaller step."
        )
    return count


def folding_note(amplitude: FloatArray, limit: str, advice: str) -> str:
    """Status: whether the signal still has content where the lines end, and so perhaps beyond."""
    tail = amplitude[int(0.9 * len(amplitude)) :]
    largest = float(np.max(amplitude[1:]))
    if float(np.max(tail)) > 0.01 * largest > 0.0:
        return f"complete; amplitudes do not fade towards the upper limit {limit}, and what lies beyond is folded back: {advice}"
    return "complete"
