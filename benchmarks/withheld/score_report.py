"""The scoring as text."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from benchmarks.withheld.calibration import chance_error, curve, expected_error
from benchmarks.withheld.case_score import Row, Share, interval, medians, shares
from benchmarks.withheld.score_pictures import by_detectability
from benchmarks.writing import table


def report(rows: Mapping[str, Sequence[Row]], oracle: Mapping[str, Any], shared: Sequence[str]) -> str:
    """Markdown.  rows : by method, "diagnosis" first."""
    own = rows["diagnosis"]
    parts = [
        "# Withheld cases: what was found",
        f"{len(own)} cases. Counts with 95 % intervals (Clopper, Pearson).",
        _counts(rows),
        *(["What score.py of round 1 says on the same files:", "\n".join(f"    {line}" for line in shared)] if shared else []),
        "## How far the gap shrinks",
        _gap(own, oracle),
        "## Calibration",
        _calibration(own),
        "## Accuracy against detectability",
        _detectability(own),
        "## Confusion",
        "Rows: what was there; columns of a case with two causes are joined by +.",
        _confusion(own),
        "## Every case",
        _cases(own, oracle.get("ratios", {})),
    ]
    return "\n\n".join(parts)


def _counts(rows: Mapping[str, Sequence[Row]]) -> str:
    found = {name: shares(of) for name, of in rows.items()}
    means = {name: medians(of) for name, of in rows.items()}
    lines = [(what, *(str(found[name][what]) for name in rows)) for what in found["diagnosis"]]
    lines += [(what, *(_number(means[name][what]) for name in rows)) for what in means["diagnosis"]]
    return table(("", *rows), lines)


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.3g}"


def _gap(rows: Sequence[Row], oracle: Mapping[str, Any]) -> str:
    kinds = {"effect": "effects", "parameter": "parameters", "sensor": "sensors", "none": "nulls", "unknown": "no name"}
    lines = []
    for kind, words in kinds.items():
        gaps = [row.gap for row in rows if row.kind == kind and row.gap is not None]
        if gaps:
            lines.append((words, len(gaps), *(f"{_median([gap[name] for gap in gaps]):.4g}" for name in ("nominal", "refit", "effect"))))
    text = table(("cases with", "number", "nominal, median", "refit", "with the claim"), lines)
    text = "Root mean square of what no fit saw, in standard deviations of the noise (floor 1).\n\n" + text
    if oracle:
        good = Share(right=oracle["within"], of=oracle["cases"])
        text += (
            f"\n\nHeld-out gap over that of an oracle, which fits the right cause with all its laws: median {oracle['median']:.3f},"
            f" within 10 % in {good}."
        )
    return text


def _median(values: Sequence[float]) -> float:
    ordered = sorted(values)
    return ordered[len(ordered) // 2]


def _calibration(rows: Sequence[Row]) -> str:
    sure, right = [row.confidence for row in rows], [row.effect for row in rows]
    lines = []
    for item in curve(sure, right):
        low, high = interval(item.right, item.of)
        lines.append((f"{item.confidence:.3f}", f"{item.share:.3f} ({low:.2f}-{high:.2f})", item.of))
    return (
        f"Expected calibration error {expected_error(sure, right):.3f} (10 bins); perfect probabilities of this number would show"
        f" {chance_error(sure):.3f} on average.\n\n" + table(("probability said", "share right", "answers"), lines)
    )


def _detectability(rows: Sequence[Row]) -> str:
    lines = [(f"{low:.3g} to {high:.3g}", str(found)) for low, high, found in by_detectability(rows)]
    if not lines:
        return "The truths of this set say nothing of it."
    return "Of the faintest cause, nulls left out.\n\n" + table(("detectability", "effect right"), lines)


def _confusion(rows: Sequence[Row]) -> str:
    pairs = Counter((_words(row.truth, row.kind), _words(row.claim, row.said)) for row in rows)
    lines = [(truth, said, number, "" if truth == said else "wrong") for (truth, said), number in sorted(pairs.items())]
    return table(("truth", "answer", "cases", ""), lines)


def _words(causes: Sequence[tuple[str, str | None]], verdict: str) -> str:
    return " + ".join(sorted(name for name, _ in causes)) or verdict


def _cases(rows: Sequence[Row], ratios: Mapping[str, float]) -> str:
    lines = []
    for row in rows:
        truth = " + ".join(f"{name} at {at}" for name, at in row.truth) or "none"
        claim = " + ".join(f"{name} at {at}" for name, at in row.claim) or row.said
        gap = "-" if row.gap is None else " > ".join(f"{row.gap[name]:.3g}" for name in ("nominal", "refit", "effect"))
        seen = "-" if row.detectability is None else f"{row.detectability:.2g}"
        place = "-" if row.place is None else "yes" if row.place else "NO"
        oracle = f"{ratios[row.case]:.2f}" if row.case in ratios else "-"
        lines.append((row.case, truth, claim, "yes" if row.effect else "NO", place, f"{row.confidence:.2f}", seen, gap, oracle))
    head = ("case", "truth", "answer", "right", "place", "probability", "detectability", "gap", "over oracle")
    return table(head, lines)
