"""A cause alone begins again from the values of a pair in which the other one is next to nothing."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis import all_samples
from hdrive_mbs.diagnosis.all_samples import LONG, on_all_samples
from hdrive_mbs.diagnosis.alone_again import alone_again, run_from_less
from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.located import Located
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.tasks import RIVAL, Task
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.verdict import TIED
from tests.unit.diagnosis_cases import bench, records

BENCH = bench()
FACTORS = factors_of(BENCH)
NOT_LOOKED = Located(places=(), doubt="", forces=(), turned=())
FRICTION = Added(hm.CoulombStribeckFriction(coulomb=8.0), "load", "friction")
DRAG = Added(hm.ViscousDrag(coefficient=0.01), "motor", "drag")


@pytest.fixture(scope="module")
def simulator() -> Simulator:
    return Simulator(BENCH.trials(records((hm.CoulombStribeckFriction(coulomb=8.0), "load"))[0]), 2.5e-4, 4)


@pytest.fixture(scope="module")
def plain(simulator: Simulator) -> Fitted:
    hypothesis = Hypothesis(FACTORS)
    return fit(simulator, hypothesis, np.zeros(hypothesis.size), steps=0)


def fitted(plain: Fitted, *added: Added, cost: float, first: float = 0.0) -> Fitted:
    """With these causes at the values that they have, and a first parameter off by so much."""
    hypothesis = Hypothesis(FACTORS, added)
    z = hypothesis.start()
    z[0] = first
    return dataclasses.replace(plain, hypothesis=hypothesis, z=z, cost=cost, chi_fit=1.2, converged=True)


def test_what_is_a_part_of_the_best_and_lies_behind_begins_at_its_values(plain: Fitted) -> None:
    fits = {
        0: fitted(plain, FRICTION, DRAG, cost=1000.0, first=0.7),
        1: fitted(plain, dataclasses.replace(FRICTION, effect=hm.CoulombStribeckFriction(coulomb=3.0)), cost=1000.0 + TIED + 1.0),
        2: fitted(plain, DRAG, cost=1000.0 + TIED - 1.0),  # cannot be told from it anyhow
        3: fitted(plain, dataclasses.replace(FRICTION, at="motor"), cost=9000.0),  # elsewhere
        4: fitted(plain, Added(hm.QuadraticDrag(coefficient=1e-7), "motor", "drag"), cost=9000.0),  # another law
        5: fitted(plain, FRICTION, dataclasses.replace(DRAG, at="load"), cost=9000.0),  # as many causes
    }
    tasks = alone_again(fits, 7, 1e-5)
    assert list(tasks) == [1]
    [task] = tasks.values()
    assert task.hypothesis.labels == {FRICTION.label}
    assert task.hypothesis.values(task.z)["friction.coulomb"] == pytest.approx(8.0)
    assert task.z[0] == 0.7
    assert (task.steps, task.share, task.beat) == (7, 1e-5, 1000.0 + RIVAL)
    assert alone_again({}, 7, 1e-5) == {}


def test_a_task_is_run_where_it_begins_with_less_alone(simulator: Simulator) -> None:
    hypothesis = Hypothesis(FACTORS, (FRICTION,))
    there = fit(simulator, hypothesis, hypothesis.start(), steps=0)
    task = Task(hypothesis, hypothesis.start(), None, 1, 1e-5)
    assert run_from_less(simulator, task, there.cost) is None
    found = run_from_less(simulator, task, np.nextafter(there.cost, np.inf))
    assert found is not None
    assert found.cost < there.cost


def test_a_friction_that_stays_in_a_hollow_is_not_told_as_two_causes(
    simulator: Simulator, plain: Fitted, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The pair ends at the friction that is there beside a drag of nothing; alone the friction had ended at an eighth of it."""
    real = all_samples.run_task
    nothing = dataclasses.replace(DRAG, effect=hm.ViscousDrag(coefficient=1e-9))
    pair = fit(simulator, Hypothesis(FACTORS, (FRICTION, nothing)), Hypothesis(FACTORS, (FRICTION, nothing)).start(), steps=4)
    small = Hypothesis(FACTORS, (dataclasses.replace(FRICTION, effect=hm.CoulombStribeckFriction(coulomb=1.0)),))
    stuck = fit(simulator, small, small.start(), steps=0)
    asked: list[int] = []

    def run(fine: Simulator, task: Task) -> Fitted | None:
        """As the fits of a case came out."""
        asked.append(task.steps)
        known = {0: plain, 1: stuck, 2: pair}[len(task.hypothesis.added)]
        return known if task.hypothesis.added or task.steps == 0 else real(fine, task)

    monkeypatch.setattr(all_samples, "run_task", run)
    with Team(1) as team:
        last = on_all_samples(team, simulator, plain, [stuck, pair], NOT_LOOKED, lambda done, total: None)
    alone, both = last.others
    assert alone is not None
    assert both is not None
    assert LONG in asked
    assert stuck.cost > both.cost + 10.0 * TIED
    assert alone.cost < both.cost + 1.0
    assert alone.hypothesis.values(alone.z)["friction.coulomb"] == pytest.approx(8.0, rel=0.1)
