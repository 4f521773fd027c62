"""``hdrive-mbs diagnose-all``: many cases on processes and on a cluster.  The search itself is replaced by the bench's file."""

from __future__ import annotations

import gc
import json
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from hdrive_mbs.campaign import sweeping
from hdrive_mbs.campaign.job_files import FinishedJob
from hdrive_mbs.campaign.sweeping import sweep
from hdrive_mbs.cli.case_diagnosis import cases_in, content_hash
from hdrive_mbs.cli.main import app
from hdrive_mbs.diagnosis import diagnose as search
from hdrive_mbs.diagnosis.report_json import read_report_json
from hdrive_mbs.errors import FileFormatError
from hdrive_mbs.scene_file import load_scene, save_scene, scene_from_dict
from models import drive_bench
from tests.patience import PATIENCE
from tests.unit.diagnosis_samples import SAMPLES
from tests.unit.test_campaign import gone
from tests.unit.test_campaign_cluster import scheduler, start
from tests.unit.test_diagnose_cli import record

ROOT = Path(__file__).parents[2]
BENCH = '''
import os
import time
from pathlib import Path

from hdrive_mbs.diagnosis import diagnose as search
from models.drive_bench import build
from tests.unit.diagnosis_samples import SAMPLES


def quick(bench, records, *, candidates, workers, folder, every, search_seconds):
    """Says that it works, keeps a fit, takes its time, and answers."""
    before = folder is not None and (folder / "fit").exists()
    if folder is not None:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "fit").write_text("kept")
    with Path(__file__).with_suffix(".log").open("a") as log:
        log.write(f"{records.names[0]} {os.getpid()} {'goes_on' if before else 'begins'}\\n")
    time.sleep(SECONDS)
    return SAMPLES["without_pictures"]()


search.diagnose = quick
'''


@pytest.fixture
def bench(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A bench whose diagnoses take no time; what it puts in place of the search is taken back."""
    monkeypatch.setattr(search, "diagnose", search.diagnose)
    monkeypatch.setattr(sys, "path", list(sys.path))
    yield written(tmp_path, "quick_bench", 0.0)
    sys.modules.pop("quick_bench", None)
    gc.collect()


def written(folder: Path, stem: str, seconds: float) -> Path:
    file = folder / f"{stem}.py"
    file.write_text(BENCH.replace("SECONDS", repr(seconds)))
    return file


def log_lines(bench: Path) -> list[list[str]]:
    log = bench.with_suffix(".log")
    return [line.split() for line in log.read_text().splitlines()] if log.exists() else []


def cases(folder: Path, *names: str) -> Path:
    for name in names:
        (folder / name).mkdir(parents=True)
        record(folder / name, f"run_{name}.csv")
    return folder


def invoke(*words: str) -> Any:
    return CliRunner().invoke(app, ["diagnose-all", *words], catch_exceptions=False)


def test_every_case_gets_its_report_and_the_table_a_line(bench: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    done = invoke(str(bench), "--records", str(cases(tmp_path / "set", "a", "b")), "--out", str(out), "--workers", "2", "--json", "-")
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    assert found["columns"]["case"] == ["a", "b"]
    assert found["columns"]["verdict"] == ["effect", "effect"]
    origin = found["origin"]
    assert origin["versions"]["hdrive-mbs"]
    assert scene_from_dict(origin["scene"]) == drive_bench.build()
    assert origin["settings"]["bench"] == {"file": str(bench), "digest": content_hash([bench])}
    assert origin["settings"]["reading"]["repair"] is None
    answer = SAMPLES["without_pictures"]()
    for name in ("a", "b"):
        assert read_report_json(out / name / "diagnosis.json")["verdict"] == answer.verdict
        assert load_scene(out / name / "improved.toml") == answer.improved
        assert load_scene(out / name / "improved" / "run_1.toml") == answer.driven[0].scene
        assert "Diagnosis of" in (out / name / "diagnosis.html").read_text("utf-8")
    assert {item.name for item in out.iterdir()} == {"a", "b", "jobs", "diagnoses.csv"}  # and no work left
    assert (out / "diagnoses.csv").read_text().splitlines()[1].startswith("a,")


@pytest.mark.slow
def test_a_failing_case_is_told_with_its_records_and_the_same_command_goes_on_once_it_is_mended(bench: Path, tmp_path: Path) -> None:
    folder, out = cases(tmp_path / "set", "a", "b", "c"), tmp_path / "out"
    (folder / "b" / "run_b.csv").write_text("time [s],motor_angle [rad]\n0.0,1.0\n0.0,2.0\n")
    words = (str(bench), "--records", str(folder), "--out", str(out), "--workers", "1")
    done = invoke(*words)
    assert done.exit_code == 1
    assert f"failed: b ({folder / 'b'}): RecordError: " in done.stderr
    assert "Traceback" in (out / "failures.txt").read_text()
    assert sorted(line[0] for line in log_lines(bench)) == ["run_a", "run_c"]
    assert (out / "c" / "diagnosis.html").exists()
    assert not (out / "b").exists()

    record(folder / "b", "run_b.csv")
    (out / "a" / "diagnosis.txt").unlink()  # what is gone is written again, without working it out again
    again = invoke(*words)
    assert again.exit_code == 0, again.output
    assert "3 of 3 cases done, 2 of them found finished" in again.stdout
    assert [line[0] for line in log_lines(bench)[2:]] == ["run_b"]
    assert (out / "a" / "diagnosis.txt").exists()
    assert not (out / "failures.txt").exists()


@pytest.mark.slow
def test_a_changed_record_or_bench_makes_the_case_anew(bench: Path, tmp_path: Path) -> None:
    words = (str(bench), "--records", str(cases(tmp_path / "set", "a")), "--out", str(tmp_path / "out"), "--workers", "1")
    assert invoke(*words).exit_code == 0
    record(tmp_path / "set" / "a", "run_a.csv", samples=90)
    assert invoke(*words).exit_code == 0
    bench.write_text(bench.read_text() + "\n# another text\n")
    assert invoke(*words).exit_code == 0
    assert len(log_lines(bench)) == 3
    assert invoke(*words).exit_code == 0
    assert len(log_lines(bench)) == 3


def test_cases_are_folders_files_and_folders_of_folders_with_short_names(tmp_path: Path) -> None:
    cases(tmp_path / "one", "a", "b")
    cases(tmp_path / "two", "a")
    alone = Path(record(tmp_path, "alone.csv"))
    assert list(cases_in([tmp_path / "one"])) == ["a", "b"]
    assert list(cases_in([tmp_path / "one" / "a", alone])) == ["a", "alone"]
    assert cases_in([tmp_path / "one", tmp_path / "two", tmp_path / "one" / "a"]) == {
        "one_a": tmp_path / "one" / "a",
        "one_b": tmp_path / "one" / "b",
        "two_a": tmp_path / "two" / "a",
    }
    (tmp_path / "empty").mkdir()
    with pytest.raises(FileFormatError, match="holds no measured records, and none of its folders does"):
        cases_in([tmp_path / "empty"])
    with pytest.raises(FileFormatError, match="no such file or folder"):
        cases_in([tmp_path / "nowhere"])


@pytest.mark.slow
def test_a_killed_process_of_this_machine_loses_no_case_and_no_fit(bench: Path, tmp_path: Path) -> None:
    written(tmp_path, "quick_bench", 0.5)
    killed: list[str] = []
    over = threading.Event()

    def kill() -> None:
        while not killed and not over.wait(0.005):
            if lines := log_lines(bench):
                killed.append(lines[0][0])
                os.kill(int(lines[0][1]), signal.SIGKILL)

    thread = threading.Thread(target=kill)
    thread.start()
    folder, out = cases(tmp_path / "set", "a", "b"), tmp_path / "out"
    done = invoke(str(bench), "--records", str(folder), "--out", str(out), "--workers", "2")
    over.set()
    thread.join()
    assert done.exit_code == 0, done.output
    assert sorted(line[0] for line in log_lines(bench)) == sorted(["run_a", "run_b", killed[0]])
    assert [killed[0], "goes_on"] in [[line[0], line[2]] for line in log_lines(bench)], "its fits were found again"
    for name in ("a", "b"):
        assert read_report_json(out / name / "diagnosis.json")["verdict"] == "effect"


COMMAND = """
import signal
from hdrive_mbs.cli.main import main
if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's job in the background ignores it, and so do its children
    main()
"""


@pytest.mark.slow
@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT])
def test_an_interrupted_command_keeps_finished_cases_and_the_same_one_goes_on(bench: Path, tmp_path: Path, how: signal.Signals) -> None:
    written(tmp_path, "quick_bench", 0.5)
    names = ("a", "b", "c", "d", "e")
    out, script = tmp_path / "out", tmp_path / "command.py"
    script.write_text(COMMAND)
    words = (str(bench), "--records", str(cases(tmp_path / "set", *names)), "--out", str(out), "--workers", "2")
    process = subprocess.Popen(
        [sys.executable, script, "diagnose-all", *words],
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    end = time.monotonic() + PATIENCE
    while not list(out.glob("*/diagnosis.html")) and process.poll() is None and time.monotonic() < end:
        time.sleep(0.01)
    if how == signal.SIGINT:
        os.killpg(process.pid, how)  # as a terminal does
    else:
        process.send_signal(how)
    said, errors = process.communicate(timeout=PATIENCE)
    assert gone({int(line[1]) for line in log_lines(bench)}, PATIENCE), "a worker outlived the command"
    finished = len(list(out.glob("jobs/*.npz")))
    assert 1 <= finished < len(names), errors
    if how == signal.SIGINT:
        assert process.returncode == 130, errors
        assert f"stopped with {finished} of 5 jobs done" in " ".join(said.split())
        assert f"{finished} of 5 cases done" in said
    else:
        assert process.returncode == -signal.SIGKILL

    before = log_lines(bench)
    begun = {line[0] for line in before}
    again = invoke(*words)
    assert again.exit_code == 0, again.output
    assert f"5 of 5 cases done, {finished} of them found finished" in again.stdout
    ran = {line[0]: line[2] for line in log_lines(bench)[len(before) :]}
    assert len(ran) == len(log_lines(bench)) - len(before) == len(names) - finished
    assert {name for name, how_it_began in ran.items() if how_it_began == "goes_on"} >= begun & set(ran), "fits were found again"
    for name in names:
        assert read_report_json(out / name / "diagnosis.json")["verdict"] == "effect"


# on a cluster


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Address of a scheduler with two worker processes, each with a nanny that starts it again."""
    pytest.importorskip("distributed", reason="dask.distributed comes with the cluster extra")
    folder = tmp_path_factory.mktemp("cluster")
    process, address = scheduler(folder)
    workers = start("dask_worker", address, "--nworkers", "2", "--nthreads", "1", "--host", "127.0.0.1", "--local-directory", str(folder))
    yield address
    for running in (workers, process):
        running.terminate()
        running.wait(timeout=120)


@pytest.mark.slow
def test_a_killed_worker_of_a_cluster_loses_no_case_and_no_fit(cluster: str, bench: Path, tmp_path: Path) -> None:
    written(tmp_path, "quick_bench", 1.0)
    killed: list[str] = []
    over = threading.Event()

    def kill() -> None:
        while not killed and not over.wait(0.005):
            if lines := log_lines(bench):
                killed.append(lines[0][0])
                os.kill(int(lines[0][1]), signal.SIGKILL)

    thread = threading.Thread(target=kill)
    thread.start()
    folder, out = cases(tmp_path / "set", "a", "b", "c"), tmp_path / "out"
    (folder / "c" / "run_c.csv").write_text("time [s],motor_angle [rad]\n0.0,1.0\n0.0,2.0\n")
    done = invoke(str(bench), "--records", str(folder), "--out", str(out), "--scheduler", cluster)
    over.set()
    thread.join()
    assert f"failed: c ({folder / 'c'}): RecordError: " in done.stderr
    assert "2 of 3 cases done" in done.stdout
    assert [killed[0], "goes_on"] in [[line[0], line[2]] for line in log_lines(bench)], "its fits were found again"
    for name in ("a", "b"):
        assert read_report_json(out / name / "diagnosis.json")["verdict"] == "effect"


@pytest.mark.slow
def test_a_worker_of_a_cluster_takes_the_new_text_of_a_changed_bench(cluster: str, bench: Path, tmp_path: Path) -> None:
    names = ("a", "b", "c", "d")
    words = ("--records", str(cases(tmp_path / "set", *names)), "--out", str(tmp_path / "out"), "--scheduler", cluster)
    written(tmp_path, "quick_bench", 0.2)
    assert invoke(str(bench), *words).exit_code == 0
    assert len({line[1] for line in log_lines(bench)}) == 2, "both workers have read the first text"
    bench.write_text(bench.read_text().replace("'begins'", "'changed'"))
    done = invoke(str(bench), *words)
    assert done.exit_code == 0, done.output + (tmp_path / "out" / "failures.txt").read_text()
    assert [line[2] for line in log_lines(bench)] == ["begins"] * 4 + ["changed"] * 4


def test_the_scene_of_a_scene_file_is_sent_itself(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[Any] = []

    def quick(bench: Any, records: Any, **options: Any) -> Any:
        calls.append((bench, options["search_seconds"], options["every"]))
        return SAMPLES["without_pictures"]()

    def at_once(task: Any, points: Any, *, arrived: Any, **options: Any) -> Any:
        file.unlink()  # a worker elsewhere has no such file
        task = pickle.loads(pickle.dumps(task))
        return sweep(task, points, executor="here", folder=tmp_path / "out", arrived=arrived)

    file = save_scene(drive_bench.build(), tmp_path / "bench.toml")
    monkeypatch.setattr(search, "diagnose", quick)
    monkeypatch.setattr(sweeping, "sweep", at_once)
    words = (str(file), "--records", str(cases(tmp_path / "set", "a")), "--out", str(tmp_path / "out"))
    assert invoke(*words, "--search-seconds", "30", "--every", "1").exit_code == 0
    assert calls == [(drive_bench.build(), 30.0, 1)]
    (job,) = (tmp_path / "out" / "jobs").glob("*.npz")
    told = FinishedJob.load(job).settings
    assert told["function"] == "CaseDiagnosis"
    assert told["fingerprint"]
    assert told["search_seconds"] == 30.0
    assert told["every"] == 1
    assert "bench" not in told, "it is the scene itself"
