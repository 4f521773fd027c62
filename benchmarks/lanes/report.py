"""Results of the lanes as text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def report(numbers: Mapping[str, Any]) -> str:
    """Time of a run against that in one lane, and what it costs for each lane."""
    narrow, wide = numbers["lanes_used"]
    lines = [
        "# Lanes of compiled runs",
        "",
        f"{numbers['about']['processor']}; {narrow} lanes, and {wide} for more lines. CPU seconds, least of {numbers['repeats']}.",
        "Shares are of one lane's time: of the whole run, and of it for each lane.",
        "",
        "| model | lanes | machine code [s] | run [ms] | of one lane | each lane | apart |",
        "|---|---|---|---|---|---|---|",
    ]
    for model in dict.fromkeys(row["model"] for row in numbers["rows"]):
        rows = [row for row in numbers["rows"] if row["model"] == model]
        one = rows[0]["run_s"]
        lines += [
            f"| {model} | {row['width']} | {row['compile_s']:.2f} | {1e3 * row['run_s']:.1f} | {row['run_s'] / one:.2f}"
            f" | {row['run_s'] / one / row['width']:.2f} | {row['apart']:.0e} |"
            for row in rows
        ]
    records = numbers["records"]
    lines += [
        "",
        "Lines of three records, each record by itself and all side by side:",
        "",
        "| model | lengths | lines of each record | each by itself [ms] | together [ms] | of each by itself | differ |",
        "|---|---|---|---|---|---|---|",
        *(
            f"| {row['model']} | {row['lengths']} | {row['lines']} | {1e3 * row['apart_s']:.1f} | {1e3 * row['together_s']:.1f}"
            f" | {row['together_s'] / row['apart_s']:.2f} | {row['differ']:.0e} |"
            for row in records
        ),
    ]
    return "\n".join([*lines, ""])
