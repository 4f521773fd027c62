"""From a finding to the answer object of one case, in the names of the answer format."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import Any

from benchmarks.withheld.finding import Claimed, Finding
from benchmarks.withheld.names import Label, Name, Names, verdict_of
from hdrive_mbs.diagnosis.result import NOWHERE

WORDS = ("none", "unknown")
"""Entries of a ranking that are no causes."""
TINY = 1e-300
ROUNDING = 1e-9
"""Of probabilities that add up."""
NAMED = 8.0
"""Odds of a label with a name over one without, before any record is seen.  Of the causes of our own sets up to the ninth rotor set
167 of 190 (drive) and 108 of 126 (rotor) have a name, which 38 of 87 and 55 of 118 labels share: 9.4 and 6.9."""


def answer_of(case: str, finding: Finding, names: Names) -> dict[str, Any]:
    """The answer.

    A claim without a name is answered "unknown", with its place first in ``where``, or before it the one where the gap lies instead of it.
    If a cause with a name is tied with it, that one is claimed: the table of names says beforehand that it is more likely to be there, and
    the probabilities of what is tied are weighed by that (NAMED).  Of two claimed causes the one that explains more by itself decides: if
    it has a name, what has none beside it is left out; if not, the answer is "unknown".
    """
    claimed = names.joined(_named(finding, names))
    if len(finding.claimed) == 1 and finding.tied:
        finding = replace(finding, ranking=_weighed(finding, names))
    verdict = finding.verdict
    if verdict not in WORDS:
        verdict = _verdict([name for name, _ in claimed])
    ranking = ranking_of(finding.ranking, names, _companions(finding, names) if claimed else ())
    chances = {(item["effect"], item["at"]): item["probability"] for item in ranking}
    return {
        "case": case,
        "verdict": verdict,
        "effects": [
            {"effect": name[0], "at": name[1], "probability": _chance(name, chances), "parameters": dict(item.parameters)}
            for name, item in claimed
        ],
        "indistinguishable": [list(name) for name in _tied(finding, names)] if claimed else [],
        "ranking": ranking,
        "where": _where(finding, names, [name for name, _ in claimed]),
        "gap": dict(finding.gap),
        "seconds": finding.seconds,
    }


def failed_answer(case: str, error: str, seconds: float) -> dict[str, Any]:
    """The answer to a case that could not be diagnosed."""
    nothing: dict[str, list[Any]] = {"effects": [], "indistinguishable": [], "ranking": [], "where": []}
    return {"case": case, "verdict": "unknown", **nothing, "gap": {}, "seconds": seconds, "error": error}


def ranking_of(ranking: Mapping[Label, float], names: Names, left_out: Collection[Label] = ()) -> list[dict[str, Any]]:
    """Names by falling probability: labels with one name are added up, at the place of the most probable of them.

    Two causes that stand together share one probability, which counts once for each name.

    left_out : labels that the answer does not speak of
    """
    total: dict[str, float] = {}
    counted: set[str] = set()
    best: dict[str, tuple[float, str | None]] = {}
    together = together_in(ranking)
    for label, probability in ranking.items():
        if label in left_out:
            continue
        name = names.name(label)
        effect = label[0] if label[0] in WORDS else "unknown" if name is None else name[0]
        at = None if label[0] in WORDS else names.place_of(label)
        if label not in together or effect not in counted:
            total[effect] = total.get(effect, 0.0) + probability
        if label in together:
            counted.add(effect)
        if effect not in best or probability > best[effect][0]:
            best[effect] = probability, at
    order = sorted(total, key=lambda effect: -total[effect])
    return [{"effect": effect, "at": best[effect][1], "probability": total[effect]} for effect in order]


def together_in(ranking: Mapping[Label, float]) -> list[Label]:
    """The two causes that share one probability, if any: what the probabilities add up to above 1 is theirs."""
    surplus = sum(ranking.values()) - 1.0
    if surplus < ROUNDING:
        return []
    found = [label for label, chance in ranking.items() if abs(chance - surplus) < ROUNDING and label[0] not in WORDS]
    return found if len(found) > 1 else []


def _companions(finding: Finding, names: Names) -> list[Label]:
    """Claimed causes without a name, of which an answer that claims another one says nothing: their probability is that of the other."""
    return [item.label for item in finding.claimed if names.name(item.label) is None] if len(finding.claimed) > 1 else []


def _named(finding: Finding, names: Names) -> list[tuple[Name, Claimed]]:
    """Claimed causes with their names; empty where the answer is "unknown" or "none"."""
    found = [(name, item) for item in finding.claimed if (name := names.name(item.label)) is not None]
    if len(found) == len(finding.claimed):
        return list(dict(reversed(found)).items())[::-1]
    if not found:
        return _instead(finding, names)
    first = max(finding.claimed, key=lambda item: finding.ranking.get(item.label, 0.0))
    return found if names.name(first.label) is not None else []


def _instead(finding: Finding, names: Names) -> list[tuple[Name, Claimed]]:
    """The most probable cause with a name among those that are tied with a claim that has none."""
    tied = [label for label in finding.tied if names.name(label) is not None]
    if not tied:
        return []
    best = max(tied, key=lambda label: finding.ranking.get(label, 0.0))
    name = names.name(best)
    assert name is not None
    return [(name, Claimed(label=best))]


def _weighed(finding: Finding, names: Names) -> dict[Label, float]:
    """Probabilities in which what is tied shares what it has by the odds that the table of names gives beforehand."""
    together = {*finding.tied, *(item.label for item in finding.claimed)} & set(finding.ranking)
    weights = {label: finding.ranking[label] * (NAMED if names.name(label) is not None else 1.0) for label in together}
    share = sum(finding.ranking[label] for label in together) / max(sum(weights.values()), TINY)
    return {label: weights[label] * share if label in together else chance for label, chance in finding.ranking.items()}


def _verdict(claimed: list[Name]) -> str:
    kinds = [verdict_of(effect) for effect, _ in claimed]
    return "unknown" if not kinds else "effect" if "effect" in kinds else kinds[0]


def _tied(finding: Finding, names: Names) -> list[Name]:
    found = [name for label in finding.tied if (name := names.name(label)) is not None]
    return list(dict.fromkeys(found))


def _chance(name: Name, chances: Mapping[tuple[str, str | None], float]) -> float:
    return max((value for (effect, _), value in chances.items() if effect == name[0]), default=0.0)


def _where(finding: Finding, names: Names, claimed: list[Name]) -> list[dict[str, Any]]:
    """Places of the claim first, then the located ones, then those of what was ranked; these before where nothing was located."""
    by_rank: dict[str, float] = {}
    seen: list[Label] = []
    together = together_in(finding.ranking)
    for label, probability in finding.ranking.items():
        if label[0] not in WORDS:
            place = names.place_of(label)
            again = label in together and any(other in together and names.place_of(other) == place for other in seen)
            by_rank[place] = by_rank.get(place, 0.0) + (0.0 if again else probability)
            seen.append(label)
    located: dict[str, float] = {}
    nothing = max(finding.where, key=lambda at: finding.where[at], default=None) == NOWHERE
    for at, probability in finding.where.items():
        if at == NOWHERE:
            continue
        located[names.place(at)] = located.get(names.place(at), 0.0) + probability
    unnamed = [] if claimed else [names.place_of(item.label) for item in finding.claimed]
    if unnamed and finding.elsewhere:
        unnamed = [names.place(finding.elsewhere), *unnamed]
    ranked = [] if finding.verdict == "none" else sorted(by_rank, key=lambda at: -by_rank[at])
    places = sorted(located, key=lambda at: -located[at])
    order = dict.fromkeys([*(at for _, at in claimed), *unnamed, *((*ranked, *places) if nothing else (*places, *ranked))])
    return [{"at": at, "probability": max(by_rank.get(at, 0.0), located.get(at, 0.0))} for at in order]
