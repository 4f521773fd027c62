"""The benchmark of lines that are built once runs, and says what it measured."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from benchmarks.built_once import __main__ as command


def test_lines_from_templates_have_the_constants_of_those_that_are_built(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert command.main(["--quick", "--out", str(tmp_path)]) == 0
    rows = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))["rows"]
    assert len(rows) > 5
    assert all(row["has"] and row["kept"] > 0 and row["apart"] < 1e-11 for row in rows)
    assert f"{len(rows)} of {len(rows)} laws and places have a template" in capsys.readouterr().out
