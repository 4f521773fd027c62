"""The benchmark of lanes runs, and says what it measured."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from benchmarks.lanes import __main__ as command
from benchmarks.lanes.study import COUNTS, LENGTHS, WIDTHS


def test_every_width_gives_the_motion_of_one_lane(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert command.main(["--quick", "--out", str(tmp_path)]) == 0
    found = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))
    rows = found["rows"]
    assert [row["width"] for row in rows] == [*WIDTHS, *WIDTHS]
    assert all(row["apart"] < 1e-9 for row in rows)
    assert "| rotor bench | 4 |" in capsys.readouterr().out
    assert [row["lines"] for row in found["records"]] == [*COUNTS] * 2 * len(LENGTHS)
    assert all(row["differ"] == 0.0 for row in found["records"])
