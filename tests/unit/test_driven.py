"""The improved scene as each record drives it, from where the record starts."""

from __future__ import annotations

import dataclasses
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import hdrive_mbs as hm
from hdrive_mbs.cli.diagnose import write_improved
from hdrive_mbs.cli.main import app
from hdrive_mbs.diagnosis.driven import channels_at_start, driven_scenes
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.improved_words import file_names, improved_words, own_files
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.result import Driven
from hdrive_mbs.diagnosis.search import fit_nominal
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.verify import engine_difference
from hdrive_mbs.scene_file import load_scene
from models import two_rotor_line
from tests.unit.diagnosis_cases import DURATION, INPUTS, bench, quiet
from tests.unit.diagnosis_samples import SAMPLES

ANGLES, SPEEDS = {"motor": 0.4, "load": 0.4 / 50.0}, {"motor": 40.0, "load": 0.8}


@cache
def moving() -> tuple[Simulator, Fitted]:
    """A record that begins at 0.55 s of the load cycle, where the drive has turned at 40 rad/s for a while."""
    known = dataclasses.replace(bench(), angles=ANGLES, speeds=SPEEDS)
    simulator = Simulator(known.trials(quiet()[1].between(0.55, DURATION)), 2.5e-4)
    return simulator, fit_nominal(simulator, factors_of(known))


def test_a_record_in_motion_is_verified_from_where_it_starts() -> None:
    """Started from rest the engine would be 40 rad/s slower at first: a radian and more, over 1000 times the noise."""
    assert engine_difference(*moving()) < 0.02


def test_the_driven_scene_gives_what_the_search_saw_on_the_engine() -> None:
    simulator, fitted = moving()
    [item] = driven_scenes(simulator, fitted, ["load_cycle"])
    assert item.record == "load_cycle"
    assert item.duration == pytest.approx(DURATION - 0.55)
    assert item.initial == pytest.approx({"motor.angle": 0.4, "motor.speed": 40.0, "load.angle": 0.008, "load.speed": 0.8})
    run = hm.simulate(item.scene, item.duration, initial=item.initial, progress=False)
    times = simulator.trials[0].times
    own = simulator.columns(fitted.hypothesis, fitted.z)[0]
    for column, measured in simulator.trials[0].measured.items():
        assert np.abs(run.at(measured.channel, times) - own[column]).max() < 0.1 * measured.noise


def test_each_record_has_its_own_inputs_and_views_share_a_scene() -> None:
    known = bench()
    trials = [trial for record in quiet() for trial in known.trials(record)]
    again = dataclasses.replace(trials[0], name="staircase, again")
    other = dataclasses.replace(trials[0], name="staircase, otherwise", scene=trials[0].scene.replacing({"load.viscous": 0.31}))
    simulator = Simulator([trials[0], again, other, trials[1]], 1e-3)
    found = driven_scenes(simulator, fit_nominal(simulator, factors_of(known)), list(INPUTS))
    assert [item.record for item in found] == ["staircase", "staircase, otherwise", "load_cycle"]
    for item, which in zip(found[::2], INPUTS, strict=True):
        table = item.scene.parts["motor"].characteristic.reference  # type: ignore[attr-defined]
        times, speeds = INPUTS[which][:2]
        assert np.allclose(table.speeds, np.interp(table.times, times, speeds))
        assert item.initial == {}


def test_values_at_the_start_are_in_the_true_sense() -> None:
    reverse = hm.Scene(
        name="reverse",
        parts={
            "motor": hm.Motor(inertia=1e-3, characteristic=lambda speed: 0.0),
            "gear": hm.HarmonicDrive(ratio=50.0, output_sense="opposite", stiffness=hm.CubicStiffness(linear=1e4, cubic=0.0)),
            "load": hm.Load(inertia=1.0, torque=lambda time: 0.0),
        },
        connections=[("motor", "gear", "load")],
    )
    found = channels_at_start(reverse.network(), {"load": 0.01, "motor": 0.0}, {"motor": 50.0, "load": 1.0})
    assert found == {"motor.speed": 50.0, "load.angle": -0.01, "load.speed": -1.0}
    run = hm.simulate(reverse, 0.01, initial=found, progress=False)
    assert (run["load.angle"].values[0], run["load.speed"].values[0]) == (-0.01, -1.0)


def test_files_of_records_have_different_names() -> None:
    scene = bench().scene
    names = ["run up.csv", "run_up_csv", "Run-up csv", "run_up_csv_2", "+"]
    found = file_names([Driven(record=name, scene=scene, duration=1.0, initial={}) for name in names])
    assert found == ("run_up_csv.toml", "run_up_csv_2.toml", "Run_up_csv_3.toml", "run_up_csv_2_2.toml", "record.toml")


def test_the_command_at_the_head_of_a_records_scene_runs_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    simulator, fitted = moving()
    driven = driven_scenes(simulator, fitted, ["load_cycle"])
    answer = dataclasses.replace(SAMPLES["without_pictures"](), improved=driven[0].scene, driven=driven)
    write_improved(answer, tmp_path)
    assert "improved/RECORD.toml" in " ".join(improved_words(answer))
    file = tmp_path / "improved" / "load_cycle.toml"
    assert load_scene(file) == driven[0].scene
    head = [line for line in file.read_text("utf-8").splitlines() if line.startswith("#")]
    words = head[1].removeprefix("# hdrive-mbs ").split()
    assert "--initial" in words
    assert head[0].endswith("In the folder of this file:")
    monkeypatch.chdir(file.parent)
    done = CliRunner().invoke(app, [*words, "--out", "out"])
    assert done.exit_code == 0, done.output
    run = hm.Response.load(file.parent / "out" / "response.npz")
    assert run.times[-1] == pytest.approx(driven[0].duration)
    assert run.at("motor.speed", np.zeros(1))[0] == 40.0
    own = simulator.columns(fitted.hypothesis, fitted.z)[0]["load_angle"]
    assert abs(run.at("load_encoder", np.array([run.times[-1]]))[0] - own[-1]) < 1e-6


def test_scenes_of_an_earlier_diagnosis_go_and_other_files_stay(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """And a law that is a Python function keeps the rest from being written no more."""
    simulator, fitted = moving()
    first, second = (driven_scenes(simulator, fitted, [name])[0] for name in ("load_cycle", "load"))
    plain = SAMPLES["without_pictures"]()
    (tmp_path / "improved").mkdir()
    (tmp_path / "improved" / "mine.toml").write_text("x = 1\n")
    write_improved(dataclasses.replace(plain, driven=(first,)), tmp_path)
    assert {path.name for path in (tmp_path / "improved").iterdir()} == {"mine.toml", "load_cycle.toml"}
    function = dataclasses.replace(second, record="third", scene=second.scene.replacing({"load.torque": lambda time: 0.0 * time}))
    write_improved(dataclasses.replace(plain, driven=(second, function)), tmp_path)
    assert {path.name for path in (tmp_path / "improved").iterdir()} == {"mine.toml", "load.toml"}
    assert "third.toml was not written: load.torque.function is a Python" in capsys.readouterr().err


def test_the_files_of_all_own_classes_of_a_scene_are_named() -> None:
    scene = two_rotor_line.build()
    answer = dataclasses.replace(SAMPLES["without_pictures"](), improved=scene)
    assert own_files(scene) == ("two_rotor_line.py",)
    assert own_files(bench().scene) == ()
    assert "hdrive-mbs run improved.toml --effects two_rotor_line.py" in " ".join(improved_words(answer))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("load.angle", "write CHANNEL=VALUE"),
        ("load.speed=fast", "fast"),
        ("motor_current=2 A", "no number"),
        ("loat.speed=1", "load.angle/.speed"),
        ("load.speed=inf", "must be a finite number"),
    ],
)
def test_an_initial_value_that_cannot_be_read_is_refused(text: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = hm.save_scene(bench().scene, tmp_path / "scene.toml")
    done = CliRunner().invoke(app, ["run", str(file), "--duration", "0.01", "--initial", text, "--out", str(tmp_path / "out")])
    assert done.exit_code != 0
    assert isinstance(done.exception, hm.HdriveError)
    assert said in str(done.exception)
    assert not (tmp_path / "out").exists()


def test_an_initial_speed_may_have_a_unit(tmp_path: Path) -> None:
    file = hm.save_scene(bench().scene, tmp_path / "scene.toml")
    words = ("run", str(file), "--duration", "0.01", "--initial", "load.speed=60 rpm", "--out", str(tmp_path))
    assert CliRunner().invoke(app, list(words)).exit_code == 0
    run = hm.Response.load(tmp_path / "response.npz")
    assert run["load.speed"].values[0] == pytest.approx(2.0 * np.pi)
