"""Results and the JSON of the command line say of what scene, with what settings and versions they were made."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import hdrive_mbs as hm
from hdrive_mbs.analysis.result import versions
from hdrive_mbs.campaign.fingerprint import fingerprint
from hdrive_mbs.campaign.job_files import FinishedJob
from hdrive_mbs.cli.main import app
from hdrive_mbs.scene_file import scene_from_dict
from models import harmonic_drive_train, two_rotor_line
from tests.unit import campaign_jobs


@pytest.mark.slow
@pytest.mark.parametrize(
    ("model", "words"),
    [
        (harmonic_drive_train, ("modes", "--torque", "0")),
        (harmonic_drive_train, ("torsion", "--torques", "20,40")),
        (harmonic_drive_train, ("run", "--duration", "0.01")),
        (two_rotor_line, ("modes", "--speed", "100")),
        (two_rotor_line, ("campbell", "--speeds", "0:200:3")),
        (two_rotor_line, ("unbalance", "--speeds", "100:200:3")),
        (two_rotor_line, ("run-up", "--duration", "0.02")),
        (harmonic_drive_train, ("sweep", "--vary", "gear.ratio=80,100", "--workers", "1")),
        (two_rotor_line, ("sweep", "--vary", "bearing=full,improved", "--count", "1", "--workers", "1")),
    ],
    ids=lambda value: value[0] if isinstance(value, tuple) else value.__name__.rpartition(".")[2],
)
def test_json_of_a_command_holds_scene_settings_and_versions(model: Any, words: tuple[str, ...], tmp_path: Path) -> None:
    target = tmp_path / "found.json"
    out = ("--out", str(tmp_path / "out"))
    done = CliRunner().invoke(app, [words[0], str(model.__file__), *words[1:], *out, "--json", str(target)], catch_exceptions=False)
    assert done.exit_code == 0, done.output
    origin = json.loads(target.read_text())["origin"]
    assert origin["versions"] == versions()
    assert {"hdrive-mbs", "exudyn", "numpy"} <= set(origin["versions"])
    assert scene_from_dict(origin["scene"]).parts.keys() == model.build().parts.keys()
    assert origin["status"]
    kept = [hm.load(path) for path in (tmp_path / "out").glob("*.npz")]
    assert [(type(item).__name__, item.scene) for item in kept] == [(origin["result"], scene_from_dict(origin["scene"]))]
    (tmp_path / "scene.json").write_text(json.dumps(origin["scene"]))
    assert hm.load_scene(tmp_path / "scene.json") == kept[0].scene


def test_a_swept_scene_is_made_again_from_what_the_campaign_carries(tmp_path: Path) -> None:
    words = ["--analysis", "modes", "--vary", "gear.ratio=80,100", "--set", "motor.inertia=2e-3", "--torque", "40", "--count", "1"]
    words += ["--effect", "ViscousDrag@load:coefficient=0.2", "--workers", "1", "--out", str(tmp_path)]
    done = CliRunner().invoke(app, ["sweep", str(harmonic_drive_train.__file__), *words], catch_exceptions=False)
    assert done.exit_code == 0, done.output
    campaign = hm.Campaign.load(tmp_path / "campaign.npz")
    assert campaign.scene is not None
    assert campaign.scene.effects[0].at == "load"
    settings = campaign.settings
    task = hm.SceneAnalysis(scene=campaign.scene, analysis=settings["analysis"], options=settings["options"])
    assert fingerprint(task) == settings["fingerprint"]
    again = hm.sweep(task, [{"gear.ratio": value} for value in campaign["gear.ratio"]], executor="here")
    assert [dict(values) for values in again.values] == [dict(values) for values in campaign.values]
    jobs = [FinishedJob.load(path) for path in (tmp_path / "jobs").glob("*.npz")]
    assert {job.settings["fingerprint"] for job in jobs} == {settings["fingerprint"]}
    assert [job.settings["options"] for job in jobs] == [{"torque": 40.0, "count": 1}] * 2


def test_a_sweep_that_opens_the_file_anew_carries_the_file_its_digest_and_what_the_command_was_given(tmp_path: Path) -> None:
    file = str(two_rotor_line.__file__)
    words = ["--vary", "bearing=full,improved", "--set", "rotor_1.mass=9", "--count", "2", "--workers", "1", "--out", str(tmp_path)]
    done = CliRunner().invoke(app, ["sweep", file, *words], catch_exceptions=False)
    assert done.exit_code == 0, done.output
    campaign = hm.Campaign.load(tmp_path / "campaign.npz")
    settings = campaign.settings
    assert settings["sha256"] == {settings["file"]: hashlib.sha256(Path(file).read_bytes()).hexdigest()}
    assert (settings["file"], settings["set"], settings["effect"]) == (file, ("rotor_1.mass=9",), ())
    assert (settings["analysis"], settings["options"]) == ("modes", {"count": 2})
    assert campaign.scene is not None
    assert campaign.scene.parameters()["rotor_1.mass"].value == 9.0


def test_a_campaign_of_a_function_names_it_and_its_fingerprint(tmp_path: Path) -> None:
    campaign = hm.sweep(campaign_jobs.square, [{"x": 1}, {"x": 2}], executor="here", folder=tmp_path)
    assert campaign.scene is None
    assert campaign.settings["function"] == "square"
    assert campaign.settings["fingerprint"] == fingerprint(campaign_jobs.square)
    other = hm.sweep(campaign_jobs.fails_at_three, [{"x": 1}], executor="here")
    assert other.settings["fingerprint"] != campaign.settings["fingerprint"]


def test_a_function_of_ones_own_may_say_what_it_is_made_of() -> None:
    @dataclasses.dataclass(frozen=True)
    class Heavier:
        base: hm.Scene

        def __call__(self, point: dict[str, Any]) -> float:
            return float(point["factor"])

        def made_of(self) -> tuple[hm.Scene, dict[str, Any]]:
            return self.base, {"law": "linear"}

    scene = harmonic_drive_train.build()
    campaign = hm.sweep(Heavier(scene), [{"factor": 2.0}], executor="here")
    assert campaign.scene == scene
    assert (campaign.settings["function"], campaign.settings["law"]) == ("Heavier", "linear")


def test_settings_are_plain_and_a_scene_with_functions_is_left_out() -> None:
    scene = harmonic_drive_train.build()
    job = FinishedJob(
        scene=scene,
        status="complete",
        settings={"speeds": np.arange(2.0), "solver": hm.RungeKutta4(step=1e-3), "names": ("a", np.int64(3))},
        parameters={},
        values={},
        seconds=0.0,
        worker="",
        attempts=1,
    )
    told = job.made_from()
    assert told["settings"]["speeds"] == [0.0, 1.0]
    assert told["settings"]["names"] == ["a", 3]
    assert told["settings"]["solver"].startswith("RungeKutta4(")
    assert json.loads(json.dumps(told)) == told
    assert dataclasses.replace(job, scene=None).made_from()["scene"] is None


def test_a_scene_that_is_too_long_for_an_attribute_of_hdf5_is_kept_all_the_same(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    train = harmonic_drive_train.build()
    scene = hm.Scene(name=train.name, parts=train.parts, connections=train.connections, notes="x" * 100_000)
    result = hm.modes(scene)
    with h5py.File(result.export(tmp_path / "modes.h5")) as file:
        text = file["hdrive_mbs.scene"][()].decode()
        assert file.attrs["hdrive_mbs.result"] == "Modes"
    assert scene_from_dict(json.loads(text)) == scene
