"""Fits that have to come down to the cost of another one, and are given up where their steps do not lead there."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis import all_samples, tasks
from hdrive_mbs.diagnosis import fit as fitting
from hdrive_mbs.diagnosis.all_samples import on_all_samples
from hdrive_mbs.diagnosis.fit import LONG, Fitted, falls_short, fit, stalls
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.located import Located
from hdrive_mbs.diagnosis.pairs import swapped
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.scans import fits_from
from hdrive_mbs.diagnosis.screening import Look
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import Suspect
from hdrive_mbs.diagnosis.tasks import Found, Task, further, rivalling, run_task
from hdrive_mbs.diagnosis.team import Team
from tests.unit.bent_valley import CENTRE, Bent, two
from tests.unit.diagnosis_cases import bench, records

BENCH = bench()
NOT_LOOKED = Located(places=(), doubt="", forces=(), turned=())
DRAG = Added(hm.QuadraticDrag(coefficient=1e-7), "motor", "drag")


@pytest.fixture(scope="module")
def missing() -> Simulator:
    """The friction of a load is missing, which no drag of the motor stands for."""
    return Simulator(BENCH.trials(records((hm.CoulombStribeckFriction(coulomb=8.0), "load"))[0]), 2.5e-4, 4)


@pytest.fixture(scope="module")
def task() -> Task:
    hypothesis = Hypothesis(factors_of(BENCH), (DRAG,))
    return Task(hypothesis, hypothesis.start(), None, 8, 1e-9)


@pytest.mark.parametrize(
    ("costs", "beat", "left", "short"),
    [
        ([100.0, 90.0], 0.0, 1, False),  # too few steps to tell
        ([100.0, 90.0, 80.0], None, 1, False),
        ([100.0, 90.0, 80.0], 19.0, 3, True),  # 80 - 3 * 20 = 20
        ([100.0, 90.0, 80.0], 21.0, 3, False),
        ([1e6, 100.0, 99.0, 98.0], 50.0, 10, True),  # the first steps are not the last ones
        ([100.0, 99.0, 50.0], 0.0, 1, False),  # a late gain counts
        ([100.0, 90.0, 30.0], 40.0, 0, False),  # it is there
    ],
)
def test_a_fit_falls_short_of_a_cost_that_its_last_gains_do_not_lead_to(
    costs: list[float], beat: float | None, left: int, short: bool
) -> None:
    assert falls_short(costs, beat, left) is short


@pytest.mark.parametrize(
    ("costs", "does"),
    [
        ([1000.0, 999.9, 999.8, 999.7, 999.6, 999.5], False),  # fewer steps than it takes to say so
        ([1000.0, 999.9, 999.8, 999.7, 999.6, 999.5, 999.4], True),  # 0.6 of 100 above noise
        ([1000.0, 999.6, 998.6, 995.6, 987.6, 975.6, 957.6], False),  # more and more
        ([950.0, 940.0, 930.0, 920.0, 915.0, 910.0, 909.0, 908.9, 908.8, 908.7, 908.6, 908.5, 908.4], False),  # 0.6 of 9
    ],
)
def test_a_fit_stalls_where_its_last_steps_gain_next_to_nothing_of_what_stands_above_noise(costs: list[float], does: bool) -> None:
    assert stalls(costs, 900.0) is does


@pytest.mark.parametrize(("part", "patient", "steps"), [(0.02, False, 1), (0.02, True, None), (0.0008, True, LONG)])
def test_a_patient_fit_goes_on_where_its_steps_gain_little_until_it_stalls(
    monkeypatch: pytest.MonkeyPatch, part: float, patient: bool, steps: int | None
) -> None:
    """A straight valley in which steps are that part of the way: 0.04 of what is left is gained, or 0.0016, less than ends another fit."""
    bent = Bent(0.0)
    bent.noise *= 1.03  # so that the bottom stands above noise
    bottom, start = bent.bottom(), np.array([CENTRE - 0.38, 0.0])

    def proposals(hypothesis: Hypothesis, z: np.ndarray, *_: object) -> list[tuple[np.ndarray, float]]:
        return [(z + part * (bottom - z), 0.0)]

    monkeypatch.setattr(fitting, "_proposals", proposals)
    monkeypatch.setattr(fitting, "_curved", lambda *_: [])
    found = fit(bent, two(), start, steps=500, patient=patient)  # type: ignore[arg-type]
    assert found.converged
    assert found.patient is patient
    least = bent.blocks.cost(bent.one(bottom)[bent.fit]) + two().prior_cost(bottom)
    if steps is None:
        assert found.steps > 3 * LONG
        assert found.cost - least < 0.25 * (found.history[0] - least)
    else:
        assert found.steps == steps
        assert found.cost - least > 0.9 * (found.history[0] - least)


def test_what_has_converged_without_patience_is_fitted_again_with_it_and_once(missing: Simulator, task: Task) -> None:
    found = run_task(missing, dataclasses.replace(task, steps=0))
    assert found is not None
    ended = dataclasses.replace(found, converged=True)
    assert further(ended).done is ended
    assert further(ended, patient=True).done is None
    assert further(dataclasses.replace(ended, patient=True), patient=True).done is not None
    assert further(dataclasses.replace(ended, patient=True)).done is not None
    assert further(dataclasses.replace(found, patient=True), patient=True).done is None
    assert found.converged is found.patient is False


def test_a_fit_that_cannot_catch_up_ends_early_and_one_that_can_is_the_same(missing: Simulator, task: Task) -> None:
    full = run_task(missing, task)
    out_of_reach = run_task(missing, dataclasses.replace(task, beat=0.1 * full.cost if full else None))
    within = run_task(missing, dataclasses.replace(task, beat=full.cost + 1.0 if full else None))
    assert full is not None
    assert out_of_reach is not None
    assert within is not None
    assert out_of_reach.steps < full.steps
    assert not out_of_reach.converged
    assert out_of_reach.history == full.history[: len(out_of_reach.history)]
    np.testing.assert_array_equal(within.z, full.z)


@pytest.mark.parametrize(("beat", "hops"), [(1.0, 0), (1e9, 2), (None, 2)])
def test_no_hop_is_tried_from_where_a_fit_fell_short(
    missing: Simulator, task: Task, monkeypatch: pytest.MonkeyPatch, beat: float | None, hops: int
) -> None:
    asked: list[int] = []

    def settled(simulator: Simulator, fitted: Fitted, number: int) -> Fitted:
        asked.append(number)
        return fitted

    monkeypatch.setattr(tasks, "settled", settled)
    monkeypatch.setattr(tasks, "NEAR", np.inf)
    run_task(missing, dataclasses.replace(task, steps=0, hops=2, beat=beat))
    assert asked == ([hops] if hops else [])


def test_on_all_samples_the_others_have_to_catch_up_with_the_best_as_it_is_there(
    missing: Simulator, task: Task, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Task] = []
    near = dataclasses.replace(fit(missing, task.hypothesis, task.z, steps=0), chi_fit=1.2)

    def run(fine: Simulator, task: Task) -> Fitted:
        asked.append(task)
        return dataclasses.replace(near, cost=5000.0)

    monkeypatch.setattr(all_samples, "run_task", run)
    found = [dataclasses.replace(near, cost=cost) for cost in (300.0, 100.0, 200.0)]
    said: list[tuple[int, int]] = []
    with Team(1) as team:
        last = on_all_samples(team, missing, near, found, NOT_LOOKED, lambda done, total: said.append((done, total)))
    assert [given.beat for given in asked] == [None, None, 5025.0, 5025.0, None]  # as given, the best, the others, the nominal model
    assert len(last.others) == 3
    assert [done for done, total in said] == [0, 1, 2, 2, 3, 4, 5]
    assert {total for _, total in said} == {5}


def test_what_is_fitted_beside_a_better_fit_has_to_catch_up_with_it(
    missing: Simulator, task: Task, monkeypatch: pytest.MonkeyPatch
) -> None:
    fitted = fit(missing, task.hypothesis, task.z, steps=0)
    assert rivalling(fitted) == fitted.cost + tasks.RIVAL
    suspect = Suspect(DRAG.label, "QuadraticDrag", (task.hypothesis,), (task.hypothesis,))
    look = Look(task.hypothesis, task.z, 7.0, fitted.residuals, task.hypothesis)
    assert [given.beat for _, given in fits_from([(suspect, look), (suspect, None)], 3.0)] == [3.0]
    asked: list[Task] = []
    monkeypatch.setattr("hdrive_mbs.diagnosis.pairs.run_task", lambda simulator, given: asked.append(given) or fitted)
    both = Hypothesis(factors_of(BENCH), (DRAG, Added(hm.ViscousDrag(coefficient=0.1), "load", "drag_2")))
    pair = Found(suspect, fit(missing, both, both.start(), steps=0))
    other = Hypothesis(factors_of(BENCH), (Added(hm.ViscousDrag(coefficient=0.1), "motor", "other"),))
    rival = Found(
        Suspect(other.added[0].label, "ViscousDrag", (other,), (other,)), dataclasses.replace(fitted, hypothesis=other, z=other.start())
    )
    with Team(1) as team:
        swapped(team, missing, pair, ("nothing", "nowhere"), [rival])
    assert [given.beat for given in asked] == [rivalling(pair.fitted)]
