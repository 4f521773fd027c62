"""Results of fits with differences of many lengths, as text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmarks.writing import table

HEAD = ("place", "change of the residuals", "above the least", "mean square", "steps", "ended", "runs", "seconds", "of long")


def report(numbers: Mapping[str, Any]) -> str:
    """Of each place what the fits leave above the best one, and what they cost against that with the longest differences."""
    lines = [
        "# Lengths of differences",
        "",
        f"{numbers['about']['processor']}. Cost: negative logarithm of the posterior but for a constant. Change: root of the sum of",
        "squares by which a difference along one coordinate changes the residuals; none: as long as the coordinate's step, about a",
        "hundredth of a standard deviation.",
        "",
    ]
    rows = []
    for place, bears in numbers["bears"].items():
        own = [row for row in numbers["rows"] if row["place"] == place]
        least, slowest = min(row["cost"] for row in own), own[0]["seconds"]
        for row in own:
            change, ended = "none" if row["change"] is None else f"{row['change']:g}", "yes" if row["converged"] else "no"
            left = [f"{row['cost'] - least:.1f}", f"{row['mean_square']:.4f}"]
            rows.append(
                [place, change, *left, row["steps"], ended, row["runs"], f"{row['seconds']:.1f}", f"{row['seconds'] / slowest:.2f}"]
            )
        shown = f"the largest column bears {bears['largest']:.0f}, the direction that shows least {bears['least']:.2f}."
        lines.append(f"{place}: least cost {least:.1f}; {shown}")
    return "\n".join([*lines, "", table(HEAD, rows), ""])
