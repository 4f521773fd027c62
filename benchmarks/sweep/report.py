"""The table of the benchmark as text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmarks.writing import facts, table


def report(numbers: Mapping[str, Any]) -> str:
    """results.md: wall time of each way, and how many times as fast as one after the other."""
    alone = min(numbers["ways"][0]["run_ups_seconds"])
    rows = []
    for row in numbers["ways"]:
        best, worst = min(row["run_ups_seconds"]), max(row["run_ups_seconds"])
        rows.append(
            [
                row["way"],
                str(row["workers"]),
                f"{best:.2f}",
                f"{worst:.2f}",
                f"{alone / best:.2f}",
                f"{1e3 * min(row['nothing_seconds']) / numbers['nothings']:.2f}",
            ]
        )
    heads = ["way", "workers", "best [s]", "worst [s]", "times as fast", "job that does nothing [ms]"]
    parts = [
        "# Sweep: last results",
        "",
        facts(numbers["machine"]),
        "",
        f"{numbers['run_ups']} run-ups of the two-rotor line over {numbers['duration']:g} s with a step of 1e-4 s; "
        f"{numbers['nothings']} jobs that do nothing. Wall seconds of the call to `sweep`, of {numbers['repeats']} repeats, with the start "
        "of its processes but without that of the dask cluster.",
        "",
        table(heads, rows),
        "",
        "All ways and repeats gave the same table to the last bit." if numbers["equal"] else "THE WAYS GAVE DIFFERENT NUMBERS.",
    ]
    return "\n".join(parts)
