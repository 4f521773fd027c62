"""The content of Figs 6-11 of the paper: both sets of data, full against simplified and improved."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from benchmarks.bearings.cases import FULL, IMPROVED, SIMPLIFIED, Case
from benchmarks.bearings.histories import ripple
from benchmarks.bearings.run_up import COORDINATES, RunUp
from hdrive_mbs.plots.look import COLOURS, house_look, legend_above, new_figure

DRAWN = (FULL, SIMPLIFIED, IMPROVED)
LOOKS: Mapping[str, dict[str, Any]] = {
    FULL: {"color": COLOURS[4], "linestyle": "-", "linewidth": 2.2},
    SIMPLIFIED: {"color": COLOURS[1], "linestyle": "-", "linewidth": 1.1},
    IMPROVED: {"color": COLOURS[5], "linestyle": (0, (3, 3)), "linewidth": 1.4},
    "merged": {"color": COLOURS[2], "linestyle": "-.", "linewidth": 1.3},
}
UNITS = {"x": (1e6, "\u00b5m"), "y": (1e6, "\u00b5m"), "psi": (1e6, "\u00b5rad"), "theta": (1e6, "\u00b5rad")}
SPEED = "speed of the rotor [rad/s]"
HEAD = 54.0
"""Room for a legend of three lines below a title [points]."""

Histories = Mapping[Case, Mapping[str, RunUp]]


def figures(histories: Histories) -> dict[str, Figure]:
    """Pictures by file name."""
    with house_look():
        return {
            "figure_6_rotor_1_distances": _distances(histories, "rotor_1", 6),
            "figure_7_rotor_1_trajectory": _trajectories(histories),
            "figure_8_rotor_1_vibration": _vibration(histories),
            "figure_9_rotor_1_torsion": _torsion(histories),
            "figure_10_rotor_2_distances": _distances(histories, "rotor_2", 10),
            "figure_11_constant_speed": _constant_speed(histories),
        }


def _thin(run: RunUp, values: Any, count: int = 6000) -> tuple[Any, Any]:
    """Times and values at so many equal steps: more than a picture can show."""
    times = np.linspace(run.times[0], run.times[-1], count)
    return times, np.interp(times, run.times, values)


def _distances(histories: Histories, rotor: str, number: int) -> Figure:
    both = any(run.eccentricity[rotor] > 0.0 for of in histories.values() for run in of.values())
    rows = ("C", "P") if both else ("C",)
    figure = new_figure(5.6 * len(histories), 1.2 + 3.0 * len(rows))
    grid = figure.subplots(len(rows), len(histories), squeeze=False, sharex=True, sharey="row")
    for column, (case, of) in enumerate(histories.items()):
        for row, point in enumerate(rows):
            ax = grid[row, column]
            for model in DRAWN:
                run = of[model]
                distance = run.distance(rotor) if point == "C" else run.mass_centre_distance(rotor)
                _, speed = _thin(run, run.speed[rotor])
                peak = run.peak(rotor)
                text = f"{model}: {1e6 * peak.amplitude:.1f} \u00b5m at {peak.speed:.1f} rad/s" if point == "C" else None
                ax.plot(speed, 1e6 * _thin(run, distance)[1], label=text, **LOOKS[model])
            if column == 0:
                what = "geometric centre C" if point == "C" else "mass centre P"
                ax.set_ylabel(f"{what}: distance\nfrom the axis [\u00b5m, 0-peak]")
            if point == "C":
                ax.set_title(case.name, pad=HEAD)
                legend_above(ax, columns=1)
        grid[-1, column].set_xlabel(SPEED)
    for ax in grid[:, 0]:
        ax.set_ylim(bottom=0.0)  # only now: it ends the automatic scale of the whole row
    what = "distances of C and P from the axis" if both else "distance from the axis (it is balanced, so P and C are one)"
    figure.suptitle(f"Fig. {number}: {rotor.replace('_', ' ')}, {what}", x=0.01, ha="left")
    return figure


def _trajectories(histories: Histories) -> Figure:
    """A few turns of P and C below, at and above the first critical speed, by the full and the simplified model."""
    case, of = next(iter(histories.items()))
    models = (FULL, SIMPLIFIED)
    figure = new_figure(10.5, 7.4)
    grid = figure.subplots(len(models), 3)
    for row, model in enumerate(models):
        run = of[model]
        top = run.peak("rotor_1").speed
        last = 0.98 * float(run.speed["rotor_1"][-1])
        for ax, (speed, name) in zip(grid[row], ((0.6 * top, "below"), (top, "at the peak"), (last, "above")), strict=True):
            k = int(np.argmin(np.abs(run.speed["rotor_1"] - speed)))
            inside = np.abs(run.times - run.times[k]) <= 3.0 * np.pi / speed
            for x, y, label, look in (
                (*run.mass_centre("rotor_1"), "mass centre P", {"color": COLOURS[1]}),
                (run.lateral["rotor_1"]["x"], run.lateral["rotor_1"]["y"], "geometric centre C", {"color": COLOURS[0], "linestyle": "--"}),
            ):
                ax.plot(1e6 * x[inside], 1e6 * y[inside], label=label, **look)
            ax.plot([0.0], [0.0], "+", color="black", markersize=8)
            ax.set_aspect("equal", adjustable="datalim")
            ax.set_title(f"{model}, {name}: {run.speed['rotor_1'][k]:.0f} rad/s")
            ax.set_xlabel("x [\u00b5m]")
            ax.set_ylabel("y [\u00b5m]")
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2)
    title = f"Fig. 7: rotor 1 of {case.name}, three turns of P and C: above the critical speed P stays nearer to the axis (+) than C"
    figure.suptitle(title, x=0.01, ha="left")
    return figure


def _vibration(histories: Histories) -> Figure:
    case, of = next(iter(histories.items()))
    models = (FULL, SIMPLIFIED)
    figure = new_figure(10.5, 8.0)
    grid = figure.subplots(len(COORDINATES), len(models), sharex=True, sharey="row")
    for column, model in enumerate(models):
        for ax, name in zip(grid[:, column], COORDINATES, strict=True):
            factor, unit = UNITS[name]
            times, values = _thin(of[model], of[model].lateral["rotor_1"][name], 20_000)
            ax.plot(times, factor * values, color=LOOKS[model]["color"], linestyle="-", linewidth=0.5)
            if column == 0:
                ax.set_ylabel(f"{name} [{unit}]")
        grid[0, column].set_title(model)
        grid[-1, column].set_xlabel("time [s]")
    figure.suptitle(f"Fig. 8: transverse and gyroscopic vibration of rotor 1 of {case.name} during the run-up", x=0.01, ha="left")
    return figure


def _torsion(histories: Histories) -> Figure:
    figure = new_figure(5.6 * len(histories), 6.6)
    grid = figure.subplots(2, len(histories), squeeze=False)
    for column, (case, of) in enumerate(histories.items()):
        top, bottom = grid[:, column]
        for model in (FULL, SIMPLIFIED):
            run = of[model]
            times, values = _thin(run, run.speed["rotor_1"] - run.drive_speed, 20_000)
            top.plot(times, values, color=LOOKS[model]["color"], linestyle="-", linewidth=0.5, label=model)
        for model in DRAWN:
            times, values = ripple(of[model])
            bottom.plot(times, 1e3 * values, label=f"{model}: {1e3 * 0.5 * np.ptp(values):.1f} mrad/s 0-peak", **LOOKS[model])
        top.set_title(case.name, pad=20)
        legend_above(top, columns=2)
        bottom.set_title("around the largest peak, below 300 rad/s, about its trend", pad=HEAD)
        legend_above(bottom, columns=1)
        if column == 0:
            top.set_ylabel("speed of rotor 1 over that\nof the drive disc [rad/s]")
            bottom.set_ylabel("torsional vibration velocity\nof rotor 1 [mrad/s]")
        for ax in (top, bottom):
            ax.set_xlabel("time [s]")
    figure.suptitle("Fig. 9: torsional vibration velocity of rotor 1", x=0.01, ha="left")
    return figure


TURNS = 6


def _constant_speed(histories: Histories) -> Figure:
    figure = new_figure(5.6 * len(histories), 8.0)
    grid = figure.subplots(len(COORDINATES), len(histories), squeeze=False, sharex=True, sharey="row")
    for column, (case, of) in enumerate(histories.items()):
        for ax, name in zip(grid[:, column], COORDINATES, strict=True):
            factor, unit = UNITS[name]
            for model in DRAWN:
                run = of[model]
                turns = run.angle["rotor_1"] / (2.0 * np.pi)  # over time the models are out of step: they get there a little apart
                last = np.floor(turns[-1]) - TURNS
                inside = (turns >= last) & (turns <= last + TURNS)
                ax.plot(turns[inside] - last, factor * run.lateral["rotor_1"][name][inside], label=model, **LOOKS[model])
            if column == 0:
                ax.set_ylabel(f"{name} [{unit}]")
        grid[0, column].set_title(f"{case.name}, {of[FULL].speed['rotor_1'][-1]:.0f} rad/s", pad=20)
        legend_above(grid[0, column])
        grid[-1, column].set_xlabel("spin angle of rotor 1 [turns]")
    figure.suptitle("Fig. 11: vibration of rotor 1 at constant speed, its last turns of the run", x=0.01, ha="left")
    return figure
