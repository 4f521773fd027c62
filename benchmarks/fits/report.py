"""Results of the fits as text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

WORDS = (
    "Misfit: what the diagnosis minimises, for a sample; 1 is noise alone, and stretches that fit badly count by their logarithm.",
    "Mean square: of the same samples, which scipy minimises. Runs of the bench's model, those of differences included. Time of the",
    "processor against that of curved steps.",
)


def report(numbers: Mapping[str, Any]) -> str:
    """What each way leaves and what it costs, against the fit of the diagnosis."""
    rows = numbers["rows"]
    ways = list(dict.fromkeys(row["way"] for row in rows))
    peers = ways[1:]
    cases = list(dict.fromkeys((row["bench"], row["case"]) for row in rows))
    heads = [f"{what} {way}" for what in ("misfit", "mean square", "runs") for way in ways] + [f"time {way}" for way in peers]
    lines = [
        "# Joint fits",
        "",
        f"{numbers['about']['processor']}. {WORDS[0]}",
        *WORDS[1:],
        "",
        "| bench | cause | law at place | mean square at the start | " + " | ".join(heads) + " |",
        "|" + "---|" * (4 + len(heads)),
    ]
    ratios: dict[str, list[float]] = {way: [] for way in peers}
    for bench, case in cases:
        own = {row["way"]: row for row in rows if (row["bench"], row["case"]) == (bench, case)}
        first = own[ways[0]]
        times = {way: own[way]["seconds"] / first["seconds"] for way in peers}
        for way, ratio in times.items():
            ratios[way].append(ratio)
        cells = [bench, first["cause"], f"{first['law']} at {first['place']}", f"{first['begun']:.4g}"]
        cells += [f"{own[way]['misfit']:.4f}" for way in ways] + [f"{own[way]['left']:.4f}" for way in ways]
        cells += [str(own[way]["runs"]) for way in ways] + [f"{times[way]:.2f}" for way in peers]
        lines.append("| " + " | ".join(cells) + " |")
    middle = ", ".join(f"{way} {float(np.exp(np.mean(np.log(ratios[way])))):.2f}" for way in peers)
    lines += ["", f"Time in the geometric mean, against {ways[0]} steps: {middle}."]
    return "\n".join([*lines, ""])
