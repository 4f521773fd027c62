"""Order spectrum: amplitudes per revolution of a shaft, also while its speed changes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from hdrive_mbs.analysis.result import Result
from hdrive_mbs.analysis.signals.plane_signal import turning_place
from hdrive_mbs.analysis.signals.shaft_angle import TURN, ShaftAngle, shaft_history
from hdrive_mbs.analysis.signals.source import Source
from hdrive_mbs.analysis.signals.spectrum import chosen_history, chosen_span, folding_note, sample_count, values_at
from hdrive_mbs.analysis.signals.windows import line_amplitudes, local_maxima, window_named
from hdrive_mbs.errors import AnalysisError
from hdrive_mbs.printed_table import PrintedTable
from hdrive_mbs.signals import FloatArray, TimeHistory


class OrderPeak(NamedTuple):
    """A line of an order spectrum: order and amplitude, 0-peak."""

    order: float
    amplitude: float


@dataclass(frozen=True, kw_only=True, eq=False)
class OrderSpectrum(Result):
    """One-sided amplitude spectrum over orders of a shaft; every amplitude is 0-peak.

    An order is a number of periods per revolution of the shaft ``against``.

    channel, unit : of the signal and of its amplitudes
    order : shape (m,), from 0
    amplitude : 0-peak, shape (m,); order 0 holds the size of the mean over the angle
    phase : of a cosine, at the start of the span [rad]
    mean : over the angle
    revolutions : of the shaft, over the span analysed
    start, end : the span analysed [s]
    slowest, fastest : speed of the shaft over the span [rad/s]
    """

    channel: str
    unit: str
    against: str
    order: FloatArray
    amplitude: FloatArray
    phase: FloatArray
    mean: float
    window: str
    revolutions: float
    start: float
    end: float
    samples: int
    slowest: float
    fastest: float

    @property
    def resolution(self) -> float:
        """Distance of two lines in orders: one over the number of revolutions."""
        return 1.0 / self.revolutions

    def peaks(self, count: int = 10, *, above: float = 0.01) -> tuple[OrderPeak, ...]:
        """The largest maxima, largest first, with order and amplitude interpolated between lines.

        above : smallest amplitude that counts, as a share of the largest
        """
        found = local_maxima(self.amplitude, window_named(self.window), count, above)
        return tuple(OrderPeak(position * self.resolution, height) for position, height in found)

    def tables(self) -> tuple[PrintedTable, ...]:
        """The largest orders."""
        rows = tuple((peak.order, peak.amplitude) for peak in self.peaks())
        notes = (
            f"mean {self.mean:.6g} {self.unit}; {self.revolutions:.4g} revolutions from {self.start:g} to {self.end:g} s at "
            f"{self.slowest:.4g} to {self.fastest:.4g} rad/s, lines {self.resolution:.4g} orders apart, {self.window}",
        )
        heads = (f"order of {self.against}", f"amplitude 0-peak [{self.unit}]")
        return (PrintedTable(title=f"largest orders of {self.channel}", heads=heads, rows=rows, notes=notes),)

    def columns(self) -> dict[str, np.ndarray]:
        return {
            f"order of {self.against} [1]": self.order,
            f"{self.channel} amplitude 0-peak [{self.unit}]": self.amplitude,
            "phase [rad]": self.phase,
        }


def order_spectrum(
    source: Source,
    channel: str | None = None,
    *,
    against: str | TimeHistory | None = None,
    window: str = "hann",
    start: float | None = None,
    end: float | None = None,
    samples_per_revolution: float | None = None,
    whole_revolutions: bool = True,
) -> OrderSpectrum:
    """Amplitude spectrum (0-peak) over orders of a shaft: the signal is sampled evenly in its angle.

    against : angle of the shaft, by channel ("motor.angle") or place ("motor"), or a time history [rad]; if not given,
        the motor, else the reference shaft of a rotor line
    start, end : part of the record to analyse [s]; all of it if not given
    samples_per_revolution : if not given, from the shortest usual step of the record
    whole_revolutions : end the span at the last whole revolution, so that whole orders fall on lines

    A line of constant order is sharp however the speed changes; the amplitude shown is its mean over
    the revolutions.  Something of constant frequency is smeared instead.  Interpolation as in ``spectrum``.  Raises AnalysisError when
    the angle does not run in one direction over the span, or by less than one revolution.
    """
    history, scene = chosen_history(source, channel)
    if against is None:
        has_motor = isinstance(source, TimeHistory) or "motor.angle" in source
        against = "motor.angle" if has_motor else turning_place(source, history.name, None)
    shaft = shaft_history(source, against)
    shape = window_named(window)
    begin, finish = chosen_span(history, start, end)
    begin, finish = chosen_span(shaft, begin, finish)
    turning = ShaftAngle.over(shaft, begin, finish)
    turns = turning.turns
    if turns < 1.0 - 1e-9:
        raise AnalysisError(
            f"{shaft.name} turns by only {turns:.3g} revolutions from {begin:g} s to {finish:g} s; an order spectrum needs at least 1. "
            "Take a longer run, or a shaft that turns faster."
        )
    if whole_revolutions:
        turns = float(np.floor(turns * (1.0 + 1e-9)))
    span = TURN * turns
    step = None if samples_per_revolution is None else TURN / samples_per_revolution
    count = sample_count(history.name, turning.angles, span, step, "rad")
    wanted = turning.angles[0] + turning.direction * span / count * np.arange(count + 1)
    at = turning.times_of(wanted)
    values = values_at(source, history, at[:-1])
    amplitude, phase = line_amplitudes(values, shape)
    last = float(at[-1])
    covered = np.abs(turning.speeds[turning.times <= last])
    return OrderSpectrum(
        scene=scene,
        status=folding_note(amplitude, f"order {0.5 * count / turns:.4g}", "give more samples_per_revolution"),
        settings={"window": window, "against": shaft.name, "start": begin, "end": last, "whole_revolutions": whole_revolutions},
        channel=history.name,
        unit=history.unit,
        against=shaft.name.removesuffix(".angle"),
        order=np.arange(len(amplitude)) / turns,
        amplitude=amplitude,
        phase=phase,
        mean=float(np.mean(values)),
        window=window,
        revolutions=turns,
        start=begin,
        end=last,
        samples=count,
        slowest=float(covered.min()),
        fastest=float(covered.max()),
    )
