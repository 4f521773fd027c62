"""Whether the place that was found is the true one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmarks.withheld.names import Names, names_of
from hdrive_mbs.diagnosis.result import NOWHERE

OUTCOMES = ("right", "tied", "wrong", "not visible", "doubted", "not trusted, right", "not trusted, wrong", "kept", "false alarm")
"""right, tied, wrong: a place was named;  not visible: there was a cause and no place was named;  doubted: nor is nowhere relied on
kept, false alarm: there was no cause."""
BOTH = {"bearings": ("bearing_1", "bearing_2")}
"""Places of truths that stand for several."""


def judged(bench: str, found: Mapping[str, Any], case: str, truth: Mapping[str, Any]) -> dict[str, Any]:
    """What was found of a case beside its truth, with an outcome."""
    causes = [(str(item["effect"]), str(item["at"])) for item in truth["truth"]]
    best = next((item for item in found["places"] if item["at"] != NOWHERE), None)
    nowhere = found["places"][0]["at"] == NOWHERE
    names = names_of(bench)
    wanted = {place for _, at in causes for place in BOTH.get(at, (at,))}
    if nowhere or best is None:
        outcome = ("not visible" if found["trusted"] else "doubted") if causes else "kept"
    elif not causes:
        outcome = "false alarm" if found["trusted"] else "not trusted, wrong"
    else:
        right = names.place(best["at"]) in wanted
        tied = any(names.place(at) in wanted for at in best["tied"])
        outcome = "right" if right else "tied" if tied else "wrong"
        if not found["trusted"]:
            outcome = f"not trusted, {'wrong' if outcome == 'wrong' else 'right'}"
    return {
        "case": case,
        "causes": causes,
        "kind": _kind(causes),
        "outcome": outcome,
        "found": "" if best is None or nowhere else names.place(best["at"]),
        "tied": [] if best is None or nowhere else _others(best, names),
        "probability": found["places"][0]["probability"],
        "trusted": found["trusted"],
        "left": found["left"],
        "seconds": found["seconds"],
    }


def _others(best: Mapping[str, Any], names: Names) -> list[str]:
    return sorted({names.place(at) for at in best["tied"]} - {names.place(best["at"])})


def _kind(causes: list[tuple[str, str]]) -> str:
    if len(causes) != 1:
        return "two causes" if causes else "none"
    [(effect, _)] = causes
    for kind in ("parameter", "probe", "encoder", "load_encoder", "torque_sensor"):
        if effect.startswith(kind):
            return "parameter" if kind == "parameter" else "sensor"
    return "unlisted" if effect == "unknown" else "effect"
