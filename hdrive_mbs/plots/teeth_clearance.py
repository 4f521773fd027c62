"""Pictures of clearances: along the engagement, and over generator angle and w0."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import TwoSlopeNorm

from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.look import COLOURS, GREY, given_or_new, house_look, legend_above
from hdrive_mbs.teeth.clearance import Clearances
from hdrive_mbs.teeth.clearance_map import ClearanceMap


@plot.register
def plot_clearances(result: Clearances, ax: Axes | None = None) -> Axes:
    """Distance of the tooth outlines over the generator angle, with the zones of common height."""
    angle = np.degrees(result.angles)
    with house_look():
        fresh = ax is None
        ax = given_or_new(ax)
        ax.plot(angle, 1e6 * result.gap, color=COLOURS[0], linestyle="-", label="distance to the nearer rigid tooth")
        ax.axhline(0.0, color=GREY, linewidth=0.8, linestyle="-")
        ax.plot(
            [angle[result.worst]],
            [1e6 * result.minimum],
            "o",
            color=COLOURS[1],
            markersize=5,
            label=f"smallest, {1e6 * result.minimum:.1f}\u2009µm at {angle[result.worst]:.1f}°",
        )
        inside = ax.fill_between(
            angle, 0.0, 1.0, where=result.in_mesh.tolist(), transform=ax.get_xaxis_transform(), color="#EFEFEF", zorder=0.3
        )
        inside.set_label("teeth have a common height")
        ax.set_xlim(0.0, 360.0)
        ax.set_xticks(range(0, 361, 45))
        ax.set_xlabel("generator angle from the starting axis [°]")
        ax.set_ylabel("distance of the outlines [µm]")
        legend_above(ax, columns=2)
        if fresh:
            ax.figure.suptitle(f"{result.stage.name}: {'interference' if result.interferes else 'no interference'}", x=0.01, ha="left")
    return ax


@plot.register
def plot_clearance_map(result: ClearanceMap, ax: Axes | None = None) -> Axes:
    """Distance of the outlines over generator angle and w0; red is interference, the line is contact."""
    gap = 1e6 * result.gap
    now = 1e3 * result.stage.deformation.on_major_axis
    with house_look():
        ax = given_or_new(ax, 7.2, 4.6)
        x, y = np.degrees(result.angles), 1e3 * result.amplitudes
        largest = float(np.nanmax(np.abs(gap[np.isfinite(gap)])))
        low = float(min(np.nanmin(gap), -0.02 * largest))
        picture = ax.pcolormesh(
            x,
            y,
            gap,
            cmap="RdBu",
            norm=TwoSlopeNorm(vcenter=0.0, vmin=low, vmax=max(float(np.nanmax(gap)), 0.02 * largest)),
            shading="nearest",
        )
        if np.nanmin(gap) < 0.0 < np.nanmax(gap):
            ax.contour(x, y, gap, levels=[0.0], colors="black", linewidths=1.2)
        ax.axhline(now, color="black", linewidth=1.0, linestyle="--")
        ax.annotate(f"w0 = {now:.3g}\u2009mm", (x[0], now), xytext=(4, 3), textcoords="offset points", fontsize=9)
        ax.set_facecolor("#BBBBBB")
        ax.grid(False)
        ax.set_xticks(np.arange(0.0, x[-1] + 1.0, 30.0))
        ax.set_xlabel("generator angle from the starting axis [°]")
        ax.set_ylabel("w0 on the major axis [mm]")
        ax.set_title(f"{result.stage.name}: distance of the tooth outlines (grey: cannot be built)")
        bar = ax.figure.colorbar(picture, ax=ax)
        bar.set_label("distance [µm], negative: interference")
    return ax
