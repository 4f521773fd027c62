"""Picture of a static deflection line with the bearing loads."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from scipy.interpolate import CubicHermiteSpline

from hdrive_mbs.analysis.deflection_line import StaticDeflection
from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.look import GREY, given_or_new, house_look, legend_above, readable, style

FloatArray = npt.NDArray[np.float64]


@plot.register
def plot_static_deflection(result: StaticDeflection, ax: Axes | None = None) -> Axes:
    """Deflection in x and y along the shaft, with tilts as slopes between the places; loads beside the bearings."""
    with house_look():
        fresh = ax is None
        ax = given_or_new(ax, 7.2, 4.2)
        on_shaft = [k for k, place in enumerate(result.places) if not place.endswith(".housing") and np.isfinite(result.positions[k])]
        kept = [k for i, k in enumerate(on_shaft) if i == 0 or result.positions[k] > result.positions[on_shaft[i - 1]]]
        z = result.positions[kept]
        # x' = theta, y' = -psi: cubics are the exact shape of a slender shaft that carries no load between its stations
        for number, (key, slope) in enumerate((("y", -result.psi), ("x", result.theta))):
            values = 1e6 * getattr(result, key)
            look = style(number)
            if len(kept) > 1:
                fine = np.linspace(z[0], z[-1], 400)
                ax.plot(fine, CubicHermiteSpline(z, values[kept], 1e6 * slope[kept])(fine), label=f"{key} of the shaft", **look)
            ax.plot(z, values[kept], "o", color=look["color"], markersize=4, label=f"{key} of the shaft" if len(kept) == 1 else None)
            housings = [k for k, place in enumerate(result.places) if place.endswith(".housing") and np.isfinite(result.positions[k])]
            if housings:
                ax.plot(
                    result.positions[housings],
                    values[housings],
                    "s",
                    color=look["color"],
                    markersize=5,
                    markerfacecolor="white",
                    label=f"{key} of housings",
                )
        for bearing in result.bearings:
            place = bearing if bearing in result.places else None
            if place is not None:
                largest = float(np.max(np.hypot(result.load_x, result.load_y)))
                x, y = (value if abs(value) > 1e-9 * largest else 0.0 for value in result.bearing_load(bearing))
                at = result[place]
                ax.annotate(
                    f"{readable(bearing)}\n{x:.4g}, {y:.4g} N",
                    (at["z"], 1e6 * at["y"]),
                    xytext=(0, 8),
                    textcoords="offset points",
                    ha="center",
                    fontsize=8.5,
                )
        ax.axhline(0.0, color=GREY, linewidth=0.8, linestyle="-", zorder=0.5)
        ax.margins(y=0.25)
        ax.set_xlabel("z along the shaft [m]")
        ax.set_ylabel("static deflection [µm]")
        if fresh:
            name = result.scene.name if result.scene is not None else "rotor line"
            ax.figure.figure.suptitle(f"{name}: static deflection at {result.speed:.4g} rad/s, bearing loads in x, y", x=0.01, ha="left")
        legend_above(ax, columns=4)
    return ax
