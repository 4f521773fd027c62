"""What the benchmark adds to the figures of the paper: error against run time, steady response, maps of validity."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from benchmarks.bearings.cases import FINAL, FULL, IMPROVED, PAPER, SIMPLIFIED, Case
from benchmarks.bearings.figures import LOOKS
from benchmarks.bearings.precision import ADAPTIVE, FIXED, IMPLICIT, TARGET, Runs
from benchmarks.bearings.run_up import ROTORS
from benchmarks.bearings.steady import Steady
from benchmarks.bearings.sweep import CHEAPER
from hdrive_mbs.plots.look import COLOURS, GREY, house_look, legend_above, new_figure

MARKERS = {IMPLICIT: "o", FIXED: "s", ADAPTIVE: "^"}
LOWEST = 1e-7
"""Errors below this are drawn there: the converged runs are not known better."""


def pictures(
    runs: Mapping[Case, Mapping[str, Runs]], responses: Mapping[Case, Mapping[str, Steady]], swept: Mapping[str, Any], duration: float
) -> dict[str, Figure]:
    """Pictures by file name."""
    with house_look():
        return {
            "error_against_time": _precision(runs, duration),
            "campbell": _campbells({case: of for case, of in responses.items() if case in PAPER}),
            "steady_response": _responses({case: of for case, of in responses.items() if case in PAPER}),
            "validity_critical_speeds": _validity(swept["maps"], "critical_speeds"),
            "validity_peaks": _validity(swept["maps"], "peaks"),
            "where_the_damping_sits": _damping(swept["damping"]),
        }


def _precision(every: Mapping[Case, Mapping[str, Runs]], duration: float) -> Figure:
    """Above: what the solver does; below: what solver and model do together."""
    drawn = {case: of for case, of in every.items() if any(s.kind == ADAPTIVE for s in of[FULL].settings)} or dict(every)
    figure = new_figure(max(5.6 * len(drawn), 8.4), 8.8)
    grid = figure.subplots(2, len(drawn), squeeze=False, sharex=True, sharey=True)
    for column, (case, of) in enumerate(drawn.items()):
        for row, title in enumerate((f"{case.name}: error of the solver", f"{case.name}: error of solver and model")):
            ax = grid[row, column]
            for model, runs in of.items():
                exact = runs.converged if row == 0 else of[FULL].converged
                for kind, marker in MARKERS.items():
                    points = [
                        (runs.median(s), max(runs.error(s, exact), LOWEST)) for s in runs.settings if s.kind == kind and s in runs.peaks
                    ]
                    if points:
                        ax.loglog(
                            *zip(*sorted(points), strict=True),
                            color=LOOKS[model]["color"],
                            linestyle={IMPLICIT: "-", FIXED: "--", ADAPTIVE: ":"}[kind],
                            marker=marker,
                            markersize=5,
                            label=f"{model}, {kind}",
                        )
            ax.axhline(TARGET, color=GREY, linestyle=":", linewidth=1.2)
            ax.set_title(title)
            if column == 0:
                against = "the same model, converged" if row == 0 else "the full model, converged"
                ax.set_ylabel(f"error of the peaks (0-peak), the larger of\nboth rotors, against {against} [1]")
            if row == 1:
                ax.set_xlabel(f"CPU time for {duration:g} s simulated [s]")
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=8)
    return figure


def _responses(responses: Mapping[Case, Mapping[str, Steady]]) -> Figure:
    figure = new_figure(5.6 * len(responses), 7.0)
    grid = figure.subplots(len(ROTORS), len(responses), squeeze=False, sharex=True, sharey="row")
    for column, (case, of) in enumerate(responses.items()):
        for row, rotor in enumerate(ROTORS):
            ax = grid[row, column]
            for model in (FULL, SIMPLIFIED, IMPROVED):
                ax.semilogy(of[model].speeds, 1e6 * of[model].amplitude[rotor], label=model, **LOOKS[model])
            for w in of[FULL].criticals:
                if w <= of[FULL].speeds[-1]:
                    ax.axvline(w, color=GREY, linestyle=":", linewidth=1.0)
            ax.axvspan(FINAL, of[FULL].speeds[-1], color="#EEEEEE", zorder=0)
            if column == 0:
                ax.set_ylabel(f"{rotor.replace('_', ' ')}: distance of C\nfrom the axis [\u00b5m, 0-peak]")
            ax.set_xlim(0.0, of[FULL].speeds[-1])
        grid[0, column].set_title(case.name, pad=20)
        legend_above(grid[0, column])
        grid[-1, column].set_xlabel("speed [rad/s]")
    title = "Steady response to unbalance; dotted: undamped critical speeds; grey: beyond the run-up"
    figure.suptitle(title, x=0.01, ha="left")
    return figure


def _campbells(responses: Mapping[Case, Mapping[str, Steady]]) -> Figure:
    figure = new_figure(5.6 * len(responses), 5.0)
    axes = figure.subplots(1, len(responses), squeeze=False, sharey=True)[0]
    for ax, (case, of) in zip(axes, responses.items(), strict=True):
        for model in (FULL, SIMPLIFIED, IMPROVED):
            result = of[model].campbell
            for k in range(result.frequencies.shape[1]):
                ax.plot(result.speeds, result.frequencies[:, k], label=model if k == 0 else None, **LOOKS[model])
            met = np.array(of[model].damped_criticals)
            ax.plot(met, met, "o", color=LOOKS[model]["color"], markersize=5, markerfacecolor="white", markeredgewidth=1.4, zorder=5)
        top = float(of[FULL].campbell.speeds[-1])
        ax.plot([0.0, top], [0.0, top], color=GREY, linestyle="--", linewidth=1.0)
        ax.set_xlim(0.0, top)
        ax.set_ylim(0.0, 1.2 * top)
        ax.set_title(case.name, pad=20)
        ax.set_xlabel("speed [rad/s]")
        legend_above(ax)
    axes[0].set_ylabel("damped frequency [rad/s]")
    title = "Campbell diagrams; rings: forward whirl meets the speed (dashed)"
    figure.suptitle(title, x=0.01, ha="left")
    return figure


def _validity(maps: Mapping[str, Any], what: str) -> Figure:
    """Deviation over diameter and stiffness, one row per stiffness that is changed, one column per model."""
    figure = new_figure(11.0, 7.2)
    grid = figure.subplots(2, len(CHEAPER), sharey=True, sharex="row")
    diameters = 1e3 * np.array(maps["diameters"])
    shown = None
    for row, name in enumerate(("bearing", "foundation")):
        stiffness = np.array(maps[name]["stiffness"])
        for ax, model in zip(grid[row], CHEAPER, strict=True):
            table = maps[name]["models"][model]
            values = np.abs(table[what]) if what == "critical_speeds" else np.fmax(*(np.abs(table[rotor]) for rotor in ROTORS))
            percent = 100.0 * np.clip(values, 1e-6, 1.0)
            shown = ax.pcolormesh(stiffness, diameters, percent, norm=LogNorm(1e-3, 100.0), cmap="cividis", shading="nearest")
            if min(percent.shape) > 2:
                lines = ax.contour(stiffness, diameters, percent, levels=[0.05, 1.0, 10.0], colors="white", linewidths=1.2, linestyles="-")
                ax.clabel(lines, fmt=lambda level: f"{level:g} %", fontsize=8)
            quiet = np.argwhere(table["warned"] == 0.0)
            ax.plot(stiffness[quiet[:, 1]], diameters[quiet[:, 0]], ".", color="white", markersize=4)
            ax.plot([1.2e8 if name == "bearing" else 6e6], [22.0], "*", color="white", markeredgecolor="black", markersize=11)
            ax.set_xscale("log")
            ax.set_xlim(stiffness[0], stiffness[-1])
            ax.set_ylim(diameters[0], diameters[-1])
            ax.set_title(model)
            ax.set_xlabel(f"stiffness of the {name} [N/m]")
            ax.grid(visible=False)
        grid[row, 0].set_ylabel("diameter of the shaft [mm]")
    texts = {"critical_speeds": "critical speeds up to 1000 rad/s, largest", "peaks": "steady first peak (0-peak), larger of both rotors:"}
    assert shown is not None
    figure.colorbar(shown, ax=grid, label=f"{texts[what]} deviation from the full model [%]")
    title = "M-REF (star) with other bearings on 6e6 N/m (above), and bearings of 1.2e8 N/m on other foundations (below). Dots: no warning"
    figure.suptitle(title, x=0.01, ha="left")
    return figure


def _damping(found: Mapping[str, Any]) -> Figure:
    """Left: the simplified model over the share of the bearing element; right: the improved one over its loss factor."""
    figure = new_figure(11.0, 4.8)
    left, right = figure.subplots(1, 2)
    for (name, rows), (colour, marker) in zip(found.items(), ((COLOURS[1], "o"), (COLOURS[0], "s")), strict=True):
        share = [100.0 * row["share"] for row in rows]
        for rotor, line in zip(ROTORS, ("-", "--"), strict=True):
            look = {"color": colour, "linestyle": line, "marker": marker, "markersize": 4}
            text = f"stiffness of {name}, {rotor.replace('_', ' ')}"
            left.plot(share, [100.0 * row[SIMPLIFIED][rotor] for row in rows], label=text, **look)
            right.loglog([row["loss"] for row in rows], [100.0 * abs(row[IMPROVED][rotor]) for row in rows], **look)
    left.axhline(0.0, color=GREY, linewidth=1.0, linestyle="-")
    left.set_xlabel("share of the bearing element in the damping ratio [%]")
    left.set_ylabel("deviation of the steady first peak (0-peak)\nfrom that of the full model [%]")
    left.set_title("simplified")
    right.axhline(0.5, color=GREY, linewidth=1.2, linestyle=":")
    right.set_xlabel("damping force over elastic force in the bearing, c_b w / k_b [1]")
    right.set_ylabel("size of the same deviation [%]")
    right.set_title("improved (dotted: the aim of 0.5 %)")
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=4)
    title = "Damping moved from the foundation into the bearing, steady response at the first critical speed w"
    figure.suptitle(title, x=0.01, ha="left")
    return figure
