"""The tables of the comparison as text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmarks.writing import facts, table


def report(numbers: Mapping[str, Any]) -> str:
    """results.md: times and errors side by side, and the ratio to ROSS's fastest way of the same work."""
    ross = numbers.get("ross")
    parts = ["# Rotor speed: last results", "", facts(numbers["machine"]), ""]
    if ross:
        parts += [facts({k: ross[k] for k in ("python", "ross-rotordynamics", "numpy", "scipy", "numba") if k in ross}), ""]
    parts += [f"## Campbell diagram, {numbers['speeds']} speeds", "", _campbell(numbers, ross), ""]
    parts += ["## Prescribed run-up, 6 elements", "", _run_up(numbers, ross), ""]
    parts += [
        "Times are CPU seconds, best of the calls after the first. Errors of the Campbell diagram: relative, largest over the speeds, "
        "of the lowest and of the sixth lateral frequency; of the run-up: over the largest displacement "
        f"({numbers['largest displacement'] * 1e6:.2f} um, 0-peak), each against its own equations (README.md: the term Ksdt).",
    ]
    return "\n".join(parts)


def _campbell(numbers: Mapping[str, Any], ross: Mapping[str, Any] | None) -> str:
    rows = []
    for run in numbers["campbell"]:
        count, best = run["elements"], min(run["seconds"])
        theirs = (
            [item for item in ross["campbell"] if item["elements"] == count and len(item.get("errors", [0.0] * 6)) >= 6] if ross else []
        )
        fastest = min((min(item["seconds"]) for item in theirs), default=None)
        rows.append(_campbell_row("hdrive_mbs", run, "" if fastest is None else f"{fastest / best:.1f} x as fast as the fastest below"))
        rows += [_campbell_row(f"ROSS, {item['way']}", item, "") for item in theirs]
    return table(["elements", "way", "first call [s]", "next [s]", "error 1st", "error 6th", "wrong whirl", ""], rows)


def _campbell_row(way: str, run: Mapping[str, Any], note: str) -> list[str]:
    errors = [f"{value:.1e}" for value in run["errors"]] if "errors" in run else ["-"] * 6
    wrong = f"{run['wrong_whirl']:.0%}" if "wrong_whirl" in run else "-"
    return [
        str(run["elements"]), way, f"{run['first_seconds']:.2f}", f"{min(run['seconds']):.3f}", errors[0], errors[5],
        wrong, note,
    ]  # fmt: skip


def _run_up(numbers: Mapping[str, Any], ross: Mapping[str, Any] | None) -> str:
    rows = [
        [
            str(run["steps"]),
            "hdrive_mbs (solver alone)",
            f"{min(run['seconds']):.3f} ({min(run['solver_seconds']):.3f})",
            f"{run['error']:.1e}",
        ]
        for run in numbers["run_up"]
    ]
    rows += [
        [str(run["steps"]), f"ROSS, {run['way']}", f"{min(run['seconds']):.3f}", f"{run['error']:.1e}"]
        for run in (ross or {}).get("run_up", ())
    ]
    return table(["steps", "way", "CPU [s]", "error"], sorted(rows, key=lambda row: -int(row[0])))
