"""``hdrive-mbs sweep`` by its options and files."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import hdrive_mbs as hm
from hdrive_mbs.cli.main import app
from hdrive_mbs.cli.sweep import parse_values
from hdrive_mbs.errors import FileFormatError, ParameterError, PlaceError
from models.harmonic_drive_train import build

ROOT = Path(__file__).parents[2]
TRAIN = str(ROOT / "models" / "harmonic_drive_train.py")
LINE = str(ROOT / "models" / "two_rotor_line.py")


def invoke(*words: str) -> Any:
    return CliRunner().invoke(app, ["sweep", *words], catch_exceptions=False)


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("gear.ratio=80,100", [80.0, 100.0]),
        ("gear.ratio=80:120:3", [80.0, 100.0, 120.0]),
        ("gear.damping=1:100:3:log", [1.0, 10.0, 100.0]),
        ("gear.stiffness.lost_motion=3 arcmin:9 arcmin:3", [np.radians(angle / 60.0) for angle in (3.0, 6.0, 9.0)]),
        ("bearing=full,improved", ["full", "improved"]),
    ],
)
def test_values_are_read_in_si(text: str, values: list[Any]) -> None:
    path, found = parse_values(build(), text)
    assert path == text.partition("=")[0]
    assert found == (values if isinstance(values[0], str) else pytest.approx(values, rel=1e-12))


@pytest.mark.parametrize(
    ("text", "error", "words"),
    [
        ("gear.ratio", FileFormatError, "write PATH=FIRST:LAST:COUNT"),
        ("gear.ratio=1:2", FileFormatError, "write PATH=FIRST:LAST:COUNT"),
        ("gear.ratio=1:2:3:lin", FileFormatError, "write PATH=FIRST:LAST:COUNT"),
        ("gear.ratio=1:2:many", FileFormatError, "COUNT a whole number"),
        ("gear.ratio=1:2:1", ParameterError, "1 values are not a range"),
        ("gear.damping=0:2:3:log", ParameterError, "above 0"),
    ],
)
def test_values_that_cannot_be_read_say_how_to_write_them(text: str, error: type[Exception], words: str) -> None:
    with pytest.raises(error, match=words):
        parse_values(build(), text)


def test_a_sweep_writes_result_table_and_figures_and_goes_on_where_it_stood(tmp_path: Path) -> None:
    words = [TRAIN, "--vary", "gear.stiffness.stiffness_1=1e4:3e4:2", "--vary", "motor.inertia=1e-3,2e-3", "--count", "1", "--workers", "2"]
    words += ["--out", str(tmp_path), "--json", str(tmp_path / "found.json")]
    done = invoke(*words)
    assert done.exit_code == 0, done.output
    assert "4 of 4 jobs done." in done.output
    with (tmp_path / "campaign.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [(float(row["gear.stiffness.stiffness_1 [N m/rad]"]), float(row["motor.inertia [kg m^2]"])) for row in rows] == [
        (1e4, 1e-3),
        (1e4, 2e-3),
        (3e4, 1e-3),
        (3e4, 2e-3),
    ]
    by_hand = hm.modes(build().replacing({"gear.stiffness.stiffness_1": 3e4, "motor.inertia": 2e-3})).undamped[0]
    assert float(rows[3]["mode 1 undamped [rad/s]"]) == pytest.approx(by_hand, rel=1e-11)  # 12 digits are written
    assert hm.Campaign.load(tmp_path / "campaign.npz")["mode 1 undamped [rad/s]"][3] == by_hand
    again = invoke(*words)
    assert json.loads((tmp_path / "found.json").read_text())["reused"] == 4
    assert "4 of 4 jobs done, 4 of them found finished." in again.output


def test_an_argument_of_build_can_be_varied_and_a_campbell_swept(tmp_path: Path) -> None:
    words = [LINE, "--vary", "bearing=full,improved", "--analysis", "campbell", "--speeds", "0:600:4", "--count", "2", "--workers", "1"]
    done = invoke(*words, "--out", str(tmp_path))
    assert done.exit_code == 0, done.output
    found = hm.Campaign.load(tmp_path / "campaign.npz")
    assert list(found.parameters["bearing"]) == ["full", "improved"]
    full, improved = found["critical speed 1 [rad/s]"]
    assert full == pytest.approx(improved, rel=1e-3)  # what the improved bearing is for
    assert full != improved
    with pytest.raises(PlaceError, match="bearin"):
        invoke(LINE, "--vary", "bearin=full,improved", "--out", str(tmp_path))


def test_an_analysis_may_be_written_like_its_command(tmp_path: Path) -> None:
    words = [LINE, "--vary", "rotor_1.mass=8,9", "--analysis", "run-up", "--duration", "0.02", "--workers", "1", "--out", str(tmp_path)]
    assert invoke(*words).exit_code == 0
    assert len(hm.Campaign.load(tmp_path / "campaign.npz").parameters["rotor_1.mass"]) == 2


def test_a_scene_with_a_class_of_its_file_is_opened_anew_by_the_workers(tmp_path: Path) -> None:
    # the characteristic of the drive is a class of that file, deep inside a part of this package
    done = invoke(LINE, "--vary", "rotor_1.mass=8,9", "--count", "1", "--workers", "1", "--out", str(tmp_path))
    assert done.exit_code == 0, done.output
    heavy, heavier = hm.Campaign.load(tmp_path / "campaign.npz")["mode 1 damped [rad/s]"]
    assert heavier < heavy


def test_an_effect_of_the_users_own_file_takes_part(tmp_path: Path) -> None:
    file = tmp_path / "own_drag_of_a_sweep.py"
    file.write_text(
        "from dataclasses import dataclass\n\nimport hdrive_mbs as hm\n\n\n@dataclass(frozen=True, kw_only=True)\n"
        "class SweptDrag(hm.TorqueEffect):\n    drag: float = hm.parameter('N m s/rad', 'drag of a brake', low=0.0)\n\n"
        "    def torque(self, time, angle, speed):\n        return -self.drag * speed\n"
    )
    words = [
        TRAIN,
        "--effect",
        "SweptDrag@gear.flexspline:drag=1",
        "--effects",
        str(file),
        "--vary",
        "swept_drag.drag=0.1,1",
        "--torque",
        "50",
    ]
    done = invoke(*words, "--count", "1", "--workers", "2", "--out", str(tmp_path / "campaign"))
    assert done.exit_code == 0, done.output
    ratios = hm.Campaign.load(tmp_path / "campaign" / "campaign.npz")["mode 1 damping ratio [1]"]
    assert 0.0 < ratios[0] < ratios[1]


def test_failed_jobs_end_with_a_code_of_their_own_and_a_file_with_tracebacks(tmp_path: Path) -> None:
    # a ratio of 0 is refused by HarmonicDrive; the other job is done all the same
    done = invoke(TRAIN, "--vary", "gear.ratio=100,0", "--workers", "1", "--out", str(tmp_path))
    assert done.exit_code == 1
    assert "1 of 2 jobs done" in done.output
    told = (tmp_path / "failures.txt").read_text()
    assert "failed: gear.ratio = 0: ParameterError" in told
    assert "Traceback" in told
