"""What the bounds of ``elsewhere`` come from: answers of our own opened sets whose located place is another one than the claimed.

Sets with a number: drive up to the 28th, rotor up to the 30th, and drive_unlisted and drive_pairs: those that were answered before the
bounds.  A place of the gear's teeth counts as the gear; of what is located, only places of the machine.
"""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from hdrive_mbs.diagnosis.elsewhere import LEAVES, SURE

OWN = Path(__file__).parents[2] / "benchmarks" / "withheld" / "own"
SETS = [*(f"drive_{k}" for k in range(2, 29)), *(f"rotor_{k}" for k in range(2, 31)), "drive", "rotor", "drive_unlisted", "drive_pairs"]
READS = ("encoder", "sensor", "probe", "spin_angle", "h1_", "h2_")
"""Parts of the names of sensors."""


def _part(at: str) -> str:
    return "flexspline" if at == "mesh" else at


def _contradicted() -> list[tuple[float, bool, bool, str, str]]:
    """Of each claim that a place contradicts: what it leaves [times the noise], whether it and whether the list is right, law, place."""
    found = []
    for name in SETS:
        answers = {item["case"]: item for item in _read(name, "answers.json")}
        for case in _read(name, "results.json")["cases"]:
            answer = answers.get(case["case"])
            if answer is None or answer["verdict"] in ("none", "parameter", "sensor") or len(answer["where"]) < 2 or not case["gap"]:
                continue
            claims = answer["effects"] or [{"effect": "", "at": answer["where"][0]["at"]}]
            at = {_part(item["at"]) for item in claims}
            others = [item for item in answer["where"] if _part(item["at"]) not in at and not any(word in item["at"] for word in READS)]
            first = max(others, key=lambda item: item["probability"], default=None)
            if first is None or first["probability"] < SURE:
                continue
            truth = {_part(at) for _, at in case["truth"]}
            found.append((case["gap"]["effect"], bool(at & truth), _part(first["at"]) in truth, claims[0]["effect"], first["at"]))
    return found


def _read(name: str, file: str) -> Any:
    return json.loads((OWN / name / file).read_text(encoding="utf-8"))


TEETH = "friction_mesh_load"
CONTRADICTED = _contradicted()


@pytest.mark.parametrize(("leaves", "claim", "place"), [(False, 10, 2), (True, 2, 8)])
def test_a_claim_that_leaves_noise_is_right_about_its_place_and_one_that_leaves_more_mostly_wrong(
    leaves: bool, claim: int, place: int
) -> None:
    counted = Counter((mine, list_) for left, mine, list_, law, _ in CONTRADICTED if (left > LEAVES) == leaves and law != TEETH)
    assert counted == {(True, False): claim, (False, True): place} | ({(True, True): 1} if leaves else {})  # one of two causes each


def test_friction_of_the_teeth_is_located_at_the_wave_generator() -> None:
    found = [(mine, at) for _, mine, _, law, at in CONTRADICTED if law == TEETH]
    assert found == 13 * [(True, "wave_generator")]
