"""Picture of a torsion curve, as catalogues draw it: torque to the right, angle upwards."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from hdrive_mbs.analysis.drive_train.torsion import TorsionCurve
from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.look import GREY, given_or_new, house_look, legend_above, number, other_unit, readable, style

ARCMIN_PER_MRAD = 180.0 * 60.0 / (np.pi * 1e3)


@plot.register
def plot_torsion(result: TorsionCurve, ax: Axes | None = None, *, label: str | None = None) -> Axes:
    """Angle over torque with lost motion and corners (seed F, Fig. 5); the right scale is in minutes of arc."""
    with house_look():
        fresh = ax is None
        ax = given_or_new(ax)
        drawn = len([line for line in ax.get_lines() if not str(line.get_label()).startswith("_")])
        name = label or _label(result)
        order = np.arange(len(result.torque)) if result.loss else np.argsort(result.torque, kind="stable")
        torque, angle = result.torque[order], 1e3 * result.angle[order]
        ax.plot(torque, angle, label=name, **style(drawn))
        for corner, at in zip(result.corner_torque, result.corner_angle, strict=True):
            _corner(ax, float(corner), 1e3 * float(at))
        if result.lost_motion > 0.0:
            _gap(ax, 1e3 * result.gap[0], 1e3 * result.gap[1])
        ax.set_xlabel("torque [N\u2009m]")
        ax.set_ylabel("torsion angle [mrad]")
        if fresh:
            right = ax.secondary_yaxis("right", functions=other_unit(ARCMIN_PER_MRAD))
            right.set_ylabel("torsion angle [arcmin]")
            right.spines["right"].set_visible(True)
        legend_above(ax, columns=1)
    return ax


def _label(result: TorsionCurve) -> str:
    text = readable(result.measured)
    if result.lost_motion > 0.0:
        width = 1e3 * result.lost_motion
        text += f", lost motion {number(width)}\u2009mrad = {number(width * ARCMIN_PER_MRAD)}\u2009arcmin"
    return f"{text}, slow loop with {result.loss:.3g}\u2009J lost per cycle" if result.loss else text


def _corner(ax: Axes, torque: float, angle: float) -> None:
    ax.plot([torque], [angle], "o", color=GREY, markersize=4.5, label="_corner")
    ax.annotate(
        f"{torque:.4g}\u2009N\u2009m\n{angle:.3g}\u2009mrad",
        (torque, angle),
        xytext=(7, -5),
        textcoords="offset points",
        va="top",
        fontsize=8.5,
        color="#333333",
    )


def _gap(ax: Axes, lower: float, upper: float) -> None:
    """The lost motion as an arrow at zero torque."""
    ax.annotate(
        "", (0.0, upper), (0.0, lower), arrowprops={"arrowstyle": "<->", "color": GREY, "shrinkA": 0, "shrinkB": 0, "linewidth": 1.0}
    )
