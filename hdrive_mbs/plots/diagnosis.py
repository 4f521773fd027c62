"""The summary picture of a diagnosis: how far the gap shrinks, what causes it, where it lies, and one column before and after."""

from __future__ import annotations

import textwrap

import numpy as np
from matplotlib.axes import Axes

from hdrive_mbs.diagnosis import sentences
from hdrive_mbs.diagnosis.result import Diagnosis, Trace
from hdrive_mbs.plots.diagnosis_domain import plot_domain
from hdrive_mbs.plots.diagnosis_gap import plot_gap
from hdrive_mbs.plots.diagnosis_look import FloatArray
from hdrive_mbs.plots.diagnosis_ranking import plot_places, plot_ranking
from hdrive_mbs.plots.diagnosis_traces import plot_traces
from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.look import given_or_new, house_look, new_figure, readable


@plot.register
def plot_diagnosis(result: Diagnosis, ax: Axes | None = None) -> Axes:
    """Gap, ranking, places or domain, and the column that was worst off, one below the other; returns the first Axes.

    With ``ax`` the gap of all records together is drawn there.
    """
    with house_look():
        if ax is not None:
            return plot_gap(result, ax, together=True) if result.gaps else plot_ranking(result, ax)
        panels = [(name, height) for name, height, there in _panels(result) if there]
        if not panels:
            empty = given_or_new(None, 7.2, 1.6)
            empty.set_axis_off()
            empty.set_title(_title(result))
            return empty
        figure = new_figure(7.2, 0.8 + sum(height for _, height in panels))
        grid = figure.add_gridspec(len(panels), 1, height_ratios=[height for _, height in panels])
        drawn = []
        for k, (name, _) in enumerate(panels):
            panel = figure.add_subplot(grid[k])
            _draw(name, result, panel)
            drawn.append(panel)
        figure.suptitle(_title(result), x=0.01, ha="left")
    return drawn[0]


def _panels(result: Diagnosis) -> tuple[tuple[str, float, bool], ...]:
    placed = not sentences.only_noise(result)
    return (
        ("gap", 2.1, bool(result.gaps)),
        ("ranking", 0.9 + 0.3 * min(len(result.ranking), 6), bool(result.ranking)),
        ("places", 0.9 + 0.3 * min(len(result.where), 4), placed and bool(result.where)),
        ("domain", 2.0, placed and bool(result.domain) and not result.where),
        ("traces", 2.6, bool(result.traces)),
    )


def _draw(name: str, result: Diagnosis, ax: Axes) -> None:
    if name == "gap":
        plot_gap(result, ax, together=True)
    elif name == "ranking":
        plot_ranking(result, ax, top=6)
    elif name == "places":
        plot_places(result, ax, top=4)
    elif name == "domain":
        plot_domain(result, ax)
    else:
        worst = worst_first(result)[0]
        plot_traces(result, ax, record=worst.record, column=worst.column, residuals=True)
        ax.set_xlabel(f"time [s] ({readable(worst.column)}, record {worst.record!r})")


def worst_first(result: Diagnosis) -> list[Trace]:
    """Traces by how far the refitted model is off in noise units; where it is the answer, by how far the nominal one was."""
    return sorted(result.traces, key=lambda trace: _size(trace, trace.refit if result.causes else trace.nominal), reverse=True)


def _size(trace: Trace, simulated: FloatArray) -> float:
    left = (trace.measured - simulated) / trace.noise
    return float(np.nanmean(left**2)) if np.isfinite(left).any() else 0.0


def _title(result: Diagnosis) -> str:
    said = f"{result.scene.name}: {sentences.verdict(result)} {sentences.confidence(result)} {sentences.ambiguity(result)}"
    return textwrap.fill(said.replace("_", " "), 90)
