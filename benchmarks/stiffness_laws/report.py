"""The results of the benchmark as text."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from benchmarks.stiffness_laws.claim import Claim
from benchmarks.writing import facts, table


def report(numbers: Mapping[str, Any], claims: Sequence[Claim]) -> str:
    """Markdown: verdicts, Table 1, laws, runs."""
    parts = [
        "# The stiffness laws of Folega et al. 2014, judged",
        "Train of models/harmonic_drive_train.py, laws fitted to the catalogue curve of Table 1 up to 137 N m. Load in the gap torque: "
        "4 + 3 sin(2 pi t) N m; above it: 20 + 5 sin(2 pi t) N m. Explicit, adaptive: DormandPrince (1e-6, 1e-8), "
        "coarse: 1e-4, 1e-6; explicit, fixed step: RungeKutta4, 20 us; implicit: Trapezoidal, 0.1 ms. CPU seconds.",
        facts(numbers["machine"]),
        "## Claims",
        table(("where", "the paper", "found", "verdict"), [(c.where, c.says, c.found, c.verdict) for c in claims]),
        "## Table 1",
        table(
            ("equation", "torque [N m]", "Table 1 [rad]", "corrected [rad]", "as printed [rad]"),
            [
                (r["equation"], f"{r['torque']:g}", f"{r['table']:.2e}", f"{r['corrected']:.5e}", f"{r['as_printed']:.5e}")
                for r in numbers["table_1"]["rows"]
            ],
        ),
        "## Laws",
        _laws(numbers["shapes"]["laws"]),
        "## Runs",
        "Per simulated second; torque: of the law, over the second half of the run. The jump laws inside the gap torque were run for "
        f"{numbers['durations']['in_gap']:g} s, as one second takes minutes; CPU time of the others: median of {numbers['repeats']}.",
        _runs(numbers["pulses"]["runs"]),
    ]
    return "\n\n".join(parts)


def _laws(laws: Mapping[str, Any]) -> str:
    rows = []
    for name, law in laws.items():
        modes = ", ".join(f"{value:.1f} at {float(load):g} N m" for load, value in law["first_mode"].items())
        twists = f"{1e3 * law['twist_at_5']:.3f}, {1e3 * law['twist_at_20']:.3f}"
        deviation = f"{law['largest_deviation']:.2f}, {law['rms_deviation']:.2f}"
        rows.append((name, deviation, f"{law['torque_inside_gap']:.2f}", f"{law['torque_at_edge']:.2f}", twists, modes))
    head = (
        "law",
        "largest, rms deviation [N m]",
        "inside the gap [N m]",
        "at its edge [N m]",
        "twist at 5, 20 N m [mrad]",
        "first mode, undamped [rad/s]",
    )
    described = "\n".join(f"- {name}: {law['law']}" for name, law in laws.items())
    return f"{table(head, rows)}\n\n{described}"


def _runs(runs: Mapping[str, Any]) -> str:
    rows = []
    for key, run in runs.items():
        scenario, law, solver = key.split(" / ")
        if "failure" in run:
            rows.append((scenario, law, solver, f"failed: {run['failure']}", "", "", "", "", ""))
            continue
        rows.append((
            scenario, law, solver, f"{run['steps_per_second']:.3g}", f"{run['rejected_per_second']:.2g}", f"{run['median_step']:.1e}",
            f"{run['cpu_per_second']:.3g}", f"{run['pulses_per_second']:.3g}",
            f"{run['smallest_torque']:.2f} - {run['largest_torque']:.2f}",
        ))  # fmt: skip
    head = ("scenario", "law", "solver", "steps", "rejected", "median step [s]", "CPU [s]", "passages of the edge", "torque [N m]")
    return table(head, rows)
