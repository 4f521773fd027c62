"""The benchmark of laws runs, and says what each costs."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from benchmarks.laws import __main__ as command
from benchmarks.laws.study import QUICK


def test_a_law_is_told_with_its_operations_and_the_error_of_its_step(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert command.main(["--quick", "--out", str(tmp_path)]) == 0
    rows = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))["rows"]
    laws = {bench: {row["law"]: row for row in rows if row["bench"] == bench} for bench in ("drive bench", "rotor bench")}
    assert set(laws["rotor bench"]) == {"none", *QUICK}
    assert set(laws["drive bench"]) == {"none", "DahlFriction", "PreslidingFriction"}
    for found in laws.values():
        assert all(row["operations"] > found["none"]["operations"] for name, row in found.items() if name != "none")
        assert all(row["step_error"] < 1e-3 for row in found.values())
        assert found["PreslidingFriction"]["costly"]["pow"] == 2  # a power for each of its exponents, and no more
    assert "| PreslidingFriction |" in capsys.readouterr().out
