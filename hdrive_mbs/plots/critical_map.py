"""Picture of a critical speed map."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from hdrive_mbs.analysis.whirl.critical_map import CriticalSpeedMap
from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.look import COLOURS, GREY, given_or_new, house_look, legend_above, number, other_unit, readable
from hdrive_mbs.plots.point_names import name_point

LOOK = {"forward": ("-", COLOURS[0]), "backward": ("--", COLOURS[1]), "mixed": ("-", COLOURS[0])}


@plot.register
def plot_critical_map(
    result: CriticalSpeedMap, ax: Axes | None = None, *, curves: Mapping[str, tuple[Sequence[float], Sequence[float]]] | None = None
) -> Axes:
    """Undamped critical speeds over support stiffness, both logarithmic.

    curves : bearing -> (speeds [rad/s], stiffness [N/m]): its own stiffness over speed, with the critical speeds where
        branches meet it
    """
    with house_look():
        fresh = ax is None
        ax = given_or_new(ax, 7.2, 4.8)
        seen: set[str] = set()
        for k, whirl in enumerate(result.whirl):
            line, colour = LOOK[whirl]
            single = {"marker": "o", "markersize": 4} if len(result.stiffness) == 1 else {}
            ax.plot(
                result.stiffness,
                result.speeds[:, k],
                linestyle=line,
                color=colour,
                label=None if whirl in seen else f"{whirl} whirl",
                **single,  # type: ignore[arg-type]
            )
            seen.add(whirl)
        for k, (name, (speeds, stiffness)) in enumerate((curves or {}).items()):
            ax.plot(stiffness, speeds, color=GREY, linestyle=(":", "-.")[k % 2], linewidth=1.6, label=f"stiffness of {readable(name)}")
            for whirl, speed, at in result.crossings(speeds, stiffness):
                ax.plot([at], [speed], "o", color=LOOK[whirl][1], markersize=5, markerfacecolor="white", markeredgewidth=1.2)
                name_point(ax, number(speed), at, speed)
        ax.set_xscale("log")
        ax.set_yscale("log")
        ax.set_xlabel("support stiffness [N/m]")
        ax.set_ylabel("undamped critical speed [rad/s]")
        if np.isfinite(result.speeds).any():
            ax.margins(x=0.0)
        if fresh:
            right = ax.secondary_yaxis("right", functions=other_unit(30.0 / np.pi))
            right.set_ylabel("[rpm]")
            right.spines["right"].set_visible(True)
            name = result.scene.name if result.scene is not None else "rotor line"
            order = "" if result.order == 1.0 else f", whirl at {result.order:g} x speed"
            ax.figure.figure.suptitle(f"{name}: critical speed map{order}", x=0.01, ha="left")
        legend_above(ax)
    return ax
