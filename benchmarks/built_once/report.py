"""Results of lines that are built once as text."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from benchmarks.writing import table


def report(numbers: Mapping[str, Any]) -> str:
    """Each law, and the median over all of a bench."""
    made = [
        "# Lines built once",
        "",
        f"{numbers['about']['processor']}. CPU seconds, least of {numbers['repeats']} batches of {numbers['sets']} parameter sets; a run is"
        " as long as a record of the bench, as many side by side as there are lanes.",
        "",
    ]
    for bench in dict.fromkeys(row["bench"] for row in numbers["rows"]):
        rows = [row for row in numbers["rows"] if row["bench"] == bench]
        made += [f"## {bench.capitalize()} bench", "", *_summary(rows), "", _table(rows, numbers["sets"]), ""]
    return "\n".join(made)


def _summary(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    with_one = [row for row in rows if row["has"]]
    saved = np.median([row["template_s"] / row["built_s"] for row in with_one])
    share = np.median([row["built_s"] / (row["built_s"] + row["run_s"]) for row in rows])
    pays = np.median([row["made_s"] / (row["built_s"] - row["template_s"]) for row in with_one])
    return [
        f"{len(with_one)} of {len(rows)} laws and places have a template. In the median a line from it takes {saved:.3f} of one that is"
        f" built, building takes {share:.2f} of building and running one record, and a template pays from {pays:.1f} lines on.",
        f"Largest difference of constants: {max(row['apart'] for row in with_one):.0e} of them.",
    ]


def _table(rows: Sequence[Mapping[str, Any]], sets: int) -> str:
    heads = ("law", "place", "template made [ms]", "line built [ms]", "line from template [ms]", "run [ms]", "holds", "apart")
    cells = [
        (
            row["law"],
            row["place"],
            f"{1e3 * row['made_s']:.1f}" if row["has"] else "none",
            f"{1e3 * row['built_s']:.2f}",
            f"{1e3 * row['template_s']:.3f}" if row["has"] else "",
            f"{1e3 * row['run_s']:.2f}",
            f"{row['kept']}/{sets}" if row["has"] else "",
            f"{row['apart']:.0e}" if row["has"] else "",
        )
        for row in rows
    ]
    return table(heads, cells)
