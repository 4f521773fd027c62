"""The times as tables."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmarks.writing import facts, table


def report(numbers: Mapping[str, Any]) -> str:
    """results.md"""
    rows = [
        [name, f"{row['cpu_s']:.3f}", f"{row['wall_s']:.3f}", f"{row['over_numpy_and_scipy']:.2f}"]
        for name, row in numbers["imports"].items()
    ]
    lines = [
        "# The front door: import, demo, page",
        "",
        f"A whole process each, median of {numbers['repeats']} taken in turn; the ratio is that of CPU times to `import numpy, scipy`.",
        "",
        table(("a process that does", "CPU [s]", "wall [s]", "ratio"), rows),
        "",
    ]
    demo = numbers["demo"]
    if demo is not None:
        sections = [[name, f"{demo['sections_cpu_s'][name]:.1f}", f"{seconds:.1f}"] for name, seconds in demo["sections_wall_s"].items()]
        lines += [
            table(
                ("section of the demo", "CPU [s]", "wall [s]"),
                [*sections, ["whole command", f"{demo['cpu_s']:.1f}", f"{demo['wall_s']:.1f}"]],
            ),
            "",
            f"Page: {demo['page_bytes'] / 1e6:.2f} MB in one file. Verdict of the diagnosis: {demo['verdict']}. The diagnosis uses two"
            " processes where there are two cores; their CPU time is in it.",
            "",
        ]
    lines += ["The machine was shared with other work: go by CPU time and by ratios within this run.", "", facts(numbers["machine"])]
    return "\n".join(lines)
