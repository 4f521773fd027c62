"""Picture of the mode shapes of a rotor line along its axis."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

from hdrive_mbs.analysis.whirl.station_shapes import DIRECTIONS
from hdrive_mbs.analysis.whirl.whirl_modes import WhirlModes
from hdrive_mbs.errors import AnalysisError
from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.look import GREY, headed, house_look, legend_above, new_figure, number, readable, style
from hdrive_mbs.plots.shafts import drive_order, shaft_numbers

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

POINTS = 20
"""Points of the curve between two places."""

TOP = 1.12
"""End of the axis of amplitudes; further out where a shaft bends further between its places."""


@plot.register
def plot_whirl_modes(result: WhirlModes, ax: Axes | None = None, *, mode: int = 1, most: int = 6) -> Axes:
    """Shapes along the axis, one panel a mode; returns the first.

    Lateral modes: x and y, each at the moment at which it is largest (for circles a quarter turn apart), the curve
    between places drawn with their tilts.  Torsional modes: spin angle; axial modes: z.

    mode : number of the mode (from 1) that is drawn where ``ax`` is given;  most : panels of a new figure
    """
    count = min(len(result.frequencies), most)
    if count == 0:
        raise AnalysisError("There is no oscillating mode, so no shape to draw.")
    with house_look():
        if ax is not None:
            if not 1 <= mode <= len(result.frequencies):
                raise AnalysisError(f"mode = {mode}: this result has the modes 1 to {len(result.frequencies)}.")
            _shape(ax, result, mode - 1)
            ax.set_ylabel("motion, 0-peak, largest 1 [1]")
            legend_above(ax)
            return ax
        columns = 2 if count == 4 else min(count, 3)
        rows = -(-count // columns)
        figure = new_figure(3.1 * columns + 0.5, 2.5 * rows + 0.9)
        axes = figure.subplots(rows, columns, squeeze=False).ravel()
        for k in range(count):
            _shape(axes[k], result, k)
            axes[k].set_title(_title(result, k), fontsize=9)
        for spare in axes[count:]:
            spare.remove()
        for k in range(0, count, columns):
            axes[k].set_ylabel("motion, 0-peak,\nlargest 1 [1]")
        name = result.scene.name if result.scene is not None else "rotor line"
        left = len(result.frequencies) - count
        more = f", {left} more not drawn" if left else ""
        headed(figure, f"{name}: damped modes at {number(result.speed)}\u2009rad/s{more}")
        handles = {label: handle for one in axes[:count] for handle, label in zip(*one.get_legend_handles_labels(), strict=True)}
        figure.legend(handles.values(), handles.keys(), loc="outside lower left", ncols=6)
    first: Axes = axes[0]
    return first


def _title(result: WhirlModes, k: int) -> str:
    frequency = float(result.frequencies[k])
    hertz = number(frequency / (2.0 * np.pi))
    ratio = float(result.damping_ratios[k])
    damping = f"damping ratio {ratio:.2g}" if abs(ratio) > 1e-9 else "undamped"
    return f"mode {k + 1}: {result.whirl[k]}, {damping}\n{number(frequency)}\u2009rad/s, {hertz}\u2009Hz"


def _shape(ax: Axes, result: WhirlModes, k: int) -> None:
    motion = dict(zip(DIRECTIONS, result.shapes[k].T, strict=True))
    word = result.whirl[k]
    ax.axhline(0.0, color=GREY, linewidth=0.8, linestyle="-", zorder=0.5)
    ax.set_ylim(-TOP, TOP)
    if word == "torsional" and np.any(np.isnan(result.positions)):
        _by_place(ax, result, _at_largest(motion["phi"]))
        return
    shown = np.isfinite(result.positions) & (np.abs(result.shapes[k]).max(axis=1) > 0.0)
    on_shaft = shown & np.array([not place.endswith(".housing") for place in result.places])
    curves: list[tuple[str, FloatArray, FloatArray | None, int]]
    if word == "torsional":
        curves = [("spin angle", _at_largest(motion["phi"]), None, 2)]
    elif word == "axial":
        curves = [("z", _at_largest(motion["z"]), None, 3)]
    else:
        curves = [
            ("x", *_together(motion["x"], motion["theta"]), 0),
            ("y", *_together(motion["y"], -motion["psi"]), 1),
        ]
    shafts = np.array(shaft_numbers(result.scene, result.places))
    for label, values, slopes, look in curves:
        z = result.positions
        pieces = [_curve(z[own], values[own], None if slopes is None else slopes[own]) for own in _shafts(shafts, on_shaft)]
        along = np.concatenate([np.append(piece[0], np.nan) for piece in pieces])
        across = np.concatenate([np.append(piece[1], np.nan) for piece in pieces])
        ax.plot(along, across, label=label, **style(look))
        top = max(ax.get_ylim()[1], 1.06 * float(np.nanmax(np.abs(across), initial=0.0)))
        ax.set_ylim(-top, top)
        ax.plot(z[on_shaft], values[on_shaft], color=style(look)["color"], linestyle="none", marker="o", markersize=3.5)
        beside = shown & ~on_shaft
        if beside.any() and slopes is not None:
            ax.plot(
                z[beside],
                values[beside],
                color=style(look)["color"],
                linestyle="none",
                marker="s",
                markersize=4.5,
                markerfacecolor="none",
                label=f"housings, {label}",
            )
    ax.set_xlabel("position z [m]")


def _at_largest(values: ComplexArray) -> FloatArray:
    """Values at the moment at which the largest of them is real."""
    return _together(values, np.zeros_like(values))[0]


def _together(values: ComplexArray, slopes: ComplexArray) -> tuple[FloatArray, FloatArray]:
    """Values and slopes at the moment at which the largest value has no imaginary part."""
    largest = values[np.argmax(np.abs(values))]
    turn = np.conj(largest) / abs(largest) if abs(largest) > 1e-9 else 1.0
    return np.real(values * turn), np.real(slopes * turn)


def _shafts(numbers: npt.NDArray[np.int_], shown: npt.NDArray[np.bool_]) -> list[npt.NDArray[np.bool_]]:
    """The shown places of each shaft."""
    return [shown & (numbers == number) for number in np.unique(numbers[shown])]


def _curve(z: FloatArray, values: FloatArray, slopes: FloatArray | None) -> tuple[FloatArray, FloatArray]:
    """Cubics from place to place with the tilts as slopes, or straight lines; places at the same position are not joined."""
    if slopes is None:
        return z, values
    along, across = [z[:1]], [values[:1]]
    for a, b in pairwise(range(len(z))):
        length = z[b] - z[a]
        if length <= 0.0:
            continue
        s = np.linspace(0.0, 1.0, POINTS)[1:]
        cubic = (1.0 - s) ** 2 * ((1.0 + 2.0 * s) * values[a] + length * s * slopes[a])
        cubic = cubic + s**2 * ((3.0 - 2.0 * s) * values[b] - length * (1.0 - s) * slopes[b])
        along.append(z[a] + length * s)
        across.append(cubic)
    return np.concatenate(along), np.concatenate(across)


def _by_place(ax: Axes, result: WhirlModes, values: FloatArray) -> None:
    """Spin angles of a line of which not every place has a position, from the motor on."""
    turning = [k for k in drive_order(result.scene, result.places) if not result.places[k].endswith(".housing")]
    ax.plot(range(len(turning)), values[turning], marker="o", markersize=4, label="spin angle", **style(2))
    names = [readable(result.places[k]) for k in turning]
    ax.set_xticks(range(len(turning)), names, rotation=60, ha="right", rotation_mode="anchor", fontsize=7)
