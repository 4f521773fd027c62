"""The benchmark of the teeth runs, and says what the tests say."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

pytest.importorskip("shapely")


def test_the_quick_benchmark_runs_and_writes_its_verdicts(tmp_path: Path) -> None:
    from benchmarks.teeth.__main__ import main

    assert main(["--quick", "--out", str(tmp_path)]) == 0
    numbers = json.loads((tmp_path / "results.json").read_text())
    assert numbers["gears"]["A"]["ratio"] == -50.0
    assert all(row["different"] == 0 for row in numbers["accuracy"].values())
    # 10,000 designs in seconds, with room for a slow and busy machine: more than 500 a second
    assert all(row["per_second"] > 500.0 for row in numbers["sweeps"].values())
    text = (tmp_path / "results.md").read_text()
    assert text.count("| holds") == 5
    assert "does not hold with one unshifted module" in text
