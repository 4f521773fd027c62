"""The share of a gap that a claim has to take, held against what the opened sets show of right and wrong claims.

Figures are those of the committed results: what no fit saw, before and after the claim.
"""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

from hdrive_mbs.diagnosis.verdict import EXPLAINED, FAINT

OWN = Path(__file__).parents[2] / "benchmarks" / "withheld" / "own"
UNTIL = {"drive": 7, "rotor": 12}
"""The sets of each bench that were opened when the bound was drawn."""
WIDE = 2.6
"""Mean square of a gap up to which what was left decided until then, whatever its share."""


def shares() -> list[tuple[float, bool]]:
    """Share of the logarithm of the gap, and whether the claim was right, of claims in gaps beyond FAINT and up to WIDE."""
    found = []
    for path in OWN.glob("*/results.json"):
        name = re.fullmatch(r"(drive|rotor)(?:_(\d+))?", path.parent.name)
        if name is None or int(name[2] or 1) > UNTIL[name[1]]:
            continue
        for case in json.loads(path.read_text("utf-8"))["cases"]:
            if case["claim"] and case["gap"]:
                before, after = case["gap"]["refit"] ** 2, case["gap"]["effect"] ** 2
                if FAINT < before <= WIDE:
                    found.append((1.0 - math.log(max(after, 1.0)) / math.log(before), case["effect"]))
    return found


def test_right_claims_took_more_than_the_bound_and_those_below_it_were_wrong() -> None:
    found = shares()
    right = [share for share, is_right in found if is_right]
    below = sorted(round(share, 2) for share, is_right in found if share < EXPLAINED and not is_right)
    assert min(right) > EXPLAINED
    assert round(min(right), 2) == 0.52
    assert below == [0.03, 0.16]  # two, on which the bound rests
    assert (len(right), len(found)) == (56, 60)
