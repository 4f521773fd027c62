"""``hdrive-mbs diagnose``: what it hands on, what it writes, and how it refuses.  The search itself is replaced here."""

from __future__ import annotations

import dataclasses
import gc
import itertools
import json
import multiprocessing
import subprocess
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import Result
from typer.testing import CliRunner

import hdrive_mbs as hm
from hdrive_mbs.cli.diagnose import tried
from hdrive_mbs.cli.main import app, main
from hdrive_mbs.cli.python_file import own_types
from hdrive_mbs.cli.stages import plain_lines, stage_bars
from hdrive_mbs.diagnosis import diagnose as search
from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.candidates import known_effects
from hdrive_mbs.diagnosis.report_json import read_report_json
from hdrive_mbs.diagnosis.report_text import report_text
from hdrive_mbs.diagnosis.result import Diagnosis
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.errors import FileFormatError, RecordError
from hdrive_mbs.scene_file import load_scene, save_scene
from models import drive_bench
from tests.patience import PATIENCE
from tests.unit.diagnosis_samples import SAMPLES

BENCH = """
from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.measured import Measured
from models import drive_bench


def bench():
    return Bench(scene=drive_bench.build(), knowledge={}, measured={"motor_angle": Measured(channel="motor_encoder", noise=1e-4)})
"""
BUILD = """
from models.drive_bench import build
"""
SEAL_DRAG = '''
from dataclasses import dataclass

import numpy as np

import hdrive_mbs as hm


@dataclass(frozen=True, kw_only=True)
class SealDrag(hm.TorqueEffect):
    """Lip-seal drag: tau = -a sign(w) |w|^0.4."""

    scale: float = hm.parameter("N m", "drag at 1 rad/s", low=0.0, typical=(0.01, 1.0))

    def torque(self, time, angle, speed):
        return -self.scale * np.sign(speed) * np.abs(speed) ** 0.4
'''
NUMBERS = itertools.count()


@pytest.fixture
def path() -> Iterator[list[str]]:
    """sys.path as it was, afterwards, and no module of a test, whose effects would count as the library's."""
    before, modules = list(sys.path), set(sys.modules)
    yield sys.path
    folders = [folder for folder in sys.path if folder not in before]
    sys.path[:] = before
    for name in set(sys.modules) - modules:
        if str(Path(getattr(sys.modules[name], "__file__", None) or "").parent) in folders:
            del sys.modules[name]
    gc.collect()


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch, path: list[str]) -> list[dict[str, Any]]:
    """What the search was asked for; it answers at once."""
    answer = SAMPLES["without_pictures"]()
    calls: list[dict[str, Any]] = []

    def quick(bench: Any, records: Any, **options: Any) -> Diagnosis:
        calls.append({"bench": bench, "records": records, **options})
        return answer

    monkeypatch.setattr(search, "diagnose", quick)
    return calls


def written(folder: Path, text: str, stem: str = "scene") -> str:
    """A .py file whose name no other test has."""
    file = folder / f"{stem}_{next(NUMBERS)}.py"
    file.write_text(text)
    return str(file)


def record(folder: Path, name: str, *, head: str = "motor_angle [rad]", samples: int = 80) -> str:
    times = np.arange(samples) * 1e-3
    rows = [f"{t:.3f},{np.sin(20.0 * t):.6f}" for t in times]
    folder.mkdir(exist_ok=True)
    (folder / name).write_text("\n".join([f"time [s],{head}", *rows]) + "\n")
    return str(folder / name)


def invoke(*words: str) -> Result:
    return CliRunner().invoke(app, ["diagnose", *words], catch_exceptions=False)


def refused(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, *words: str) -> str:
    """The one line of an error that was foreseen; its exit code is 2."""
    monkeypatch.setattr(sys, "argv", ["hdrive-mbs", "diagnose", *words])
    with pytest.raises(SystemExit) as stopped:
        main()
    assert stopped.value.code == 2
    said = capsys.readouterr().err
    assert "Traceback" not in said
    return said


def test_report_is_printed_and_everything_is_written(asked: list[dict[str, Any]], tmp_path: Path) -> None:
    scene, file, out = written(tmp_path, BENCH), record(tmp_path, "a.csv"), tmp_path / "out"
    options = ("--workers", "2", "--search-seconds", "90", "--every", "2")
    done = invoke(scene, "--records", file, "--out", str(out), "--json", str(tmp_path / "d.json"), *options)
    assert done.exit_code == 0
    answer = SAMPLES["without_pictures"]()
    expected = report_text(answer)
    assert expected in done.stdout
    assert (out / "diagnosis.txt").read_text("utf-8") == expected
    assert read_report_json(tmp_path / "d.json") == read_report_json(out / "diagnosis.json")
    assert load_scene(out / "improved.toml") == answer.improved
    assert load_scene(out / "improved" / "run_1.toml") == answer.driven[0].scene
    assert "Diagnosis of" in (out / "diagnosis.html").read_text("utf-8")
    names = {"diagnosis.txt", "diagnosis.json", "diagnosis.html", "diagnosis.png", "diagnosis.svg", "improved.toml", "improved"}
    assert {item.name for item in out.iterdir()} == names  # and no work left
    assert isinstance(asked[0]["bench"], Bench)
    assert asked[0]["workers"] == 2
    assert asked[0]["search_seconds"] == 90.0
    assert asked[0]["every"] == 2
    assert asked[0]["candidates"] is None


def test_the_improved_scene_says_whose_inputs_it_holds_and_runs_with_the_file_of_its_effect(
    asked: list[dict[str, Any]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = written(tmp_path, SEAL_DRAG, "seal")
    [kind] = (item for item in own_types(Path(own)) if issubclass(item, Effect))
    improved = drive_bench.build().with_effect(kind(scale=0.05), at="motor", name="seal_drag")
    answer = dataclasses.replace(SAMPLES["without_pictures"](), improved=improved, inputs={"torque\n[x]": "motor.characteristic"})
    monkeypatch.setattr(search, "diagnose", lambda *given, **options: answer)
    out = tmp_path / "out"
    assert invoke(written(tmp_path, BENCH), "--records", record(tmp_path, "a.csv"), "--out", str(out)).exit_code == 0
    head = [line for line in (out / "improved.toml").read_text("utf-8").splitlines() if line.startswith("#")]
    assert "holds motor.characteristic (driven by column 'torque" in head[0]
    assert "as the bench file has it, not as in a record" in head[0]
    assert head[-1].endswith(f"hdrive-mbs run improved.toml --effects ../{Path(own).name}")
    assert "as the bench file has it" in " ".join((out / "diagnosis.txt").read_text("utf-8").split())
    assert load_scene(out / "improved.toml", types=[kind]) == improved
    script = "import sys; from hdrive_mbs.cli.main import main; sys.argv[0] = 'hdrive-mbs'; main()"
    words = ("modes", str(out / "improved.toml"))
    without = subprocess.run([sys.executable, "-c", script, *words], capture_output=True, text=True, timeout=PATIENCE, check=False)
    assert without.returncode == 2
    assert "No type 'SealDrag'. effects.seal_drag: it can be one of " in without.stderr
    assert "--effects FILE.py" in without.stderr
    assert len(without.stderr) < 600
    again = subprocess.run(
        [sys.executable, "-c", script, *words, "--effects", own], capture_output=True, text=True, timeout=PATIENCE, check=False
    )
    assert again.returncode == 0, again.stderr


def test_json_on_stdout_is_all_that_is_printed(asked: list[dict[str, Any]], tmp_path: Path) -> None:
    done = invoke(written(tmp_path, BUILD), "--records", record(tmp_path, "a.csv"), "--out", str(tmp_path / "out"), "--json", "-")
    assert json.loads(done.stdout)["verdict"] == "effect"
    assert isinstance(asked[0]["bench"], hm.Scene)


def test_a_scene_file_is_enough(asked: list[dict[str, Any]], tmp_path: Path) -> None:
    save_scene(drive_bench.build(), tmp_path / "bench.toml")
    done = invoke(str(tmp_path / "bench.toml"), "--records", record(tmp_path, "a.csv"), "--out", str(tmp_path / "out"))
    assert done.exit_code == 0
    assert asked[0]["bench"] == drive_bench.build()


def test_records_are_folders_and_files_in_any_number(asked: list[dict[str, Any]], tmp_path: Path) -> None:
    for name in ("a.csv", "b.csv"):
        record(tmp_path / "runs", name)
    others = [record(tmp_path, name) for name in ("c.csv", "d.csv", "e.csv")]
    scene = written(tmp_path, BENCH)
    invoke(scene, "--records", str(tmp_path / "runs"), "--records", others[0], *others[1:], "--out", str(tmp_path / "out"))
    assert sorted(asked[0]["records"].names) == ["a", "b", "c", "d", "e"]
    assert asked[0]["records"]["a"]["motor_angle"].unit == "rad"


def test_columns_are_mapped_and_given_units_on_the_command_line(asked: list[dict[str, Any]], tmp_path: Path) -> None:
    file = record(tmp_path, "a.csv", head="n_mot")
    words = ("--channel", "n_mot=motor.speed", "--unit", "n_mot=rpm", "--out", str(tmp_path / "out"))
    assert invoke(written(tmp_path, BUILD), "--records", file, *words).exit_code == 0
    column = asked[0]["records"]["a"]["motor.speed"]
    assert column.unit == "rad/s"
    assert np.max(column.values) == pytest.approx(np.max(np.sin(20.0 * 1e-3 * np.arange(80))) * np.pi / 30.0, rel=1e-5)


def test_a_column_that_is_mapped_leaves_the_columns_of_the_bench_in_place(asked: list[dict[str, Any]], tmp_path: Path) -> None:
    file = tmp_path / "a.csv"
    rows = [f"{k * 1e-3:.3f},{0.1 * k:.1f},{0.2 * k:.1f},{k % 3}" for k in range(80)]
    file.write_text("\n".join(["time [s],n_load [rad],motor_angle [rad],spare", *rows]) + "\n")
    words = ("--channel", "n_load=load_encoder", "--out", str(tmp_path / "out"))
    assert invoke(written(tmp_path, BENCH), "--records", str(file), *words).exit_code == 0
    assert sorted(asked[0]["records"]["a"].channels) == ["motor_angle", "n_load"]  # and not the spare one, which has no unit
    words = ("--channel", "n_load=motor_encoder", "--out", str(tmp_path / "out_2"))
    assert invoke(written(tmp_path, BENCH), "--records", str(file), *words).exit_code == 0
    assert sorted(asked[1]["records"]["a"].channels) == ["n_load"]  # what is mapped stands for the bench's own column


def test_effects_of_an_own_file_are_tried_beside_the_library(asked: list[dict[str, Any]], tmp_path: Path) -> None:
    own = written(tmp_path, SEAL_DRAG, "seal")
    out = str(tmp_path / "out")
    assert invoke(written(tmp_path, BENCH), "--records", record(tmp_path, "a.csv"), "--effects", own, "--out", out).exit_code == 0
    names = [kind.__name__ for kind in asked[0]["candidates"]]
    assert names[0] == "SealDrag"
    assert names.count("SealDrag") == 1
    assert {"CoulombStribeckFriction", "KinematicError", "BoucWenHysteresis"} <= set(names)


def test_only_some_effects_are_tried_by_class_or_family(asked: list[dict[str, Any]], tmp_path: Path) -> None:
    own = written(tmp_path, SEAL_DRAG, "seal")
    scene, file = written(tmp_path, BENCH), record(tmp_path, "a.csv")
    words = ("--effects", own, "--only", "SealDrag", "--only", "mesh_friction", "--out", str(tmp_path / "out"))
    assert invoke(scene, "--records", file, *words).exit_code == 0
    assert {kind.__name__ for kind in asked[0]["candidates"]} == {"SealDrag", "MeshFriction", "MeshPreslidingFriction"}
    with pytest.raises(hm.PlaceError, match=r"No effect 'MeshFrction'\. The library, with your own files, has .*MeshFriction"):
        invoke(scene, "--records", file, "--only", "MeshFrction", "--out", str(tmp_path / "out"))


def test_effects_of_the_bench_s_own_file_count_beside_other_files_and_can_be_chosen(asked: list[dict[str, Any]], tmp_path: Path) -> None:
    scene, file = written(tmp_path, SEAL_DRAG.replace("SealDrag", "RingDrag") + BENCH), record(tmp_path, "a.csv")
    assert invoke(scene, "--records", file, "--only", "RingDrag", "--out", str(tmp_path / "out")).exit_code == 0
    assert [kind.__name__ for kind in asked[0]["candidates"]] == ["RingDrag"]
    other = written(tmp_path, SEAL_DRAG.replace("SealDrag", "LipDrag"), "lip")
    assert invoke(scene, "--records", file, "--effects", other, "--out", str(tmp_path / "out_2")).exit_code == 0
    assert {"LipDrag", "RingDrag", "MeshFriction"} <= {kind.__name__ for kind in asked[1]["candidates"]}


def test_other_processes_can_read_an_effect_of_an_own_file(path: list[str], tmp_path: Path) -> None:
    kind = own_types(Path(written(tmp_path, SEAL_DRAG, "sent")))[0]
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        assert pool.submit(repr, kind(scale=0.3)).result(timeout=PATIENCE) == repr(kind(scale=0.3))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("import math\n\nx = 1.0\ny = math.sqrt(-x)\n", ", line 4: ValueError: math domain error"),
        ("x = 1\ndef broken(:\n    pass\n", ", line 2: SyntaxError"),
        ("import no_such_package_at_all\n", ", line 1: ModuleNotFoundError: No module named 'no_such_package_at_all'"),
        ("import sys\nsys.exit(3)\n", ", line 2: SystemExit: 3"),
        (
            'import hdrive_mbs as hm\n\n\nclass Wrong(hm.TorqueEffect):\n    kind = "magic"\n',
            ", line 4: ParameterError: Wrong.kind = 'magic'",
        ),
        ("x = 1\n", "defines no effect"),
    ],
)
def test_an_effect_file_that_cannot_be_used_is_named_with_its_line(text: str, words: str, path: list[str], tmp_path: Path) -> None:
    file = written(tmp_path, text, "broken")
    with pytest.raises(FileFormatError) as error:
        own_types(Path(file))
    assert str(error.value).startswith(file)
    assert words in str(error.value)


def test_a_file_with_a_law_of_ones_own_serves_a_scene(path: list[str], tmp_path: Path) -> None:
    head = "from hdrive_mbs import MotorCharacteristic\n\n\nclass Idle(MotorCharacteristic):\n"
    law = head + "    def torque(self, time, speed):\n        return 0.0\n"
    file = Path(written(tmp_path, law, "law"))
    assert [kind.__name__ for kind in own_types(file)] == ["Idle"]
    assert tried([file]) == known_effects()


def test_a_scene_file_that_names_own_classes_is_diagnosed_with_their_files(asked: list[dict[str, Any]], tmp_path: Path) -> None:
    own = written(tmp_path, SEAL_DRAG, "seal")
    [kind] = (item for item in own_types(Path(own)) if issubclass(item, Effect))
    scene = save_scene(drive_bench.build().with_effect(kind(scale=0.05), at="motor", name="seal_drag"), tmp_path / "improved.toml")
    words = (str(scene), "--records", record(tmp_path, "a.csv"), "--out", str(tmp_path / "out"))
    assert invoke(*words, "--effects", own).exit_code == 0
    assert asked[-1]["bench"].effects[0].name == "seal_drag"


def test_an_effect_file_must_not_have_the_name_of_another_module(path: list[str], tmp_path: Path) -> None:
    (tmp_path / "json.py").write_text("x = 1\n")
    with pytest.raises(FileFormatError, match=r"another module named 'json'.*rename the file"):
        own_types(tmp_path / "json.py")
    (tmp_path / "my-effect.py").write_text("x = 1\n")
    with pytest.raises(FileFormatError, match="rename it to letters, digits"):
        own_types(tmp_path / "my-effect.py")


Words = Callable[[Path], tuple[str, ...]]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (lambda f: ("nowhere.py", "--records", record(f, "a.csv")), "nowhere.py: no such file. Give a .py file with bench()"),
        (lambda f: (written(f, "x = 1\n"), "--records", record(f, "a.csv")), "has neither a function bench()"),
        (lambda f: (written(f, "def bench():\n    return 3\n"), "--records", record(f, "a.csv")), "bench() returned a int, not a Bench"),
        (lambda f: (written(f, "def build():\n    return 1 / 0\n"), "--records", record(f, "a.csv")), "line 2: ZeroDivisionError"),
        (lambda f: (written(f, BENCH), "--records", str(f / "none")), "no such file or folder"),
        (lambda f: (written(f, BENCH), "--records", record(f, "a.csv", head="motor_angle")), "unit"),
        (lambda f: (written(f, BENCH), "--records", record(f, "a.csv", head="motor_angle [bananas]")), "bananas"),
        (lambda f: (written(f, BENCH), "--records", record(f, "a.csv"), "--unit", "motor_angle"), "--unit 'motor_angle': write NAME=VALUE"),
        (lambda f: (written(f, BENCH), "--records", record(f, "a.csv"), "--effects", str(f / "no.py")), "no.py: no such file"),
        (lambda f: (written(f, BENCH), "--records", record(f, "a.csv"), "--channel", "load=load.speed"), "No channel 'load'"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(
    words: Words,
    said: str,
    asked: list[dict[str, Any]],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert said in refused(capsys, monkeypatch, *words(tmp_path))
    assert asked == []
    assert not (tmp_path / "results").exists()


def test_an_error_of_the_search_is_one_line_and_can_be_mended(
    path: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def short(*given: Any, **options: Any) -> Diagnosis:
        raise RecordError("Record 'a' has 80 samples; a diagnosis needs more.")

    monkeypatch.setattr(search, "diagnose", short)
    words = (written(tmp_path, BENCH), "--records", record(tmp_path, "a.csv"), "--out", str(tmp_path / "out"))
    for _ in range(2):  # the second time as the first: what failed at once is nothing to go on with
        assert "error: Record 'a' has 80 samples" in refused(capsys, monkeypatch, *words)
        assert not (tmp_path / "out").exists()
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "mine.txt").write_text("kept")
    refused(capsys, monkeypatch, *words)
    assert [item.name for item in (tmp_path / "out").iterdir()] == ["mine.txt"]


def test_an_interrupted_diagnosis_is_kept_and_gone_on_with(
    asked: list[dict[str, Any]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    answers = search.diagnose

    def interrupted(*given: Any, folder: Path, **options: Any) -> Diagnosis:
        (folder / "fit_1").write_text("kept")
        raise KeyboardInterrupt

    monkeypatch.setattr(search, "diagnose", interrupted)
    out = tmp_path / "out"
    words = (written(tmp_path, BENCH), "--records", record(tmp_path, "a.csv"), "--out", str(out))
    done = invoke(*words)
    assert done.exit_code == 130
    assert "--resume goes on" in done.stderr
    assert (out / "work" / "fit_1").read_text() == "kept"

    assert "was not finished: go on with --resume" in refused(capsys, monkeypatch, *words)

    record(tmp_path, "a.csv", samples=90)
    assert "of another scene, other records" in refused(capsys, monkeypatch, *words, "--resume")
    assert (out / "work" / "fit_1").read_text() == "kept"

    record(tmp_path, "a.csv")
    assert "effects or options" in refused(capsys, monkeypatch, *words, "--resume", "--every", "2")
    monkeypatch.setattr(search, "diagnose", answers)
    assert invoke(*words, "--resume").exit_code == 0
    assert asked[0]["folder"] == out / "work"
    assert not (out / "work").exists()
    assert (out / "diagnosis.html").exists()


def test_stages_are_shown_on_a_terminal_only() -> None:
    with stage_bars(show=False) as report:
        assert report is None
    with stage_bars(show=True) as report:
        assert report is not None
        report("screening", 1, 4)
        report("screening", 4, 4)
        report("joint fits", 0, 0)  # a stage without work divides nothing by nothing


def test_without_a_terminal_a_plain_line_comes_every_half_minute(capsys: pytest.CaptureFixture[str]) -> None:
    times = iter((100.0, 101.0, 129.0, 131.0, 140.0, 175.0))
    report = plain_lines(clock=lambda: next(times))
    for stage, done, total in (("first", 1, 4), ("first", 2, 4), ("first", 3, 4), ("second", 0, 1), ("third", 0, 1)):
        report(stage, done, total)
    assert capsys.readouterr().err == "31 s: first, 3 of 4, about 15 s left of this\n75 s: third\n"
    with stage_bars() as shown:  # stderr is no terminal here
        assert shown is not None
        shown("first", 1, 4)
    assert capsys.readouterr().err == ""


def test_tests_leave_no_effect_behind() -> None:
    gc.collect()
    assert "SealDrag" not in [kind.__name__ for kind in known_effects() if kind.__module__.startswith(("seal_", "sent_"))]
