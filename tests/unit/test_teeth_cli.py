"""``hdrive-mbs teeth``."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import hdrive_mbs as hm
from hdrive_mbs.cli.main import app
from models.double_harmonic_transmission import build, gear

MODEL = Path(__file__).parents[2] / "models" / "double_harmonic_transmission.py"
RUN = CliRunner()


def teeth(*words: object) -> None:
    result = RUN.invoke(app, ["teeth", *map(str, words)])
    if result.exception is not None:
        raise result.exception
    assert result.exit_code == 0, result.output


def test_positions_and_clearances_are_written_in_mm_and_degrees(tmp_path: Path) -> None:
    target = tmp_path / "teeth.json"
    teeth(MODEL, "--step", "15", "--json", target)
    document = json.loads(target.read_text())
    assert document["ratio"] == pytest.approx(-50.0)
    assert len(document["stages"]) == 2
    for entry, stage in zip(document["stages"], gear("A").stages()):
        assert entry["angle_deg"] == [15.0 * k for k in range(13)]
        motion = hm.tooth_motion(stage, np.radians(entry["angle_deg"]), exact=False)
        np.testing.assert_allclose(entry["P"], 1e3 * motion.P, atol=1e-9)
        np.testing.assert_allclose(entry["R"], 1e3 * motion.R, atol=1e-9)
        exact = hm.tooth_motion(stage, np.radians(entry["angle_deg"]))
        np.testing.assert_allclose(entry["P_exact"], 1e3 * exact.P, atol=1e-9)
        assert entry["min_clearance_mm"] == pytest.approx(1e3 * hm.clearances(stage).minimum)
        assert entry["interferes"] is False
        # tooth 0 stands on the starting axis: x is 0, not a rounding of it
        assert entry["P"][0][0] == entry["M"][0] == 0.0
    # stage I on the major axis and opposite, stage II on the minor one
    centres = [[0.5 * sum(zone) for zone in entry["zones_from_major_axis_deg"]] for entry in document["stages"]]
    np.testing.assert_allclose(centres, [[0.0, 180.0], [90.0, 270.0]], atol=1e-6)


def test_one_stage_and_another_set_can_be_chosen(tmp_path: Path) -> None:
    target = tmp_path / "teeth.json"
    teeth(MODEL, "--stage", 2, "--set", "name=C", "--json", target)
    document = json.loads(target.read_text())
    assert document["ratio"] == pytest.approx(-48.205, abs=5e-4)
    assert [entry["stage"] for entry in document["stages"]] == [2]


def test_a_scene_file_with_teeth_is_read(tmp_path: Path) -> None:
    scene = hm.save_scene(build("C"), tmp_path / "scene.toml")
    target = tmp_path / "teeth.json"
    teeth(scene, "--json", target)
    assert json.loads(target.read_text())["ratio"] == pytest.approx(gear("C").ratio)


def test_the_design_window_is_written(tmp_path: Path) -> None:
    target = tmp_path / "design.json"
    teeth("design", MODEL, "--stage", 1, "--per-variable", 5, "--out", tmp_path, "--json", target)
    (entry,) = json.loads(target.read_text())["stages"]
    assert entry["designs"] == 5**4
    assert set(entry["best"]) == {"profile_angle_deg", "height_mm", "clearance_mm", "amplitude_mm"}
    assert all(bound["low"] <= bound["high"] and bound["below"] for bound in entry["bounds"])
    assert (tmp_path / "design_1.png").stat().st_size > 10_000


def test_the_w0_that_both_stages_share_is_the_overlap_of_their_ranges(tmp_path: Path) -> None:
    target = tmp_path / "design.json"
    teeth("design", MODEL, "--per-variable", 4, "--json", target)
    document = json.loads(target.read_text())
    ranges = [(b["low"], b["high"]) for entry in document["stages"] for b in entry["bounds"] if b["variable"] == "amplitude_mm"]
    assert len(ranges) == 2
    low, high = document["common_amplitude_mm"]
    assert all(one[0] <= low < high <= one[1] for one in ranges)
    assert low in {one[0] for one in ranges}
    assert high in {one[1] for one in ranges}


def test_pictures_are_written_with_the_animation_or_without_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    animated: list[Path] = []
    monkeypatch.setattr("hdrive_mbs.plots.animate", lambda _, path: animated.append(path))
    teeth(MODEL, "--stage", 1, "--no-animation", "--out", tmp_path)
    assert {path.stem for path in tmp_path.glob("*.png")} == {"section", "positions_1", "clearance_1", "clearance_map_1"}
    assert animated == []
    monkeypatch.setattr("hdrive_mbs.plots.save_figure", lambda *_: [])  # drawn, not written again
    teeth(MODEL, "--stage", 1, "--out", tmp_path)
    assert animated == [tmp_path / "meshing.gif"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ((MODEL, "--stage", 3), "has the stages 1 to 2"),
        ((MODEL, "--step", 0), "step must be greater than 0"),
        ((MODEL, "--set", "size=3"), "has no such argument"),
        ((MODEL, "--set", "name=B"), "There is no set 'B'; there are A, C"),
        ((MODEL.parent / "harmonic_drive_train.py",), "has no gear with teeth"),
        (("design",), "takes one SCENE"),
        (("design", MODEL, "--per-variable", 1), "1 points per variable; a grid needs at least 2"),
        (("missing.py",), "no such file"),
    ],
)
def test_wrong_calls_are_refused(words: tuple[object, ...], message: str) -> None:
    with pytest.raises(hm.HdriveError, match=message):
        teeth(*words)
