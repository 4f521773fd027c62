"""Results of the pace as text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np


def report(numbers: Mapping[str, Any]) -> str:
    """Of each cause what is left with the line as it is and at the pace, and what a batch of points costs."""
    rows = numbers["rows"]
    shares = [row["quick_s"] / row["exact_s"] for row in rows]
    steps = rows[0]["steps"]
    lines = [
        "# A search in longer steps",
        "",
        f"{numbers['about']['processor']}; CPU seconds of {numbers['at_once']} points, least of {numbers['repeats']}, in turns.",
        f"The line as it is takes steps of {1e3 * rows[0]['step']:.4g} ms. With {rows[0]['slowed']} vibrations slowed: "
        + ", ".join(f"{1e3 * step:.4g} ms in {name!r}" for name, step in steps.items())
        + f". A batch takes {np.median(shares):.2f} of the time in the median ({min(shares):.2f} to {max(shares):.2f}).",
        "",
        "| cause | law | place | left, line as it is | same point at the pace | fitted on, line as it is | fitted on at the pace | apart"
        " | line as it is [ms] | at the pace [ms] | share |",
        "|---|---|---|---|---|---|---|---|---|---|---|",
        *(
            f"| {row['cause']} | {row['law']} | {row['place']} | {row['exact']:.4f} | {row['quick']:.4f} | {row['on']:.4f}"
            f" | {row['refitted']:.4f} | {row['moved']:.2f} | {1e3 * row['exact_s']:.1f} | {1e3 * row['quick_s']:.1f} | {share:.2f} |"
            for row, share in zip(rows, shares, strict=True)
        ),
    ]
    return "\n".join([*lines, ""])
