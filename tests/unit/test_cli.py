"""The command line: what it writes, and one line of error with exit code 2 for what we foresaw."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

import hdrive_mbs as hm
from hdrive_mbs.cli.main import app, main
from models.harmonic_drive_train import build
from tests.patience import PATIENCE

TRAIN = str(Path(__file__).parents[2] / "models" / "harmonic_drive_train.py")


def call(*arguments: str) -> str:
    done = CliRunner().invoke(app, list(arguments), catch_exceptions=False)
    assert done.exit_code == 0, done.output
    return done.output


def fails(*arguments: str) -> str:
    code = "import sys; from hdrive_mbs.cli.main import main; main()"
    done = subprocess.run([sys.executable, "-c", code, *arguments], capture_output=True, text=True, timeout=PATIENCE)
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    return done.stderr


def test_modes_json_equals_the_api(tmp_path: Path) -> None:
    call("modes", TRAIN, "--torque", "50", "--json", str(tmp_path / "m.json"))
    written = json.loads((tmp_path / "m.json").read_text())
    modes = hm.modes(build(), torque=50.0)
    assert written["undamped"] == pytest.approx(modes.undamped.tolist(), rel=1e-12)
    assert written["damped"] == pytest.approx(modes.damped.tolist(), rel=1e-12)
    assert written["damping_ratio"] == pytest.approx(modes.damping_ratio.tolist(), rel=1e-12)


def test_torsion_json_gives_table_1_of_the_paper(tmp_path: Path) -> None:
    # Folega et al. 2014, Table 1: 2.04e-3, 3.21e-3, 3.56e-3 rad at 23.5, 98, 137 N m
    call("torsion", TRAIN, "--torques", "23.5,98,137", "--json", str(tmp_path / "t.json"))
    written = json.loads((tmp_path / "t.json").read_text())
    assert written["torque"] == [23.5, 98.0, 137.0]
    assert [round(angle * 1e3, 2) for angle in written["angle"]] == [2.04, 3.21, 3.56]


def test_run_writes_summary_result_and_pictures(tmp_path: Path) -> None:
    call("run", TRAIN, "--duration", "0.05", "--csv", "--out", str(tmp_path / "out"), "--json", str(tmp_path / "r.json"))
    written = json.loads((tmp_path / "r.json").read_text())
    assert written["status"] == "complete"
    assert written["duration"] == pytest.approx(0.05)
    response = hm.load(written["result"])
    assert written["channels"]["motor.speed"]["final"] == pytest.approx(response["motor.speed"].values[-1])
    assert all(Path(picture).stat().st_size > 1000 for picture in written["pictures"])
    assert Path(written["csv"]).read_text().splitlines()[0].startswith("time [s],")


def test_set_changes_a_value_with_and_without_unit(tmp_path: Path) -> None:
    for setting in ("load.inertia=2.0", "load.inertia=20000 kg*cm^2"):
        call("modes", TRAIN, "--torque", "50", "--set", setting, "--json", str(tmp_path / "m.json"))
        written = json.loads((tmp_path / "m.json").read_text())
        expected = hm.modes(build().replacing({"load.inertia": 2.0}), torque=50.0)
        assert written["undamped"] == pytest.approx(expected.undamped.tolist(), rel=1e-9)


def test_set_passes_arguments_to_build(tmp_path: Path) -> None:
    script = tmp_path / "scene.py"
    script.write_text(
        "import hdrive_mbs as hm\n"
        "def build(stiffness=100.0, kind='a'):\n"
        "    assert kind == 'b'\n"
        "    parts = {'a': hm.Inertia(inertia=1.0), 's': hm.Shaft(stiffness=stiffness)}\n"
        "    return hm.Scene(name='one', parts=parts, connections=[('a', 's', 'ground')])\n"
    )
    call("modes", str(script), "--set", "stiffness=400", "--set", "kind=b", "--json", str(tmp_path / "m.json"))
    # closed form: sqrt(k/J) = 20 rad/s
    assert json.loads((tmp_path / "m.json").read_text())["undamped"] == pytest.approx([20.0], rel=1e-7)


def test_a_scene_file_works_like_a_script(tmp_path: Path) -> None:
    path = hm.save_scene(build(), tmp_path / "train.toml")
    call("modes", str(path), "--torque", "50", "--json", str(tmp_path / "m.json"))
    assert json.loads((tmp_path / "m.json").read_text())["undamped"] == pytest.approx(hm.modes(build(), torque=50.0).undamped.tolist())


def test_effect_option_adds_an_effect(tmp_path: Path) -> None:
    option = "ViscousDrag@motor:coefficient=0.01"
    call("run", TRAIN, "--duration", "0.2", "--effect", option, "--out", str(tmp_path), "--json", str(tmp_path / "r.json"))
    slowed = json.loads((tmp_path / "r.json").read_text())["channels"]["motor.speed"]["final"]
    assert slowed < hm.simulate(build(), 0.2)["motor.speed"].values[-1]


def test_effects_lists_every_effect_with_units_and_ranges(tmp_path: Path) -> None:
    call("effects", TRAIN, "--json", str(tmp_path / "e.json"))
    library = {item["effect"]: item for item in json.loads((tmp_path / "e.json").read_text())}
    friction = library["CoulombStribeckFriction"]
    assert friction["acts_on"] == "body"
    assert "motor" in friction["places"]
    assert {"name": "coulomb", "unit": "N m"}.items() <= friction["parameters"][0].items()
    assert (friction["family"], friction["kind"], friction["parameters"][0]["typical"]) == ("friction", "force", [0.005, 50.0])
    assert (library["KinematicError"]["places"], library["SensorGain"]["places"]) == (["gear"], [])


def test_json_to_stdout_is_nothing_but_json() -> None:
    assert json.loads(call("modes", TRAIN, "--json", "-"))["rigid_modes"] == 1


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("modes", "nowhere.py"), ("nowhere.py", "no such file")),
        (("modes", TRAIN, "--set", "motor.inertai=2"), ("inertai", "inertia")),
        (("modes", TRAIN, "--set", "motor.inertia=-2"), ("Motor.inertia", "-2 kg m^2", "greater than 0")),
        (("modes", TRAIN, "--set", "motor.inertia=2 kg"), ("kg m^2", "does not fit")),
        (("modes", TRAIN, "--set", "motor.inertia"), ("PATH=VALUE",)),
        (("run", TRAIN, "--solver", "euler"), ("euler", "dormand-prince")),
        (("run", TRAIN, "--solver", "runge-kutta-4", "--step", "1e-3"), ("beyond its limit of stability", "shorter step")),
        (("run", TRAIN, "--duration", "0.01", "--out", f"{TRAIN}/under/a/file"), ("Cannot write", "Choose a folder")),
        (("run", TRAIN, "--effect", "ViscousDrag@gear.mesh:coefficient=1"), ("gear.mesh", "motor")),
        (("torsion", TRAIN, "--torques", "1,two"), ("--torques", "commas")),
        (("torsion", TRAIN, "--at", "gaer"), ("gaer", "gear")),
    ],
)
def test_foreseen_errors_name_the_thing_and_the_way_out(
    arguments: tuple[str, ...], words: tuple[str, ...], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """In this process; a process of its own says the same (the next test)."""
    monkeypatch.setattr(sys, "argv", ["hdrive-mbs", *arguments])
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 2
    message = capsys.readouterr().err
    for word in words:
        assert word in message


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--solver", "runge-kutta-4", "--step", "1e-3"), ("beyond its limit of stability",)),
        # of which it lists the first ones: effects of other tests are no part of it there
        (("--effect", "Witchcraft@motor"), ("Witchcraft", "BallPass")),
    ],
)
def test_a_foreseen_error_of_a_process_is_said_without_a_traceback(arguments: tuple[str, ...], words: tuple[str, ...]) -> None:
    message = fails("run", TRAIN, *arguments)
    assert message.startswith("error: ")
    for word in words:
        assert word in message
