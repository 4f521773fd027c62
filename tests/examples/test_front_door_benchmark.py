"""The benchmarks of the front door and of rotor speed run with --quick.  No time is judged here."""

from __future__ import annotations

import json
import math
import re
import subprocess
from pathlib import Path

import pytest

from benchmarks.commit import commit
from benchmarks.front_door import __main__ as front_door
from benchmarks.front_door.study import IMPORTS
from benchmarks.machine import machine
from benchmarks.rotor_speed import __main__ as rotor_speed

ROOT = Path(__file__).parents[2]


def test_the_front_door_times_every_import_beside_numpy_and_scipy(tmp_path: Path) -> None:
    assert front_door.main(["--quick", "--out", str(tmp_path)]) == 0
    found = json.loads((tmp_path / "results.json").read_text("utf-8"))
    assert set(found["imports"]) == set(IMPORTS)
    assert found["imports"]["numpy and scipy"]["over_numpy_and_scipy"] == 1.0
    assert all(math.isfinite(row[key]) and row[key] > 0.0 for row in found["imports"].values() for key in row)
    assert found["demo"] is None
    assert all(f"| {name} " in (tmp_path / "results.md").read_text("utf-8") for name in IMPORTS)


def test_rotor_speed_states_errors_and_times_without_the_other_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROSS_PYTHON", raising=False)
    assert rotor_speed.main(["--quick", "--out", str(tmp_path)]) == 0
    found = json.loads((tmp_path / "results.json").read_text("utf-8"))
    assert "ross" not in found
    [campbell], [run_up] = found["campbell"], found["run_up"]
    # the lowest frequency of the beam errs by what its elements err by, assembled by hand and solved apart from the package
    assert campbell["errors"][0] == pytest.approx(found["elements alone"]["6"][0], rel=1e-3)
    assert campbell["wrong_whirl"] == 0.0
    assert found["reference agreement"] < 1e-3 * run_up["error"]  # what the run-up is compared with is sharper than it
    assert math.isfinite(run_up["error"])
    assert "## Campbell diagram, 11 speeds" in (tmp_path / "results.md").read_text("utf-8")


def test_results_say_of_which_commit_they_are() -> None:
    done = subprocess.run(["git", "rev-parse", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=False)
    found = machine()["commit"]
    if done.returncode:
        assert found == "unknown"
    else:
        assert re.fullmatch(re.escape(done.stdout.strip()) + "( with changes)?", found)


def test_outside_of_a_repository_the_commit_is_not_known(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GIT_DIR", str(tmp_path / "none"))
    assert commit() == "unknown"
