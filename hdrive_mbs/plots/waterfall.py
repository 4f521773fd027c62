"""Pictures of spectra over speed and over time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm

from hdrive_mbs.analysis.signals.spectrogram import Spectrogram
from hdrive_mbs.analysis.signals.waterfall import Waterfall
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.lengths import shown_unit
from hdrive_mbs.plots.look import COLOURS, GREY, given_or_new, house_look, number, other_unit, readable

FloatArray = npt.NDArray[np.float64]

COLOUR_MAP = "viridis"
HEIGHT = 9.0
"""Steps of speed that the largest amplitude is high in the picture of lines."""

RANGE = 1e-4
"""Smallest over largest amplitude on the scale of colours."""

KINDS = ("lines", "map")
PAPER = {"facecolor": "white", "edgecolor": "none", "pad": 0.6, "alpha": 0.8}


@plot.register
def plot_waterfall(
    result: Waterfall, ax: Axes | None = None, *, kind: str = "lines", highest: float | None = None, orders: Sequence[float] | None = None
) -> Axes:
    """Spectra one behind the other, each standing on its speed, or as a map of colours.

    kind : "lines" or "map" (logarithmic colours, 80 dB)
    highest : end of the axis of lines [rad/s or orders]; just beyond what holds 0.5 % of the largest if not given
    orders : lines of constant order that are drawn; 1 and 2 (and backward) if not given
    """
    if kind not in KINDS:
        raise ParameterError(f"kind = {kind!r}: must be one of {', '.join(KINDS)}.")
    with house_look():
        fresh = ax is None
        ax = given_or_new(ax, 7.2, 5.4)
        part, reach = _shown(result.lines, result.amplitude, highest, result.resolution)
        lines, amplitude = result.lines[part], result.amplitude[:, part]
        if kind == "lines":
            _stack(ax, result, lines, amplitude)
        else:
            _map(ax, lines, result.speeds, amplitude, result.unit, fresh)
        wanted = orders if orders is not None else ((1.0, 2.0, -1.0) if result.two_sided else (1.0, 2.0))
        _orders(ax, result, wanted, reach, kind == "map")
        ax.set_xlim(-reach if result.two_sided else 0.0, reach)
        ax.set_ylabel(f"speed of {readable(result.reference)} [rad/s]")
        _names(ax, result, fresh)
    return ax


@plot.register
def plot_spectrogram(result: Spectrogram, ax: Axes | None = None, *, highest: float | None = None) -> Axes:
    """Amplitudes over time and frequency as a map of colours (logarithmic, 80 dB).

    highest : end of the frequency axis [rad/s]; just beyond what holds 0.5 % of the largest if not given
    """
    with house_look():
        fresh = ax is None
        ax = given_or_new(ax, 7.2, 4.4)
        part, reach = _shown(result.frequency, result.amplitude, highest, result.resolution)
        _map(ax, result.times, result.frequency[part], result.amplitude[:, part].T, result.unit, fresh)
        ax.set_ylim(-reach if result.two_sided else 0.0, reach)
        ax.set_xlabel("time [s]")
        sense = ", positive from x to y" if result.two_sided else ""
        ax.set_ylabel(f"frequency{sense} [rad/s]")
        if fresh:
            window = "Hann" if result.window == "hann" else readable(result.window)
            text = f"{readable(result.channel)}: amplitudes 0-peak, {window} window of {number(result.length)}\u2009s"
            ax.figure.figure.suptitle(text, x=0.01, ha="left", fontsize=10)
    return ax


def _shown(lines: FloatArray, amplitude: FloatArray, highest: float | None, resolution: float) -> tuple[npt.NDArray[np.bool_], float]:
    """Which lines are drawn, and how far the axis goes."""
    if highest is None:
        beside = np.where(np.abs(lines) > 0.5 * resolution, amplitude, 0.0)
        strong = np.nonzero(np.max(beside, axis=0) > 0.005 * float(beside.max()))[0]
        furthest = float(np.max(np.abs(lines[strong]))) if len(strong) else float(np.max(np.abs(lines)))
        highest = min(1.15 * furthest + 4.0 * resolution, float(np.max(np.abs(lines))))
    if not highest > 0.0:
        raise ParameterError(f"highest = {highest:g}: must be greater than 0.")
    return np.abs(lines) <= highest * (1.0 + 1e-9), highest


def _stack(ax: Axes, result: Waterfall, lines: FloatArray, amplitude: FloatArray) -> None:
    """Slow pieces in front, so that the resonance stands behind what leads to it."""
    speeds = result.speeds
    step = float(np.ptp(speeds)) / max(len(speeds) - 1, 1) or 1.0
    inner = np.where(np.abs(lines) > 0.5 * result.resolution, amplitude, 0.0)  # the mean is no vibration
    largest = float(inner.max()) or 1.0
    scale = HEIGHT * step / largest
    for k in reversed(range(len(speeds))):
        base = np.full(len(lines), speeds[k])
        order = 2.0 + (len(speeds) - k) * 1e-3
        ax.fill_between(lines, base, base + scale * inner[k], color="white", linewidth=0.0, zorder=order)
        ax.plot(lines, base + scale * inner[k], color=COLOURS[0], linestyle="-", linewidth=0.7, zorder=order)
    bar = _round_down(0.5 * largest)
    right, top = float(lines[-1]), float(speeds[-1] + (HEIGHT - 0.5) * step)
    ax.plot([0.97 * right] * 2, [top - scale * bar, top], color="black", linestyle="-", linewidth=2.0, zorder=5.0)
    factor, unit = shown_unit(result.unit, bar)
    text = f"{number(factor * bar)}\u2009{unit}\n0-peak "
    ax.text(0.955 * right, top - 0.5 * scale * bar, text, ha="right", va="center", fontsize=8.5, zorder=5.0, bbox=PAPER)
    ax.set_ylim(float(speeds[0]) - 0.5 * step, float(speeds[-1]) + (HEIGHT + 1.0) * step)


def _round_down(value: float) -> float:
    """1, 2 or 5 times a power of ten."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * max(digit for digit in (1.0, 2.0, 5.0) if digit * power <= value * (1.0 + 1e-12)))


def _map(ax: Axes, x: FloatArray, y: FloatArray, amplitude: FloatArray, unit: str, fresh: bool) -> None:
    largest = float(np.max(amplitude)) or 1.0
    factor, unit = shown_unit(unit, largest)
    norm = LogNorm(RANGE * factor * largest, factor * largest)
    mesh = ax.pcolormesh(
        x, y, factor * np.maximum(amplitude, RANGE * largest), norm=norm, cmap=COLOUR_MAP, shading="nearest", rasterized=True
    )
    ax.grid(False)
    if fresh:
        ax.figure.figure.colorbar(mesh, ax=ax, label=f"amplitude, 0-peak [{unit}]", pad=0.02)


def _orders(ax: Axes, result: Waterfall, orders: Sequence[float], reach: float, below: bool) -> None:
    top, bottom = float(result.speeds[-1]), float(result.speeds[0])
    for order in orders:
        ends = np.array([bottom, top])
        at = order * ends if result.axis == "frequency" else np.full(2, order)
        if abs(at[0]) > reach:
            continue
        if abs(at[1]) > reach:
            ends[1] = reach / abs(order)
            at[1] = np.copysign(reach, order)
        ax.plot(at, ends, color=GREY, linestyle="--", linewidth=1.0, zorder=4.0)
        options: dict[str, Any] = {"fontsize": 8.5, "color": "#333333", "bbox": PAPER, "zorder": 4.5}
        at_edge = abs(at[1]) >= 0.97 * reach
        shift = (-4 if at[1] > 0.0 else 4, -4) if at_edge else (0, -4 if below else 3)
        options |= {"ha": ("right" if at[1] > 0.0 else "left") if at_edge else "center", "va": "top" if at_edge or below else "bottom"}
        ax.annotate(f"{order:g}x", (at[1], ends[1]), xytext=shift, textcoords="offset points", **options)


def _names(ax: Axes, result: Waterfall, fresh: bool) -> None:
    sense = ", backward negative" if result.two_sided else ""
    if result.axis == "frequency":
        ax.set_xlabel(f"frequency{sense} [rad/s]")
        if fresh:
            above = ax.secondary_xaxis("top", functions=other_unit(0.5 / np.pi))
            above.set_xlabel(f"frequency{sense} [Hz]")
            above.spines["top"].set_visible(True)
    else:
        ax.set_xlabel(f"order: periods per revolution of {readable(result.reference)}{sense} [1]")
    if fresh:
        window = "Hann" if result.window == "hann" else readable(result.window)
        unit = "s" if result.axis == "frequency" else "revolutions"
        text = f"{readable(result.channel)}: amplitudes 0-peak, {window} window of {number(result.length)}\u2009{unit}"
        ax.figure.figure.suptitle(text, x=0.01, ha="left", fontsize=10)
