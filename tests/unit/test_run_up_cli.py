"""``hdrive-mbs run-up``: its JSON, its files, the choice of the bearing model."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

import hdrive_mbs as hm
from hdrive_mbs.cli.main import app
from models.two_rotor_line import build
from tests.patience import PATIENCE

LINE = str(Path(__file__).parents[2] / "models" / "two_rotor_line.py")


def call(*arguments: str) -> str:
    done = CliRunner().invoke(app, list(arguments), catch_exceptions=False)
    assert done.exit_code == 0, done.output
    return done.output


def test_json_gives_each_rotor_its_peak_0_peak_with_the_speed_and_the_final_speed(tmp_path: Path) -> None:
    call("run-up", LINE, "--duration", "0.3", "--csv", "--out", str(tmp_path / "out"), "--json", str(tmp_path / "r.json"))
    written = json.loads((tmp_path / "r.json").read_text())
    run = hm.run_up(build(), 0.3)
    assert list(written["rotors"]) == ["drive_disc", "rotor_1", "rotor_2"]
    for name, figures in written["rotors"].items():
        assert figures["peak_amplitude"] == pytest.approx(run.peak_amplitude[name], rel=1e-9)
        assert figures["speed_at_peak"] == pytest.approx(run.peak_speed[name], rel=1e-9)
    # 20 N m on 0.04787 kg m^2: 418 rad/s^2
    assert written["final_speed"] == pytest.approx(run.final_speed, rel=1e-12)
    assert written["final_speed"] == pytest.approx(0.3 * 20.0 / 0.04787, rel=1e-2)
    assert written["captured"] is False
    assert written["driven_speed"] == pytest.approx(1000.0, rel=1e-3)
    assert written["amplitudes"] == "m, 0-peak, about the static position"
    assert all(Path(picture).stat().st_size > 1000 for picture in written["pictures"])
    assert isinstance(hm.load(written["result"]), hm.RunUp)
    assert "rotor_1.whirl [m]" in Path(written["csv"]).read_text().splitlines()[0]


def test_set_chooses_arguments_of_build_and_values_of_parts(tmp_path: Path) -> None:
    settings = ["--set", "bearing=full", "--set", "torque=40", "--set", "rotor_1.eccentricity=40e-6"]
    call("run-up", LINE, "--duration", "0.1", *settings, "--out", str(tmp_path), "--json", str(tmp_path / "r.json"))
    written = json.loads((tmp_path / "r.json").read_text())
    run = hm.run_up(build("full", torque=40.0).replacing({"rotor_1.eccentricity": 40e-6}), 0.1)
    assert written["rotors"]["rotor_1"]["peak_amplitude"] == pytest.approx(run.peak_amplitude["rotor_1"], rel=1e-9)
    assert written["final_speed"] == pytest.approx(run.final_speed, rel=1e-9)


@pytest.fixture
def script(tmp_path: Path) -> str:
    """A scene of one's own, with a dataclass in it and a bearing that can be chosen."""
    path = tmp_path / "own_line.py"
    path.write_text(
        "from __future__ import annotations\n"
        "import dataclasses\n"
        "import hdrive_mbs as hm\n"
        "from tests.unit.rotor_scenes import jeffcott, support\n"
        "@dataclasses.dataclass(frozen=True, kw_only=True)\n"
        "class Limited(hm.MotorCharacteristic):\n"
        "    limit: float = hm.parameter('N m', 'torque')\n"
        "    def torque(self, time, speed):\n"
        "        return self.limit + 0.0 * speed\n"
        "def build(bearing='full'):\n"
        "    law = {'full': support(), 'improved': support(4e5, 4e5)}[bearing]\n"
        "    return jeffcott(Limited(limit=5.0), law)\n"
    )
    return str(path)


def test_the_bearing_argument_reaches_build(script: str, tmp_path: Path) -> None:
    criticals = {}
    for bearing in ("full", "improved"):
        call(
            "run-up",
            str(script),
            "--duration",
            "1",
            "--set",
            f"bearing={bearing}",
            "--out",
            str(tmp_path),
            "--json",
            str(tmp_path / "r.json"),
        )
        criticals[bearing] = json.loads((tmp_path / "r.json").read_text())["critical_speeds"][0]
    assert criticals["improved"] == pytest.approx(2.0**0.5 * criticals["full"], rel=1e-9)


def test_coast_down_accuracy_and_error_estimate_are_options(script: str, tmp_path: Path) -> None:
    options = ["--coast-down", "--initial-speed", "500", "--duration", "0.05", "--accuracy", "1e-2", "--estimate-error"]
    call("run-up", script, *options, "--out", str(tmp_path), "--json", str(tmp_path / "r.json"))
    written = json.loads((tmp_path / "r.json").read_text())
    assert "nothing brakes the line" in written["status"]
    assert written["final_speed"] == pytest.approx(500.0, rel=1e-4)
    assert written["applied_torque"] == pytest.approx(0.0, abs=1e-9)
    assert 0.0 <= written["rotors"]["disc"]["estimated_error"] < 1e-2
    assert (tmp_path / "coast_down.png").is_file()


def test_a_step_of_ones_own_is_taken(script: str, tmp_path: Path) -> None:
    output = call("run-up", script, "--duration", "0.02", "--step", "1e-4", "--out", str(tmp_path))
    assert "200 steps" in output
    assert "peak of C, 0-peak" in output


def test_a_foreseen_error_is_one_line_with_exit_code_2(tmp_path: Path) -> None:
    train = str(Path(LINE).with_name("harmonic_drive_train.py"))
    code = "from hdrive_mbs.cli.main import main; main()"
    for arguments, message in (
        (["run-up", train, "--out", str(tmp_path)], "only turns; use start_up"),
        (["run-up", LINE, "--duration", "-1", "--out", str(tmp_path)], "duration = -1.0 s: must be greater than 0 s"),
    ):
        done = subprocess.run([sys.executable, "-c", code, *arguments], capture_output=True, text=True, timeout=PATIENCE)
        assert done.returncode == 2
        assert message in done.stderr
        assert "Traceback" not in done.stderr
