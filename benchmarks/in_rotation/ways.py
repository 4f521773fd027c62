"""Ways to begin a run where its record begins, each at the true model: what it leaves, and what it costs."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

import hdrive_mbs as hm
from benchmarks.in_rotation.case import PlainBench, bench
from hdrive_mbs.compiled.line import CompiledRun, run_many
from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.lines import Lines
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.simulator import Simulator

FloatArray = npt.NDArray[np.float64]

INTEGRATION = 1e-4
"""Step of the compiled runs [s]."""
RUN_INS = (0.0, 0.5, 1.0, 3.0)
"""Of the run-in alone [s]."""
SHORT = 0.5
"""Run-in with which free vibration is eliminated, or the state at the begin is fitted [s]."""
NUDGE = 1e-6
"""Initial displacement [m, rad] of a column of the fitted state; speeds are 300 times as large."""
RATE = 300.0


def ways(true: hm.Scene, record: hm.Record, repeats: int) -> list[dict[str, Any]]:
    """Of each way its name, the rms that it leaves in standard deviations of the noise, CPU seconds, and runs."""
    found = [_row(f"run-in of {run_in:g} s", _simulated(bench(true, run_in, PlainBench), record), 1, repeats) for run_in in RUN_INS]
    found.append(_row("free vibration eliminated", _simulated(bench(true, SHORT), record), 1, repeats))
    fitted, runs = _states_fitted(bench(true, SHORT, PlainBench), record)
    found.append(_row("state at the begin fitted", fitted, runs, repeats))
    return found


def _row(way: str, left: Callable[[], float], runs: int, repeats: int) -> dict[str, Any]:
    seconds, rms = [], left()
    for _ in range(repeats):
        begun = time.process_time()
        rms = left()
        seconds.append(time.process_time() - begun)
    return {"way": way, "rms": rms, "seconds": float(np.median(seconds)), "runs": runs}


def _simulated(known: Bench, record: hm.Record) -> Callable[[], float]:
    """What the diagnosis makes of the record."""
    trials, hypothesis = known.trials(record), Hypothesis(factors_of(known))

    def left() -> float:
        simulator = Simulator(trials, INTEGRATION)
        [residuals] = simulator.residuals(hypothesis, [np.zeros(hypothesis.size)])
        assert residuals is not None
        return float(np.sqrt(np.mean(residuals[simulator.used] ** 2)))

    return left


def _states_fitted(known: Bench, record: hm.Record) -> tuple[Callable[[], float], int]:
    """The peer: positions and speeds of all lateral coordinates at the start of the run-in by least squares, a run for each.

    The line is linear, so one step is the answer.
    """
    [trial] = known.trials(record)
    hypothesis = Hypothesis(factors_of(known))
    lateral = [body.name for body in trial.scene.network().bodies if body.lateral and not body.name.endswith(".z")]

    def left() -> float:
        [[start]] = Lines([trial]).at(hypothesis, [np.zeros(hypothesis.size)])
        assert start is not None
        angles: list[Mapping[str, float]] = [start.angles]
        speeds: list[Mapping[str, float]] = [trial.speeds]
        for name in lateral:
            angles += [{**start.angles, name: start.angles.get(name, 0.0) + NUDGE}, start.angles]
            speeds += [trial.speeds, {**trial.speeds, name: trial.speeds.get(name, 0.0) + RATE * NUDGE}]
        runs = run_many([start.line] * len(angles), trial.samples, trial.every, step=INTEGRATION, angles=angles, speeds=speeds)
        rows = []
        for run in runs:
            assert isinstance(run, CompiledRun)
            rows.append(np.concatenate([run.values[item.channel] / item.white for item in trial.measured.values()]))
        measured = np.concatenate([trial.columns[name] / item.white for name, item in trial.measured.items()])
        there = np.isfinite(measured)
        base = measured[there] - rows[0][there]
        columns = np.array([row[there] - rows[0][there] for row in rows[1:]]).T
        sizes = np.linalg.lstsq(columns, base, rcond=None)[0]
        return float(np.sqrt(np.mean((base - columns @ sizes) ** 2)))

    return left, 1 + 2 * len(lateral)
