"""The ways of the benchmark of fits, on a valley in closed form, and its table."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.fits.report import report
from benchmarks.fits.study import WAYS, ends
from tests.unit.bent_valley import Bent, two


@pytest.mark.parametrize("way", WAYS)
def test_each_way_ends_at_the_bottom(way: str) -> None:
    bent, start = Bent(0.05), np.zeros(2)
    z = WAYS[way](bent, two(), start)  # type: ignore[arg-type]
    bottom = ends(bent, two(), bent.bottom())  # type: ignore[arg-type]
    found = ends(bent, two(), z)  # type: ignore[arg-type]
    # a fit ends where a step gains less than 0.2 + 1e-4 of the cost, 0.275 of 1500 samples; two such steps
    assert bottom["misfit"] - 1e-9 <= found["misfit"] < bottom["misfit"] + 2.0 * 2.0 * 0.275 / 1500.0


def test_the_table_holds_ratios_to_the_first_way() -> None:
    case = {"bench": "drive", "case": "c01", "cause": "play", "law": "LostMotion", "place": "gear", "begun": 7.0}
    rows = [
        {**case, "way": way, "left": 1.5, "misfit": 1.25, "runs": runs, "seconds": seconds}
        for way, runs, seconds in (("curved", 10, 2.0), ("scipy", 30, 5.0))
    ]
    text = report({"about": {"processor": "P"}, "rows": rows})
    assert "| drive | play | LostMotion at gear | 7 | 1.2500 | 1.2500 | 1.5000 | 1.5000 | 10 | 30 | 2.50 |" in text
    assert text.rstrip().endswith("against curved steps: scipy 2.50.")
