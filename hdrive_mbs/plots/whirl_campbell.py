"""Picture of the Campbell diagram of a rotor line: frequencies above, damping below."""

from __future__ import annotations

import textwrap
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from hdrive_mbs.analysis.whirl.rotor_places import reference_shaft
from hdrive_mbs.analysis.whirl.whirl_campbell import WhirlCampbell
from hdrive_mbs.analysis.whirl.whirl_modes import STABLE
from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.look import GREY, given_or_new, house_look, legend_above, new_figure, number, other_unit, readable
from hdrive_mbs.plots.order_line import draw_order
from hdrive_mbs.plots.point_names import name_point
from hdrive_mbs.plots.whirl_look import WHIRL_LOOK

RING: dict[str, Any] = {"linestyle": "none", "marker": "o", "markersize": 6, "markerfacecolor": "white", "markeredgewidth": 1.4}
UNSTABLE = "#F3D9D6"
DRIFTING = "#F8F3E4"


@plot.register
def plot_whirl_campbell(result: WhirlCampbell, ax: Axes | None = None, *, highest: float | None = None) -> Axes:
    """Damped frequencies by kind of whirl with order lines and critical speeds; damping ratios in a panel below.

    highest : end of the frequency axis [rad/s]; if not given, above the order lines and the lowest branches
    With ``ax`` only the frequencies are drawn.  Rings are critical speeds, small grey ones those that unbalance hardly
    excites (backward circles, heavily damped, axial).  Speeds at which a vibration grows are shaded; paler where only
    something grows without oscillating, a motor for one whose torque rises with its speed.
    """
    with house_look():
        if ax is not None:
            top = _top(result) if highest is None else highest
            _frequencies(given_or_new(ax), result, top)
            ax.set_xlabel(f"speed of {_reference(result)} [rad/s]")
            legend_above(ax, columns=4)
            return ax
        figure = new_figure(7.2, 6.0)
        above, below = figure.subplots(2, 1, sharex=True, height_ratios=(3.0, 1.2))
        top = _top(result) if highest is None else highest
        hidden = _frequencies(above, result, top)
        _damping(below, result, top)
        rpm = above.secondary_xaxis("top", functions=other_unit(30.0 / np.pi))
        rpm.set_xlabel(f"speed of {_reference(result)} [rpm]")
        hertz = above.secondary_yaxis("right", functions=other_unit(0.5 / np.pi))
        hertz.set_ylabel("damped frequency [Hz]")
        for scale, side in ((rpm, "top"), (hertz, "right")):
            scale.spines[side].set_visible(True)
        name = result.scene.name if result.scene is not None else "rotor line"
        outside = "\n" + textwrap.fill(f"not drawn, higher: {', '.join(hidden)}", 92) if hidden else ""
        figure.suptitle(f"{name}: Campbell diagram{outside}", x=0.01, ha="left", fontsize=10)
        figure.legend(*above.get_legend_handles_labels(), loc="outside lower left", ncols=4)
    first: Axes = above
    return first


def _reference(result: WhirlCampbell) -> str:
    """The shaft whose speed is on the axis."""
    return "rotation" if result.scene is None else readable(reference_shaft(result.scene))


def _top(result: WhirlCampbell) -> float:
    orders = max((slope * float(np.max(np.abs(result.speeds))) for slope in result.order_slopes), default=0.0)
    finite = result.frequencies[np.isfinite(result.frequencies)]
    lowest, largest = (float(finite.min()), float(finite.max())) if finite.size else (1.0, 1.0)
    return min(max(1.1 * orders, 1.6 * lowest), 1.1 * max(largest, orders))


def _frequencies(ax: Axes, result: WhirlCampbell, top: float) -> list[str]:
    """Draw the branches; returns those that lie above the picture."""
    hidden, named = [], set()
    _unstable(ax, result)
    for k, word in enumerate(result.whirl):
        branch = result.frequencies[:, k]
        if not np.nanmin(branch) <= top:
            hidden.append(f"mode {k + 1} ({word}, {number(float(np.nanmin(branch)))} rad/s)")
            continue
        ax.plot(result.speeds, branch, linewidth=1.6, label=None if word in named else word, **WHIRL_LOOK[word])
        named.add(word)
    for order, place, slope in zip(result.order_numbers, result.order_places, result.order_slopes, strict=True):
        draw_order(ax, f"{order:g} x {readable(place)}", result.speeds, slope, top, linestyle="-", linewidth=0.8, zorder=1.5)
    _criticals(ax, result, top)
    ax.set_xlim(float(result.speeds[0]), float(result.speeds[-1]))
    ax.set_ylim(0.0, top)
    ax.set_ylabel("damped frequency [rad/s]")
    return hidden


def _criticals(ax: Axes, result: WhirlCampbell, top: float) -> None:
    """A ring at each crossing with its speed, those that matter first."""
    crossings = zip(result.critical_speeds.tolist(), result.critical_orders, result.critical_notes, strict=True)
    for speed, order, note in sorted(crossings, key=lambda item: item[2] != ""):
        frequency = result.order_slopes[order] * abs(speed)
        if frequency > top:
            continue
        look = {"color": GREY, "markersize": 4} if note else {"color": "black"}
        ax.plot([speed], [frequency], **{**RING, **look, "zorder": 3})
        name_point(ax, number(speed), speed, frequency, fontsize=8.0, color=look["color"])
    if any(note == "" for note in result.critical_notes):
        ax.plot([], [], color="black", label="critical speed [rad/s]", **RING)
    if any(result.critical_notes):
        ax.plot([], [], color=GREY, label="hardly excited", **{**RING, "markersize": 4})


def _unstable(ax: Axes, result: WhirlCampbell) -> None:
    """Shade the speeds at which a motion grows, up to the thresholds."""
    if np.all(result.stable):
        return
    edges = np.concatenate([result.speeds[:1], 0.5 * (result.speeds[1:] + result.speeds[:-1]), result.speeds[-1:]])
    for speed in result.threshold_speeds:
        edges[1:-1][np.argmin(np.abs(edges[1:-1] - speed))] = speed
    vibrates = np.any(result.damping_ratios < -STABLE, axis=1)
    if "without oscillating" not in result.status:
        vibrates[:] = True
    for shown, colour, text in ((vibrates, UNSTABLE, "unstable"), (~vibrates, DRIFTING, "drifts off")):
        label: str | None = text
        for k in np.flatnonzero(~result.stable & shown):
            ax.axvspan(float(edges[k]), float(edges[k + 1]), color=colour, linewidth=0.0, zorder=0.4, label=label)
            label = None


def _damping(ax: Axes, result: WhirlCampbell, top: float) -> None:
    _unstable(ax, result)
    ax.axhline(0.0, color=GREY, linewidth=0.8)
    for k, word in enumerate(result.whirl):
        if np.nanmin(result.frequencies[:, k]) <= top:
            ax.plot(result.speeds, result.damping_ratios[:, k], linewidth=1.3, **WHIRL_LOOK[word])
    largest = float(np.nanmax(np.abs(result.damping_ratios), initial=0.0))
    if largest < 1e-6:  # undamped: rounding shall not fill the picture
        ax.set_ylim(-0.01, 0.05)
    ax.set_xlabel(f"speed of {_reference(result)} [rad/s]")
    ax.set_ylabel("damping ratio [1]")
