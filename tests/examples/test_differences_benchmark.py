"""The benchmark of differences runs, and short ones leave no more than long ones."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from benchmarks.differences import __main__ as command


@pytest.mark.slow
def test_fits_with_short_differences_leave_no_more_than_long_ones(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert command.main(["--quick", "--out", str(tmp_path)]) == 0
    found = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))
    assert set(found["bears"]) == {"motor", "wave_generator"}
    for place, bears in found["bears"].items():
        long, short = (row for row in found["rows"] if row["place"] == place)
        assert (long["change"], short["change"]) == (None, 0.3)
        assert short["cost"] < long["cost"] + 2.0 * (0.2 + 1e-4 * long["cost"])  # what may be left ends a fit
        assert 0.0 < bears["least"] < 1e-2 * bears["largest"]  # a column that is off by a hundredth hides what shows least
    assert "| wave_generator |" in capsys.readouterr().out
