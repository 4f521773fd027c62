"""Picture of successive tooth positions: seed I, Figs. 3 and 5, and the trajectories of P and R."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.look import COLOURS, GREY, house_look, new_figure
from hdrive_mbs.teeth.motion import ToothMotion, placed, tooth_motion
from hdrive_mbs.teeth.section import rigid_teeth, tooth_line


@plot.register
def plot_positions(result: ToothMotion, ax: Axes | None = None, *, outlines: bool = True, labels: bool = True) -> Axes:
    """Positions of one flexible tooth against the rigid wheel, in the paper's frame, in mm.

    outlines : draw the tooth at each angle, not only the points P and R
    labels : write the generator angle at every third P
    """
    stage = result.stage
    with house_look():
        if ax is None:
            ax = new_figure(7.2, 4.6).add_subplot()
        draw_rigid(ax, result)
        fine = tooth_motion(stage, np.linspace(result.angles[0], result.angles[-1], 361), exact=result.exact)
        if outlines:
            teeth = 1e3 * (placed(stage, tooth_line(stage, True), result.angles) - np.array([0.0, stage.fibre_radius]))
            for k, tooth in enumerate(teeth):
                ax.plot(
                    tooth[:, 0], tooth[:, 1], color=COLOURS[0], linestyle="-", linewidth=0.7, label="flexible tooth" if k == 0 else None
                )
        for points, line, name, colour in ((result.P, fine.P, "P, tip", COLOURS[1]), (result.R, fine.R, "R, root", COLOURS[2])):
            ax.plot(1e3 * line[:, 0], 1e3 * line[:, 1], color=colour, linestyle="-", linewidth=1.2)
            ax.plot(1e3 * points[:, 0], 1e3 * points[:, 1], "o", color=colour, markersize=3.5, label=name)
        if labels:
            _angles(ax, result)
        ax.set_aspect("equal")
        ax.set_xlabel("x, along the tangent [mm]")
        ax.set_ylabel("y, outwards from the undeformed fibre [mm]")
        step = np.degrees(result.angles[1] - result.angles[0]) if len(result.angles) > 1 else 0.0
        motion = "exact" if result.exact else "first order, as printed (corrected)"
        ax.set_title(f"{stage.name}: every {step:.4g}° of the generator from the starting axis, {motion}", pad=22)
        ax.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=4, borderaxespad=0.2)
    return ax


def draw_rigid(ax: Axes, result: ToothMotion) -> None:
    """The rigid teeth that the flexible one passes, filled."""
    stage = result.stage
    ends = np.sort([result.P[0, 0], result.P[-1, 0]]) / (stage.rigid.pitch_angle * stage.rigid.tip_radius)
    numbers = np.arange(np.floor(ends[0] - 0.5), np.ceil(ends[1] + 0.5) + 1.0)
    line = 1e3 * (rigid_teeth(stage, numbers).reshape(-1, 2) - np.array([0.0, stage.fibre_radius]))
    back = 1e3 * stage.direction * 0.35 * stage.rigid.height
    body = np.vstack((line, line[::-1][[0, -1]]))
    edge = np.max(line[:, 1]) if stage.direction > 0 else np.min(line[:, 1])
    body[-2:, 1] = edge + back
    ax.add_patch(Polygon(body, closed=True, facecolor="#E4E4E4", edgecolor="none", zorder=0.5, label="rigid wheel"))
    ax.plot(line[:, 0], line[:, 1], color=GREY, linestyle="-", linewidth=1.2)
    for point, name in ((result.M, "M"), (result.N, "N")):
        ax.plot([1e3 * point[0]], [1e3 * point[1]], "s", color="black", markersize=3.5)
        ax.annotate(name, (1e3 * point[0], 1e3 * point[1]), xytext=(5, 0), textcoords="offset points", va="center", fontsize=9)
    pitch = 1e3 * stage.rigid.pitch_angle * stage.rigid.tip_radius
    ax.set_xlim(1e3 * np.min(result.P[:, 0]) - 0.6 * pitch, 1e3 * np.max(result.P[:, 0]) + 0.6 * pitch)


def _angles(ax: Axes, result: ToothMotion) -> None:
    """Angles beside every third P, outside the trajectory; those closer together than a letter is high are left out."""
    points = 1e3 * result.P
    middle = 0.5 * (np.min(points[:, 0]) + np.max(points[:, 0]))
    written: list[tuple[float, float]] = []
    for k in range(0, len(points), 3):
        x, y = points[k]
        if any(np.hypot(x - a, y - b) < 0.06 * np.ptp(points[:, 0]) for a, b in written):
            continue
        written.append((x, y))
        right = x >= middle
        ax.annotate(
            f"{np.degrees(result.angles[k]):.0f}°",
            (x, y),
            xytext=(6 if right else -6, 0),
            textcoords="offset points",
            ha="left" if right else "right",
            va="center",
            fontsize=8,
            color=COLOURS[1],
            bbox={"facecolor": "white", "alpha": 0.75, "edgecolor": "none", "pad": 0.6},
        )
