"""The benchmark of lines that are built once runs, and says what it measured."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from benchmarks.built_once import __main__ as command


@pytest.mark.slow
def test_lines_from_templates_have_the_constants_of_those_that_are_built(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert command.main(["--quick", "--out", str(tmp_path)]) == 0
    rows = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))["rows"]
    drive, rotor = ([row for row in rows if row["bench"] == bench] for bench in ("drive", "rotor"))
    assert len(drive) > 5
    assert all(row["has"] and row["kept"] > 0 and row["apart"] < 1e-11 for row in drive)
    without = {row["law"] for row in rotor if not row["has"]}
    assert without <= {"HiddenModeSupport"}  # of a matrix whose entries do not stay in proportion
    assert all(row["kept"] > 0 and row["apart"] < 1e-11 for row in rotor if row["has"])
    text = capsys.readouterr().out
    for some in (drive, rotor):
        assert f"{sum(row['has'] for row in some)} of {len(some)} laws and places have a template" in text
