"""Picture of an orbit."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from hdrive_mbs.analysis.signals.orbit import Orbit
from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.lengths import shown_unit
from hdrive_mbs.plots.look import COLOURS, given_or_new, house_look, legend_above, number, readable

COLOUR_MAP = "viridis"
DRAWN_AS_PICTURE = 3000
"""Pieces of a path above which an SVG holds it as pixels."""

MOST_MARKS = 60
"""Key-phase points drawn."""

CHANGING = 0.02
"""Change of speed above which the path is coloured by it."""

ASIDE = 0.2
"""Size of a path over its distance from the origin below which the picture shows the path alone: whirl about a large sag."""

WORDS = {"axis": "from the axis", "static": "from the static position", "mean": "from its mean"}


@plot.register
def plot_orbit(result: Orbit, ax: Axes | None = None, *, marks: bool = True) -> Axes:
    """The path in x and y with equal scales, coloured by the speed where that changes; without the origin where that is far off.

    marks : points where the spin angle is a whole number of revolutions
    """
    with house_look():
        fresh = ax is None
        ax = given_or_new(ax, 5.8, 5.6)
        speed = np.abs(result.speed)
        furthest = float(np.max(np.abs(np.concatenate([result.x, result.y])), initial=0.0))
        factor, unit = shown_unit(result.unit, furthest)
        x, y = factor * result.x, factor * result.y
        if np.ptp(speed) > CHANGING * speed.max():
            points = np.stack([x, y], axis=1)
            pieces = np.stack([points[:-1], points[1:]], axis=1)
            lines = LineCollection(list(pieces), cmap=COLOUR_MAP, linewidths=0.8, rasterized=len(pieces) > DRAWN_AS_PICTURE)
            lines.set_array(0.5 * (speed[1:] + speed[:-1]))
            ax.add_collection(lines)
            if fresh:
                ax.figure.figure.colorbar(lines, ax=ax, label="speed [rad/s]", shrink=0.85)
        else:
            ax.plot(x, y, color=COLOURS[0], linestyle="-", linewidth=1.2)
        if marks and 0 < len(result.marks) <= MOST_MARKS:
            ax.plot(*(factor * result.marks.T), "o", color=COLOURS[1], markersize=3.5, label="once per revolution")
        ax.plot([x[0]], [y[0]], ">", color="black", markersize=5.0, label="start")
        ax.plot([x[-1]], [y[-1]], "s", color="black", markersize=4.0, label="end")
        (left, right), (low, high) = (x.min(), x.max()), (y.min(), y.max())
        size = 0.5 * max(right - left, high - low)
        if 0.0 < size < ASIDE * factor * furthest:
            across, up, reach = 0.5 * (left + right), 0.5 * (low + high), 1.2 * size
        else:
            across, up, reach = 0.0, 0.0, 1.08 * factor * furthest or 1.0
        ax.set_xlim(across - reach, across + reach)
        ax.set_ylim(up - reach, up + reach)
        ax.set_aspect("equal")
        words = "" if result.unit == "N" and result.about == "axis" else f", counted {WORDS[result.about]}"
        ax.set_xlabel(f"x{words} [{unit}]")
        ax.set_ylabel(f"y{words} [{unit}]")
        legend_above(ax)
        if fresh:
            ax.figure.figure.suptitle(_title(result), x=0.01, ha="left", fontsize=10)
    return ax


def _title(result: Orbit) -> str:
    place = readable(result.place) if result.centre == "geometric" else f"centre of mass of {readable(result.place)}"
    first, last = abs(result.speed[0]), abs(result.speed[-1])
    speeds = f"{first:.4g} to {last:.4g}" if abs(first - last) > CHANGING * max(first, last) else f"{np.mean(np.abs(result.speed)):.4g}"
    text = f"{place}, {result.times[0]:.4g} to {result.times[-1]:.4g} s, {speeds} rad/s: {result.precession} precession"
    if math.isfinite(result.forward):
        factor, unit = shown_unit(result.unit, result.major)
        circles = f"forward {number(factor * result.forward)}\u2009{unit}, backward {number(factor * result.backward)}\u2009{unit}"
        text += f"\nonce per revolution, 0-peak: {circles}"
    return text
