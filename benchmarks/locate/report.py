"""The tables of the benchmark as text."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.locate.judging import OUTCOMES
from benchmarks.withheld.case_score import interval
from benchmarks.writing import facts, table

EDGES = (0.0, 0.5, 0.9, 1.01)
"""Of the groups of probabilities."""


def report(numbers: Mapping[str, Any]) -> str:
    """results.md: outcomes by kind of cause, and every case."""
    parts = ["# Where the gap sits: last results", "", facts(numbers["machine"]), ""]
    for bench, rows in numbers["cases"].items():
        parts += [
            f"## {bench} bench, {len(rows)} cases",
            "",
            _shares(rows),
            "",
            _by_kind(rows),
            "",
            _calibration(rows),
            "",
            _cases(rows),
            "",
        ]
    if numbers.get("failed"):
        parts += [f"Not located, because the case failed: {', '.join(Path(item['folder']).name for item in numbers['failed'])}.", ""]
    return "\n".join(parts)


def _shares(rows: list[Mapping[str, Any]]) -> str:
    named = [row for row in rows if row["outcome"] in ("right", "tied", "wrong")]
    good = sum(row["outcome"] in ("right", "tied") for row in named)
    seconds = [row["seconds"] for row in rows]
    if not named:
        return "No place was named."
    low, high = interval(good, len(named))
    return (
        f"Of {len(named)} places that were named {good} are right or in the tied group (95 % interval {low:.2f} to {high:.2f})."
        f" CPU seconds a case without the refit: median {np.median(seconds):.0f}, most {max(seconds):.0f}."
    )


def _by_kind(rows: list[Mapping[str, Any]]) -> str:
    shown = [outcome for outcome in OUTCOMES if any(row["outcome"] == outcome for row in rows)]
    kinds = sorted({row["kind"] for row in rows})
    return table(
        ["cause", *shown],
        [[kind, *(str(sum(row["kind"] == kind and row["outcome"] == outcome for row in rows)) for outcome in shown)] for kind in kinds],
    )


def _calibration(rows: list[Mapping[str, Any]]) -> str:
    """How often the answer that comes first is right by itself, ties not counted, beside its probability; nowhere is right of nothing."""
    good = ("right", "not trusted, right", "kept")
    lines = []
    for low, high in pairwise(EDGES):
        here = [row for row in rows if low <= row["probability"] < high]
        if here:
            mean = float(np.mean([row["probability"] for row in here]))
            lines.append([f"{low:g} to {min(high, 1.0):g}", f"{mean:.2f}", f"{sum(row['outcome'] in good for row in here)} of {len(here)}"])
    return table(["probability of the first answer", "mean", "right"], lines)


def _cases(rows: list[Mapping[str, Any]]) -> str:
    return table(
        ["case", "cause", "found", "tied with", "probability", "left", "outcome", "s"],
        [
            [
                row["case"],
                ", ".join(f"{effect} at {at}" for effect, at in row["causes"]) or "none",
                row["found"],
                ", ".join(row["tied"]),
                f"{row['probability']:.2f}",
                f"{row['left']:.3g}",
                row["outcome"],
                f"{row['seconds']:.0f}",
            ]
            for row in rows
        ],
    )
