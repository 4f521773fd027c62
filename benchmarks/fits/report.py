"""Results of the fits as text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

WAYS = ("curved", "straight", "scipy")


def report(numbers: Mapping[str, Any]) -> str:
    """What each way leaves and what it costs, against the fit of the diagnosis."""
    rows = numbers["rows"]
    cases = list(dict.fromkeys((row["bench"], row["case"]) for row in rows))
    lines = [
        "# Joint fits",
        "",
        f"{numbers['about']['processor']}. Mean square of the fitted samples (1: noise alone) at the start and the end; runs of the",
        "bench's model, those of differences included; processor time against that of curved steps.",
        "",
        "| bench | cause | law at place | start | curved | straight | scipy | runs: curved | straight | scipy | time: straight | scipy |",
        "|---|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    ratios: dict[str, list[float]] = {"straight": [], "scipy": []}
    for bench, case in cases:
        own = {row["way"]: row for row in rows if (row["bench"], row["case"]) == (bench, case)}
        first = own["curved"]
        times = {way: own[way]["seconds"] / first["seconds"] for way in ratios}
        for way, ratio in times.items():
            ratios[way].append(ratio)
        lines.append(
            f"| {bench} | {first['cause']} | {first['law']} at {first['place']} | {first['begun']:.4g} | "
            + " | ".join(f"{own[way]['left']:.4f}" for way in WAYS)
            + " | "
            + " | ".join(str(own[way]["runs"]) for way in WAYS)
            + " | "
            + " | ".join(f"{times[way]:.2f}" for way in ratios)
            + " |"
        )
    middle = {way: float(np.exp(np.mean(np.log(values)))) for way, values in ratios.items()}
    lines += ["", f"Time in the geometric mean: straight {middle['straight']:.2f}, scipy {middle['scipy']:.2f} times that of curved steps."]
    return "\n".join([*lines, ""])
