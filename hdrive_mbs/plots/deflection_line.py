"""Picture of a static deflection line with the bearing loads."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from scipy.interpolate import CubicHermiteSpline

from hdrive_mbs.analysis.unbalance.deflection_line import StaticDeflection
from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.look import GREY, given_or_new, house_look, legend_above, readable, style
from hdrive_mbs.plots.shafts import shaft_numbers

FloatArray = npt.NDArray[np.float64]


ROWS = 2
"""Rows in which the loads are written where bearings are close together."""

CLOSE = 0.2
"""Distance, as a share of the line, below which two bearings count as close together."""


@plot.register
def plot_static_deflection(result: StaticDeflection, ax: Axes | None = None) -> Axes:
    """Deflection in x and y along the shafts, with tilts as slopes between the places; loads below the bearings."""
    with house_look():
        fresh = ax is None
        ax = given_or_new(ax, 7.2, 4.2)
        numbers = shaft_numbers(result.scene, result.places)
        shafts: list[list[int]] = []
        for number in sorted(set(numbers)):
            own = [
                k
                for k, place in enumerate(result.places)
                if numbers[k] == number and not place.endswith(".housing") and np.isfinite(result.positions[k])
            ]
            kept = [k for i, k in enumerate(own) if i == 0 or result.positions[k] > result.positions[own[i - 1]]]
            shafts += [kept] if kept else []
        # x' = theta, y' = -psi: cubics are the exact shape of a slender shaft that carries no load between its stations
        for number, (key, slope) in enumerate((("y", -result.psi), ("x", result.theta))):
            values = 1e6 * getattr(result, key)
            look = style(number)
            label: str | None = f"{key} of the shaft"
            for kept in shafts:
                z = result.positions[kept]
                if len(kept) > 1:
                    fine = np.linspace(z[0], z[-1], 400)
                    ax.plot(fine, CubicHermiteSpline(z, values[kept], 1e6 * slope[kept])(fine), label=label, **look)
                    label = None
            alone = [k for kept in shafts for k in kept]
            ax.plot(result.positions[alone], values[alone], "o", color=look["color"], markersize=4, label=label)
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
        _loads(ax, result)
        ax.axhline(0.0, color=GREY, linewidth=0.8, linestyle="-", zorder=0.5)
        ax.margins(x=0.09, y=0.1)
        low, high = ax.get_ylim()
        ax.set_ylim(low - (0.1 + 0.13 * ROWS) * (high - low), high)  # room for the loads
        ax.set_xlabel("z along the shaft [m]")
        ax.set_ylabel("static deflection [µm]")
        if fresh:
            name = result.scene.name if result.scene is not None else "rotor line"
            ax.figure.figure.suptitle(f"{name}: static deflection at {result.speed:.4g} rad/s, bearing loads in x, y", x=0.01, ha="left")
        legend_above(ax, columns=4)
    return ax


def _loads(ax: Axes, result: StaticDeflection) -> None:
    """Name and load of each bearing at the foot of the picture, with a line up to it."""
    bearings = sorted((result[name]["z"], name) for name in result.bearings if name in result.places)
    largest = float(np.max(np.hypot(result.load_x, result.load_y), initial=0.0))
    finite = result.positions[np.isfinite(result.positions)]
    span = max(float(np.ptp(finite)) if finite.size else 0.0, 1e-12)
    row, before = 0, -np.inf
    for z, name in bearings:
        row = (row + 1) % ROWS if z - before < CLOSE * span else 0
        before = z
        x, y = (value if abs(value) > 1e-9 * largest else 0.0 for value in result.bearing_load(name))
        ax.axvline(z, color=GREY, linewidth=0.6, linestyle=":", zorder=0.4)
        ax.annotate(
            f"{readable(name)}\n{x:.4g}, {y:.4g} N",
            (z, 0.02 + 0.13 * row),
            xycoords=("data", "axes fraction"),
            ha="center",
            va="bottom",
            fontsize=8.5,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.6, "alpha": 0.8},
        )
