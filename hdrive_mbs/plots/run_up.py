"""Picture of a run-up: speed over time, and the whirl of every rotor over its speed (seed M, Figs. 6 and 10)."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from hdrive_mbs.analysis.run_up.run_up import RunUp
from hdrive_mbs.analysis.whirl.rotor_places import spin_ratios
from hdrive_mbs.errors import ParameterError, unknown_place
from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.lengths import shown_unit
from hdrive_mbs.plots.look import GREY, house_look, legend_above, new_figure, number, other_unit, raised, readable, style
from hdrive_mbs.plots.point_names import name_point
from hdrive_mbs.plots.thinning import thinned

NEGLIGIBLE = 1e-9
"""A rotor that whirls less than this share of the largest has no panel."""

ORIGINS = {
    "static": ("whirl", "mass_centre_whirl", "whirl about rest"),
    "axis": ("radial", "mass_centre_radial", "distance from axis"),
}


FAST = 0.3
"""Share of the highest speed above which a run that is never slower than that begins its axis there."""


@plot.register
def plot_run_up(
    result: RunUp, ax: Axes | None = None, *, rotors: Sequence[str] | None = None, about: str = "static", logarithmic: bool = False
) -> Axes:
    """Amplitudes of geometric and mass centre over the speed, one panel per rotor, below the speed over time; returns the top one.

    rotors : which; all that whirl if not given
    about : "static" for the whirl about the static position, "axis" for the distance from the axis
    logarithmic : amplitudes on a logarithmic scale
    With ``ax`` the first of these rotors goes there.
    """
    if about not in ORIGINS:
        raise ParameterError(f"about = {about!r}: must be one of {', '.join(ORIGINS)}.")
    chosen = list(rotors) if rotors is not None else _whirling(result)
    for name in chosen:
        if name not in result.rotors:
            raise unknown_place("rotor", name, result.rotors, "This run")
    with house_look():
        if ax is not None:
            _rotor(ax, result, chosen[0], about, logarithmic)
            legend_above(ax)
            return ax
        figure = new_figure(7.2, 2.4 + 2.0 * len(chosen))
        grid = figure.add_gridspec(1 + len(chosen), 1, height_ratios=[0.62] + [1.0] * len(chosen))
        first = figure.add_subplot(grid[0])
        _speed(first, result)
        panels: list[Axes] = []
        for k, name in enumerate(chosen):
            panel = figure.add_subplot(grid[1 + k], sharex=panels[0] if panels else None)
            _rotor(panel, result, name, about, logarithmic)
            panel.set_title(readable(name))
            if k < len(chosen) - 1:
                panel.set_xlabel("")
                panel.tick_params(labelbottom=False)
            panels.append(panel)
        figure.align_ylabels([first, *panels])
        named = {label: handle for panel in panels for handle, label in zip(*panel.get_legend_handles_labels(), strict=True)}
        figure.legend(list(named.values()), list(named), loc="outside lower left", ncols=3)
        if result.scene is not None:
            said = result.status.removeprefix("complete").lstrip("; ")
            note = "\n" + textwrap.fill(raised(said), 92) if said else ""
            figure.suptitle(f"{result.scene.name}: {number(result.final_speed)}\u2009rad/s at the end{note}", x=0.01, ha="left")
    return first


def _whirling(result: RunUp) -> list[str]:
    largest = max(result.peak_amplitude.values())
    return [name for name in result.rotors if result.peak_amplitude[name] > NEGLIGIBLE * largest] or [result.rotors[0]]


def _speed(ax: Axes, result: RunUp) -> None:
    name = f"{result.reference}.speed"
    ax.plot(*thinned(result.times, result.values[name]), **style(0))
    for critical in result.critical_speeds:
        if critical <= np.max(np.abs(result.values[name])):
            ax.axhline(np.copysign(critical, result.final_speed or 1.0), color=GREY, linestyle="--", linewidth=0.9)
    ax.set_xlabel("time [s]")
    ax.set_ylabel("speed [rad/s]")
    ax.margins(x=0.0)
    right = ax.secondary_yaxis("right", functions=other_unit(30.0 / np.pi))
    right.set_ylabel("speed [rpm]")
    right.spines["right"].set_visible(True)


def _rotor(ax: Axes, result: RunUp, name: str, about: str, logarithmic: bool) -> None:
    speed = np.abs(result.values[f"{name}.speed"])
    centre, mass, what = ORIGINS[about]
    shown = [(centre, "geometric centre C")]
    if not np.array_equal(result.values[f"{name}.{mass}"], result.values[f"{name}.{centre}"]):
        shown.append((mass, "centre of mass P"))
    largest = max(float(result.values[f"{name}.{ending}"].max()) for ending, _ in shown)
    factor, unit = shown_unit("m", largest)
    for k, (ending, label) in enumerate(shown):
        times, values = thinned(result.times, result.values[f"{name}.{ending}"], 2500)
        ax.plot(np.interp(times, result.times, speed), factor * values, label=label, **{**style(k), "linewidth": 1.2 - 0.3 * k})
    top = float(speed.max())
    _criticals(ax, result, name, top)
    if about == "static":
        _peaks(ax, result, name, factor, unit)
    slowest = float(speed.min())
    slowest = slowest - 0.02 * (top - slowest) if slowest > FAST * top else 0.0
    ax.set_xlim(slowest, top + 0.02 * (top - slowest) or 1.0)
    if logarithmic:
        ax.set_yscale("log")
        ax.set_ylim(1e-4 * factor * largest, 10.0 * factor * largest)
    elif largest > 0.0:
        ax.set_ylim(0.0, 1.35 * factor * largest)
    ax.set_xlabel("speed of the rotor [rad/s]")
    ax.set_ylabel(f"{what},\n0-peak [{unit}]")


def _criticals(ax: Axes, result: RunUp, name: str, top: float) -> None:
    """Critical speeds of the reference shaft, on the scale of this rotor's speed."""
    ratio = _ratio(result, name)
    label: str | None = "undamped critical speed"
    for critical in result.critical_speeds:
        if critical * ratio <= 1.02 * top:
            ax.axvline(critical * ratio, color=GREY, linestyle="--", linewidth=0.9, label=label)
            label = None


def _ratio(result: RunUp, name: str) -> float:
    """Speed of the rotor over that of the reference shaft."""
    if result.scene is not None:
        return abs(spin_ratios(result.scene)[result.scene.network().places[name]])
    turned = [np.abs(result.values[f"{place}.angle"][-1]) for place in (name, result.reference)]
    return float(turned[0] / turned[1]) if turned[1] else 1.0


def _peaks(ax: Axes, result: RunUp, name: str, factor: float, unit: str) -> None:
    for speed, amplitude, *_ in result.peaks(name):
        ax.plot([abs(speed)], [factor * amplitude], "o", color="white", markeredgecolor="black", markersize=4.0, zorder=4)
        text = f"{number(factor * amplitude)}\u2009{unit},\n{number(abs(speed))}\u2009rad/s"
        name_point(ax, text, abs(speed), factor * amplitude)
