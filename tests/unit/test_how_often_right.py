"""How often the diagnosis is right, as the documentation says it: the committed results of the sealed sets."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from benchmarks.withheld.case_score import interval

ROOT = Path(__file__).parents[2]
OWN = ROOT / "benchmarks" / "withheld" / "own"
ORDINALS = {"2nd": 2, "3rd": 3, "4th": 4, "5th": 5, "6th": 6, "7th": 7, "8th": 8, "9th": 9, "10th": 10, "11th": 11, "12th": 12}
ROWS = re.findall(r"^\| (drive|rotor) bench, (\S+) \| (.*) \|$", (ROOT / "docs" / "diagnosis.md").read_text("utf-8"), re.MULTILINE)


def share(found: dict[str, Any]) -> str:
    return f"{found['right']} of {found['of']}"


@pytest.mark.parametrize(("bench", "which", "row"), ROWS)
def test_a_row_of_the_documentation_holds_what_the_set_gave(bench: str, which: str, row: str) -> None:
    results = json.loads((OWN / f"{bench}_{ORDINALS[which]}" / "results.json").read_text("utf-8"))
    found = results["methods"]["diagnosis"]
    cases, right, place, nulls, unknown = row.split(" | ")
    effect = found["effect right"]
    low, high = interval(effect["right"], effect["of"])
    assert int(cases) == effect["of"] == len(results["cases"])
    assert right == f"{effect['right']} ({low:.2f} to {high:.2f})"
    assert [place, nulls, unknown] == [share(found[name]) for name in ("place right", "nulls kept", "unknown caught")]


def test_the_documentation_leaves_out_no_set_since_the_first_it_names() -> None:
    """Of each bench the last ones without a gap: none that went badly is passed over."""
    for bench in ("drive", "rotor"):
        told = sorted(ORDINALS[which] for name, which, _ in ROWS if name == bench)
        there = [int(path.parent.name.partition("_")[2]) for path in OWN.glob(f"{bench}_[0-9]*/results.json")]
        assert told == list(range(min(told), max(there) + 1))
