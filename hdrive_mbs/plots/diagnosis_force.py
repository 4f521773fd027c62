"""Picture of the located latent force: what an unknown force must have been, over time, speed, torque, angle and twist."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

from hdrive_mbs.diagnosis.result import Diagnosis, LatentForce
from hdrive_mbs.errors import unknown_place
from hdrive_mbs.plots.diagnosis_look import WIDTH, FloatArray, binned, drawn_unit, needed, varies
from hdrive_mbs.plots.look import COLOURS, house_look, new_figure, readable

OVER = {"speed": "speed", "torque": "torque", "angle": "angle", "twist": "twist"}
UNITS = {"speed": "rad/s", "torque": "N m", "angle": "rad", "twist": "rad"}


def plot_force(
    diagnosis: Diagnosis, ax: Axes | None = None, *, at: str | None = None, way: str | None = None, record: str | None = None
) -> Axes:
    """The force over time, and against whatever of speed, torque, angle (within a revolution) and twist varies at its place.

    at, way, record : which; the first force if not given
    With ``ax`` only the force against speed (or what else varies first) is drawn, there.
    """
    force = _chosen(diagnosis, at, way, record)
    over = [name for name in OVER if varies(getattr(force, name), len(force.times))]
    with house_look():
        if ax is not None:
            _against(ax, force, over[0]) if over else _history(ax, force)
            return ax
        figure = new_figure(WIDTH, 2.2 + 1.9 * len(over))
        panels = list(np.atleast_1d(figure.subplots(1 + len(over), 1)))
        _history(panels[0], force)
        for panel, name in zip(panels[1:], over, strict=True):
            _against(panel, force, name)
        figure.align_ylabels(panels)
        parts = [f"unknown signal at {readable(force.at)}", force.way, f"record {readable(force.record)}" if force.record else ""]
        title = ", ".join(part for part in parts if part)
        figure.suptitle(title, x=0.01, ha="left", fontsize=10)
    first: Axes = panels[0]
    return first


def _chosen(diagnosis: Diagnosis, at: str | None, way: str | None, record: str | None) -> LatentForce:
    needed(diagnosis.forces, "latent force", "It is estimated at the places of a gap.")
    left = list(diagnosis.forces)
    for name, value in (("at", at), ("way", way), ("record", record)):
        known = [getattr(force, name) for force in left]
        if value is not None and value not in known:
            raise unknown_place("place" if name == "at" else name, value, dict.fromkeys(known), "Among the latent forces this diagnosis")
        left = [force for force in left if value in (None, getattr(force, name))]
    return left[0]


def _history(ax: Axes, force: LatentForce) -> None:
    size, unit = drawn_unit(force.unit, force.force)
    if len(force.spread) == len(force.times):
        low, high = (force.force - 2.0 * force.spread) / size, (force.force + 2.0 * force.spread) / size
        ax.fill_between(force.times, low, high, color=COLOURS[5], alpha=0.45, linewidth=0.0)
    ax.plot(force.times, force.force / size, color=COLOURS[0], linestyle="-", linewidth=0.9)
    ax.set_xlabel("time [s]")
    ax.set_ylabel(f"signal [{unit}]")
    ax.margins(x=0.0)


def _against(ax: Axes, force: LatentForce, over: str) -> None:
    size, unit = drawn_unit(force.unit, force.force)
    x, x_unit = _axis("twist" if over == "angle" and force.way == "torsion" else over, getattr(force, over))
    ax.plot(x, force.force / size, ".", markersize=1.4, color=COLOURS[0], alpha=0.35, rasterized=True)
    for sense, look in _senses(force, over):
        middle, mean, _, _ = binned(x[sense], force.force[sense] / size)
        ax.plot(middle, mean, **look)
    ax.set_xlabel(x_unit)
    ax.set_ylabel(f"signal [{unit}]")
    ax.margins(x=0.01)
    if ax.get_legend_handles_labels()[1]:
        ax.legend(loc="best", fontsize=8.5)


def _axis(over: str, values: FloatArray) -> tuple[FloatArray, str]:
    if over == "angle" and float(np.nanmax(values) - np.nanmin(values)) > 2.0 * np.pi:
        return np.mod(values, 2.0 * np.pi), "angle within a revolution [rad]"
    size, unit = drawn_unit(UNITS[over], values)
    return values / size, f"{over} [{unit}]"


def _senses(force: LatentForce, over: str) -> list[tuple[npt.NDArray[np.bool_], dict[str, Any]]]:
    """Both directions apart where they differ and the axis is not the speed itself."""
    every = np.ones(len(force.times), dtype=bool)
    if over == "speed" or not varies(force.speed, len(force.times)) or not (np.nanmin(force.speed) < 0.0 < np.nanmax(force.speed)):
        return [(every, {"color": "black", "linestyle": "-", "linewidth": 1.6})]
    return [
        (force.speed > 0.0, {"color": COLOURS[1], "linestyle": "-", "linewidth": 1.6, "label": "forward"}),
        (force.speed < 0.0, {"color": "black", "linestyle": "--", "linewidth": 1.6, "label": "backward"}),
    ]
