"""Waterfall: amplitude spectra over the speed of a shaft during a run-up or coast-down."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.analysis.result import Result
from hdrive_mbs.analysis.signals.plane_signal import PlaneSignal, turning_place
from hdrive_mbs.analysis.signals.shaft_angle import TURN, ShaftAngle, shaft_history, turning_span
from hdrive_mbs.analysis.signals.sliding_spectra import piece_samples, sliding_spectra
from hdrive_mbs.analysis.signals.source import Source
from hdrive_mbs.analysis.signals.spectrum import chosen_span
from hdrive_mbs.analysis.signals.windows import Window, window_named
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.printed_table import PrintedTable, thinned
from hdrive_mbs.signals import FloatArray, TimeHistory

SMEARED = 0.02
"""Loss of order 1 by the change of speed within a piece above which the status says so."""

AXES = ("frequency", "order")


@dataclass(frozen=True, kw_only=True, eq=False)
class Waterfall(Result):
    """Spectra over speed; every amplitude is 0-peak.

    channel, unit : of the signal and of its amplitudes
    reference : shaft whose speed is meant
    axis : "frequency" (lines in rad/s) or "order" (periods per revolution of the reference)
    two_sided : whether the signal is x + i y of a place: positive lines run in the sense of the spin (forward)
    speeds, times : mean speed [rad/s, size] and middle [s] of each piece, shape (p,), speeds ascending
    lines : shape (m,), four for each ``resolution``
    amplitude : shape (p, m); the line at 0 holds the size of the mean
    kept : what the change of speed within each piece leaves of a line of order 1, shape (p,); 1 on an axis of orders
    window : name;  length : of a piece [s, or revolutions on an axis of orders]
    """

    channel: str
    unit: str
    reference: str
    axis: str
    two_sided: bool
    speeds: FloatArray
    times: FloatArray
    lines: FloatArray
    amplitude: FloatArray
    kept: FloatArray
    window: str
    length: float

    @property
    def resolution(self) -> float:
        """Distance at which two lines begin to be told apart [rad/s or orders]; the lines given lie four times as close."""
        return (TURN if self.axis == "frequency" else 1.0) / self.length

    def order_line(self, order: float) -> FloatArray:
        """Where an order lies on the axis of lines at each speed."""
        return order * self.speeds if self.axis == "frequency" else np.full(len(self.speeds), order)

    def along(self, order: float, *, width: float = 1.0) -> FloatArray:
        """Largest amplitude within ``width`` times the resolution of an order, at each speed; negative orders are backward whirl."""
        near = np.abs(self.lines - self.order_line(order)[:, None]) <= width * self.resolution
        return np.asarray(np.max(np.where(near, self.amplitude, 0.0), axis=1))

    def tables(self) -> tuple[PrintedTable, ...]:
        """The largest line at each speed."""
        at = np.argmax(self.amplitude, axis=1)
        unit, piece = ("rad/s", f"{self.length:.4g} s") if self.axis == "frequency" else ("orders", f"{self.length:.4g} revolutions")
        columns = {
            f"speed of {self.reference} [rad/s]": self.speeds,
            "time [s]": self.times,
            f"largest line at [{unit}]": self.lines[at],
            f"amplitude 0-peak [{self.unit}]": self.amplitude[np.arange(len(at)), at],
        }
        return (thinned(columns, title=f"waterfall of {self.channel}, pieces of {piece}, {self.window}"),)

    def columns(self) -> dict[str, np.ndarray]:
        pieces, lines = self.amplitude.shape
        return {
            "speed [rad/s]": np.repeat(self.speeds, lines),
            "time [s]": np.repeat(self.times, lines),
            "frequency [rad/s]" if self.axis == "frequency" else "order [1]": np.tile(self.lines, pieces),
            f"{self.channel} amplitude 0-peak [{self.unit}]": self.amplitude.ravel(),
        }


def waterfall(
    source: Source,
    channel: str | tuple[str, str] | None = None,
    *,
    reference: str | TimeHistory | None = None,
    axis: str = "frequency",
    pieces: int = 40,
    length: float | None = None,
    window: str = "hann",
    start: float | None = None,
    end: float | None = None,
    step: float | None = None,
) -> Waterfall:
    """Amplitude spectra (0-peak) at evenly spaced speeds of a run.

    channel : a channel, or a place with x and y (or two channels) for the full spectrum: forward whirl at positive, backward whirl at
        negative lines
    reference : shaft whose speed is meant, by place, channel of its angle or history [rad]; the place of the channel
        if it turns, else the reference shaft
    axis : "frequency": pieces of equal time, where natural frequencies stand still and orders move; "order": pieces of
        equal revolutions sampled in the angle, where orders stand still and lose nothing to the change of speed
    length : of a piece [s, or revolutions].  If not given: sqrt(2 pi/a) with the mean angular acceleration a, in which
        the speed moves by the resolution, at most an eighth of the span; 8 revolutions on an axis of orders
    pieces : how many; those at both ends that would overlap wholly are left out
    step : sampling step [s, or revolutions]; if not given, the shorter steps of the record, on an axis of orders the median

    ``kept`` states how much of order 1 survives the change of speed in each piece: |integral of the window with
    exp(i a t^2/2)| over that without.  Pieces at the ends are pushed inwards, and their speed is the mean in them.
    """
    if axis not in AXES:
        raise ParameterError(f"axis = {axis!r}: must be one of {', '.join(AXES)}.")
    if pieces < 2:
        raise ParameterError(f"pieces = {pieces}: must be at least 2.")
    signal, shape = PlaneSignal.of(source, channel), window_named(window)
    shaft = shaft_history(source, turning_place(source, signal.name, reference))
    begin, finish = chosen_span(shaft, *signal.span(start, end))
    if start is None or end is None:
        first, last = turning_span(shaft, begin, finish)
        begin, finish = (first if start is None else begin), (last if end is None else finish)
    turning = ShaftAngle.over(shaft, begin, finish)
    by_angle = axis == "order"
    # where on the axis (time or revolutions) each speed is reached first
    place = turning.direction * (turning.angles - turning.angles[0]) / TURN if by_angle else turning.times
    speeds = np.abs(turning.speeds)
    span = float(place[-1] - place[0])
    piece = _length(turning, span, by_angle) if length is None else float(length)
    if not 0.0 < piece <= span:
        unit = "revolutions" if by_angle else "s"
        raise ParameterError(f"length = {piece:g} {unit}: must be greater than 0 and at most the span of {span:.4g} {unit}.")
    wanted = np.linspace(float(speeds.min()), float(speeds.max()), pieces)
    middles = np.unique(np.clip(_first_reached(place, speeds, wanted), place[0] + 0.5 * piece, place[-1] - 0.5 * piece))
    count = piece_samples(signal.name, place, piece, step, usual=0.5 if by_angle else 0.05)
    at = middles[:, None] + piece * (np.arange(count) / count - 0.5)
    ends = middles[:, None] + piece * np.array([-0.5, 0.5])
    if by_angle:
        to_angle = turning.angles[0] + turning.direction * TURN * np.array([0.0, 1.0])
        times = turning.times_of((to_angle[0] + (to_angle[1] - to_angle[0]) * at).ravel()).reshape(at.shape)
        edges = turning.times_of((to_angle[0] + (to_angle[1] - to_angle[0]) * ends).ravel()).reshape(ends.shape)
        mean = TURN * piece / (edges[:, 1] - edges[:, 0])
    else:
        times, edges = at, ends
        mean = np.abs(np.diff(shaft.at(ends), axis=1)[:, 0]) / piece
    found = sliding_spectra(signal, times, piece, shape, sense=turning.direction)
    kept = (
        np.ones(len(mean))
        if by_angle
        else np.array([_kept(shape, shaft, float(a), float(b), count) for a, b in zip(*edges.T, strict=True)])
    )
    order = np.argsort(mean, kind="stable")
    return Waterfall(
        scene=signal.scene,
        status=_status(kept, piece),
        settings={"axis": axis, "pieces": pieces, "length": piece, "window": window, "start": begin, "end": finish, "step": piece / count},
        channel=signal.name,
        unit=signal.unit,
        reference=shaft.name.removesuffix(".angle"),
        axis=axis,
        two_sided=signal.plane,
        speeds=mean[order],
        times=0.5 * (edges[:, 0] + edges[:, 1])[order],
        lines=(1.0 if by_angle else TURN) * found.lines,
        amplitude=found.amplitude[order],
        kept=kept[order],
        window=window,
        length=piece,
    )


def _length(turning: ShaftAngle, span: float, by_angle: bool) -> float:
    if by_angle:
        return min(8.0, 0.5 * span)
    change = float(np.ptp(np.abs(turning.speeds)))
    return min(math.sqrt(TURN * span / change) if change > 0.0 else span, span / 8.0)


def _first_reached(place: FloatArray, speeds: FloatArray, wanted: FloatArray) -> FloatArray:
    """Where the speed (its running largest or, in a coast-down, smallest value) takes the wanted ones."""
    if speeds[-1] >= speeds[0]:
        passed = np.maximum.accumulate(speeds)
        return place[np.minimum(np.searchsorted(passed, wanted), len(place) - 1)]
    passed = np.maximum.accumulate(-speeds)
    return place[np.minimum(np.searchsorted(passed, -wanted), len(place) - 1)]


def _kept(window: Window, shaft: TimeHistory, begin: float, finish: float, count: int) -> float:
    """Share of a line of order 1 that is left, from the angle in the piece less its straight line."""
    at = np.linspace(begin, finish, min(count, 256), endpoint=False)
    angle = shaft.at(at)
    bent = angle - np.polyval(np.polyfit(at - at[0], angle, 1), at - at[0])
    weight = window.values(len(at))
    return float(abs(np.sum(weight * np.exp(1j * bent)))) / float(np.sum(weight))


def _status(kept: FloatArray, piece: float) -> str:
    worst = 1.0 - float(np.min(kept))
    if worst <= SMEARED:
        return "complete"
    return (
        f"complete; the speed changes within a piece of {piece:.3g} s, so that order 1 reads up to {100.0 * worst:.2g} % low: "
        "take shorter pieces, or axis='order'"
    )
