"""All parts of the benchmark in turn."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

from benchmarks.bearings.as_it_comes import as_it_comes
from benchmarks.bearings.cases import BEARINGS, CASES, DURATION, FULL, M_REF, MODELS, PAPER, SIMPLIFIED, Case, with_model
from benchmarks.bearings.claims import aims, claims
from benchmarks.bearings.figures import figures
from benchmarks.bearings.findings import Findings
from benchmarks.bearings.histories import compared
from benchmarks.bearings.pictures import pictures
from benchmarks.bearings.precision import measure
from benchmarks.bearings.steady import Steady, against, steady
from benchmarks.bearings.sweep import QUICK, WHOLE, damping_places, maps, work
from benchmarks.campaign import Where
from benchmarks.machine import machine
from benchmarks.stiffness_laws.claim import Claim
from hdrive_mbs.progress import progress_bar

FloatArray = npt.NDArray[np.float64]

QUICK_DURATION = 1.1
"""Just beyond the passage of the first critical speed [s]."""


def study(
    *, quick: bool, repeats: int, where: Where | None = None
) -> tuple[Findings, dict[str, Any], list[Claim], list[Claim], dict[str, Figure]]:
    """What was found, numbers for results.json, claims, aims, pictures.

    where : the maps are worked on; what is timed stays in this process
    """
    facts, where = machine(), where or Where()
    duration, cases, grid = (QUICK_DURATION, (M_REF,), QUICK) if quick else (DURATION, CASES, WHOLE)
    runs_share, total = 0.75, 1.0
    speeds = np.linspace(20.0, 1100.0, 541)
    with progress_bar("bearing models", total) as report:
        part = None if report is None else lambda done: report(runs_share * done)
        runs = measure(cases, duration, repeats=repeats, quick=quick, report=part)
        responses = {case: {model: steady(case.scene(model), speeds) for model in MODELS} for case in cases}
        paper = [case for case in PAPER if case in runs]
        histories = {case: {model: of.history for model, of in runs[case].items() if of.history is not None} for case in paper}
        done = 0

        def one_more() -> None:
            nonlocal done
            done += 1
            if report is not None:
                report(runs_share + (total - runs_share) * done / work(grid))

        defaults = {case: {model: as_it_comes(one, duration) for model, one in of.items()} for case, of in runs.items()}
        swept = {"maps": maps(grid, where, one_more), "damping": damping_places(grid, where, one_more)}
        found = Findings(
            duration=duration,
            runs=runs,
            steady=responses,
            run_ups={case: compared(histories[case], responses[case][FULL]) for case in paper},
            without_tilt={case: against(_without_tilt(case, speeds), responses[case][FULL]) for case in paper},
            defaults=defaults,
            swept=swept,
        )
        verdicts, reached = claims(found), aims(found)
        drawn = figures(histories) | pictures(runs, responses, swept, duration)
    numbers = {
        "machine": facts,
        "repeats": repeats,
        **found.numbers(),
        "claims": [asdict(item) for item in verdicts],
        "aims": [asdict(item) for item in reached],
    }
    return found, numbers, verdicts, reached, drawn


def _without_tilt(case: Case, speeds: FloatArray) -> Steady:
    """The simplified model with forces of the housing only."""
    nothing = dict.fromkeys(("law.stiffness_psi", "law.stiffness_theta", "law.damping_psi", "law.damping_theta"), 0.0)
    nothing |= {"polar_inertia": 1e-12, "transverse_inertia": 1e-12}
    bare = case.scene(FULL).replacing({f"{bearing}.{field}": value for bearing in BEARINGS for field, value in nothing.items()})
    return steady(with_model(bare, SIMPLIFIED)[0], speeds)
