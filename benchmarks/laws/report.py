"""Costs of laws as text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def report(numbers: Mapping[str, Any]) -> str:
    """One table for each bench, dearest law first."""
    lines = [
        "# Laws in compiled runs",
        "",
        f"{numbers['about']['processor']}, {numbers['lanes']} lanes, CPU seconds, least of {numbers['repeats']}. Each law at one place, as"
        " a search begins with it; its time is told in that of the run without any law, both in turns. The step error is the largest"
        " difference from the run with half the step, of the largest reading.",
    ]
    for bench in dict.fromkeys(row["bench"] for row in numbers["rows"]):
        rows = sorted((row for row in numbers["rows"] if row["bench"] == bench), key=lambda row: -row["of_nominal"])
        lines += ["", f"## {bench}", "", "| law | at | time | operations | of them | step error |", "|---|---|---|---|---|---|"]
        lines += [
            f"| {row['law']} | {row['at']} | {row['of_nominal']:.2f} | {row['operations']}"
            f" | {', '.join(f'{count} {name}' for name, count in row['costly'].items())} | {row['step_error']:.1e} |"
            for row in rows
        ]
    return "\n".join([*lines, ""])
