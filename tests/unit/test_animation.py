"""Animations: files of every kind, true states in every frame, errors before any drawing."""

from __future__ import annotations

import base64
import itertools
import re
import stat
import subprocess
import sys
import threading
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from PIL import Image
from typer.testing import CliRunner

import hdrive_mbs as hm
from hdrive_mbs.cli.main import app
from hdrive_mbs.plots.drive_animation import DrivePicture
from hdrive_mbs.plots.line_animation import LinePicture
from hdrive_mbs.plots.stroboscope import SEEN, STEP, moments
from models import robot_joint_line as joint
from models import two_rotor_line

SMALL = {"frames": 4, "seconds": 1.0, "dpi": 40}
SOLVER = hm.Trapezoidal(step=2e-4, newton_tolerance=1e-4)


@pytest.fixture(scope="module")
def run() -> hm.Response:
    return hm.simulate(joint.build(), 0.3, solver=SOLVER)


@pytest.fixture(scope="module")
def fast() -> hm.Response:
    return hm.simulate(two_rotor_line.build("improved", final_speed=700.0), 0.3, solver=SOLVER, initial_speed=690.0)


# -- files ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("view", ["line", "drive"])
def test_a_gif_has_as_many_frames_as_asked_for_and_they_differ(run: hm.Response, view: str, tmp_path: Path) -> None:
    path = hm.animate(run, tmp_path / "joint.gif", view=view, **SMALL)
    with Image.open(path) as picture:
        assert picture.n_frames == 4  # type: ignore[attr-defined]
        assert picture.info["loop"] == 0
        assert picture.info["duration"] == 250
        frames = []
        for k in range(4):
            picture.seek(k)
            frames.append(np.asarray(picture.convert("RGB")))
    assert np.all(frames[0][0, 0] == 255)  # paper is white
    assert all(np.any(a != b) for a, b in itertools.pairwise(frames))


def test_a_page_holds_all_frames_and_words_for_those_who_do_not_see_them(run: hm.Response, tmp_path: Path) -> None:
    page = hm.animate(run, tmp_path / "joint.html", view="drive", **SMALL).read_text("utf-8")
    frames = re.findall(r'"data:image/png;base64,([^"]+)"', page.partition("const frames")[2])
    assert len(frames) == 4
    assert all(base64.b64decode(item).startswith(b"\x89PNG") for item in frames)
    assert "http" not in page  # needs nothing from elsewhere
    assert re.search(r'<img id="frame" alt="gear of robot joint line in motion', page)


def test_frames_go_to_ffmpeg_where_there_is_one(run: hm.Response, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    encoder = tmp_path / "ffmpeg"
    encoder.write_text(
        f"#!{sys.executable}\nimport sys\nsize = sys.argv[sys.argv.index('-s') + 1].split('x')\n"
        "read = len(sys.stdin.buffer.read())\nopen(sys.argv[-1], 'w').write(f'{read / (3 * int(size[0]) * int(size[1]))} frames')\n"
    )
    encoder.chmod(encoder.stat().st_mode | stat.S_IEXEC)
    with matplotlib.rc_context({"animation.ffmpeg_path": str(encoder)}):
        assert hm.animate(run, tmp_path / "joint.mp4", **SMALL).read_text() == "4.0 frames"
        encoder.write_text(f"#!{sys.executable}\nimport sys\nsys.exit('no such codec')\n")
        with pytest.raises(hm.HdriveError, match=r"no such codec.*\.gif or \.html"):
            hm.animate(run, tmp_path / "other.mp4", **SMALL)
    assert not (tmp_path / "other.mp4").exists()


def test_an_mp4_is_a_film_of_all_frames(run: hm.Response, tmp_path: Path) -> None:
    """By the encoder that the package for tests brings, read back by the same program's decoder."""
    import imageio_ffmpeg

    path = hm.animate(run, tmp_path / "joint.mp4", **SMALL)
    assert b"ftyp" in path.read_bytes()[:16]
    frames = imageio_ffmpeg.read_frames(str(path))
    about = next(frames)
    width, height = about["size"]
    pictures = [np.frombuffer(frame, np.uint8).reshape(height, width, 3) for frame in frames]
    assert about["codec"] == "h264"
    assert about["duration"] == pytest.approx(SMALL["seconds"], rel=0.05)
    assert len(pictures) == SMALL["frames"]
    assert all(np.all(picture[0, 0] > 250) for picture in pictures)  # paper is white
    assert all(np.any(a != b) for a, b in itertools.pairwise(pictures))


def test_without_ffmpeg_the_error_says_what_to_do(run: hm.Response, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)  # as if it were not installed
    with matplotlib.rc_context({"animation.ffmpeg_path": "no-such-program"}), pytest.raises(hm.HdriveError, match=r"video.*gif or \.html"):
        hm.animate(run, tmp_path / "joint.mp4", **SMALL)


@pytest.mark.parametrize(
    ("path", "options", "words"),
    [
        ("joint.avi", {}, "'.avi'"),
        ("joint", {}, "the ending '' is none"),
        ("joint.gif", {"frames": 1}, "frames = 1"),
        ("joint.gif", {"seconds": 0.0}, "seconds"),
        ("joint.gif", {"dpi": 5}, "dpi"),
        ("joint.gif", {"times": (0.1, 9.0)}, "from 0 s to 0.3 s"),
        ("joint.gif", {"view": "side"}, "line, drive"),
        ("joint.gif", {"magnification": -2.0}, "magnification"),
        ("joint.gif", {"view": "drive", "gear": "motor"}, "gear"),
    ],
)
def test_a_request_that_makes_no_film_is_refused_before_anything_is_written(
    run: hm.Response, path: str, options: dict[str, object], words: str, tmp_path: Path
) -> None:
    with pytest.raises(hm.HdriveError, match=words):
        hm.animate(run, tmp_path / path, **{**SMALL, **options})
    assert not list(tmp_path.iterdir())


def test_a_cancelled_animation_leaves_an_older_file_as_it_was(run: hm.Response, tmp_path: Path) -> None:
    path = tmp_path / "joint.gif"
    path.write_text("older")
    stop = threading.Event()
    stop.set()
    with pytest.raises(hm.AnalysisError, match="cancelled after 0 of 4"):
        hm.animate(run, path, cancel=stop, **SMALL)
    assert [item.read_text() for item in tmp_path.iterdir()] == ["older"]


def test_a_line_without_teeth_has_no_drive_to_show_and_a_train_no_line(fast: hm.Response, tmp_path: Path) -> None:
    with pytest.raises(hm.AnalysisError, match="from_gear"):
        hm.animate(fast, tmp_path / "a.gif", view="drive", **SMALL)
    from models.double_harmonic_transmission import build

    train = hm.simulate(build(), 0.02)
    with pytest.raises(hm.AnalysisError, match="view='drive'"):
        hm.animate(train, tmp_path / "a.gif", view="line", **SMALL)
    assert hm.animate(train, tmp_path / "a.gif", **SMALL).stat().st_size > 1000
    with pytest.raises(hm.AnalysisError, match="no moving picture of a str"):
        hm.animate("run", tmp_path / "b.gif")


def test_the_command_animates_a_saved_run(run: hm.Response, tmp_path: Path) -> None:
    saved, out = run.save(tmp_path / "response.npz"), tmp_path / "joint.gif"
    words = ["animate", str(saved), "--out", str(out), "--view", "drive", "--frames", "3", "--dpi", "40", "--from", "0.1"]
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 0, done.output
    with Image.open(out) as picture:
        assert picture.n_frames == 3  # type: ignore[attr-defined]
    assert "3 frames" in done.output


OWN = """
from dataclasses import dataclass

import hdrive_mbs as hm


@dataclass(frozen=True, kw_only=True)
class GreaseOfAnimationTest(hm.TorqueEffect):
    scale: float = hm.parameter("N m", "drag at high speed", low=0.0)

    def torque(self, time, angle, speed):
        return -self.scale * speed / (1.0 + abs(speed))
"""


@pytest.mark.slow
def test_a_run_with_an_effect_of_ones_own_is_animated_with_its_file(tmp_path: Path) -> None:
    """Each command in a process of its own, which does not know the class."""
    own, model, out = tmp_path / "grease.py", Path(two_rotor_line.__file__), tmp_path / "line.gif"
    own.write_text(OWN, encoding="utf-8")

    def command(*words: str) -> subprocess.CompletedProcess[str]:
        script = "from hdrive_mbs.cli.main import main; main()"
        return subprocess.run([sys.executable, "-c", script, *words], capture_output=True, text=True, check=False, timeout=300)

    options = ("--effects", str(own), "--effect", "GreaseOfAnimationTest@drive:scale=0.05", "--duration", "0.02")
    assert command("run", str(model), *options, "--out", str(tmp_path)).returncode == 0
    # the model's motor has a law of its own too
    words = ("animate", str(tmp_path / "response.npz"), "--out", str(out), "--frames", "2", "--dpi", "40", "--effects", str(model))
    without = command(*words)
    assert without.returncode == 2
    assert "--effects FILE.py" in without.stderr
    assert not out.exists()
    done = command(*words, "--effects", str(own))
    assert done.returncode == 0, done.stderr
    with Image.open(out) as picture:
        assert picture.n_frames == 2  # type: ignore[attr-defined]


# -- what the frames show -----------------------------------------------------------------------------------


def test_the_stroboscope_shows_true_moments_a_step_apart(fast: hm.Response) -> None:
    angle = fast["drive_disc.angle"]
    found = moments(angle, 0.0, 0.3, 30, 3.0)
    assert "stroboscope" in found.note
    assert np.all(np.diff(found.times) > 0.0)
    assert np.max(np.abs(found.times - np.linspace(0.0, 0.3, 30))) <= np.pi / 690.0 + 1e-3  # half a turn
    turned = np.diff(angle.at(found.times))
    # interpolated between samples 2e-4 s = 0.14 rad apart, at nearly constant speed
    np.testing.assert_allclose(np.mod(turned[1:-1] + np.pi, 2.0 * np.pi) - np.pi, STEP, atol=1e-3)


def test_a_short_stretch_is_shown_evenly_and_says_how_much_slower(fast: hm.Response) -> None:
    found = moments(fast["drive_disc.angle"], 0.1, 0.11, 30, 3.0)
    np.testing.assert_allclose(np.diff(found.times), 0.01 / 29)
    assert np.max(np.diff(fast["drive_disc.angle"].at(found.times))) < SEEN
    assert found.note == "slowed down 300 times"


def test_the_drawn_line_is_the_deflection_magnified(fast: hm.Response) -> None:
    picture = LinePicture(fast, fast.scene, (0.1, 0.11), 5, 1.0, 1000.0)  # type: ignore[arg-type]
    picture.show(3)
    time = picture._moments.times[3]
    x, y = (1000.0 * float(fast[f"rotor_1.{key}"].at(time)) for key in "xy")
    (line,) = picture._shafts.values()
    points = line.get_xydata()
    # rotor 1 stands 0.31 m along the line; x points into the picture
    wanted = np.array([0.31, 0.0]) + np.array([0.42 * x, 0.26 * x + y])
    assert np.min(np.hypot(*(points - wanted).T)) < 1e-3  # points lie 1.4 mm apart
    assert "magnified 1000 times" in picture.figure._suptitle.get_text()
    assert f"{time:.4f} s" in picture._clock.get_text()
    # places recovered inside improved bearings stand on the shaft, not beside it
    assert {item.shaft for item in picture._stations} == {picture._stations[0].shaft}


def _shown_drive(run: hm.Response, number: int, count: int = 60) -> DrivePicture:
    picture = DrivePicture(run, run.scene, "gear", None, count, 1.0, None)  # type: ignore[arg-type]
    picture.show(number)
    return picture


def test_the_generator_and_the_flexspline_stand_at_the_angles_of_the_run(run: hm.Response) -> None:
    picture = _shown_drive(run, 40)
    time = picture._moments.times[40]
    for mark, flange in ((picture._arrow, "wave_generator"), (picture._mark, "flexspline"), (picture._fixed, "circular_spline")):
        x, y = (float(item[0]) for item in mark.get_data())
        angle = float(run[f"gear.{flange}.angle"].at(time))  # anticlockwise from the top
        assert np.hypot(x, y) * np.array([-np.sin(angle), np.cos(angle)]) == pytest.approx([x, y], abs=1e-6)


def test_the_teeth_move_beside_the_curves_of_speed_and_torque_whose_cursor_stands_at_the_frame(run: hm.Response) -> None:
    picture = _shown_drive(run, 40)
    [history] = [ax for ax in picture.figure.axes if ax.get_ylabel() == "wave generator [rad/s]"]
    beside = next(ax for ax in history.get_shared_x_axes().get_siblings(history) if ax is not history)
    assert history.get_xlabel() == "time [s]"
    assert beside.get_ylabel().startswith("torque of gear")
    for ax, channel in ((history, "gear.wave_generator.speed"), (beside, "gear.torque")):
        times, values = (np.asarray(item, float) for item in ax.lines[0].get_data())
        assert (times[0], times[-1]) == (run.times[0], run.times[-1])
        # curves are thinned to some of the run's own samples
        assert values == pytest.approx(run.values[channel][np.searchsorted(run.times, times - 1e-12)], abs=1e-12)
        assert np.ptp(values) == pytest.approx(np.ptp(run.values[channel]), rel=0.01)
    assert list(picture._cursor.get_xdata()) == [picture._moments.times[40]] * 2
    picture.show(41)
    assert list(picture._cursor.get_xdata()) == [picture._moments.times[41]] * 2
    assert "speed of the wave generator and torque over time" in picture.description


def test_the_drawn_teeth_touch_on_one_flank_and_do_not_enter_each_other(run: hm.Response) -> None:
    from shapely import Polygon
    from shapely.affinity import rotate

    times = run.times
    loaded = np.flatnonzero(run.values["gear.torque"] > 0.2)
    picture = DrivePicture(run, run.scene, "gear", (float(times[loaded[-1]]) - 0.002, float(times[-1])), 2, 1.0, None)  # type: ignore[arg-type]
    picture.show(0)
    assert picture._torque[0] > 0.0
    body = Polygon(picture._body.get_path().vertices[: 200 * _points_per_tooth(picture)])
    space = Polygon(1e3 * picture._rigid)
    half = np.degrees(picture._half_gap)

    def entering(turn: float) -> float:
        """Area [mm^2] of teeth in teeth when the flexspline is turned on [deg, anticlockwise]."""
        return float(rotate(body, turn, origin=(0.0, 0.0)).difference(space).area)

    # driven forward, which is clockwise here, the circular spline holds the flexspline back: anticlockwise there is no way left,
    # clockwise the whole lost motion
    assert entering(0.0) < 0.05 * entering(half)
    assert entering(-1.9 * half) < 0.05 * entering(half)
    assert entering(-3.0 * half) > 0.3 * entering(half)


def _points_per_tooth(picture: DrivePicture) -> int:
    from hdrive_mbs.teeth.section import tooth_line

    return len(tooth_line(picture._stage, True))
