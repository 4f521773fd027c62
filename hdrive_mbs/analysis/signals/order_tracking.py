"""Order tracking: amplitude and lag of orders of a shaft while its speed changes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.result import Result
from hdrive_mbs.analysis.signals.plane_signal import PlaneSignal, Signal, turning_place
from hdrive_mbs.analysis.signals.shaft_angle import TURN, ShaftAngle, shaft_history, turning_span
from hdrive_mbs.analysis.signals.source import Source
from hdrive_mbs.analysis.signals.spectrum import chosen_span
from hdrive_mbs.analysis.unbalance.whirl_orbit import lag
from hdrive_mbs.errors import AnalysisError, ParameterError, unknown_place
from hdrive_mbs.printed_table import PrintedTable
from hdrive_mbs.signals import FloatArray, TimeHistory

ComplexArray = npt.NDArray[np.complex128]

DEGREE = 2
"""Amplitudes are parabolas of the angle within a window."""

LARGEST_CONDITION = 1e4
"""Condition of the least squares above which orders are too close for the window."""

BACKWARD = " backward"
"""Ending of the names of tracks of backward whirl."""

CHUNK = 2000
"""Windows that are worked on at once."""


@dataclass(frozen=True, kw_only=True, eq=False)
class OrderTracking(Result):
    """Complex amplitudes (0-peak) of orders over a run, in the order of time.

    channel, unit : of the signal and of its amplitudes
    reference : shaft whose angle phi the orders count from
    two_sided : whether the signal is x + i y of a place
    tracks : names of the columns of ``amplitudes``: "1", or "1 forward" and "1 backward"
    amplitudes : A, shape (n, tracks).  One-sided: the signal is the sum of Re[A exp(i k phi)].  Two-sided: x + i y is the
        sum of A exp(i k phi) for forward and A exp(-i k phi) for backward whirl, whatever the sense of the spin
    times, speeds, angles : middle of each window [s], speed (true sense) [rad/s] and phi [rad] then
    revolutions : in a window
    """

    channel: str
    unit: str
    reference: str
    two_sided: bool
    orders: tuple[float, ...]
    tracks: tuple[str, ...]
    amplitudes: ComplexArray
    times: FloatArray
    speeds: FloatArray
    angles: FloatArray
    revolutions: float

    def track(self, order: float = 1.0, sense: str = "forward") -> ComplexArray:
        """Complex amplitude of an order over the run, shape (n,); abs is 0-peak.

        sense : "forward" or "backward", for x + i y only
        """
        return np.asarray(self.amplitudes[:, self._column(order, sense)])

    def lag(self, order: float = 1.0, sense: str = "forward") -> FloatArray:
        """Angle [rad] by which an order follows the shaft, shape (n,), from -pi/4 up to 7 pi/4: the signal, or x, is |A| cos(k phi - lag).

        The same lag as that of ``unbalance_response``: -arg A, and arg A of backward whirl, whose x is Re[A exp(-i k phi)].
        """
        return self._lags(self._column(order, sense))

    def _lags(self, column: int) -> FloatArray:
        amplitude = self.amplitudes[:, column]
        return lag(amplitude.conj() if self.tracks[column].endswith(BACKWARD) else amplitude)

    def _column(self, order: float, sense: str) -> int:
        name = f"{order:g} {sense}" if self.two_sided else f"{order:g}"
        if name not in self.tracks:
            raise unknown_place("track", name, self.tracks, "This order tracking")
        return self.tracks.index(name)

    def tables(self) -> tuple[PrintedTable, ...]:
        """Where each order is largest."""
        sizes = np.abs(self.amplitudes)
        rows = []
        for k, name in enumerate(self.tracks):
            at = int(np.argmax(sizes[:, k]))
            rows.append((name, float(sizes[at, k]), float(self.speeds[at]), float(self.times[at]), float(self._lags(k)[at])))
        heads = ("order", f"largest amplitude 0-peak [{self.unit}]", "at speed [rad/s]", "time [s]", "lag [rad]")
        return (PrintedTable(title=f"orders of {self.reference} in {self.channel}", heads=heads, rows=tuple(rows)),)

    def columns(self) -> dict[str, np.ndarray]:
        columns = {"time [s]": self.times, "speed [rad/s]": self.speeds}
        for k, name in enumerate(self.tracks):
            columns[f"order {name} amplitude 0-peak [{self.unit}]"] = np.abs(self.amplitudes[:, k])
            columns[f"order {name} lag [rad]"] = self._lags(k)
        return columns


def order_tracking(
    source: Source,
    channel: str | tuple[str, str] | None = None,
    *,
    orders: Sequence[float] = (1.0,),
    reference: str | TimeHistory | None = None,
    revolutions: float = 4.0,
    samples_per_revolution: int = 64,
    windows_per_revolution: int = 4,
    start: float | None = None,
    end: float | None = None,
) -> OrderTracking:
    """Amplitude and lag of orders along a run-up or coast-down: a Bode plot without stopping.

    channel : a channel, or a place with x and y (or two channels), whose forward and backward whirl are told apart
    orders : periods per revolution, greater than 0
    reference : shaft whose angle counts, by place, channel or history [rad]; as for ``waterfall``
    revolutions : length of the window that slides along
    samples_per_revolution : in the angle; what lies above half as many orders folds back
    windows_per_revolution : how densely the result is given
    start, end : part of the run [s]; where the shaft keeps turning one way, if not given

    The signal is sampled evenly in the angle.  In each window all orders asked for and the mean are fitted together by
    least squares with Hann weights, each amplitude as a parabola of the angle, whose middle value counts.  So an
    amplitude that changes like a parabola within the window comes out exactly; where a resonance is passed within
    about a window its top reads low (take fewer revolutions).  What else the signal holds is rejected the better the
    more windows-lengths it lies off: free whirl at a natural frequency w appears as order w/speed, and shows as beats
    within about 4/revolutions orders.
    """
    if not orders or any(not (np.isfinite(order) and order > 0.0) for order in orders) or len(set(orders)) != len(orders):
        raise ParameterError(f"orders = {tuple(orders)}: must be different numbers greater than 0.")
    if samples_per_revolution < 4.0 * max(orders):
        raise ParameterError(
            f"samples_per_revolution = {samples_per_revolution}: must be at least 4 for each period of the highest order {max(orders):g}."
        )
    if not 1 <= windows_per_revolution <= samples_per_revolution or not revolutions > 0.0:
        raise ParameterError(
            f"revolutions = {revolutions:g} must be greater than 0, windows_per_revolution = {windows_per_revolution} between 1 and "
            "samples_per_revolution."
        )
    signal = PlaneSignal.of(source, channel)
    shaft = shaft_history(source, turning_place(source, signal.name, reference))
    begin, finish = chosen_span(shaft, *signal.span(start, end))
    if start is None or end is None:
        first, last = turning_span(shaft, begin, finish)
        begin, finish = (first if start is None else begin), (last if end is None else finish)
    turning = ShaftAngle.over(shaft, begin, finish)
    if turning.turns < revolutions:
        raise AnalysisError(
            f"{shaft.name} turns by {turning.turns:.3g} revolutions from {begin:g} s to {finish:g} s, less than a window of "
            f"{revolutions:g}. Take a longer run or a shorter window."
        )
    spacing = turning.direction * TURN / samples_per_revolution
    angles = turning.angles[0] + spacing * np.arange(int(turning.turns * samples_per_revolution * (1.0 + 1e-12)) + 1)
    half = min(max(round(0.5 * revolutions * samples_per_revolution), 2), (len(angles) - 1) // 2)
    values = signal.at(turning.times_of(angles))
    signed = np.array([sign * order for order in orders for sign in (1.0, -1.0)])
    filters = _filters(signed, spacing, half)
    stride = max(1, samples_per_revolution // windows_per_revolution)
    middles = np.arange(half, len(angles) - half, stride)
    fitted = _apply(filters, values, middles, half) * np.exp(-1j * np.outer(angles[middles], signed))
    amplitudes = fitted if signal.plane else 2.0 * fitted[:, ::2]
    names = [f"{order:g}" for order in orders]
    times = turning.times_of(angles[middles])
    return OrderTracking(
        scene=signal.scene,
        status="complete",
        settings={
            "orders": tuple(orders),
            "revolutions": revolutions,
            "samples_per_revolution": samples_per_revolution,
            "start": begin,
            "end": finish,
        },
        channel=signal.name,
        unit=signal.unit,
        reference=shaft.name.removesuffix(".angle"),
        two_sided=signal.plane,
        orders=tuple(float(order) for order in orders),
        tracks=tuple(f"{name} {sense}" for name in names for sense in ("forward", "backward")) if signal.plane else tuple(names),
        amplitudes=amplitudes,
        times=times,
        speeds=turning.direction * np.interp(times, turning.times, np.abs(turning.speeds)),
        angles=angles[middles],
        revolutions=2.0 * half / samples_per_revolution,
    )


def _filters(signed: FloatArray, spacing: float, half: int) -> ComplexArray:
    """Weights, (2 half + 1, orders), whose products with the samples give the amplitudes in the middle of a window.

    Least squares of  sum_k sum_d a_kd s^d exp(i k delta)  with k over the orders and 0, s = -1 .. 1, Hann weights; the
    samples lie alike in every window, so one pseudo-inverse serves all.
    """
    j = np.arange(-half, half + 1)
    s, weight = j / half, np.cos(0.5 * np.pi * j / (half + 1))  # the root of Hann's
    waves = np.exp(1j * np.outer(j * spacing, np.append(signed, 0.0)))
    basis = np.concatenate([waves * s[:, None] ** d for d in range(DEGREE + 1)], axis=1) * weight[:, None]
    condition = float(np.linalg.cond(basis))
    if not condition < LARGEST_CONDITION:
        raise AnalysisError(
            f"Orders {', '.join(f'{order:g}' for order in signed[::2])} and the mean lie too close together for windows of "
            f"{2 * half * abs(spacing) / TURN:.3g} revolutions; take longer windows."
        )
    return np.asarray((np.linalg.pinv(basis)[: len(signed)] * weight).T)


def _apply(filters: ComplexArray, values: Signal, middles: npt.NDArray[np.intp], half: int) -> ComplexArray:
    windows = np.lib.stride_tricks.sliding_window_view(values, 2 * half + 1)
    parts = [windows[middles[k : k + CHUNK] - half] @ filters for k in range(0, len(middles), CHUNK)]
    return np.concatenate(parts)
