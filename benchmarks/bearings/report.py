"""The results of the benchmark as text."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from benchmarks.bearings.cases import FULL, MODELS
from benchmarks.bearings.claims import percent
from benchmarks.bearings.findings import Findings
from benchmarks.bearings.precision import ADAPTIVE, FIXED, IMPLICIT, SOLVERS, TARGET
from benchmarks.bearings.run_up import ROTORS
from benchmarks.stiffness_laws.claim import Claim
from benchmarks.writing import facts, table


def report(found: Findings, numbers: Mapping[str, Any], claims: Sequence[Claim], aims: Sequence[Claim]) -> str:
    """Markdown: verdicts, deviations, times, all runs."""
    parts = [
        "# The bearing models of Matyja 2015, compared",
        f"Line of models/two_rotor_line.py, torque-driven run-up of {found.duration:g} s. Amplitudes are distances of the geometric "
        f"centre from the axis, 0-peak. Deviations are from the full model, converged. CPU seconds of the integration alone, median "
        f"of {numbers['repeats']} interleaved repeats in one process (runs longer than a second: once).",
        facts(numbers["machine"]),
        "## Claims of the paper",
        _verdicts(claims, "the paper"),
        "## Aims",
        _verdicts(aims, "aim"),
        "## Accuracy",
        _scipy(found),
        _accuracy(found),
        "Deviation of the steady response over speeds away from the critical ones (largest), and at 1000 rad/s:",
        _bands(found),
        "Run-up: rms of the difference of the distances from the axis at equal speeds, over their rms:",
        _run_up_bands(found),
        "## Run time at equal accuracy",
        f"CPU time at an error of {100.0 * TARGET:g} % of the model's own converged peaks, read from a line through log(time) over "
        "log(error). Where every stable run of an explicit solver is better than that, it is the fastest of them.",
        _times(found),
        "run_up as it comes, without a setting; CPU time of the whole call with all channels and peaks:",
        _defaults(found),
        "## All runs",
        f"{IMPLICIT}: trapezoidal rule, setting: step; {FIXED}: classical Runge-Kutta, setting: step, 0.9 (and 0.45) of the longest "
        f"stable one; {ADAPTIVE}: Dormand-Prince, setting: relative tolerance (counted against the largest coordinate, the spin angle). "
        "Error: of the peaks, the larger of both rotors, against the same model and against the full one, both converged.",
        *(f"### {case.name}: {case.what}\n\n{_runs(numbers['cases'][case.name]['models'])}" for case in found.runs),
    ]
    return "\n\n".join(parts)


def _verdicts(claims: Sequence[Claim], who: str) -> str:
    return table(("where", who, "found", "verdict"), [(c.where, c.says, c.found, c.verdict) for c in claims])


def _scipy(found: Findings) -> str:
    checked = found.scipy()
    if "skipped" in checked:
        return f"Independent scipy model: not compared, {checked['skipped']}."
    listed = "; ".join(f"{name}: amplitude {item['amplitude']:.1e}, speed {item['speed']:.1e}" for name, item in checked.items())
    worst = max(runs.agreement for of in found.runs.values() for runs in of.values())
    return (
        f"Converged peaks of the full model against an independent one integrated with scipy, relative: {listed or 'no case in common'}. "
        f"The explicit method at its finest step and the implicit rule extrapolated agree within {worst:.1e} in all models."
    )


def _accuracy(found: Findings) -> str:
    rows = []
    for case, of in found.runs.items():
        for model in of:
            steady = found.steady_deviation(case, model)
            peaks = found.peak_deviation(case, model)
            exact = model == FULL
            criticals = found.steady[case][model].criticals[: len(steady["critical_speeds"])]
            pairs = zip(criticals, steady["critical_speeds"], strict=True)
            rows.append((
                case.name, model, ", ".join(f"{w:.2f}" if exact else f"{w:.2f} ({percent(d, 3)})" for w, d in pairs),
                *(_peak(of[model].converged[r].amplitude, peaks[r], of[model].converged[r].speed, exact) for r in ROTORS),
                *(", ".join(percent(value, 2) for value in steady["peaks"][r]) for r in ROTORS),
            ))  # fmt: skip
    head = ("line", "model", "critical speeds [rad/s]", "run-up peak, rotor 1", "rotor 2", "steady peaks, rotor 1", "rotor 2")
    return table(head, rows)


def _peak(amplitude: float, deviation: float, speed: float, exact: bool) -> str:
    text = f"{1e6 * amplitude:.3f} um at {speed:.2f} rad/s"
    return text if exact else f"{text} ({percent(deviation, 3)})"


def _bands(found: Findings) -> str:
    rows = []
    for case, of in found.runs.items():
        for model in of:
            if model == FULL:
                continue
            steady = found.steady_deviation(case, model)
            for band, values in steady["bands"].items():
                rows.append((case.name, model, band, *(f"{100.0 * values[r]:.3f} %" for r in ROTORS)))
            rows.append((case.name, model, "at 1000 rad/s", *(percent(steady["at_the_final_speed"][r], 3) for r in ROTORS)))
    return table(("line", "model", "speeds", "rotor 1", "rotor 2"), rows)


def _run_up_bands(found: Findings) -> str:
    rows = []
    for case, of in found.run_ups.items():
        for model, item in of.items():
            if model != FULL:
                for band, values in item["bands"].items():
                    rows.append((case.name, model, band, *("-" if values[r] is None else f"{100.0 * values[r]:.3f} %" for r in ROTORS)))
    return table(("line", "model", "speeds", "rotor 1", "rotor 2"), rows)


def _times(found: Findings) -> str:
    rows = []
    for case, of in found.runs.items():
        for model, runs in of.items():
            kind, seconds = runs.best()
            rows.append((
                case.name, model, len(runs.scene.network().bodies), f"{runs.fastest:.3g}", f"{1e6 * runs.step_limit:.1f}",
                *(_seconds(runs.time_at_target(solver)) for solver in SOLVERS),
                f"{seconds / found.duration:.3f} ({kind})", f"{found.time_ratio(case, model):.2f}",
            ))  # fmt: skip
    head = ("line", "model", "coordinates", "fastest eigenvalue [1/s]", "longest explicit step [us]", *(f"{s} [s]" for s in SOLVERS))
    return table((*head, "best over simulated time", "over full"), rows)


def _defaults(found: Findings) -> str:
    rows = []
    for case, of in found.defaults.items():
        for model, item in of.items():
            rows.append((case.name, model, item["solver"], f"{100.0 * item['error']:.3f} %", f"{item['seconds']:.2f}"))
    return table(("line", "model", "solver", "error of the peaks", "CPU [s]"), rows)


def _seconds(value: float) -> str:
    return f"{value:.3f}" if math.isfinite(value) else "-"


def _runs(models: Mapping[str, Any]) -> str:
    rows = []
    for model in MODELS:
        for run in models[model]["runs"]:
            if "failure" in run:
                rows.append((model, run["solver"], f"{run['setting']:.3g}", f"failed: {run['failure']}", "", "", "", "", "", ""))
                continue
            rows.append((
                model, run["solver"], f"{run['setting']:.3g}", f"{run['error']:.1e}", f"{run['error_against_full']:.1e}",
                f"{run['median_seconds']:.3f}", f"{run['best_seconds']:.3f}", run["samples"], run["steps"], run["rejected"],
            ))  # fmt: skip
    head = ("model", "solver", "setting", "error", "against full", "median CPU [s]", "best [s]", "repeats", "steps", "rejected")
    return table(head, rows)
