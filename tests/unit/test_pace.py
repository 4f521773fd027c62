"""A search integrates rotor lines in steps as long as their records let it."""

from __future__ import annotations

import numpy as np
import pytest

from hdrive_mbs.diagnosis.along import along
from hdrive_mbs.diagnosis.fit import fit
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.pace import CLOSE, Pace, pace_of
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.step import suitable_step
from hdrive_mbs.diagnosis.trial import Trial
from models import rotor_bench
from tests.unit.rotor_bench_records import bench, compiled, factors, recorded
from tests.unit.test_diagnosis_step import trial

FACTORS = factors("youngs_modulus", "support_stiffness_x", "rotor_1_mass", "bearing_stiffness")
SAMPLE = rotor_bench.SAMPLE_TIME


@pytest.fixture(scope="module")
def trials() -> list[Trial]:
    """What moves across the axis in a run-up and after a blow, noise and all."""
    found = [
        item
        for name, seconds in (("run_up", 1.0), ("bump", 0.3))
        for item in bench().trials(recorded(name, compiled(name, seconds), noisy=True))
    ]
    return [item for item in found if "lateral" in item.name]


@pytest.fixture(scope="module")
def pace(trials: list[Trial]) -> Pace:
    return pace_of(trials, FACTORS, suitable_step(trials, FACTORS))


def test_steps_are_longer_where_the_record_allows_it(trials: list[Trial], pace: Pace) -> None:
    step = suitable_step(trials, FACTORS)
    run_up, blow = pace.steps
    assert step < 0.5 * SAMPLE
    assert run_up == SAMPLE
    assert step < blow < SAMPLE  # more of what is fast is in it
    assert len(pace.slowed) > 0


def test_residuals_are_those_of_the_line_as_it_is_wherever_the_parameters_are(trials: list[Trial], pace: Pace) -> None:
    hypothesis = Hypothesis(factors=FACTORS)
    points = list(np.random.default_rng(3).normal(size=(3, len(FACTORS))))
    exact = Simulator(trials, suitable_step(trials, FACTORS)).residuals(hypothesis, points)
    quick = Simulator(trials, pace.steps, slowed=pace.slowed, shortest=pace.shortest)
    for one, other in zip(exact, quick.residuals(hypothesis, points), strict=True):
        assert one is not None
        assert other is not None
        for segment in quick.segments:
            assert np.sqrt(np.mean((one - other)[segment.span] ** 2)) < 1.5 * CLOSE, segment.column  # farther off than the points compared


def test_channels_along_a_trial_are_run_at_the_same_pace(trials: list[Trial], pace: Pace) -> None:
    simulator = Simulator(trials, pace.steps, slowed=pace.slowed)
    fitted = fit(simulator, Hypothesis(factors=FACTORS[:1]), np.zeros(1), steps=1, share=1e-2)
    [found] = along(simulator, 0, fitted, ["probe_r1_x"]).values()
    np.testing.assert_array_equal(found, simulator.columns(fitted.hypothesis, fitted.z)[0]["r1_x"])


def test_a_drive_goes_at_the_step_that_it_has() -> None:
    given = [trial(5e3)]
    assert pace_of(given, (), suitable_step(given, ())) == Pace((suitable_step(given, ()),))


def test_a_line_whose_step_is_a_sample_already_keeps_it(trials: list[Trial]) -> None:
    assert pace_of(trials, FACTORS, SAMPLE) == Pace((SAMPLE, SAMPLE))
