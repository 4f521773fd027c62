"""Results of records that begin in rotation as text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmarks.writing import facts, table


def report(numbers: Mapping[str, Any]) -> str:
    """What each way leaves of the noise and costs, and what a diagnosis says then."""
    first = next(row for row in numbers["ways"] if row["way"] == "free vibration eliminated")
    ways = [
        (row["way"], f"{row['rms']:.3f}", row["runs"], f"{row['seconds']:.3f}", f"{row['seconds'] / first['seconds']:.2f}")
        for row in numbers["ways"]
    ]
    planted = numbers["planted"]
    diagnoses = [
        (
            row["way"],
            " + ".join(row["causes"]) or "none",
            f"{row['refit']:.3g}",
            f"{row['left']:.3f}",
            ", ".join(f"{name} {value:.4g} of {planted[name]:.4g}" for name, value in row["identified"].items()) or "-",
            f"{row['seconds']:.0f}",
            len(row["warnings"]),
        )
        for row in numbers["diagnoses"]
    ]
    return "\n".join(
        [
            "# Records that begin in rotation",
            "",
            "At the true model, rms of what is left in standard deviations of the noise (1 is noise alone); CPU seconds, median.",
            "",
            table(("way", "left", "runs", "CPU [s]", "against the elimination"), ways),
            "",
            f"Diagnosed from the data sheet, {numbers['laws']} laws tried, one process; rms on stretches that no fit saw.",
            "",
            table(("way", "causes named", "refitted", "with them", "identified of what was planted", "CPU [s]", "warnings"), diagnoses),
            "",
            facts(numbers["about"]),
            "",
        ]
    )
