"""The benchmark of the pace of a search runs, and says what it measured."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from benchmarks.pace import __main__ as command


@pytest.mark.slow
def test_a_law_leaves_as_much_at_the_pace_of_a_search(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert command.main(["--quick", "--out", str(tmp_path)]) == 0
    [row] = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))["rows"]
    assert row["slowed"] > 0
    assert max(row["steps"].values()) > 2.0 * row["step"]
    assert row["quick"] == pytest.approx(row["exact"], abs=5e-3)
    assert row["refitted"] == pytest.approx(row["exact"], abs=5e-3)
    assert f"| {row['cause']} | {row['law']} |" in capsys.readouterr().out
