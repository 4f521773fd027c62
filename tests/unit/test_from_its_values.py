"""The law of the best fit at the places of others, begun from its values: which fits begin again, from where, and what is kept."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis import all_samples
from hdrive_mbs.diagnosis.all_samples import LAST, LONG, on_all_samples
from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.from_its_values import from_its_values
from hdrive_mbs.diagnosis.gather import in_reserve
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.located import Located
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import Suspect
from hdrive_mbs.diagnosis.tasks import RIVAL, Found, Task
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.verdict import TIED
from tests.unit.diagnosis_cases import bench, records

BENCH = bench()
NOT_LOOKED = Located(places=(), doubt="", forces=(), turned=())


@pytest.fixture(scope="module")
def simulator() -> Simulator:
    return Simulator(BENCH.trials(records((hm.CoulombStribeckFriction(coulomb=8.0), "load"))[0]), 2.5e-4, 4)


@pytest.fixture(scope="module")
def plain(simulator: Simulator) -> Fitted:
    hypothesis = Hypothesis(factors_of(BENCH))
    return dataclasses.replace(fit(simulator, hypothesis, np.zeros(hypothesis.size), steps=0), chi_fit=1.2)


def fitted(plain: Fitted, effect: hm.Effect, place: str, cost: float, *, chi_fit: float = 1.2, converged: bool = False) -> Fitted:
    """The effect there at the values that it has, and a first parameter off by 0.7."""
    hypothesis = Hypothesis(factors_of(BENCH), (Added(effect, place, "cause"),))
    z = hypothesis.start()
    z[0] = 0.7
    return dataclasses.replace(plain, hypothesis=hypothesis, z=z, cost=cost, chi_fit=chi_fit, converged=converged)


def coulomb(size: float) -> hm.CoulombStribeckFriction:
    return hm.CoulombStribeckFriction(coulomb=size)


def size_of(task: Task) -> float:
    """Of the friction at which a fit begins."""
    values = task.hypothesis.values(task.z)
    return float(values["cause.coulomb"])


def test_what_lies_behind_begins_again_from_the_values_of_the_best(plain: Fitted) -> None:
    fits = {
        3: fitted(plain, coulomb(0.2), "motor", 1000.0),
        1: fitted(plain, coulomb(0.3), "load", 1000.0 + TIED + 1.0),
        4: fitted(plain, coulomb(0.3), "gear.wave_generator", 1000.0 + TIED - 1.0),  # cannot be told from it anyhow
        5: fitted(plain, coulomb(0.3), "gear.wave_generator", 9000.0, chi_fit=20.0),  # hopeless
        6: fitted(plain, hm.ViscousDrag(coefficient=0.01), "load", 2000.0),  # another law
        7: fitted(plain, coulomb(0.4), "motor", 2000.0),  # there already
    }
    tasks = from_its_values(fits, 7, 1e-5)
    assert list(tasks) == [1]
    [task] = tasks.values()
    assert task.hypothesis.labels == fits[1].hypothesis.labels
    assert size_of(task) == pytest.approx(0.2)
    assert task.z[0] == 0.7
    assert (task.steps, task.share, task.beat) == (7, 1e-5, 1000.0 + RIVAL)
    assert from_its_values({}, 7, 1e-5) == {}


@pytest.mark.parametrize("lower", [True, False])
def test_a_fit_that_had_stopped_in_a_hollow_comes_out_of_it(
    simulator: Simulator, plain: Fitted, monkeypatch: pytest.MonkeyPatch, lower: bool
) -> None:
    """The motor leads the search and stops at 1500, the load overtakes it in few steps and goes on to its end; from there the motor
    comes down below it or not, and only what is better is kept."""
    asked: list[tuple[str, float, int]] = []

    def run(fine: Simulator, task: Task) -> Fitted:
        if not task.hypothesis.added:
            return plain
        [item] = task.hypothesis.added
        asked.append((item.at, round(size_of(task), 6), task.steps))
        if item.at == "motor":
            return fitted(plain, coulomb(0.2), "motor", 1500.0 if size_of(task) == pytest.approx(0.2) else 900.0 if lower else 1600.0)
        return fitted(plain, coulomb(0.3), "load", 1000.0 if len(asked) > 2 else 1200.0, converged=len(asked) > 2)

    monkeypatch.setattr(all_samples, "run_task", run)
    found = [fitted(plain, coulomb(0.2), "motor", 100.0), fitted(plain, coulomb(0.3), "load", 180.0, converged=True)]
    with Team(1) as team:
        last = on_all_samples(team, simulator, dataclasses.replace(plain, chi_fit=90.0), found, NOT_LOOKED, lambda done, total: None)
    assert asked[:4] == [("motor", 0.2, LONG), ("load", 0.3, LAST), ("load", 0.3, LONG), ("motor", 0.3, LONG)]
    motor, load = last.others
    assert motor is not None
    assert load is not None
    assert (motor.cost, load.cost) == (900.0 if lower else 1500.0, 1000.0)
    assert asked[4:] == ([("load", 0.2, LONG)] if lower else [])  # beside a better motor the load is asked again too


@pytest.mark.parametrize(
    ("leaves", "in_search", "asked_for"),
    [
        (1.3, 1.01, True),
        (1.3, 1.4, False),  # it left more there than the best does here
        (1.01, 1.005, False),  # nothing is left to be told
    ],
)
def test_a_law_in_reserve_is_fitted_where_the_best_leaves_more_than_it_did_in_the_search(
    simulator: Simulator, plain: Fitted, monkeypatch: pytest.MonkeyPatch, leaves: float, in_search: float, asked_for: bool
) -> None:
    asked: list[str] = []

    def run(fine: Simulator, task: Task) -> Fitted:
        if not task.hypothesis.added:
            return plain
        kind = type(task.hypothesis.added[0].effect).__name__
        asked.append(kind)
        if kind == "DahlFriction":
            assert task.beat == 1000.0 + RIVAL
            return fitted(plain, task.hypothesis.added[0].effect, "load", 600.0, chi_fit=1.0, converged=True)
        return fitted(plain, coulomb(0.2), "load", 1000.0, chi_fit=leaves, converged=True)

    monkeypatch.setattr(all_samples, "run_task", run)
    found = [fitted(plain, coulomb(0.2), "load", 100.0, chi_fit=1.005, converged=True)]
    reserve = [fitted(plain, hm.DahlFriction(coulomb=0.2, presliding=0.01), "load", 120.0, chi_fit=in_search, converged=True)]
    with Team(1) as team:
        null = dataclasses.replace(plain, chi_fit=90.0)
        last = on_all_samples(team, simulator, null, found, NOT_LOOKED, lambda done, total: None, reserve)
    assert ("DahlFriction" in asked) is asked_for
    first, second = last.others
    assert first is not None
    assert first.cost == 1000.0
    assert (second is not None) is asked_for
    assert second is None or second.cost == 600.0


def test_in_reserve_are_further_laws_of_what_came_out_best(plain: Fitted) -> None:
    def found(effect: hm.Effect, place: str, cost: float) -> Found:
        item = fitted(plain, effect, place, cost)
        return Found(Suspect(item.hypothesis.added[-1].label, type(effect).__name__, (item.hypothesis,), (item.hypothesis,)), item)

    told = [found(coulomb(0.2), "load", 100.0), found(coulomb(0.2), "motor", 105.0)]
    dahl, worse, elsewhere = (
        found(hm.DahlFriction(coulomb=0.2, presliding=0.01), place, cost)
        for place, cost in (("load", 120.0), ("load", 130.0), ("motor", 90.0))
    )
    drag = found(hm.ViscousDrag(coefficient=0.1), "load", 80.0)
    assert in_reserve([drag, worse, elsewhere, *told, dahl], told) == (dahl,)
    assert in_reserve([dahl], []) == ()
    assert in_reserve([dahl], [told[0], dahl]) == ()
