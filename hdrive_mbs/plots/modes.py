"""Picture of torsional mode shapes along the line."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

from hdrive_mbs.analysis.drive_train.modes import Modes
from hdrive_mbs.errors import AnalysisError
from hdrive_mbs.network.elements import Connection
from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.look import GREY, headed, house_look, legend_above, new_figure, number, style

FloatArray = npt.NDArray[np.float64]


@plot.register
def plot_modes(result: Modes, ax: Axes | None = None, *, one_axis: bool = True, most: int = 6) -> Axes:
    """Undamped shapes, one panel per mode; returns the first.

    one_axis : angles reduced to the motor's axis (each divided by the ideal speed ratio of its body), so
        that a geared train reads like one shaft; False shows the true angles
    most : how many modes are drawn
    With ``ax`` all shapes go there.
    """
    count = min(len(result.undamped), most)
    if count == 0:
        raise AnalysisError("There is no elastic mode at this operating point, so no shape to draw.")
    shapes, place = shown_shapes(result, one_axis), places_along_line(result)
    what = "angle reduced to the motor's axis" if one_axis else "angle, true sense"
    with house_look():
        if ax is not None:
            for k in range(count):
                _shape(ax, result, place, shapes[:, k], k, f"mode {k + 1}: {number(result.undamped[k])} rad/s")
            _bodies(ax, result, place)
            ax.set_ylabel(f"{what}, 0-peak, largest 1 [1]")
            legend_above(ax, columns=2)
            return ax
        columns = 2 if count == 4 else min(count, 3)
        rows = -(-count // columns)
        figure = new_figure(2.6 * columns + 0.6, 2.7 * rows + 1.0)
        axes = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False).ravel()
        for k in range(count):
            _shape(axes[k], result, place, shapes[:, k], 0, None)
            hertz = result.undamped[k] / (2.0 * np.pi)
            axes[k].set_title(
                f"mode {k + 1}: {number(result.undamped[k])}\u2009rad/s\n{number(hertz)}\u2009Hz{_damping(result, k)}", fontsize=9.5
            )
            _bodies(axes[k], result, place)
            axes[k].tick_params(labelbottom=k + columns >= count)
        for spare in axes[count:]:
            spare.remove()
        for k in range(0, count, columns):
            axes[k].set_ylabel(f"{what},\n0-peak, largest 1 [1]")
        axes[0].set_ylim(-1.12, 1.12)
        name = result.scene.name if result.scene is not None else "undamped modes"
        left = len(result.undamped) - count
        more = f", {left} more not drawn" if left else ""
        headed(figure, f"{name}: undamped modes at {result.motor_speed:.4g}\u2009rad/s of the motor{more}")
    first: Axes = axes[0]
    return first


def shown_shapes(result: Modes, one_axis: bool) -> FloatArray:
    """Shapes with largest entry 1; on one axis divided by the ratio of each body (NaN for one that stands)."""
    if not one_axis:
        return result.shapes
    if result.scene is None:
        raise AnalysisError("The modes came from a file without its scene, so the speed ratios are unknown; draw with one_axis=False.")
    ratios = {body.name: body.ratio for body in result.scene.network().bodies}
    ratio = np.array([ratios[name] if ratios[name] != 0.0 else np.nan for name in result.bodies])
    scaled = result.shapes / ratio[:, None]
    for k in range(scaled.shape[1]):
        largest = int(np.nanargmax(np.abs(scaled[:, k])))
        scaled[:, k] /= scaled[largest, k]
    return np.asarray(scaled, float)


def _damping(result: Modes, k: int) -> str:
    """Damping ratio, where undamped and damped modes correspond one to one."""
    if len(result.damped) != len(result.undamped):
        return ""
    return f", damping ratio {result.damping_ratio[k]:.2g}"


def _links(result: Modes) -> list[tuple[int, int]]:
    """Pairs of bodies that a connection joins."""
    index = {name: k for k, name in enumerate(result.bodies)}
    if result.scene is None:
        return [(k, k + 1) for k in range(len(result.bodies) - 1)]
    pairs = []
    for element in result.scene.network().elements:
        if isinstance(element, Connection):
            ends = [index[name] for name in element.factors if name in index]
            pairs += [(ends[i], ends[j]) for i in range(len(ends)) for j in range(i + 1, len(ends))]
    return pairs


def places_along_line(result: Modes) -> list[int]:
    """Position of each body when the line is walked from one end (the motor's, if it is an end)."""
    near: dict[int, list[int]] = {k: [] for k in range(len(result.bodies))}
    for i, j in _links(result):
        near[i].append(j)
        near[j].append(i)
    ratios = {} if result.scene is None else {body.name: body.ratio for body in result.scene.network().bodies}
    ends = sorted(near, key=lambda k: (len(near[k]), abs(ratios.get(result.bodies[k], 1.0) - 1.0) > 1e-9, result.bodies[k]))
    walked: list[int] = []
    for start in ends:
        stack = [start]
        while stack:
            k = stack.pop()
            if k not in walked:
                walked.append(k)
                stack += near[k]
    return [walked.index(k) for k in range(len(result.bodies))]


def _shape(ax: Axes, result: Modes, place: list[int], shape: FloatArray, index: int, label: str | None) -> None:
    look = style(index)
    for i, j in _links(result):
        ax.plot([place[i], place[j]], [shape[i], shape[j]], **look)
    ax.plot(place, shape, color=look["color"], linestyle="none", marker="o", markersize=4.5)
    if label is not None:
        ax.plot([], [], marker="o", markersize=4.5, label=label, **look)


def _bodies(ax: Axes, result: Modes, place: list[int]) -> None:
    ax.axhline(0.0, color=GREY, linewidth=0.8, linestyle="-", zorder=0.5)
    names = [name.rpartition(".")[2].replace("_", " ") or name for name in result.bodies]
    ax.set_xticks(place, names, rotation=40, ha="right", rotation_mode="anchor")
    ax.set_xlim(-0.4, len(names) - 0.6)
