"""Lines through several trials at once: as if each had been run alone, in as few runs as their sampling allows."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hdrive_mbs.compiled.line import CompiledRun, run_many
from hdrive_mbs.diagnosis import trial_runs
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.lines import Lines
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.diagnosis.trial_runs import Through, fold_of, measured_in, run_trial, run_trials
from hdrive_mbs.errors import SimulationError
from models import rotor_bench
from tests.unit.rotor_bench_records import bench, compiled, factors, recorded

STEP = rotor_bench.STEP


def torsion(name: str, seconds: float) -> Trial:
    """What turns on the bench in a record of it."""
    return next(item for item in bench().trials(recorded(name, compiled(name, seconds), noisy=False)) if "torsion" in item.name)


@pytest.fixture(scope="module")
def asked() -> list[Through]:
    """Two records of equal length, one that is shorter; two lines for the first."""
    trials = [torsion("run_up", 0.05), torsion("steps", 0.03), torsion("steps", 0.05)]
    hypothesis = Hypothesis(factors=factors("youngs_modulus"))
    starts = Lines(trials).at(hypothesis, [np.zeros(1), np.ones(1)])
    found = []
    for k, number in ((0, 0), (1, 0), (0, 1), (2, 0)):
        start = starts[k][number]
        assert start is not None
        found.append(Through(trials[k], start.line, start.angles, STEP))
    return found


def alone(item: Through) -> CompiledRun:
    every = item.trial.every / fold_of(item.trial)
    inner = math.ceil(every / STEP * (1.0 - 1e-9))
    samples = fold_of(item.trial) * item.trial.samples
    [found] = run_many([item.line], samples, every, step=every / inner, angles=item.angles, speeds=item.trial.speeds)
    assert isinstance(found, CompiledRun)
    return found


def test_lines_of_several_trials_are_run_as_if_each_were_alone(asked: list[Through]) -> None:
    found = dict(run_trials(asked))
    assert sorted(found) == [0, 1, 2, 3]
    for number, item in enumerate(asked):
        run = found[number]
        assert isinstance(run, CompiledRun)
        for name, values in alone(item).values.items():
            np.testing.assert_array_equal(run.values[name], values)
    first, third = (measured_in(asked[k].trial, alone(asked[k])) for k in (0, 2))
    assert any(np.abs(first[name] - third[name]).max() > 0.0 for name in first)


def test_trials_that_are_sampled_and_stepped_alike_share_a_run(asked: list[Through], monkeypatch: pytest.MonkeyPatch) -> None:
    together: list[list[int]] = []

    def counted(lines: Any, samples: Any, *arguments: Any, **keywords: Any) -> Any:
        together.append(samples)
        return run_many(lines, samples, *arguments, **keywords)

    long, short = (fold_of(asked[k].trial) * asked[k].trial.samples for k in (0, 1))
    assert short < long
    monkeypatch.setattr(trial_runs, "run_many", counted)
    list(run_trials(asked))
    assert together == [[long, long, long, short]]
    monkeypatch.setattr(trial_runs, "AT_ONCE", 2)
    together.clear()
    list(run_trials(asked))
    assert together == [[long, long], [long, short]]
    seldom = [Through(replace(asked[0].trial, every=2.0 * asked[0].trial.every), asked[0].line, asked[0].angles, STEP), asked[1]]
    together.clear()
    list(run_trials(seldom))
    assert together == [[long], [short]]
    finer = [replace(asked[0], step=0.5 * STEP), asked[1]]
    together.clear()
    list(run_trials(finer))
    assert together == [[long], [short]]


def test_what_grows_is_run_again_alone_with_half_the_step(asked: list[Through], monkeypatch: pytest.MonkeyPatch) -> None:
    steps: list[tuple[int, float]] = []

    def counted(lines: Any, samples: list[int], every: float, *, step: float, **keywords: Any) -> Any:
        steps.append((len(lines), round(every / step)))
        found = run_many(lines, samples, every, step=step, **keywords)
        return [SimulationError("grown"), *found[1:]] if len(steps) == 1 else found

    monkeypatch.setattr(trial_runs, "run_many", counted)
    same = [asked[0], asked[2], asked[3]]
    found = dict(run_trials(same))
    (first, parts), (again, twice) = steps
    assert (first, again) == (3, 1)
    assert twice == 2 * parts
    assert isinstance(found[0], CompiledRun)
    steps.clear()
    list(run_trials([replace(item, shortest=0.2 * STEP) for item in same]))
    assert steps == [(3, parts), (1, 5 * parts)]
    steps.clear()
    [kept] = [run for number, run in run_trials(same, again=False) if number == 0]
    assert isinstance(kept, SimulationError)
    assert len(steps) == 1


def test_one_trial_alone_answers_in_the_order_of_its_lines(asked: list[Through]) -> None:
    trial = asked[0].trial
    first, second = run_trial(trial, [asked[0].line, asked[2].line], [asked[0].angles, asked[2].angles], STEP)
    assert isinstance(first, CompiledRun)
    assert isinstance(second, CompiledRun)
    for run, item in ((first, asked[0]), (second, asked[2])):
        for name, values in alone(item).values.items():
            np.testing.assert_array_equal(run.values[name], values)
