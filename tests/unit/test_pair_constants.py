"""Constants of the search for a second cause against the stored fits of the opened sets that they were drawn from.

Stored are the cases of these sets that have two causes or for which a second one was searched among everything.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest

from benchmarks.withheld.calibrate import Stored, stored
from benchmarks.withheld.names import names_of
from hdrive_mbs.diagnosis.joined import CLEAR, JOINED
from hdrive_mbs.diagnosis.nearly import nearly_right
from hdrive_mbs.diagnosis.second_cause import LEFT, NOTICED, SLIGHT, nearly_all
from hdrive_mbs.diagnosis.verdict import taken

OWN = Path(__file__).parents[2] / "benchmarks" / "withheld" / "own"
SETS = [("drive", n) for n in range(17, 24)] + [("rotor", n) for n in range(21, 24)]
Label = tuple[str, str]


def cases(*sets: tuple[str, int]) -> Iterator[tuple[str, Stored]]:
    for bench, n in sets:
        for case in stored(OWN / f"{bench}_{n}" / "raw", OWN / f"{bench}_{n}" / "truths.json"):
            yield f"{bench}_{n} {case.raw['case']}", case


def label(item: Mapping[str, Any]) -> Label:
    return item["label"][0], item["label"][1]


def left(item: Mapping[str, Any]) -> float:
    return math.sqrt(item["fit"] * item["held"])


def is_one_family(item: Mapping[str, Any]) -> bool:
    return not item["loose"] and len({added["label"][0] for added in item["added"]}) == 1


def test_the_second_cause_of_a_pair_is_often_behind_the_next_labels_of_the_search_for_one() -> None:
    """Places of the last cause of the best pair among the labels of the search, the first one's being 0."""
    places = []
    for _, case in cases(*SETS):
        if len(case.labels["truth"]) < 2 or not case.raw["pairs"]:
            continue
        labels = list(dict.fromkeys(map(label, case.raw["search"])))
        best = max(case.raw["pairs"], key=lambda item: item["log_odds"])
        others = [label(item) for item in best["added"] if label(item) != labels[0]]
        places += [labels.index(item) for item in others[-1:] if item in labels]
    assert len(places) == 22
    assert sum(place <= JOINED for place in places) == 12
    behind = sorted(place for place in places if place > JOINED)
    assert (behind[0] + 1, behind[-1] + 1) == (5, 13)


def test_a_pair_that_leaves_next_to_nothing_of_what_the_first_does_has_the_right_second_cause() -> None:
    right, wrong = {}, {}
    for case_name, case in cases(*SETS, ("rotor", 24)):
        first = left(case.raw["search"][0]) if case.raw["search"] else 1.0
        if not case.raw["second"] or first < SLIGHT:
            continue
        names = names_of(case.raw["bench"])
        truth = [(item["effect"], item["at"]) for item in case.labels["truth"]]
        for item in case.raw["second"]:
            share = (left(item) - 1.0) / (first - 1.0)
            there = right if len(truth) == 2 and names.name(label(item)) in truth else wrong
            key = case_name, label(item)
            if not is_one_family(item):
                there[key] = min(share, there.get(key, math.inf))
    shares = sorted(right.values())
    assert sum(share < CLEAR for share in shares) == 12
    assert shares[11] == pytest.approx(0.0135, abs=5e-5)
    assert shares[12] == pytest.approx(0.0245, abs=5e-5)
    astray = sorted((share, *key) for key, share in wrong.items())[:3]
    assert [item[1:] for item in astray[:2]] == [
        ("drive_21 drive-c05", ("kinematic_error", "gear")),
        ("drive_23 drive-c02", ("backlash", "output_shaft")),
    ]
    assert [round(item[0], 4) for item in astray] == [0.0002, 0.0055, 0.0376]


def test_in_cases_with_two_causes_the_best_pair_of_a_search_takes_a_part_of_what_the_first_leaves() -> None:
    """Share of the logarithm, by what its fit saw and did not see."""
    there, alone = [], []
    for _, case in cases(*SETS, ("rotor", 24)):
        if not case.raw["second"] or left(case.raw["search"][0]) <= LEFT:
            continue
        best = min(case.raw["second"], key=lambda item: item["cost"])
        pair = len(case.labels["truth"]) == 2
        (there if pair else alone).append(taken(left(case.raw["search"][0]), left(best)))
    assert (len(there), len(alone)) == (23, 11)
    assert min(there) == pytest.approx(0.4223, abs=5e-5)
    less = sorted(share for share in alone if share < NOTICED)
    assert len(less) == 7
    assert less[-1] == pytest.approx(0.1792, abs=5e-5)


def test_the_best_pair_of_a_search_that_misses_the_second_cause_may_take_less() -> None:
    """Of the sets answered with the bound: a loose foot is in no pair that a search beside the clearance found, so the bound left nothing
    out that was there, and what was to be followed up has to come from what is put together first."""
    [case] = [case for name, case in cases(("rotor", 26)) if name == "rotor_26 rotor-c09"]
    first = left(case.raw["search"][0])
    assert [item["effect"] for item in case.labels["truth"]] == ["bearing_clearance", "looseness"]
    assert all("looseness" not in label(item) for item in case.raw["second"])
    assert taken(first, left(min(case.raw["second"], key=lambda item: item["cost"]))) == pytest.approx(0.1939, abs=5e-5)
    labels = list(dict.fromkeys(map(label, case.raw["search"])))
    assert labels[:2] == [("bearing_clearance", "bearing_2"), ("looseness", "bearing_2")]


def test_where_a_few_stretches_rule_the_mean_square_a_second_cause_takes_more_of_the_misfit() -> None:
    """Of the sets answered with the bound on the logarithm alone, by which neither pair was followed up."""
    stored_ = dict(cases(("drive", 31), ("drive", 32)))
    clean = min(stored_["drive_31 drive-c16"].raw["second"], key=lambda item: item["cost"])
    assert clean["fit"] == pytest.approx(1.003, abs=1e-3)
    noise = clean["misfit"] / clean["fit"]  # of all cases of the bench, which have as many samples
    for name, logarithm, misfit in (("drive_31 drive-c19", 0.1086, 0.270), ("drive_32 drive-c04", 0.0309, 0.273)):
        case = stored_[name]
        first, best = case.raw["search"][0], min(case.raw["second"], key=lambda item: item["cost"])
        assert len(case.labels["truth"]) == 2
        assert names_of("drive").name(label(best)) in [(item["effect"], item["at"]) for item in case.labels["truth"]]
        assert taken(left(first), left(best)) == pytest.approx(logarithm, abs=5e-5)
        assert (first["misfit"] - best["misfit"]) / (first["misfit"] - noise) == pytest.approx(misfit, abs=1e-3)


def test_of_right_pairs_few_leave_so_much_that_the_first_cause_is_looked_for_again_and_of_wrong_ones_all() -> None:
    """What the answer of two causes leaves on all samples, of every case of these sets whose fits are kept."""
    numbers = {"drive": range(17, 28), "rotor": (*range(9, 20), *range(21, 25), 26, 28, 29)}
    right, wrong = [], []
    for bench, some in numbers.items():
        for name, case in cases(*((bench, n) for n in some)):
            truth = {(item["effect"], item["at"]) for item in case.labels["truth"]}
            answered = json.loads((OWN / name.split()[0] / "results.json").read_text("utf-8"))["cases"]
            [answer] = [item for item in answered if item["case"] == case.raw["case"]]
            if case.raw["pairs"] and len(answer["claim"]) == 2:
                pair, gap = left(case.raw["pairs"][0]), case.raw["null"]["fit"]
                there = right if len(truth) == 2 and answer["effect"] else wrong
                there.append((pair <= nearly_all(gap), pair <= max(SLIGHT, nearly_right(gap))))
    assert [sum(column) for column in zip(*right, strict=True)] == [39, 41]
    assert len(right) == 51
    assert [sum(column) for column in zip(*wrong, strict=True)] == [0, 3]
    assert len(wrong) == 5
