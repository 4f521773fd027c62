"""Spectrogram: amplitude spectra over time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hdrive_mbs.analysis.result import Result
from hdrive_mbs.analysis.signals.plane_signal import PlaneSignal
from hdrive_mbs.analysis.signals.sliding_spectra import piece_samples, sliding_spectra
from hdrive_mbs.analysis.signals.source import Source
from hdrive_mbs.analysis.signals.windows import window_named
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.printed_table import PrintedTable, thinned
from hdrive_mbs.signals import FloatArray

TURN = 2.0 * np.pi


@dataclass(frozen=True, kw_only=True, eq=False)
class Spectrogram(Result):
    """Spectra of overlapping pieces; every amplitude is 0-peak.

    channel, unit : of the signal and of its amplitudes
    two_sided : whether the signal is x + i y of a place: positive frequencies turn from x towards y
    times : middle of each piece [s], shape (p,)
    frequency : rad/s, shape (m,)
    amplitude : shape (p, m); at 0 the size of the mean of each piece
    window, length : of a piece [s]
    """

    channel: str
    unit: str
    two_sided: bool
    times: FloatArray
    frequency: FloatArray
    amplitude: FloatArray
    window: str
    length: float

    @property
    def resolution(self) -> float:
        """Distance at which two frequencies begin to be told apart [rad/s]: 2 pi/length; lines lie four times as close."""
        return TURN / self.length

    def tables(self) -> tuple[PrintedTable, ...]:
        """The largest line of each piece."""
        at = np.argmax(self.amplitude, axis=1)
        columns = {
            "time [s]": self.times,
            "largest line at [rad/s]": self.frequency[at],
            f"amplitude 0-peak [{self.unit}]": self.amplitude[np.arange(len(at)), at],
        }
        return (thinned(columns, title=f"spectrogram of {self.channel}, pieces of {self.length:.4g} s, {self.window}"),)

    def columns(self) -> dict[str, np.ndarray]:
        pieces, lines = self.amplitude.shape
        return {
            "time [s]": np.repeat(self.times, lines),
            "frequency [rad/s]": np.tile(self.frequency, pieces),
            f"{self.channel} amplitude 0-peak [{self.unit}]": self.amplitude.ravel(),
        }


def spectrogram(
    source: Source,
    channel: str | tuple[str, str] | None = None,
    *,
    length: float | None = None,
    overlap: float = 0.9,
    window: str = "hann",
    start: float | None = None,
    end: float | None = None,
    step: float | None = None,
) -> Spectrogram:
    """Amplitude spectra (0-peak) of pieces of a channel, or of x + i y of a place, over time.

    channel : a channel, or a place with x and y (or two channels) for the two-sided spectrum (``"rotor_1"``)
    length : of a piece [s]; a twentieth of the span if not given
    overlap : share of a piece that the next one repeats
    window, start, end, step : as for ``spectrum``

    Something whose frequency changes by more than the resolution 2 pi/length within a piece is smeared and reads low.
    """
    signal = PlaneSignal.of(source, channel)
    begin, finish = signal.span(start, end)
    piece = (finish - begin) / 20.0 if length is None else float(length)
    if not 0.0 < piece <= finish - begin:
        raise ParameterError(f"length = {piece:g} s: must be greater than 0 s and at most the span of {finish - begin:g} s.")
    if not 0.0 <= overlap < 1.0:
        raise ParameterError(f"overlap = {overlap:g}: must be at least 0 and less than 1 (share of a piece).")
    inside = signal.times[(signal.times >= begin) & (signal.times <= finish)]
    count = piece_samples(signal.name, inside, piece, step)
    pieces = int(np.floor((finish - begin - piece) / (piece * (1.0 - overlap)) * (1.0 + 1e-9))) + 1
    starts = np.minimum(begin + piece * (1.0 - overlap) * np.arange(pieces), finish - piece)
    found = sliding_spectra(signal, starts[:, None] + piece / count * np.arange(count), piece, window_named(window))
    return Spectrogram(
        scene=signal.scene,
        status="complete",
        settings={"window": window, "length": piece, "overlap": overlap, "start": begin, "end": finish, "step": piece / count},
        channel=signal.name,
        unit=signal.unit,
        two_sided=signal.plane,
        times=starts + 0.5 * piece,
        frequency=TURN * found.lines,
        amplitude=found.amplitude,
        window=window,
        length=piece,
    )
