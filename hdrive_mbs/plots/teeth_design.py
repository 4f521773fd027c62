"""Picture of a design window: slices through the best point for every pair of variables."""

from __future__ import annotations

import itertools

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import Patch

from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.look import house_look, new_figure
from hdrive_mbs.teeth.design import DesignWindow
from hdrive_mbs.teeth.design_points import VARIABLES

SHORT = (
    "admissible",
    "no addendum left",
    "fibre in the teeth",
    "pointed tooth",
    "teeth join at the root",
    "tip in the root",
    "teeth do not reach",
    "tips meet on the starting axis",
    "tips clip on the way in",
    "flanks jam at full depth",
)
PAINT = ("#FFFFFF", "#4D4D4D", "#7F7F7F", "#E69F00", "#F0E442", "#D55E00", "#CCCCCC", "#CC79A7", "#56B4E9", "#0072B2")
NAMES = {"profile_angle": "profile angle [°]", "height": "tooth height [mm]", "clearance": "clearance [mm]", "amplitude": "w0 [mm]"}
SCALE = {"profile_angle": 180.0 / np.pi, "height": 1e3, "clearance": 1e3, "amplitude": 1e3}


@plot.register
def plot_design_window(
    result: DesignWindow, ax: Axes | None = None, *, x: str = "profile_angle", y: str = "amplitude", number: int = 40
) -> Axes:
    """What stops a design, over pairs of variables, the others at the best point; white is admissible, the cross the best point.

    With ``ax`` only the pair ``x``, ``y``.
    """
    with house_look():
        if ax is not None:
            seen = _slice(ax, result, x, y, number)
            _legend(ax, seen)
            return ax
        figure = new_figure(10.2, 6.4)
        axes = figure.subplots(2, 3).ravel()
        seen = set()
        for panel, (first, second) in zip(axes, itertools.combinations(VARIABLES, 2)):
            seen |= _slice(panel, result, first, second, number)
        handles = [Patch(facecolor=PAINT[k], edgecolor="#444444", linewidth=0.5, label=SHORT[k]) for k in sorted(seen)]
        figure.legend(handles=handles, loc="outside lower center", ncols=min(5, len(handles)))
        task = result.task
        figure.suptitle(
            f"Design window, {task.flexible_teeth}/{task.rigid_teeth} teeth, module {1e3 * task.module:.4g} mm, "
            f"backlash {1e6 * task.backlash:.3g} µm: {np.sum(result.points.admissible)} of {len(result.points.verdict)} designs admissible",
            x=0.01,
            ha="left",
        )
    first_axes: Axes = axes[0]
    return first_axes


def _slice(ax: Axes, result: DesignWindow, x: str, y: str, number: int) -> set[int]:
    points = result.slice(x, y, number)
    verdict = points.verdict.reshape(number, number)
    paint, norm = ListedColormap(PAINT), BoundaryNorm(np.arange(-0.5, len(PAINT)), len(PAINT))
    across, up = (np.linspace(*result.box[name], number) * SCALE[name] for name in (x, y))
    ax.pcolormesh(across, up, verdict, cmap=paint, norm=norm, shading="nearest")
    if result.best:
        ax.plot([result.best[x] * SCALE[x]], [result.best[y] * SCALE[y]], "+", color="black", markersize=9, markeredgewidth=1.6)
    ax.grid(False)
    ax.set_xlabel(NAMES[x])
    ax.set_ylabel(NAMES[y])
    return set(np.unique(verdict).tolist())


def _legend(ax: Axes, seen: set[int]) -> None:
    handles = [Patch(facecolor=PAINT[k], edgecolor="#444444", linewidth=0.5, label=SHORT[k]) for k in sorted(seen)]
    ax.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, borderaxespad=0.2)
