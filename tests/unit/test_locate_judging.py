"""Places found of a case beside the true one, in the names of the answer format."""

from __future__ import annotations

from typing import Any

import pytest

from benchmarks.locate.judging import judged
from benchmarks.locate.report import report


def found(*places: tuple[str, float, list[str]], trusted: bool = True) -> dict[str, Any]:
    given = [{"at": at, "probability": probability, "gain": 1.0, "share": 1.0, "tied": tied} for at, probability, tied in places]
    return {"places": given, "trusted": trusted, "left": 1.0, "seconds": 1.0}


def truth(*causes: tuple[str, str]) -> dict[str, Any]:
    return {"truth": [{"effect": effect, "at": at} for effect, at in causes]}


NOWHERE: tuple[str, float, list[str]] = ("nowhere", 0.9, [])
OIL = truth(("oil_whirl", "bearing_2"))


@pytest.mark.parametrize(
    ("given", "cause", "outcome"),
    [
        (found(("bearing_2.law", 0.9, [])), OIL, "right"),
        (found(("rotor_2", 0.9, ["bearing_2.law"])), OIL, "tied"),
        (found(("rotor_2", 0.9, ["bearing_2.housing"])), OIL, "wrong"),
        (found(("bearing_2.law", 0.3, []), trusted=False), OIL, "not trusted, right"),
        (found(("rotor_2", 0.3, []), trusted=False), OIL, "not trusted, wrong"),
        (found(NOWHERE, ("bearing_2.law", 0.1, [])), OIL, "not visible"),
        (found(NOWHERE, ("bearing_2.law", 0.1, []), trusted=False), OIL, "doubted"),
        (found(NOWHERE, ("rotor_1", 0.1, [])), truth(), "kept"),
        (found(("rotor_1", 0.9, []), NOWHERE), truth(), "false alarm"),
        (found(("bearing_1.law", 0.9, [])), truth(("bearing_clearance", "bearings")), "right"),
        (found(("section_2", 0.9, [])), truth(("crack", "shaft"), ("unbalance", "rotor_1")), "right"),
    ],
)
def test_the_place_that_comes_first_is_held_against_the_truth(given: dict[str, Any], cause: dict[str, Any], outcome: str) -> None:
    assert judged("rotor", given, "rotor-c01", cause)["outcome"] == outcome


def test_the_report_counts_the_first_answers_by_their_probability() -> None:
    rows = [
        judged("rotor", found(("bearing_2.law", 0.95, [])), "rotor-c01", OIL),
        judged("rotor", found(("rotor_2", 0.97, ["bearing_2.law"])), "rotor-c02", OIL),
        judged("rotor", found(("rotor_1", 0.6, [])), "rotor-c03", OIL),
    ]
    text = report({"machine": {}, "cases": {"rotor": rows}})
    lines = [" ".join(line.replace("|", " ").split()) for line in text.splitlines()]
    assert "0.9 to 1 0.96 1 of 2" in lines
    assert "0.5 to 0.9 0.60 0 of 1" in lines
    assert any(line.startswith("Of 3 places that were named 2 are right or in the tied group") for line in lines)
