"""Picture of the gap: how far the model is off before and after, against the noise."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import LogFormatter

from hdrive_mbs.diagnosis.readable import digits
from hdrive_mbs.diagnosis.report_rows import gap_name
from hdrive_mbs.diagnosis.result import Diagnosis, Gap
from hdrive_mbs.plots.diagnosis_look import LOOKS, WIDTH, needed, steps_of
from hdrive_mbs.plots.look import given_or_new, house_look, legend_above, readable

MOST = 16
"""Rows; of more only the worst are drawn."""


def plot_gap(diagnosis: Diagnosis, ax: Axes | None = None, *, together: bool = False) -> Axes:
    """Held-out root mean squares in standard deviations of the noise, with 95 % intervals, on a logarithmic axis.

    together : only all records and columns together
    """
    needed(diagnosis.gaps, "gap", "It needs stretches that were held out.")
    shown = _shown(diagnosis.gaps, together)
    steps = steps_of(bool(diagnosis.causes))
    height = 0.84 / len(steps)
    with house_look():
        ax = given_or_new(ax, WIDTH, 1.1 + (0.45 if len(shown) > 1 else 1.1) * len(shown))
        places = np.arange(len(shown))[::-1]
        values: list[float] = []
        for k, (name, text) in enumerate(steps.items()):
            misfits = [getattr(gap, name) for gap in shown]
            at = places + 0.42 - (k + 0.5) * height
            sizes = [item.value for item in misfits]
            ax.barh(at, np.nan_to_num(sizes, nan=0.0, posinf=0.0), 0.86 * height, color=LOOKS[name]["color"], label=text)
            for y, item in zip(at, misfits, strict=True):
                if math.isfinite(item.low) and math.isfinite(item.high):
                    ax.plot([item.low, item.high], [y, y], color="black", linewidth=1.0, linestyle="-", marker="|", markersize=4.0)
                if math.isfinite(item.value) and len(shown) <= 4:
                    end = item.high if math.isfinite(item.high) else item.value
                    ax.annotate(digits(item.value, 3), (end, y), (4, 0), textcoords="offset points", va="center", fontsize=8.5)
                values += [value for value in (item.value, item.low, item.high) if math.isfinite(value) and value > 0.0]
        floors = [gap.floor for gap in shown]
        ax.axvline(min(floors), color="black", linestyle="--", linewidth=1.1, label="noise alone")
        ax.set_xscale("log")
        low, high = min([*values, *floors]), max([*values, *floors])
        ax.set_xlim(0.7 * min(low, min(floors)), high * (high / low) ** 0.12 * 1.3)
        ax.set_yticks(places, [readable(gap_name(gap)) for gap in shown])
        ax.set_ylim(-0.55, len(shown) - 0.45)
        ax.grid(False, axis="y")
        for formatter in (ax.xaxis.set_major_formatter, ax.xaxis.set_minor_formatter):
            formatter(LogFormatter(labelOnlyBase=False, minor_thresholds=(1.2, 0.5)))
        ax.set_xlabel("held-out rms [standard deviations of the noise]")
        legend_above(ax, columns=2)
    return ax


def _shown(gaps: tuple[Gap, ...], together: bool) -> list[Gap]:
    if together or len(gaps) <= MOST:
        return [gaps[0]] if together else list(gaps)
    worst = sorted(gaps[1:], key=lambda gap: -gap.nominal.value)[: MOST - 1]
    return [gaps[0], *(gap for gap in gaps[1:] if any(gap is other for other in worst))]
