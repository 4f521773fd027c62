"""All parts of the benchmark in turn."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from matplotlib.figure import Figure

from benchmarks.machine import machine
from benchmarks.stiffness_laws.claim import Claim
from benchmarks.stiffness_laws.figures import figures
from benchmarks.stiffness_laws.measure import Measured
from benchmarks.stiffness_laws.output_shaft import output_shaft
from benchmarks.stiffness_laws.pulses import FULL, QUICK, Pulses, contacts, judge, planned
from benchmarks.stiffness_laws.reduction import reduction
from benchmarks.stiffness_laws.shapes import shapes
from benchmarks.stiffness_laws.table_1 import table_1
from hdrive_mbs.progress import progress_bar


def study(*, quick: bool, repeats: int) -> tuple[dict[str, Any], list[Claim], dict[str, Figure]]:
    """Numbers for results.json, the judged claims, the pictures."""
    durations = QUICK if quick else FULL
    numbers: dict[str, Any] = {"machine": machine(), "repeats": repeats, "durations": asdict(durations)}
    claims: list[Claim] = []
    plan = planned(durations, repeats)
    with progress_bar("stiffness laws", len(plan) + 4) as report:
        numbers["table_1"], judged = table_1()
        claims += judged
        numbers["shapes"], judged = shapes()
        claims += judged
        runs: dict[tuple[str, str, str], Measured] = {}
        for key, once in plan.items():
            runs[key] = once()
            if report is not None:
                report(len(runs) + 1)
        pulses = Pulses(runs, contacts(durations.contacts))
        numbers["pulses"] = pulses.numbers()
        claims += judge(pulses)
        numbers["output_shaft"], judged, shaft = output_shaft(2.0 * durations.normal)
        claims += judged
        numbers["reduction"], judged = reduction(durations.normal)
        claims += judged
        numbers["claims"] = [asdict(claim) for claim in claims]
        drawn = figures(pulses, shaft, numbers)
    return numbers, claims, drawn
