"""Picture of tracked orders: amplitude and lag over speed (Bode plot of a run-up)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

from hdrive_mbs.analysis.signals.order_tracking import OrderTracking
from hdrive_mbs.errors import unknown_place
from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.lengths import shown_unit
from hdrive_mbs.plots.look import house_look, legend_above, new_figure, number, readable, style

FloatArray = npt.NDArray[np.float64]

VISIBLE = 0.05
"""Smallest largest amplitude of a track that is drawn by itself, as a share of the largest of all."""

FAINT = 1e-3
"""Amplitude below which a lag is not drawn, as a share of the largest of its track; none of a track that is not visible."""


@plot.register
def plot_order_tracking(
    result: OrderTracking, ax: Axes | None = None, *, tracks: Sequence[str] | None = None, logarithmic: bool = False
) -> Axes:
    """Amplitude, 0-peak, over speed, and below it the lag behind the angle of the reference; returns the top one.

    tracks : which ("1 forward"); those of 5 % of the largest and more if not given
    logarithmic : amplitudes on a logarithmic scale
    With ``ax`` the amplitudes alone go there.
    """
    chosen = list(tracks) if tracks is not None else _visible(result)
    for name in chosen:
        if name not in result.tracks:
            raise unknown_place("track", name, result.tracks, "This order tracking")
    with house_look():
        if ax is not None:
            _amplitudes(ax, result, chosen, logarithmic)
            ax.set_xlabel(f"speed of {readable(result.reference)} [rad/s]")
            return ax
        figure = new_figure(7.2, 5.2)
        upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[1.3, 1.0])
        _amplitudes(upper, result, chosen, logarithmic)
        seen = _visible(result)
        for k, name in enumerate(chosen):
            if name not in seen:
                continue
            amplitude = result.amplitudes[:, result.tracks.index(name)]
            clear = np.abs(amplitude) > FAINT * float(np.max(np.abs(amplitude)))
            lower.plot(*_broken(np.abs(result.speeds), np.where(clear, np.degrees(_lag(result, name)), np.nan)), **style(k))
        lower.set_ylim(-45.0, 315.0)
        lower.set_yticks(np.arange(0.0, 316.0, 90.0))
        lower.set_ylabel("lag behind the spin [degrees]")
        lower.set_xlabel(f"speed of {readable(result.reference)} [rad/s]")
        figure.align_ylabels([upper, lower])
        title = f"{readable(result.channel)}: orders of {readable(result.reference)}, windows of {number(result.revolutions)} revolutions"
        faint = [name for name in result.tracks if name not in chosen] if tracks is None else []
        if faint:
            title += f"\nbelow {100.0 * VISIBLE:g} % of the largest and not drawn: order {', '.join(faint)}"
        figure.suptitle(title, x=0.01, ha="left", fontsize=10)
    first: Axes = upper
    return first


def _visible(result: OrderTracking) -> list[str]:
    largest = np.max(np.abs(result.amplitudes), axis=0)
    return [name for name, size in zip(result.tracks, largest, strict=True) if size >= VISIBLE * float(largest.max())]


def _lag(result: OrderTracking, name: str) -> FloatArray:
    order, _, sense = name.partition(" ")
    return result.lag(float(order), sense or "forward")


def _broken(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The line with a gap where the lag jumps across the cut."""
    jumps = np.nonzero(np.abs(np.diff(y)) > 180.0)[0] + 1
    return np.insert(x, jumps, x[jumps]), np.insert(y, jumps, np.nan)


def _amplitudes(ax: Axes, result: OrderTracking, chosen: Sequence[str], logarithmic: bool) -> None:
    factor, unit = shown_unit(result.unit, float(np.max(np.abs(result.amplitudes))))
    for k, name in enumerate(chosen):
        ax.plot(np.abs(result.speeds), factor * np.abs(result.amplitudes[:, result.tracks.index(name)]), label=f"order {name}", **style(k))
    if logarithmic:
        ax.set_yscale("log")
    else:
        ax.set_ylim(bottom=0.0)
    ax.set_ylabel(f"amplitude, 0-peak [{unit}]")
    ax.margins(x=0.0)
    legend_above(ax)
