"""Campaigns on processes of this machine: order, lost workers, failing jobs, resuming, cancelling."""

from __future__ import annotations

import concurrent.futures
import importlib.util
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.campaign.fingerprint import fingerprint, job_key
from hdrive_mbs.campaign.job_files import JobFiles
from hdrive_mbs.errors import ParameterError, PlaceError, SimulationError
from hdrive_mbs.worker_process import ONE_THREAD
from models.harmonic_drive_train import build
from tests.patience import PATIENCE
from tests.unit import campaign_jobs as jobs

ROOT = Path(__file__).parents[2]


def points(count: int, **same: Any) -> list[dict[str, Any]]:
    return [{"x": x, **same} for x in range(count)]


def log_lines(path: Path) -> list[list[str]]:
    return [line.split() for line in path.read_text().splitlines()] if path.exists() else []


def is_running(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    status = Path(f"/proc/{process}/stat")
    return not status.exists() or status.read_text().rpartition(")")[2].split()[0] != "Z"


def gone(processes: set[int], within: float = 5.0) -> bool:
    end = time.monotonic() + within
    while any(map(is_running, processes)) and time.monotonic() < end:
        time.sleep(0.02)
    return not any(map(is_running, processes))


# -- what comes out -----------------------------------------------------------------------------------


def test_results_come_in_the_order_of_the_points_whatever_finishes_first(tmp_path: Path) -> None:
    campaign = hm.sweep(jobs.waits_for_company, points(5, log=str(tmp_path / "log")), workers=2)
    assert campaign.status == "complete"
    assert list(campaign["double"]) == [0.0, 2.0, 4.0, 6.0, 8.0]
    ran = log_lines(tmp_path / "log")
    assert len(ran) == 5
    assert len({process for _, process in ran}) == 2  # both had a part
    assert gone({int(process) for _, process in ran})


def test_one_worker_two_workers_and_this_process_give_the_same_to_the_last_bit() -> None:
    seeds = [{"seed": seed} for seed in range(4)]
    found = [hm.sweep(jobs.seeded, seeds, **how) for how in ({"workers": 1}, {"workers": 2}, {"executor": "here"})]  # type: ignore[arg-type]
    for campaign in found[1:]:
        for mine, first in zip(campaign.values, found[0].values, strict=True):
            assert mine["sum"] == first["sum"]
            assert np.array_equal(mine["product"], first["product"])


def test_the_environment_is_left_as_it_was() -> None:
    before = dict(os.environ)
    hm.sweep(jobs.square, points(1), workers=1)
    assert dict(os.environ) == before
    assert ONE_THREAD[0] == "OPENBLAS_NUM_THREADS"


def test_a_campaign_is_saved_loaded_and_written_as_a_table(tmp_path: Path) -> None:
    campaign = hm.sweep(jobs.square, points(3), executor="here", units={"x": "m"})
    campaign.to_csv(tmp_path / "table.csv")
    assert (tmp_path / "table.csv").read_text() == "x [m],square [m^2],even,job\n0,0,True,done\n1,1,False,done\n2,4,True,done\n"
    again = hm.Campaign.load(campaign.save(tmp_path / "campaign.npz"))
    assert list(again["square [m^2]"]) == [0, 1, 4]
    assert again.values == campaign.values
    # a process that has not used campaigns yet can read it too
    code = f"import hdrive_mbs as hm; print(type(hm.load({str(tmp_path / 'campaign.npz')!r})).__name__)"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout == "Campaign\n"


def test_figures_that_some_points_lack_are_nan_there() -> None:
    campaign = hm.sweep(lambda point: {"a": 1.0} if point["x"] else {"b": "text"}, points(2), executor="here")
    assert np.isnan(campaign["a"][0])
    assert list(campaign["b"]) == ["text", ""]
    with pytest.raises(PlaceError, match=r"No column 'c'. This campaign has: x, b, a, job"):
        campaign["c"]


def test_a_figure_that_is_called_like_a_parameter_does_not_hide_it() -> None:
    campaign = hm.sweep(lambda point: {"x": 5.0, "job": 6.0}, points(1), executor="here")
    assert {name: column[0] for name, column in campaign.columns().items()} == {
        "x": 0,
        "x (result)": 5.0,
        "job (result)": 6.0,
        "job": "done",
    }
    with_unit = hm.sweep(jobs.square, points(2), executor="here", units={"x": "m"})
    assert list(with_unit["x"]) == list(with_unit["x [m]"]) == [0, 1]


def test_equal_points_are_run_once(tmp_path: Path) -> None:
    campaign = hm.sweep(jobs.logged, [{"x": 1, "log": str(tmp_path / "log")}] * 3, executor="here")
    assert list(campaign["double"]) == [2.0, 2.0, 2.0]
    assert len(log_lines(tmp_path / "log")) == 1


def test_a_grid_holds_every_combination_with_the_last_name_fastest() -> None:
    assert hm.grid({"a": (1, 2), "b": "xy"}) == ({"a": 1, "b": "x"}, {"a": 1, "b": "y"}, {"a": 2, "b": "x"}, {"a": 2, "b": "y"})
    with pytest.raises(ParameterError, match="'b' has no values"):
        hm.grid({"a": (1,), "b": ()})


def test_an_executor_of_the_callers_own_is_used_and_left_open() -> None:
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        assert list(hm.sweep(jobs.square, points(3), executor=pool)["square [m^2]"]) == [0, 1, 4]
        assert pool.submit(int, "1").result() == 1


class LosesEverySecond(concurrent.futures.ThreadPoolExecutor):
    """Answers every second job with an error of the executor's own."""

    def submit(self, function: Any, /, *arguments: Any, **named: Any) -> Any:
        if arguments[-1]["x"] % 2 == 0:
            return super().submit(function, *arguments, **named)
        future: concurrent.futures.Future[Any] = concurrent.futures.Future()
        future.set_exception(ConnectionError("worker 7 is gone"))
        return future


def test_a_job_that_an_executor_of_the_callers_own_loses_is_a_failure_and_the_others_go_on() -> None:
    with LosesEverySecond(2) as pool:
        campaign = hm.sweep(jobs.square, points(4), executor=pool)
    assert list(campaign.done) == [True, False, True, False]
    assert campaign.failures[0]["error"] == "The worker was lost once (ConnectionError: worker 7 is gone); the job was given up."


# -- jobs that fail, workers that die -------------------------------------------------------------------


@pytest.mark.parametrize("how", [{"workers": 2}, {"executor": "here"}])
def test_a_failing_job_is_told_with_its_point_and_traceback_and_the_others_go_on(how: dict[str, Any]) -> None:
    campaign = hm.sweep(jobs.fails_at_three, points(5), **how)
    assert campaign.status == "1 of 5 jobs failed, see failures"
    assert list(campaign.done) == [True, True, True, False, True]
    (failure,) = campaign.failures
    assert failure["index"] == 3
    assert failure["parameters"] == {"x": 3}
    assert failure["error"] == "ValueError: no root at x = 3"
    assert "raise ValueError(f\"no root at x = {point['x']}\")" in failure["traceback"]
    assert np.isnan(campaign["value"][3])
    assert campaign["job"][3].startswith("failed: ValueError")


def test_a_job_that_leaves_python_or_returns_an_object_is_a_failure_too() -> None:
    assert hm.sweep(jobs.exits, points(1), executor="here").failures[0]["error"] == "SystemExit: 3"
    error = hm.sweep(jobs.gives_an_object, points(1), executor="here").failures[0]["error"]
    assert "returned in 'thing' a object" in error


def test_the_job_of_a_killed_worker_is_run_again_and_nothing_is_lost(tmp_path: Path) -> None:
    campaign = hm.sweep(jobs.killed_once, points(6, marker=str(tmp_path / "killed")), workers=2)
    assert (tmp_path / "killed").exists()
    assert campaign.status == "complete"
    assert list(campaign["value"]) == [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]
    assert list(campaign.attempts) == [1, 1, 2, 1, 1, 1]


def test_a_job_that_kills_every_worker_is_given_up_and_blamed_alone() -> None:
    campaign = hm.sweep(jobs.always_killed, points(5), workers=2, retries=1)
    assert list(campaign.done) == [True, True, False, True, True]
    assert campaign.failures[0]["error"] == "The worker was lost 2 times (signal SIGKILL); the job was given up."
    assert list(campaign.attempts) == [1, 1, 2, 1, 1]


# -- finished jobs in a folder ----------------------------------------------------------------------------


def test_a_second_call_runs_only_what_is_new_and_what_failed(tmp_path: Path) -> None:
    log, folder = tmp_path / "log", tmp_path / "campaign"
    hm.sweep(jobs.logged, points(3, log=str(log)), executor="here", folder=folder)
    again = hm.sweep(jobs.logged, points(5, log=str(log)), executor="here", folder=folder)
    assert [x for x, _ in log_lines(log)] == ["0", "1", "2", "3", "4"]
    assert again.reused == 3
    assert list(again["double"]) == [0.0, 2.0, 4.0, 6.0, 8.0]

    failing = hm.sweep(jobs.fails_at_three, points(5), executor="here", folder=folder)
    assert hm.sweep(jobs.fails_at_three, points(5), executor="here", folder=folder).reused == failing.done.sum() == 4


def test_a_damaged_job_file_is_run_again(tmp_path: Path) -> None:
    first = hm.sweep(jobs.seeded, [{"seed": 1}, {"seed": 2}], executor="here", folder=tmp_path)
    damaged = sorted((tmp_path / "jobs").iterdir())[0]
    damaged.write_bytes(damaged.read_bytes()[:-200])
    again = hm.sweep(jobs.seeded, [{"seed": 1}, {"seed": 2}], executor="here", folder=tmp_path)
    assert again.reused == 1
    for mine, before in zip(again.values, first.values, strict=True):
        assert mine["sum"] == before["sum"]
        assert np.array_equal(mine["product"], before["product"])
        assert mine["words"] == before["words"]


INTERRUPTED = """
import signal
import sys
import hdrive_mbs as hm
from tests.unit.campaign_jobs import logged
if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's job in the background ignores it, and so do its children
    points = [{"x": x, "log": sys.argv[1], "seconds": 0.1} for x in range(30)]
    campaign = hm.sweep(logged, points, workers=2, folder=sys.argv[2])
    print(campaign.status)
"""


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT])
def test_an_interrupted_campaign_goes_on_without_running_finished_jobs_again(tmp_path: Path, how: signal.Signals) -> None:
    script, log, folder = tmp_path / "script.py", tmp_path / "log", tmp_path / "campaign"
    script.write_text(INTERRUPTED)
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    # a session of its own, and the signal to all of it for Ctrl-C, as a terminal does
    process = subprocess.Popen(
        [sys.executable, script, log, folder],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    end = time.monotonic() + 20.0
    while len(list(folder.glob("jobs/*.npz"))) < 4 and time.monotonic() < end:
        time.sleep(0.02)
    if how == signal.SIGINT:
        os.killpg(process.pid, how)
    else:
        process.send_signal(how)
    output, errors = process.communicate(timeout=10)
    workers = {int(worker) for _, worker in log_lines(log)}
    assert 1 <= len(workers) <= 2
    assert gone(workers), "a worker outlived the campaign"
    finished = len(list(folder.glob("jobs/*.npz")))
    assert 4 <= finished < 30
    if how == signal.SIGINT:
        assert process.returncode == 0, errors
        assert output == f"stopped with {finished} of 30 jobs done; the same call with the same folder goes on from there\n"
    else:
        assert process.returncode == -signal.SIGKILL

    before = log_lines(log)
    same = [{"x": x, "log": str(log), "seconds": 0.1} for x in range(30)]
    kept = {x for x in range(30) if (folder / "jobs" / f"{job_key(fingerprint(jobs.logged), same[x])}.npz").exists()}
    assert len(kept) == finished
    campaign = hm.sweep(jobs.logged, same, workers=2, folder=folder)
    assert campaign.status == "complete"
    assert campaign.reused == finished
    assert list(campaign["double"]) == [2.0 * x for x in range(30)]
    assert sorted(int(x) for x, _ in log_lines(log)[len(before) :]) == sorted(set(range(30)) - kept)


def test_a_finished_job_whose_file_was_being_written_at_the_interruption_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write, calls = JobFiles.write, []

    def interrupted(self: JobFiles, key: str, *rest: Any) -> None:
        calls.append(key)
        if len(calls) == 2:
            raise KeyboardInterrupt
        write(self, key, *rest)

    monkeypatch.setattr(JobFiles, "write", interrupted)
    campaign = hm.sweep(jobs.square, points(4), executor="here", folder=tmp_path)
    assert campaign.status.startswith("stopped with 2 of 4 jobs done")
    assert len(list(tmp_path.glob("jobs/*.npz"))) == 2
    again = hm.sweep(jobs.square, points(4), executor="here", folder=tmp_path)
    assert (again.status, again.reused) == ("complete", 2)


# -- what makes a job another one ------------------------------------------------------------------------------


def module_with(folder: Path, text: str) -> ModuleType:
    path = folder / "caller_code.py"
    path.write_text(text)
    spec = importlib.util.spec_from_file_location("caller_code", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["caller_code"] = module
    import linecache

    linecache.clearcache()
    exec(compile(text, str(path), "exec"), module.__dict__)
    return module


CODE = "LIMIT = 1.0\nPOINTS = [1]\ndef inner(x):\n    return x + LIMIT\ndef job(point):\n    return inner(point['x'])\n"


@pytest.mark.parametrize(
    ("old", "new", "changes"),
    [
        ("x + LIMIT", "x - LIMIT", True),  # a function that the job calls
        ("LIMIT = 1.0", "LIMIT = 2.0", True),  # a constant that this one reads
        ("point['x'])", "point['x']) + 0", True),
        ("POINTS = [1]", "POINTS = [1, 2]", False),  # nothing that the job reaches
    ],
)
def test_a_job_is_another_one_when_code_that_it_reaches_changes(tmp_path: Path, old: str, new: str, changes: bool) -> None:
    before = fingerprint(module_with(tmp_path, CODE).job)
    assert before == fingerprint(module_with(tmp_path, CODE).job)
    assert (fingerprint(module_with(tmp_path, CODE.replace(old, new)).job) != before) == changes


def test_a_fingerprint_is_the_same_in_another_process() -> None:
    code = (
        "from tests.unit.campaign_jobs import logged; from hdrive_mbs.campaign.fingerprint import fingerprint\n"
        "from models.harmonic_drive_train import build; import hdrive_mbs as hm\n"
        "print(fingerprint(logged), fingerprint(hm.SceneAnalysis(scene=build(), analysis='modes')))"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.split() == [fingerprint(jobs.logged), fingerprint(hm.SceneAnalysis(scene=build(), analysis="modes"))]


def test_scene_and_options_make_a_job_another_one() -> None:
    first = hm.SceneAnalysis(scene=build(), analysis="modes")
    others = [
        hm.SceneAnalysis(scene=build().replacing({"motor.inertia": 2e-3}), analysis="modes"),
        hm.SceneAnalysis(scene=build(), analysis="start_up"),
        hm.SceneAnalysis(scene=build(), analysis="modes", options={"count": 2}),
    ]
    assert len({fingerprint(item) for item in (first, *others)}) == 4


# -- scenes -----------------------------------------------------------------------------------------------


def test_a_scene_is_swept_as_if_each_point_were_analysed_by_hand() -> None:
    values = (1e4, 3e4)
    task = hm.SceneAnalysis(scene=build(), analysis="modes")
    campaign = hm.sweep(task, hm.grid({"gear.stiffness.stiffness_1": values}), workers=2)
    by_hand = [hm.modes(build().replacing({"gear.stiffness.stiffness_1": value})).undamped[0] for value in values]
    assert list(campaign["mode 1 undamped [rad/s]"]) == by_hand
    assert "gear.stiffness.stiffness_1 [N m/rad]" in campaign.columns()
    with pytest.raises(PlaceError, match="stiffnes"):
        hm.sweep(task, hm.grid({"gear.stiffnes": (1.0,)}))
    with pytest.raises(PlaceError, match=r"No option 'sped'. The analysis 'modes' has: torque, speed, count"):
        hm.SceneAnalysis(scene=build(), analysis="modes", options={"sped": 1.0})


# -- what is refused -------------------------------------------------------------------------------------------


def test_what_cannot_be_run_is_refused_with_the_way_out() -> None:
    with pytest.raises(ParameterError, match="at least one point"):
        hm.sweep(jobs.square, [])
    with pytest.raises(ParameterError, match=r"points\[1\] has y, points\[0\] has x"):
        hm.sweep(jobs.square, [{"x": 1}, {"y": 1}])
    with pytest.raises(ParameterError, match=r"points\[0\]\['x'\] = nan: must be a finite number"):
        hm.sweep(jobs.square, [{"x": float("nan")}])
    with pytest.raises(ParameterError, match=r"cannot be sent to another process.*top level of a module"):
        hm.sweep(lambda point: 1.0, points(1))
    with pytest.raises(ParameterError, match="executor = 'cluster': must be 'processes', 'here', the address"):
        hm.sweep(jobs.square, points(1), executor="cluster")
    with pytest.raises(ParameterError, match="workers = 0"):
        hm.sweep(jobs.square, points(1), workers=0)


def test_a_script_without_the_guard_says_what_is_missing(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text("import hdrive_mbs as hm\ndef job(point):\n    return 1.0\nhm.sweep(job, [{'x': 1}], workers=1)\n")
    done = subprocess.run(
        [sys.executable, script], env={**os.environ, "PYTHONPATH": str(ROOT)}, capture_output=True, text=True, timeout=PATIENCE
    )
    assert done.returncode == 1
    assert "needs the line if __name__ == '__main__':" in done.stderr.splitlines()[-1]
    assert SimulationError.__name__ in done.stderr
