"""The benchmark of sweeps runs with --quick, and every way gives the same numbers.  No time is judged here."""

from __future__ import annotations

import importlib.util
import json
from pathlib import Path

import pytest

from benchmarks.sweep import __main__ as command


@pytest.mark.slow
def test_every_way_of_a_sweep_gives_the_same_table(tmp_path: Path) -> None:
    assert command.main(["--quick", "--out", str(tmp_path)]) == 0  # 1 when they differ
    found = json.loads((tmp_path / "results.json").read_text("utf-8"))
    ways = {(row["way"], row["workers"]) for row in found["ways"]}
    expected = {("in this process", 1), ("processes", 1), ("processes", 2)}
    assert ways == expected | ({("dask", 1), ("dask", 2)} if importlib.util.find_spec("distributed") else set())
    assert all(0.0 < seconds < 600.0 for row in found["ways"] for seconds in (*row["run_ups_seconds"], *row["nothing_seconds"]))
    # amplitudes of a linear line rise with the eccentricity
    assert found["peaks"] == sorted(found["peaks"])
    assert found["peaks"][0] < found["peaks"][-1]
    assert "gave the same table to the last bit" in (tmp_path / "results.md").read_text("utf-8")
