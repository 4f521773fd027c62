"""Pictures of measured against simulated, and of what is left between them."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from hdrive_mbs.diagnosis.result import Diagnosis, Trace
from hdrive_mbs.errors import unknown_place
from hdrive_mbs.plots.diagnosis_look import (
    EFFECT,
    LOOKS,
    MEASURED,
    REFIT,
    STEPS,
    WIDTH,
    binned,
    drawn_unit,
    needed,
    shade,
    steps_of,
    varies,
)
from hdrive_mbs.plots.look import GREY, house_look, legend_above, new_figure, readable

HELD = "Ask for a diagnosis with traces."
LARGE = 30.0
"""Largest over rms of the residuals after from which those before get a scale of their own."""
OVER = {"speed": "rad/s", "torque": "N m", "angle": "rad"}


def plot_traces(
    diagnosis: Diagnosis, ax: Axes | None = None, *, record: str | None = None, column: str | None = None, residuals: bool = False
) -> Axes:
    """One column of one record: measured and simulated before and after, and below it the residuals in noise units.

    record, column : which; the first trace if not given
    With ``ax`` only the upper panel is drawn, there, or the lower one (``residuals``).  Stretches that no fit saw are shaded.
    """
    trace = _chosen(diagnosis, record, column)
    claimed = bool(diagnosis.causes)
    with house_look():
        if ax is not None:
            (_residuals if residuals else _curves)(ax, trace, claimed)
            if residuals:
                legend_above(ax, columns=2)
            ax.set_xlabel("time [s]")
            return ax
        figure = new_figure(WIDTH, 4.6)
        upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[1.25, 1.0])
        _curves(upper, trace, claimed)
        _residuals(lower, trace, claimed)
        lower.set_xlabel("time [s]")
        figure.align_ylabels([upper, lower])
        figure.suptitle(f"{trace.record}: {readable(trace.column)}", x=0.01, ha="left", fontsize=10)
    first: Axes = upper
    return first


def plot_residual(diagnosis: Diagnosis, ax: Axes | None = None, *, record: str | None = None, column: str | None = None) -> Axes:
    """Residual of a column against speed, torque and angle, before and after: mean and standard deviation in bins.

    With ``ax`` only the first of these that varies is drawn, there.
    """
    trace = _chosen(diagnosis, record, column)
    over = [name for name in OVER if varies(getattr(trace, name), len(trace.times))]
    needed(over, f"speed, torque or angle of {trace.column!r} in record {trace.record!r}", HELD)
    with house_look():
        if ax is not None:
            _against(ax, trace, over[0], bool(diagnosis.causes))
            return ax
        figure = new_figure(WIDTH, 0.6 + 1.75 * len(over))
        panels = list(np.atleast_1d(figure.subplots(len(over), 1)))
        for panel, name in zip(panels, over, strict=True):
            _against(panel, trace, name, bool(diagnosis.causes))
        figure.align_ylabels(panels)
        legend_above(panels[0], columns=2)
        figure.suptitle(
            f"{trace.record}: {readable(trace.column)}, measured minus simulated\n(lines and bands: mean and standard deviation)",
            x=0.01,
            ha="left",
            fontsize=10,
        )
    first: Axes = panels[0]
    return first


def _chosen(diagnosis: Diagnosis, record: str | None, column: str | None) -> Trace:
    needed(diagnosis.traces, "traces", HELD)
    for name, value, known in (
        ("record", record, [trace.record for trace in diagnosis.traces]),
        ("column", column, [trace.column for trace in diagnosis.traces if record in (None, trace.record)]),
    ):
        if value is not None and value not in known:
            raise unknown_place(name, value, dict.fromkeys(known), "This diagnosis")
    return next(trace for trace in diagnosis.traces if record in (None, trace.record) and column in (None, trace.column))


def _curves(ax: Axes, trace: Trace, claimed: bool) -> None:
    size, unit = drawn_unit(trace.unit, trace.measured)
    ax.plot(trace.times, trace.measured / size, label="measured", **MEASURED)
    for name, text in steps_of(claimed).items():
        ax.plot(trace.times, getattr(trace, name) / size, label=text, **LOOKS[name])
    shade(ax, trace.times, trace.held_out)
    finite = trace.measured[np.isfinite(trace.measured)] / size
    if len(finite):
        room = 0.25 * float(np.ptp(finite)) or 1.0
        ax.set_ylim(float(finite.min()) - room, float(finite.max()) + room)
    ax.set_ylabel(f"{readable(trace.column)} [{unit}]")
    ax.margins(x=0.0)
    legend_above(ax, columns=3)


def _residuals(ax: Axes, trace: Trace, claimed: bool) -> None:
    shown = list(steps_of(claimed))
    left = {name: (trace.measured - getattr(trace, name)) / trace.noise for name in shown}
    for name in shown:
        ax.plot(trace.times, left[name], label=STEPS[name], **LOOKS[name])
    shade(ax, trace.times, trace.held_out)
    last = left[shown[-1]]
    ground = max(float(np.nanstd(last)) if np.isfinite(last).any() else 1.0, 1.0)
    largest = max((float(np.nanmax(np.abs(values))) for values in left.values() if np.isfinite(values).any()), default=1.0)
    if largest > LARGE * ground:
        even = 10.0 ** np.ceil(np.log10(3.0 * ground))
        ax.set_yscale("symlog", linthresh=even)
        ax.set_ylim(-1.6 * largest, 1.6 * largest)
        decades = even * 10.0 ** np.arange(max(int(np.log10(1.6 * largest / even)), 0) + 1)
        ax.set_yticks([*-decades[::-1], 0.0, *decades], [f"{tick:g}" for tick in (*-decades[::-1], 0.0, *decades)])
        ax.minorticks_off()
    ax.axhspan(-2.0, 2.0, color=GREY, alpha=0.18, linewidth=0.0)
    ax.set_ylabel("measured minus simulated\n[standard deviations\nof the noise]")
    ax.margins(x=0.0)


def _against(ax: Axes, trace: Trace, over: str, claimed: bool) -> None:
    x = getattr(trace, over)
    factor, unit = (1.0, OVER[over]) if over != "angle" or np.ptp(x) < 20.0 else (1.0 / (2.0 * np.pi), "revolutions")
    for before, look in ((trace.refit, REFIT), *([(trace.effect, EFFECT)] if claimed else [])):
        left = (trace.measured - before) / trace.noise
        ax.plot(factor * x, left, ".", markersize=1.2, color=look["color"], alpha=0.25, rasterized=True)
        middle, mean, low, high = binned(factor * x, left)
        ax.fill_between(middle, low, high, color=look["color"], alpha=0.15, linewidth=0.0)
        ax.plot(middle, mean, label=STEPS["refit" if look is REFIT else "effect"], **{**look, "linewidth": 1.8})
    ax.set_xlabel(f"{over} [{unit}]")
    ax.set_ylabel("residual\n[standard deviations\nof the noise]")
    ax.margins(x=0.01)
