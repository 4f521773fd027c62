"""Pictures of the studies."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from benchmarks.real.held_out import Unseen


def histories(tried: Mapping[str, Unseen], every: float, rows: Mapping[str, tuple[str, float]], title: str) -> Figure:
    """Measured columns of a record that no fit saw, and what each scene leaves of them.

    rows : column -> (label, factor from SI)
    """
    figure = Figure(figsize=(9.0, 2.2 * 2 * len(rows)), layout="constrained")
    axes = figure.subplots(2 * len(rows), 1, sharex=True)
    first = next(iter(tried.values()))
    for k, (column, (label, factor)) in enumerate(rows.items()):
        above, below = axes[2 * k], axes[2 * k + 1]
        times = every * np.arange(len(first.measured[column]))
        above.plot(times, factor * (first.measured[column] - first.measured[column].mean()), color="black", linewidth=1.0)
        above.set_ylabel(f"{label}\nmeasured, less its mean")
        for name, item in tried.items():
            left = factor * (item.measured[column] - item.simulated[column])
            below.plot(times, left, linewidth=1.0, label=f"{name}: rms {factor * item.rms[column]:.3g}")
        below.set_ylabel("measured minus\nsimulated")
        below.legend(fontsize="small", ncols=3, loc="upper right")
    axes[0].set_title(f"{title}: no fit saw it")
    axes[-1].set_xlabel("time [s]")
    return figure


def planes(found: Mapping[str, Any]) -> Figure:
    """Misfit over how an unbalance is shared between the discs."""
    figure = Figure(figsize=(7.0, 4.0), layout="constrained")
    axes = figure.subplots()
    for name, item in found.items():
        (line,) = axes.plot(item["share"], item["misfit"], label=f"{name}: {item['words']}")
        axes.axvline(item["true_share"], color=line.get_color(), linestyle=":")
    axes.axhline(2.0, color="grey", linewidth=0.8)
    axes.set_ylabel("misfit above the best, log likelihood")
    axes.set_xlabel("share of the unbalance at disc 2 (dotted: as put in); below the grey line: cannot be told apart")
    axes.set_ylim(0.0, 30.0)
    axes.legend(fontsize="small")
    return figure
