"""Withheld cases answered by the workers of a dask cluster on this machine."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from benchmarks.withheld import run
from hdrive_mbs.campaign import dask_cluster
from tests.unit.test_campaign_cluster import scheduler, start
from tests.unit.withheld_job import SlowJob, written_cases

pytest.importorskip("distributed", reason="dask.distributed comes with the cluster extra")
NAMES = ("drive-c1", "drive-c2", "drive-c3", "drive-c4")


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Address of a scheduler with two worker processes, each with a nanny that starts it again."""
    folder = tmp_path_factory.mktemp("cluster")
    process, address = scheduler(folder)
    workers = start("dask_worker", address, "--nworkers", "2", "--nthreads", "1", "--host", "127.0.0.1", "--local-directory", str(folder))
    yield address
    for running in (workers, process):
        running.terminate()
        running.wait(timeout=120)


@pytest.fixture
def cases(tmp_path: Path) -> Path:
    return written_cases(tmp_path / "set", *NAMES)


def test_the_cluster_gives_the_answers_of_this_process(cluster: str, cases: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(cases.parent)  # a path from here means nothing to a worker
    words = ("--bench", "drive", "--method", "chance", "--cases", "set")
    assert run.main([*words, "--out", "far.json", "--scheduler", cluster]) == 0
    assert run.main([*words, "--out", "near.json", "--workers", "0"]) == 0
    far, near = (run.read_answers(Path(f"{name}.json")) for name in ("far", "near"))
    assert list(far) == list(NAMES)
    assert far == near


def test_a_killed_worker_loses_no_case_and_a_failing_one_is_answered_with_its_error(cluster: str, cases: Path) -> None:
    (cases / "drive-c2" / "record.parquet").write_text("broken")
    log, killed, over = cases / "log", [], threading.Event()

    def kill() -> None:
        while not killed and not over.wait(0.005):
            lines = log.read_text().splitlines() if log.exists() else []
            if lines:
                killed.append(int(lines[0].split()[1]))
                os.kill(killed[0], signal.SIGKILL)

    thread = threading.Thread(target=kill)
    thread.start()
    out = cases.parent / "answers.json"
    done = run.answer_cases(SlowJob("drive", "chance"), run.cases_of(cases, "drive"), out, workers=0, scheduler=cluster)
    over.set()
    thread.join()
    answers = run.read_answers(out)
    assert (done, list(answers)) == (1, list(NAMES))
    assert len(log.read_text().splitlines()) > len(NAMES), "the case of the killed worker was begun again"
    assert "JSONDecodeError" in answers["drive-c2"]["error"]
    assert all("error" not in answers[name] for name in NAMES if name != "drive-c2")


def test_a_cluster_that_is_not_there_is_one_line_and_keeps_what_is_answered(
    cases: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(dask_cluster, "CONNECT", 1.0)
    out = cases.parent / "answers.json"
    words = ["--bench", "drive", "--method", "chance", "--cases", str(cases), "--out", str(out)]
    run.main([*words, "--workers", "0", "--only", "drive-c1"])
    assert run.main([*words, "--scheduler", "tcp://127.0.0.1:1"]) == 1
    assert "error: No dask scheduler answers at 'tcp://127.0.0.1:1'" in capsys.readouterr().err
    assert list(run.read_answers(out)) == ["drive-c1"]
