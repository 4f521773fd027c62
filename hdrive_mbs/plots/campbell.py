"""Picture of a torsional Campbell diagram."""

from __future__ import annotations

import textwrap
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from hdrive_mbs.analysis.drive_train.campbell import Campbell
from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.look import GREY, given_or_new, house_look, legend_above, number, other_unit, readable, style
from hdrive_mbs.plots.order_line import draw_order
from hdrive_mbs.plots.point_names import name_point

CROSSING: dict[str, Any] = {
    "linestyle": "none",
    "marker": "o",
    "color": "black",
    "markersize": 6,
    "markerfacecolor": "white",
    "markeredgewidth": 1.4,
}


@plot.register
def plot_campbell(result: Campbell, ax: Axes | None = None, *, highest: float | None = None) -> Axes:
    """Natural frequencies and excitation orders over the motor speed; crossings are marked and named.

    highest : end of the frequency axis [rad/s]; if not given, above the orders and the lowest mode
    """
    with house_look():
        fresh = ax is None
        ax = given_or_new(ax, 7.2, 4.6)
        top = _top(result) if highest is None else highest
        hidden = []
        for k in range(result.frequencies.shape[1]):
            branch = result.frequencies[:, k]
            if np.nanmin(branch) > top:
                hidden.append(f"mode {k + 1} ({number(float(np.nanmin(branch)))} rad/s)")
                continue
            ax.plot(result.speeds, branch, label=f"mode {k + 1}", linewidth=1.7, **style(k))
        for order, place, slope in zip(result.order_numbers, result.order_places, result.order_slopes, strict=True):
            draw_order(ax, f"{order:g} x {readable(place)}", result.speeds, slope, top, linestyle="--", linewidth=1.0)
        _crossings(ax, result, top)
        ax.set_xlim(float(result.speeds[0]), float(result.speeds[-1]))
        ax.set_ylim(0.0, top)
        ax.set_xlabel("motor speed [rad/s]")
        ax.set_ylabel("natural frequency [rad/s]")
        if fresh:
            above = ax.secondary_xaxis("top", functions=other_unit(30.0 / np.pi))
            above.set_xlabel("motor speed [rpm]")
            right = ax.secondary_yaxis("right", functions=other_unit(0.5 / np.pi))
            right.set_ylabel("natural frequency [Hz]")
            for scale, side in ((above, "top"), (right, "right")):
                scale.spines[side].set_visible(True)
            name = result.scene.name if result.scene is not None else "Campbell diagram"
            outside = "\n" + textwrap.fill(f"not drawn, higher: {', '.join(hidden)}", 105) if hidden else ""
            ax.figure.figure.suptitle(f"{name}: torsional Campbell diagram{outside}", x=0.01, ha="left", fontsize=10)
        _legend(ax, fresh)
    return ax


def _top(result: Campbell) -> float:
    orders = max((slope * float(np.max(np.abs(result.speeds))) for slope in result.order_slopes), default=0.0)
    lowest = float(np.nanmin(result.frequencies)) if np.isfinite(result.frequencies).any() else 1.0
    highest = float(np.nanmax(result.frequencies)) if np.isfinite(result.frequencies).any() else 1.0
    return min(max(1.1 * orders, 1.6 * lowest), 1.1 * max(highest, orders))


def _crossings(ax: Axes, result: Campbell, top: float) -> None:
    """A ring at each crossing with its motor speed."""
    for speed, order in zip(result.critical_speeds.tolist(), result.critical_orders, strict=True):
        frequency = result.order_slopes[order] * abs(speed)
        if frequency <= top:
            ax.plot([speed], [frequency], **CROSSING)
            name_point(ax, number(speed), speed, frequency)


def _legend(ax: Axes, fresh: bool) -> None:
    ax.plot([], [], label="crossing, motor speed in rad/s", **CROSSING)
    ax.plot([], [], color=GREY, linestyle="--", linewidth=1.0, label="excitation order")
    if not fresh:
        legend_above(ax)
        return
    ax.figure.figure.legend(*ax.get_legend_handles_labels(), loc="outside lower left", ncols=4)
