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

BESIDE = 0.04
"""Probabilities closer than this have their numbers to either side."""


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
        ax.errorbar(at, shown, yerr=spread, color=COLOURS[0], marker="o", linestyle="none", label="answers (number), 95 % interval")
        for item, following in zip(found, (*at[1:], math.inf), strict=True):
            left = following - item.confidence < BESIDE  # so that "1" and "1" are not read as eleven
            ax.annotate(
                f"{item.of}",
                (item.confidence, item.share),
                textcoords="offset points",
                xytext=(-6 if left else 6, 5),
                ha="right" if left else "left",
                fontsize=8,
            )
        ax.set(xlabel="probability of the answer", ylabel="share of right answers", xlim=(0, 1.06), ylim=(-0.03, 1.06))
        ax.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2)
        return made


def detectability_figure(rows: Sequence[Row]) -> Figure:
    """Share right by detectability, with 95 % intervals; every case as a tick."""
    with house_look():
        made = new_figure(6.4, 4.0)
        ax = made.subplots()
        steps = by_detectability(rows)
        first = steps[0][0] if steps else None
        for low, high, found in steps:
            ends = interval(found.right, found.of)
            middle = math.sqrt(low * high)
            ax.plot([low, high], [found.value] * 2, color=COLOURS[0], linestyle="-")
            ax.plot([middle] * 2, ends, color=COLOURS[0], linestyle="-", linewidth=0.9, label="95 % interval" if low == first else None)
            ax.annotate(f"{found.right}/{found.of}", (middle, found.value), textcoords="offset points", xytext=(4, -11), fontsize=8)
        for good, colour, level in ((True, COLOURS[2], 1.06), (False, COLOURS[1], -0.06)):
            at = [row.detectability for row in rows if row.detectability is not None and row.effect == good]
            words = "right" if good else "wrong"
            ax.plot(at, [level] * len(at), color=colour, marker="|", linestyle="none", label=words)
        ax.set(
            xscale="log",
            xlabel="detectability of the faintest cause (squared distance in noise)",
            ylabel="share of right answers",
            ylim=(-0.12, 1.12),
        )
        ax.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3)
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
