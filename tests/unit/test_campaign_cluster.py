"""Campaigns on a real dask scheduler with two workers, all on this machine."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from typer.testing import CliRunner

import hdrive_mbs as hm
from hdrive_mbs.campaign import dask_cluster
from hdrive_mbs.campaign.fingerprint import fingerprint, job_key
from hdrive_mbs.cli.main import app
from hdrive_mbs.errors import DependencyError, ParameterError, SimulationError
from tests.unit import campaign_jobs as jobs
from tests.unit.test_campaign import log_lines, points

pytest.importorskip("distributed", reason="dask.distributed comes with the cluster extra")

ROOT = Path(__file__).parents[2]
TRAIN = ROOT / "models" / "harmonic_drive_train.py"


def start(module: str, *arguments: str) -> subprocess.Popen[bytes]:
    # with 0 allowed failures the scheduler gives a job up as soon as its worker dies, which brings the retries of sweep to work
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "0"}
    command = [sys.executable, "-m", f"distributed.cli.{module}", *arguments, "--no-dashboard"]
    return subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def scheduler(folder: Path) -> tuple[subprocess.Popen[bytes], str]:
    told = folder / "scheduler.json"
    process = start("dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--scheduler-file", str(told))
    end = time.monotonic() + 20.0
    while time.monotonic() < end:
        try:
            return process, json.loads(told.read_text())["address"]
        except (FileNotFoundError, ValueError):
            time.sleep(0.05)
    process.kill()
    raise AssertionError("the scheduler did not start")


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Address of a scheduler with two worker processes, each with a nanny that starts it again."""
    folder = tmp_path_factory.mktemp("cluster")
    process, address = scheduler(folder)
    where = ("--host", "127.0.0.1", "--local-directory", str(folder))
    workers = start("dask_worker", address, "--nworkers", "2", "--nthreads", "1", *where)
    yield address
    for running in (workers, process):
        running.terminate()
        running.wait(timeout=20)


def test_the_cluster_gives_what_this_process_gives_in_order_and_both_workers_work(cluster: str, tmp_path: Path) -> None:
    campaign = hm.sweep(jobs.waits_for_company, points(6, log=str(tmp_path / "log")), executor=cluster)
    assert campaign.status == "complete"
    assert list(campaign["double"]) == [2.0 * x for x in range(6)]
    assert len({worker for _, worker in log_lines(tmp_path / "log")}) == 2
    seeds = [{"seed": seed} for seed in range(3)]
    near, far = hm.sweep(jobs.seeded, seeds, executor="here"), hm.sweep(jobs.seeded, seeds, executor=cluster)
    for mine, theirs in zip(near.values, far.values, strict=True):
        assert theirs["product"].shape == (60, 60)
        # sums of another number of BLAS threads may differ in the last digits
        assert theirs["product"] == pytest.approx(mine["product"], rel=1e-12, abs=1e-12)


def test_a_worker_that_is_killed_from_outside_costs_nothing_but_time(cluster: str, tmp_path: Path) -> None:
    log = tmp_path / "log"
    killed: list[int] = []

    def kill() -> None:
        end = time.monotonic() + 20.0
        while not killed and time.monotonic() < end:
            lines = log_lines(log)
            if len(lines) >= 3:
                killed.append(int(lines[-1][1]))  # that worker is in the middle of its job of 0.3 s
                os.kill(killed[0], signal.SIGKILL)
            time.sleep(0.005)

    thread = threading.Thread(target=kill)
    thread.start()
    campaign = hm.sweep(jobs.logged, points(6, log=str(log), seconds=0.3), executor=cluster, folder=tmp_path / "campaign")
    thread.join()
    assert killed
    assert campaign.status == "complete"
    assert list(campaign["double"]) == [2.0 * x for x in range(6)]
    ran = [x for x, _ in log_lines(log)]
    assert set(ran) == {str(x) for x in range(6)}
    assert len(ran) > 6, "the job of the killed worker was run again"
    assert campaign.attempts.max() >= 2
    assert len(list((tmp_path / "campaign" / "jobs").iterdir())) == 6


INTERRUPTED = """
import signal, sys
import hdrive_mbs as hm
from tests.unit.campaign_jobs import held

if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)
    points = [{"x": x, "log": sys.argv[1], "go": sys.argv[4], "seconds": 0.1} for x in range(20)]
    print(hm.sweep(held, points, executor=sys.argv[3], folder=sys.argv[2]).status)
"""


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT])
def test_a_campaign_on_the_cluster_that_was_interrupted_goes_on_from_what_is_finished(
    cluster: str, tmp_path: Path, how: signal.Signals
) -> None:
    script, log, folder, go = tmp_path / "script.py", tmp_path / "log", tmp_path / "campaign", tmp_path / "go"
    script.write_text(INTERRUPTED)
    command = [sys.executable, str(script), str(log), str(folder), cluster, str(go)]
    caller = subprocess.Popen(
        command, env={**os.environ, "PYTHONPATH": str(ROOT)}, stdout=subprocess.PIPE, text=True, start_new_session=True
    )
    end = time.monotonic() + 30.0
    while len(list(folder.glob("jobs/*.npz"))) < 4 and time.monotonic() < end:
        time.sleep(0.02)
    caller.send_signal(how)
    try:
        output, _ = caller.communicate(timeout=10)
    except subprocess.TimeoutExpired:
        caller.send_signal(
            how
        )  # Python drops an interrupt that comes while a finaliser runs (here one of distributed's); a user presses again
        output, _ = caller.communicate(timeout=20)
    go.touch()
    finished = len(list(folder.glob("jobs/*.npz")))
    assert 4 <= finished < 20
    if how == signal.SIGINT:
        assert output == f"stopped with {finished} of 20 jobs done; the same call with the same folder goes on from there\n"
    same = [{"x": x, "log": str(log), "go": str(go), "seconds": 0.1} for x in range(20)]
    kept = {x for x in range(20) if (folder / "jobs" / f"{job_key(fingerprint(jobs.held), same[x])}.npz").exists()}
    before = log_lines(log)
    campaign = hm.sweep(jobs.held, same, executor=cluster, folder=folder)
    assert campaign.status == "complete"
    assert campaign.reused == finished == len(kept)
    assert list(campaign["double"]) == [2.0 * x for x in range(20)]
    # a job that a worker was at when its caller went may still write down that it ran
    again = {int(x) for x, _ in log_lines(log)[len(before) :]}
    assert again >= set(range(20)) - kept
    assert len(again & kept) <= 2


def test_a_job_that_kills_its_workers_is_given_up_and_a_failing_one_reported(cluster: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dask_cluster, "FETCH", 3.0)  # a result that went with its worker is waited for so long
    campaign = hm.sweep(jobs.always_killed, points(4), executor=cluster, retries=1)
    assert list(campaign.done) == [True, True, False, True]
    assert campaign.failures[0]["error"].startswith("The worker was lost 2 times (dask gave the job up")
    failing = hm.sweep(jobs.fails_at_three, points(4), executor=cluster)
    assert [failure["parameters"] for failure in failing.failures] == [{"x": 3}]
    assert "raise ValueError" in failing.failures[0]["traceback"]


def test_a_client_of_the_callers_own_is_used_and_left_open(cluster: str, tmp_path: Path) -> None:
    from distributed import Client

    with Client(cluster, set_as_default=False) as client:
        campaign = hm.sweep(jobs.fails_at_three, points(5), executor=client, folder=tmp_path)
        assert list(campaign.done) == [True, True, True, False, True]
        assert campaign.failures[0]["error"] == "ValueError: no root at x = 3"
        assert campaign.settings["executor"] == "Client"
        again = hm.sweep(jobs.fails_at_three, points(5), executor=client, folder=tmp_path)
        assert (again.reused, len(again.failures)) == (4, 1)
        assert client.submit(int, "1").result(timeout=20) == 1
    with pytest.raises(ParameterError, match="this dask client is closed; give one that is connected"):
        hm.sweep(jobs.square, points(1), executor=client)


def test_the_futures_of_a_dask_client_s_executor_are_taken_too(cluster: str) -> None:
    from distributed import Client

    with Client(cluster, set_as_default=False) as client, client.get_executor() as executor:
        assert list(hm.sweep(jobs.square, points(3), executor=executor)["square [m^2]"]) == [0, 1, 4]


def test_workers_with_other_versions_are_not_believed(cluster: str, monkeypatch: pytest.MonkeyPatch) -> None:
    mine = dask_cluster.versions()
    monkeypatch.setattr(dask_cluster, "versions", lambda: {**mine, "exudyn": "0.0.1"})
    campaign = hm.sweep(jobs.square, points(1), executor=cluster)
    assert f"has exudyn {mine['exudyn']}, this machine" in campaign.failures[0]["error"]
    assert "Install the same versions" in campaign.failures[0]["error"]


def test_the_command_line_runs_on_the_cluster(cluster: str, tmp_path: Path) -> None:
    command = ["sweep", str(TRAIN), "--vary", "gear.stiffness.stiffness_1=1e4,3e4", "--scheduler", cluster, "--out", str(tmp_path)]
    done = CliRunner().invoke(app, [*command, "--json", str(tmp_path / "found.json")], catch_exceptions=False)
    assert done.exit_code == 0, done.output
    found = json.loads((tmp_path / "found.json").read_text())
    assert found["columns"]["gear.stiffness.stiffness_1 [N m/rad]"] == [1e4, 3e4]
    assert found["columns"]["mode 1 undamped [rad/s]"][0] < found["columns"]["mode 1 undamped [rad/s]"][1]


def test_a_cluster_without_workers_or_without_a_scheduler_is_not_waited_for_for_ever(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(dask_cluster, "PATIENCE", 0.5)
    monkeypatch.setattr(dask_cluster, "CONNECT", 2.0)
    monkeypatch.setattr(dask_cluster, "LOOK", 0.1)
    process, address = scheduler(tmp_path)
    try:
        with pytest.raises(SimulationError, match=rf"scheduler at {address} has had no worker for 0.5 s. Start some with 'dask worker"):
            hm.sweep(jobs.square, points(2), executor=address)
    finally:
        process.terminate()
        process.wait(timeout=20)
    with pytest.raises(SimulationError, match=rf"No dask scheduler answers at '{address}'.*Start one with 'dask scheduler'"):
        hm.sweep(jobs.square, points(2), executor=address)


def test_without_dask_the_error_has_the_command_that_installs_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(DependencyError, match=r'pip install "hdrive-mbs\[cluster\]"'):
        hm.sweep(jobs.square, points(1), executor="tcp://127.0.0.1:1")
