"""Scores of one case by the rules of the answer format (round 1), and of many."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Any

from scipy.stats import beta

from benchmarks.withheld.names import verdict_of

NAMED = ("effect", "parameter", "sensor")
"""Kinds of cases whose causes have a name."""
LARGEST_TIE = 3
"""Names that a declared tie may have, the claim included, to count."""


@dataclass(frozen=True, kw_only=True)
class Row:
    """Scores of a case; None where a question does not apply.

    kind : right verdict;  two : two causes;  answered : whether there is an answer
    confidence : probability that the answer gives to what it says;  detectability : of the case's faintest cause
    """

    case: str
    kind: str
    two: bool
    answered: bool
    said: str
    effect: bool
    verdict: bool
    tied: bool
    top: bool
    place: bool | None
    brier: float | None
    confidence: float
    gap: Mapping[str, float] | None
    seconds: float | None
    detectability: float | None
    truth: tuple[tuple[str, str], ...]
    claim: tuple[tuple[str, str | None], ...]


def kind_of(truth: Sequence[Mapping[str, Any]]) -> str:
    """The right verdict of a case."""
    return verdict_of(truth[0]["effect"]) if truth else "none"


def score(case: str, labels: Mapping[str, Any], answer: Mapping[str, Any] | None) -> Row:
    """Scores of a case; no answer counts as wrong, and so does one that the runner gave for a method that failed ("unknown" with the error,
    see ``failed_answer``): it would be right by chance where the cause has no name."""
    truth = labels["truth"]
    kind = kind_of(truth)
    want = [(item["effect"], item["at"]) for item in truth]
    found = answer or {}
    got = [(item["effect"], item.get("at")) for item in found.get("effects", [])]
    said, names = found.get("verdict", "no answer"), [name for name, _ in got]
    right = said == kind and "error" not in found
    ranking = found.get("ranking", [])
    place: bool | None
    brier = None
    first_place = [item["at"] for item in found.get("where", [])[:1]]
    if kind in ("none", "unknown"):
        effect = top = tied = right and not got
        place = None if kind == "none" and answer is not None else bool(want) and first_place == [want[0][1]]
    else:
        wanted = sorted(name for name, _ in want)
        effect = wanted == sorted(names)
        top = all(name in names or name in [item["effect"] for item in ranking[:3]] for name in wanted) and answer is not None
        place = all(item in got for item in want) or (len(want) == 1 and first_place == [want[0][1]])
        group = {tuple(item[:2]) for item in found.get("indistinguishable", [])} | set(got)
        tied = effect or (len(want) == 1 and len(group) <= LARGEST_TIE and want[0] in group)
        if len(want) == 1 and answer is not None:
            brier = _brier(ranking, want[0][0])
    return Row(
        case=case,
        kind=kind,
        two=len(want) == 2,
        answered=answer is not None,
        said=said,
        effect=effect,
        verdict=right,
        tied=tied,
        top=top,
        place=place,
        brier=brier,
        confidence=confidence(found),
        gap=_gap(found),
        seconds=found.get("seconds"),
        detectability=_detectability(labels),
        truth=tuple(want),
        claim=tuple(got),
    )


def confidence(answer: Mapping[str, Any]) -> float:
    """Probability that an answer gives to what it says: of its least certain claim, or of "none" or "unknown"."""
    if answer.get("effects"):
        return float(min(item.get("probability", 1.0) for item in answer["effects"]))
    listed = [item["probability"] for item in answer.get("ranking", []) if item["effect"] == answer.get("verdict")]
    return float(listed[0]) if listed else 0.0


def _brier(ranking: Iterable[Mapping[str, Any]], wanted: str) -> float:
    listed = [item for item in ranking if item["effect"] != "none"]
    missing = all(item["effect"] != wanted for item in listed)
    return float(sum((item["probability"] - (item["effect"] == wanted)) ** 2 for item in listed) + missing)


def _gap(answer: Mapping[str, Any]) -> dict[str, float] | None:
    gap = answer.get("gap") or {}
    wanted = ("nominal", "refit", "effect", "floor")
    return {name: float(gap[name]) for name in wanted} if all(isinstance(gap.get(name), (int, float)) for name in wanted) else None


def _detectability(labels: Mapping[str, Any]) -> float | None:
    known = labels.get("detectability")
    if not isinstance(known, Mapping) or not labels["truth"]:
        return None
    each = known.get("each")
    return float(min(each)) if each else float(known["linear"]) if "linear" in known else None


def closed(gap: Mapping[str, float]) -> float:
    """Share of the gap's energy above the floor that the claim closes, on what no fit saw."""
    left = max(gap["effect"], gap["floor"]) ** 2 - gap["floor"] ** 2
    return 1.0 - left / max(gap["nominal"] ** 2 - gap["floor"] ** 2, 1e-9)


def interval(right: int, of: int, level: float = 0.95) -> tuple[float, float]:
    """Clopper, Pearson (1934): exact interval of a share."""
    outside = 0.5 * (1.0 - level)
    low = float(beta.ppf(outside, right, of - right + 1)) if right else 0.0
    high = float(beta.ppf(1.0 - outside, right + 1, of - right)) if right < of else 1.0
    return low, high


@dataclass(frozen=True, kw_only=True)
class Share:
    """How many of how many, with the 95 % interval."""

    right: int
    of: int

    @property
    def value(self) -> float:
        return self.right / self.of if self.of else float("nan")

    def __str__(self) -> str:
        if not self.of:
            return "-"
        low, high = interval(self.right, self.of)
        return f"{self.right}/{self.of} ({low:.2f}-{high:.2f})"


def share(rows: Iterable[Row], value: Callable[[Row], bool | None]) -> Share:
    """Share of rows with a true value, among those where it applies."""
    values = [found for row in rows if (found := value(row)) is not None]
    return Share(right=sum(values), of=len(values))


def shares(rows: Sequence[Row]) -> dict[str, Share]:
    """Every count of the scoring."""
    return {
        "effect right": share(rows, lambda row: row.effect),
        "single causes right": share(rows, lambda row: row.effect if row.kind in NAMED and not row.two else None),
        "with declared ties of at most 3": share(rows, lambda row: row.tied),
        "among the first 3": share(rows, lambda row: row.top),
        "verdict right": share(rows, lambda row: row.verdict),
        "place right": share(rows, lambda row: row.place),
        "nulls kept": share(rows, lambda row: row.verdict if row.kind == "none" else None),
        "unknown caught": share(rows, lambda row: row.verdict if row.kind == "unknown" else None),
        "wrongly unknown": share(rows, lambda row: row.said == "unknown" if row.kind != "unknown" else None),
        "both of two": share(rows, lambda row: row.effect if row.two else None),
    }


def medians(rows: Sequence[Row]) -> dict[str, float | None]:
    """Brier score (mean), gap closed and seconds (medians)."""
    brier = [row.brier for row in rows if row.brier is not None]
    shrunk = [closed(row.gap) for row in rows if row.gap is not None and row.kind == "effect"]
    seconds = [row.seconds for row in rows if row.seconds is not None]
    return {
        "Brier score": sum(brier) / len(brier) if brier else None,
        "gap energy closed, median": median(shrunk) if shrunk else None,
        "seconds, median": median(seconds) if seconds else None,
    }
