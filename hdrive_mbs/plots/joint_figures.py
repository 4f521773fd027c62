"""Pictures of a geared rotor line that runs up: what its gear does, and what different models of its bearings make of it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes

from hdrive_mbs.analysis.run_up.run_up import RunUp
from hdrive_mbs.plots.lengths import shown_unit
from hdrive_mbs.plots.look import GREY, house_look, legend_above, new_figure, style
from hdrive_mbs.plots.thinning import thinned
from hdrive_mbs.signals import FloatArray

POINTS = 2500
"""Of a curve."""
WIDTH = 6.2
"""Of the pictures [inch]: they fit a phone at two thirds of their size."""


def plot_gear_run(run: RunUp, gear: str, *, lost_motion: float) -> Axes:
    """Torque of a gear over time, and its twist with the edges of the lost motion; returns the upper axes."""
    with house_look():
        figure = new_figure(WIDTH, 4.4)
        axes: tuple[Axes, Axes] = tuple(figure.subplots(2, 1, sharex=True))
        upper, lower = axes
        upper.plot(*thinned(run.times, run.values[f"{gear}.torque"], POINTS), **{**style(0), "linewidth": 0.9})
        upper.set_ylabel("torque of the gear [N m]")
        lower.plot(*thinned(run.times, 1e3 * run.values[f"{gear}.twist"], POINTS), **{**style(1), "linestyle": "-", "linewidth": 0.9})
        for k, edge in enumerate((-0.5e3 * lost_motion, 0.5e3 * lost_motion)):
            lower.axhline(edge, color=GREY, linestyle="--", linewidth=0.9, label=None if k else "edges of the lost motion")
        lower.set_ylabel("twist [mrad]")
        lower.set_xlabel("time [s]")
        lower.margins(x=0.0)
        legend_above(lower)
        figure.align_ylabels()
    return upper


def plot_bearing_models(runs: Mapping[str, RunUp], rotor: str) -> Axes:
    """Largest whirl of one rotor in each of its revolutions over its speed, a curve for each bearing model, where it stands out."""
    largest = max(run.peak_amplitude[rotor] for run in runs.values())
    factor, unit = shown_unit("m", largest)
    with house_look():
        ax = new_figure(WIDTH, 3.4).add_subplot()
        slowest = np.inf
        for k, (name, run) in enumerate(runs.items()):
            speed, whirl = _each_revolution(run, rotor)
            ax.plot(speed, factor * whirl, label=f"{name} bearings", **{**style(k), "linewidth": 2.0 - 0.4 * k})
            slowest = min(slowest, float(speed[whirl > 0.15 * largest].min(initial=speed.max())))
        ax.set_xlim(0.95 * slowest, None)
        ax.set_ylim(0.0, None)
        ax.set_xlabel("speed of the rotor [rad/s]")
        ax.set_ylabel(f"largest whirl in a revolution,\n0-peak [{unit}]")
        legend_above(ax)
    return ax


def _each_revolution(run: RunUp, rotor: str) -> tuple[FloatArray, FloatArray]:
    """Mean speed and largest whirl of every whole revolution."""
    turns = np.abs(run.values[f"{rotor}.angle"]) / (2.0 * np.pi)
    first = np.flatnonzero(np.diff(np.floor(turns), prepend=-1.0) > 0.0)
    whirl = np.maximum.reduceat(run.values[f"{rotor}.whirl"], first)
    speed = np.add.reduceat(np.abs(run.values[f"{rotor}.speed"]), first) / np.diff(first, append=len(turns))
    return speed[:-1], whirl[:-1]
