"""Pictures of the scoring: calibration curve, accuracy against detectability."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from benchmarks.withheld.calibration import curve
from benchmarks.withheld.case_score import Row, Share, interval, share
from hdrive_mbs.plots.look import COLOURS, GREY, house_look, new_figure

LEAST = 5
"""Cases that a step of detectability holds at least, where there are as many."""


def calibration_figure(rows: Sequence[Row]) -> Figure:
    """Share right over the probability that was said, with 95 % intervals."""
    with house_look():
        made = new_figure(4.6, 4.4)
        ax = made.subplots()
        ax.plot([0, 1], [0, 1], color=GREY, linestyle="--", label="perfect")
        found = curve([row.confidence for row in rows], [row.effect for row in rows])
        ends = np.array([interval(item.right, item.of) for item in found]).reshape(-1, 2)
        shown = np.array([item.share for item in found])
        at = [item.confidence for item in found]
        spread = np.abs(ends.T - shown)
        ax.errorbar(at, shown, yerr=spread, color=COLOURS[0], marker="o", linestyle="none", label="answers (number)")
        for item in found:
            ax.annotate(f" {item.of}", (item.confidence, item.share), textcoords="offset points", xytext=(4, -9), fontsize=8)
        ax.set(xlabel="probability of the answer", ylabel="share of right answers", xlim=(0, 1.02), ylim=(0, 1.02))
        ax.legend(loc="upper left")
        return made


def detectability_figure(rows: Sequence[Row]) -> Figure:
    """Share right by detectability, with 95 % intervals; every case as a tick."""
    with house_look():
        made = new_figure(6.4, 3.8)
        ax = made.subplots()
        for low, high, found in by_detectability(rows):
            ends = interval(found.right, found.of)
            middle = math.sqrt(low * high)
            ax.plot([low, high], [found.value] * 2, color=COLOURS[0], linestyle="-")
            ax.plot([middle] * 2, ends, color=COLOURS[0], linestyle="-", linewidth=0.9)
            ax.annotate(f"{found.right}/{found.of}", (middle, found.value), textcoords="offset points", xytext=(4, 4), fontsize=8)
        for good, colour, level in ((True, COLOURS[2], 1.04), (False, COLOURS[1], -0.04)):
            at = [row.detectability for row in rows if row.detectability is not None and row.effect == good]
            words = "right" if good else "wrong"
            ax.plot(at, [level] * len(at), color=colour, marker="|", linestyle="none", label=words)
        ax.set(
            xscale="log",
            xlabel="detectability of the faintest cause (squared distance in noise)",
            ylabel="share of right answers",
            ylim=(-0.1, 1.1),
        )
        ax.legend(loc="center right")
        return made


def by_detectability(rows: Sequence[Row], steps: int = 5) -> list[tuple[float, float, Share]]:
    """Steps with about as many cases each: their least and greatest detectability, and how many are right."""
    known = sorted((row for row in rows if row.detectability), key=lambda row: row.detectability or 0.0)
    number = max(min(steps, len(known) // LEAST), 1)
    found = []
    for part in np.array_split(np.arange(len(known)), number):
        own = [known[k] for k in part]
        if own:
            found.append((own[0].detectability or 0.0, own[-1].detectability or 0.0, share(own, lambda row: row.effect)))
    return found
