"""Pictures of amplitude spectra over frequency and over orders."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

from hdrive_mbs.analysis.signals.order_spectrum import OrderSpectrum
from hdrive_mbs.analysis.signals.spectrum import Spectrum
from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.lengths import shown_unit
from hdrive_mbs.plots.look import COLOURS, given_or_new, house_look, readable

FloatArray = npt.NDArray[np.float64]

TURN = 2.0 * np.pi
"""rad/s of one Hz."""


@plot.register
def plot_spectrum(
    result: Spectrum, ax: Axes | None = None, *, highest: float | None = None, logarithmic: bool = False, peaks: int = 4
) -> Axes:
    """Amplitudes, 0-peak, over frequency.

    highest : end of the frequency axis [Hz]; just beyond the last line of 0.5 % of the largest if not given
    logarithmic : amplitudes on a logarithmic scale
    peaks : how many of the largest peaks are named
    The mean (line at 0 Hz) is written in the title, not drawn.
    """
    factor, unit = _unit(result)
    found = [(peak.frequency / TURN, factor * peak.amplitude) for peak in result.peaks(peaks)]
    with house_look():
        ax = given_or_new(ax, 7.2, 3.6)
        _draw(ax, result.hertz, factor * result.amplitude, found, highest, logarithmic, "Hz")
        ax.set_xlabel("frequency [Hz]")
        span = f"{result.start:.4g} to {result.end:.4g} s, {result.resolution / TURN:.3g} Hz per line"
        _labels(ax, result, unit, f"{_window(result.window)} window, {span}")
    return ax


@plot.register
def plot_order_spectrum(
    result: OrderSpectrum, ax: Axes | None = None, *, highest: float | None = None, logarithmic: bool = False, peaks: int = 4
) -> Axes:
    """Amplitudes, 0-peak, over orders of a shaft (options as for a spectrum; ``highest`` is an order)."""
    factor, unit = _unit(result)
    found = [(peak.order, factor * peak.amplitude) for peak in result.peaks(peaks)]
    with house_look():
        ax = given_or_new(ax, 7.2, 3.6)
        _draw(ax, result.order, factor * result.amplitude, found, highest, logarithmic, "")
        ax.set_xlabel(f"order: periods per revolution of {readable(result.against)} [1]")
        speeds = f"{result.slowest:.4g} to {result.fastest:.4g} rad/s"
        _labels(ax, result, unit, f"{_window(result.window)} window, {result.revolutions:.4g} revolutions at {speeds}")
    return ax


def _window(name: str) -> str:
    return "Hann" if name == "hann" else readable(name)


def _unit(result: Spectrum | OrderSpectrum) -> tuple[float, str]:
    """Factor and unit of the amplitudes."""
    return shown_unit(result.unit, float(np.max(result.amplitude[1:], initial=0.0)))


def _labels(ax: Axes, result: Spectrum | OrderSpectrum, unit: str, how: str) -> None:
    factor, mean_unit = shown_unit(result.unit, abs(result.mean))
    ax.set_ylabel(f"amplitude, 0-peak [{unit}]")
    ax.set_title(f"{readable(result.channel)}: mean {factor * result.mean:.4g}\u2009{mean_unit}\n{how}", fontsize=9.5)


def _draw(
    ax: Axes,
    x: FloatArray,
    amplitude: FloatArray,
    peaks: Sequence[tuple[float, float]],
    highest: float | None,
    logarithmic: bool,
    unit: str,
) -> None:
    shown = amplitude[1:]
    largest = float(shown.max(initial=0.0))
    if highest is None:
        strong = np.nonzero(shown > (1e-4 if logarithmic else 0.005) * largest)[0]
        last = int(strong[-1]) + 1 if len(strong) else len(x) - 1
        highest = float(x[min(len(x) - 1, max(int(1.15 * last) + 2, 10))])
    part = slice(1, int(np.searchsorted(x, highest, side="right")))
    if 0 < len(x[part]) <= 120:
        ax.vlines(x[part], 0.0 if not logarithmic else max(largest * 1e-6, 1e-300), amplitude[part], color=COLOURS[0], linewidth=1.4)
    ax.plot(x[part], amplitude[part], color=COLOURS[0], linestyle="-", linewidth=1.0 if len(x[part]) > 120 else 0.5)
    ax.set_xlim(0.0, highest)
    if logarithmic:
        ax.set_yscale("log")
        ax.set_ylim(bottom=max(largest * 1e-5, 1e-300), top=15.0 * largest if largest > 0.0 else 1.0)
    elif largest > 0.0:
        ax.set_ylim(0.0, 1.22 * max(largest, *(height for _, height in peaks), 0.0))
    _name(ax, [peak for peak in peaks if peak[0] <= highest], highest, unit)


LABEL = 0.1
"""Width of the name of a peak, as a share of the axis."""


def _name(ax: Axes, peaks: Sequence[tuple[float, float]], highest: float, unit: str) -> None:
    """Frequency and amplitude beside each peak, largest first; a name that would cover another is left out."""
    taken: list[tuple[float, float]] = []
    for position, height in peaks:
        ax.plot([position], [height], "o", color=COLOURS[1], markersize=3.5)
        for side, shift in (("center", -0.5), ("left", 0.0), ("right", -1.0)):
            first = position / highest + shift * LABEL
            free = all(first + LABEL <= start or first >= end for start, end in taken)
            if free and first >= 0.0 and first + LABEL <= 1.0:
                taken.append((first, first + LABEL))
                ax.annotate(
                    f"{position:.4g}{chr(0x2009) + unit if unit else ''}\n{height:.3g}",
                    (position, height),
                    xytext=({"center": 0, "left": 4, "right": -4}[side], 4),
                    textcoords="offset points",
                    ha=side,
                    va="bottom",
                    fontsize=8.5,
                )
                break
