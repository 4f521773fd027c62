"""Rotors saved by ROSS on the command line: read like a scene where all of them maps, else written as one without the rest."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

import hdrive_mbs as hm
from hdrive_mbs.cli.diagnose import open_bench
from hdrive_mbs.cli.main import app
from hdrive_mbs.cli.scene_source import open_scene
from hdrive_mbs.errors import FileFormatError
from tests.patience import PATIENCE

DATA = Path(__file__).parents[1] / "data"
"""The rotor and ROSS's own values, made by make_ross_rotor.py there with ROSS 2.3.0."""


@pytest.fixture
def with_a_gear(tmp_path: Path) -> Path:
    """The rotor with two things that do not map."""
    document = json.loads((DATA / "ross_rotor.json").read_text())
    document["GearElement_Pinion"] = {"n": 4, "m": 3.0}
    document["ShaftElement_Shaft Element 3"]["alpha"] = 0.5
    path = tmp_path / "geared.json"
    path.write_text(json.dumps(document))
    return path


def said(*words: str) -> str:
    """What a command that ends with an error of ours writes to stderr."""
    code = "import sys; from hdrive_mbs.cli.main import main; main()"
    done = subprocess.run([sys.executable, "-c", code, *words], capture_output=True, text=True, timeout=PATIENCE)
    assert done.returncode == 2, done.stderr
    assert done.stdout == ""
    return done.stderr


@pytest.mark.parametrize("suffix", ["toml", "json"])
def test_a_command_takes_a_rotor_of_ross_in_place_of_a_scene(suffix: str, tmp_path: Path) -> None:
    words = ["modes", str(DATA / f"ross_rotor.{suffix}"), "--speed", "400", "--set", "disk_0.mass=9", "--json", str(tmp_path / "m.json")]
    done = CliRunner().invoke(app, words, catch_exceptions=False)
    assert done.exit_code == 0, done.output
    found = json.loads((tmp_path / "m.json").read_text())
    by_hand = hm.whirl_modes(hm.load_ross(DATA / f"ross_rotor.{suffix}").replacing({"disk_0.mass": 9.0}), 400.0)
    assert [mode["frequency"] for mode in found["modes"]] == pytest.approx(by_hand.frequencies.tolist(), rel=1e-12)
    assert "saved by ROSS 2.3.0" in found["origin"]["scene"]["notes"]


def test_the_content_tells_a_rotor_from_a_scene_not_the_name(tmp_path: Path) -> None:
    rotor = hm.load_ross(DATA / "ross_rotor.toml")
    ours = hm.save_scene(rotor, tmp_path / "ross_rotor.toml")
    assert open_scene(ours) == open_scene(DATA / "ross_rotor.toml") == open_bench(DATA / "ross_rotor.toml") == rotor
    neither = tmp_path / "neither.toml"
    neither.write_text("[parameters]\na = 1\n")
    with pytest.raises(FileFormatError, match="not a scene: 'format' must be"):
        open_scene(neither)


def test_what_does_not_map_stops_the_command_and_all_of_it_is_listed_with_the_way_out(with_a_gear: Path) -> None:
    told = said("campbell", str(with_a_gear), "--speeds", "0:100:3")
    assert "2 of this rotor do not map" in told
    assert "Pinion: a GearElement" in told
    assert "Shaft Element 3.alpha: 0.5 1/s" in told
    assert "hdrive-mbs from-ross FILE --leave-out 'Shaft Element 3.alpha' ... --out SCENE.toml" in told
    assert "leave_out=" not in told


def test_from_ross_writes_the_scene_and_says_what_it_left_out(with_a_gear: Path, tmp_path: Path) -> None:
    out = tmp_path / "line.toml"
    agreed = ["--leave-out", "Pinion", "--leave-out", "*.alpha"]
    done = CliRunner().invoke(app, ["from-ross", str(with_a_gear), *agreed, "--out", str(out), "--name", "geared line"])
    assert done.exit_code == 0, done.output
    lines = done.stderr.splitlines()
    assert [line.partition(": ")[2].partition(":")[0] for line in lines] == ["Shaft Element 3.alpha", "Pinion"]
    assert all(line.startswith("left out: ") for line in lines)
    scene = hm.load_scene(out)
    assert scene == hm.load_ross(with_a_gear, leave_out=["Pinion", "*.alpha"], name="geared line")
    assert "Left out: Pinion: a GearElement." in scene.notes


def test_from_ross_writes_nothing_where_something_is_not_agreed_to(with_a_gear: Path, tmp_path: Path) -> None:
    out = tmp_path / "line.toml"
    told = said("from-ross", str(with_a_gear), "--leave-out", "Pinion", "--out", str(out))
    assert "1 of this rotor do not map" in told
    assert not out.exists()


def test_a_rotor_on_which_all_maps_is_written_without_a_word_on_stderr(tmp_path: Path) -> None:
    done = CliRunner().invoke(app, ["from-ross", str(DATA / "ross_rotor.toml"), "--out", str(tmp_path / "line.json")])
    assert (done.exit_code, done.stderr) == (0, "")
    assert hm.load_scene(tmp_path / "line.json") == hm.load_ross(DATA / "ross_rotor.toml")
