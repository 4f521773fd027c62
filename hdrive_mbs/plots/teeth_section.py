"""Picture of a wave gear in section: all wheels, flexspline and generator, and the teeth on both axes."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import PathPatch, Polygon
from matplotlib.path import Path

from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.look import COLOURS, GREY, house_look, new_figure, number
from hdrive_mbs.teeth.deformation import FloatArray
from hdrive_mbs.teeth.gear import WaveGear
from hdrive_mbs.teeth.section import around, fibre_line

FLEXIBLE = "#9CC9E6"
RIGID = ("#D9D9D9", "#F0D9B5")


@plot.register
def plot_section(result: WaveGear, ax: Axes | None = None, *, phase: float = 0.0) -> Axes:
    """The gear with the generator's major axis upwards, in mm; without ``ax`` also the teeth on the major and the minor axis.

    phase : generator angle phi [rad] against the flexspline, so other teeth come to the axes
    """
    with house_look():
        if ax is not None:
            _draw(ax, result, phase)
            return ax
        figure = new_figure(10.5, 6.6)
        grid = figure.add_gridspec(2, 2, width_ratios=(2.0, 1.0))
        whole = figure.add_subplot(grid[:, 0])
        _draw(whole, result, phase)
        whole.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, borderaxespad=0.2)
        figure.suptitle(f"{type(result).__name__}, ratio {number(result.ratio)}", x=0.01, ha="left")
        radius = 1e3 * result.stages()[0].fibre_radius
        radii = [r for stage in result.stages() for wheel in (stage.flexible, stage.rigid) for r in (wheel.tip_radius, wheel.root_radius)]
        reach = max(abs(1e3 * r - radius) for r in radii)
        views = {
            "on the major axis": (0.0, radius, figure.add_subplot(grid[0, 1])),
            "on the minor axis": (radius, 0.0, figure.add_subplot(grid[1, 1])),
        }
        for name, (x, y, close) in views.items():
            _draw(close, result, phase)
            half = 1.1 * reach
            close.set_xlim(x - half, x + half)
            close.set_ylim(y - half, y + half)
            close.set_title(name)
    return whole


def _draw(ax: Axes, gear: WaveGear, phase: float) -> None:
    stages = gear.stages()
    outer = around(stages[0], phase)
    rim = stages[0].flexible.root_radius - stages[0].fibre_radius
    inner = around(stages[1], phase) if len(stages) > 1 else None
    bore = inner[0] if inner is not None else fibre_line(stages[0], -rim)
    ring = outer[1]
    edge = np.max(np.hypot(ring[:, 0], ring[:, 1])) + 2.5 * stages[0].rigid.height
    _between(ax, _circle(edge), ring, RIGID[0], "circular spline")
    _between(ax, outer[0], bore, FLEXIBLE, "flexspline")
    if inner is not None:
        wheel = inner[1]
        smallest = np.min(np.hypot(wheel[:, 0], wheel[:, 1])) - 2.5 * stages[1].rigid.height
        _between(ax, wheel, _circle(smallest), RIGID[1], "output wheel")
        cam = fibre_line(stages[0], -(stages[0].fibre_radius - stages[1].flexible.root_radius))
        ax.plot(1e3 * cam[:, 0], 1e3 * cam[:, 1], color=GREY, linestyle=":", linewidth=0.9, label="wave generator, beside the teeth")
    else:
        ax.add_patch(Polygon(1e3 * bore, closed=True, facecolor="#F3F3F3", edgecolor=GREY, linewidth=0.6, label="wave generator"))
    fibre = fibre_line(stages[0])
    ax.plot(1e3 * fibre[:, 0], 1e3 * fibre[:, 1], color=COLOURS[1], linestyle="--", linewidth=0.9, label="neutral fibre")
    ax.set_aspect("equal")
    limit = 1.02e3 * edge
    ax.set_xlim(-limit, limit)
    ax.set_ylim(-limit, limit)
    ax.grid(False)
    ax.set_xlabel("[mm]")
    ax.set_ylabel("[mm]")


def _circle(radius: float) -> FloatArray:
    angle = np.linspace(0.0, 2.0 * np.pi, 361)
    return radius * np.stack((np.sin(angle), np.cos(angle)), axis=-1)


def _between(ax: Axes, outside: FloatArray, inside: FloatArray, colour: str, label: str) -> None:
    """Fill between two closed contours, whichever way they run."""
    rings = []
    for points, wanted in ((outside, 1.0), (inside, -1.0)):
        x, y = points[:, 0], points[:, 1]
        area = np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))
        rings.append(points if np.sign(area) == wanted else points[::-1])
    paths = [Path(1e3 * np.vstack((ring, ring[:1])), closed=True) for ring in rings]
    ax.add_patch(PathPatch(Path.make_compound_path(*paths), facecolor=colour, edgecolor="#444444", linewidth=0.4, label=label))
