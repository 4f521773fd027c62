"""A run over withheld cases that is stopped or killed goes on from what it has answered."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from benchmarks.withheld import run
from tests.patience import PATIENCE
from tests.unit.test_campaign import gone, log_lines
from tests.unit.withheld_job import answered, written_cases

ROOT = Path(__file__).parents[2]
NAMES = tuple(f"drive-c{number}" for number in range(8))


@pytest.mark.slow
@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT])
def test_an_interrupted_run_keeps_its_answers_and_the_next_one_answers_the_rest(tmp_path: Path, how: signal.Signals) -> None:
    cases, out = written_cases(tmp_path / "set", *NAMES), tmp_path / "answers.json"
    process = subprocess.Popen(
        [sys.executable, "-m", "tests.unit.withheld_job", cases, out],
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    end = time.monotonic() + PATIENCE
    while len(run.read_answers(out)) < 2 and process.poll() is None and time.monotonic() < end:
        time.sleep(0.01)
    if how == signal.SIGINT:
        os.killpg(process.pid, how)  # as a terminal does
    else:
        process.send_signal(how)
    _, said = process.communicate(timeout=PATIENCE)
    assert gone({int(worker) for _, worker in log_lines(cases / "log")}, PATIENCE), "a worker outlived the run"
    kept = run.read_answers(out)
    assert 2 <= len(kept) < len(NAMES), said
    assert {path.stem for path in out.with_suffix(".raw").iterdir()} >= set(kept)
    if how == signal.SIGINT:
        assert process.returncode == 130, said
        assert said.endswith(f"stopped; the same command goes on from {out}\n")  # perhaps behind half a line
    else:
        assert process.returncode == -signal.SIGKILL

    before = log_lines(cases / "log")
    assert answered(cases, out) == 0
    answers = run.read_answers(out)
    assert list(answers) == list(NAMES)
    assert {name: answers[name] for name in kept} == kept
    assert sorted(name for name, _ in log_lines(cases / "log")[len(before) :]) == [name for name in NAMES if name not in kept]
