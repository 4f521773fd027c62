"""Raw figures of a case, beside its answer: what every fit gave, so that other constants of the verdict can be tried later."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import hdrive_mbs as hm
from benchmarks.withheld.finding import Claimed, Finding
from benchmarks.withheld.names import Label
from hdrive_mbs.diagnosis import verdict
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.gather import Evidence
from hdrive_mbs.diagnosis.result import Diagnosis
from hdrive_mbs.diagnosis.tasks import Found
from hdrive_mbs.diagnosis.unevenness import patches, unevenness
from hdrive_mbs.diagnosis.verdict import Claim, judge

LOOKS = 30
"""Cheapest first looks that are kept."""


def raw_of(evidence: Evidence, groups: Mapping[str, Sequence[str]]) -> dict[str, Any]:
    """Figures of all fits as plain data: mean squares of fitted and held-out samples, log odds over the refitted nominal model."""
    looks = sorted(evidence.single.looks.items(), key=lambda item: item[1])[:LOOKS]
    return {
        "nominal": _fit(evidence.nominal),
        "null": _fit(evidence.null),
        "uneven": unevenness(evidence.fine, patches(evidence.fine, evidence.null)),
        "null_coarse": _fit(evidence.single.base),
        "singles": [_found(item, groups) for item in evidence.singles],
        "pairs": [_found(item, groups) for item in evidence.pairs],
        "search": [_found(item, groups) for item in evidence.single.found],
        "second": [] if evidence.pair is None else [_found(item, groups) for item in evidence.pair.found],
        "looks": dict(looks),
    }


def _fit(fitted: Fitted) -> dict[str, Any]:
    return {
        "fit": fitted.chi_fit,
        "held": fitted.chi_held,
        "cost": fitted.cost,
        "misfit": fitted.cost - fitted.hypothesis.prior_cost(fitted.z),
        "misfit_held": fitted.misfit_held,
        "steps": fitted.steps,
        "converged": bool(fitted.converged),
        "z": [round(value, 4) for value in fitted.z.tolist()],
    }


def _found(found: Found, groups: Mapping[str, Sequence[str]]) -> dict[str, Any]:
    hypothesis = found.fitted.hypothesis
    added = [{"label": list(item.label), "law": type(item.effect).__name__, "kind": type(item.effect).kind} for item in hypothesis.added]
    loose = [["parameter", group] for group, names in groups.items() if set(names) & set(hypothesis.loose)]
    return {
        "label": list(found.suspect.label),
        "law": found.suspect.law,
        "log_odds": found.log_odds,
        "added": added,
        "loose": loose,
        **_fit(found.fitted),
    }


@dataclass(frozen=True)
class _Suspect:
    label: Label
    law: str


@dataclass(frozen=True)
class _Hypothesis:
    added: tuple[Any, ...]
    loose: Mapping[str, float]


@dataclass(frozen=True)
class _Fitted:
    chi_fit: float
    chi_held: float
    hypothesis: _Hypothesis


@dataclass(frozen=True)
class _Found:
    """As much of a Found as the verdict looks at."""

    suspect: _Suspect
    fitted: _Fitted
    log_odds: float
    labels: tuple[Label, ...]


def _stored(entry: Mapping[str, Any]) -> Found:
    added = tuple(_added(item) for item in entry["added"])
    hypothesis = _Hypothesis(added, {group: 1.0 for _, group in entry["loose"]})
    labels = [_label(item["label"]) for item in entry["added"]] + [_label(item) for item in entry["loose"]]
    suspect = _Suspect(_label(entry["label"]), entry["law"])
    return _Found(suspect, _Fitted(entry["fit"], entry["held"], hypothesis), entry["log_odds"], tuple(labels))  # type: ignore[return-value]


def _added(item: Mapping[str, Any]) -> Any:
    family, at = item["label"]
    limits = getattr(getattr(hm, str(item["law"]), None), "limits", ())
    effect = type(str(item["law"]), (), {"kind": item["kind"], "family": family, "limits": limits})()
    return type("Added", (), {"effect": effect, "at": at, "label": (family, at)})()


def _label(pair: Sequence[str]) -> Label:
    return pair[0], pair[1]


def judged(raw: Mapping[str, Any]) -> Claim:
    """The verdict that the present rules and constants give on stored figures, among them how uneven a gap is where that is stored."""
    pairs = [_stored(item) for item in raw["pairs"]]
    misfit = math.sqrt(raw["null"]["fit"] * raw["null"]["held"])
    return judge(misfit, [_stored(item) for item in raw["singles"]], pairs, uneven=raw.get("uneven", 0.0))


def finding_again(raw: Mapping[str, Any]) -> Finding:
    """The finding that the present rules and constants give on stored figures; places and parameters as they were."""
    claim = judged(raw)
    fit: Any = claim.fit
    labels = () if fit is None or claim.kind in ("none", "unknown") else fit.labels
    before = {name: math.sqrt(raw[key]["held"]) for name, key in (("nominal", "nominal"), ("refit", "null"))}
    after = math.sqrt(fit.fitted.chi_held) if labels else before["refit"]
    return Finding(
        verdict=claim.kind,
        claimed=tuple(Claimed(label=label) for label in labels),
        tied=claim.tied,
        ranking=claim.probabilities,
        where=raw.get("where", {}),
        elsewhere=raw.get("elsewhere", ""),
        gap={**before, "effect": after, "floor": 1.0},
        seconds=raw.get("seconds", 0.0),
    )


def places_of(diagnosis: Diagnosis) -> list[dict[str, Any]]:
    """Located places as plain data."""
    kept = ("at", "probability", "gain", "share", "sensor")
    return [{**{name: getattr(place, name) for name in kept}, "tied": list(place.tied)} for place in diagnosis.where]


@contextmanager
def constants(**values: float) -> Iterator[None]:
    """The verdict with other constants, while the block lasts; names are those in hdrive_mbs/diagnosis/verdict.py."""
    unknown = [name for name in values if not hasattr(verdict, name)]
    if unknown:
        raise ValueError(f"no constant {unknown[0]!r} in hdrive_mbs/diagnosis/verdict.py.")
    before = {name: getattr(verdict, name) for name in values}
    try:
        for name, value in values.items():
            setattr(verdict, name, value)
        yield
    finally:
        for name, value in before.items():
            setattr(verdict, name, value)
