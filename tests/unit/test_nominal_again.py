"""A nominal model whose first fit ended in a hollow is fitted again from where a search left its parameters."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis import gather
from hdrive_mbs.diagnosis.deadline import Deadline
from hdrive_mbs.diagnosis.diagnose import diagnose
from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.nominal_again import nominal_again
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.search import Search, fit_nominal
from hdrive_mbs.diagnosis.search import search as search_
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import PARAMETER, Suspect
from hdrive_mbs.diagnosis.tasks import Found
from hdrive_mbs.diagnosis.team import Team
from tests.unit.diagnosis_cases import DISTURBED, KNOWLEDGE, bench, quiet

BENCH = bench()
NOMINAL = Hypothesis(factors_of(BENCH))
HOLLOW = np.array([{"motor_inertia": -5.0, "flexspline_stiffness": 5.0}.get(name, 0.0) for name in KNOWLEDGE])


@pytest.fixture(scope="module")
def simulator() -> Simulator:
    return Simulator(BENCH.trials(quiet()[0]), 2.5e-4, 4)


def there(simulator: Simulator, hypothesis: Hypothesis, z: np.ndarray) -> Fitted:
    """A fit that stopped where it stands."""
    return fit(simulator, hypothesis, z, steps=0)


def test_it_is_fitted_from_what_a_loosened_parameter_found_within_its_tolerance(simulator: Simulator) -> None:
    loose = Hypothesis(NOMINAL.factors, loose={"load_inertia": 8.0})
    suspect = Suspect(("parameter", "load_inertia"), PARAMETER, (loose,), (loose,))
    found = Found(suspect, there(simulator, loose, loose.start(np.array([DISTURBED[name] for name in KNOWLEDGE]))))
    null = there(simulator, NOMINAL, HOLLOW)
    assert null.chi_fit > 100.0
    with Team(1) as team:
        better = nominal_again(team, simulator, null, [found])
    assert better is not None
    assert better.hypothesis.loose == {}
    assert better.chi_fit < 1.05
    assert better.cost <= found.fitted.cost + NOMINAL.prior_cost(NOMINAL.start(found.fitted.hypothesis.nominal_part(found.fitted.z)))


def test_nothing_is_done_where_it_stands_at_its_best(simulator: Simulator) -> None:
    null = fit_nominal(simulator, NOMINAL.factors)
    drag = Hypothesis(NOMINAL.factors, (Added(hm.QuadraticDrag(coefficient=2e-5), "motor", "drag"),))
    suspect = Suspect(("quadratic_drag", "motor"), "QuadraticDrag", (drag,), (drag,))
    with Team(1) as team:
        assert nominal_again(team, simulator, null, [Found(suspect, fit(simulator, drag, drag.start(null.z)))]) is None
        assert nominal_again(team, simulator, null, []) is None


def test_all_is_looked_for_again_from_where_the_nominal_model_comes_to_then(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is missing, and a first fit ended in a hollow: as in our own eighth drive set (c04), where an inertia was claimed."""
    bases: list[float] = []
    monkeypatch.setattr(gather, "fit_nominal", lambda simulator, factors: there(simulator, NOMINAL, HOLLOW))

    def search(team: Team, simulator: Simulator, base: Fitted, *more: Any, **how: Any) -> Search:
        bases.append(base.chi_fit)
        return search_(team, simulator, base, *more, **how)

    monkeypatch.setattr(gather, "search", search)
    found = diagnose(BENCH, quiet(), candidates=(hm.QuadraticDrag, hm.SensorGain), pictures=False)
    assert len(bases) == 2
    assert bases[0] > 100.0
    assert bases[1] < 1.05
    assert found.verdict == "none"
    assert abs(found.gap.refit.value - 1.0) < 0.02


@pytest.mark.parametrize(
    ("takes", "seconds", "searches"),
    [
        (40.0, None, 1),  # a little of what was left
        (150.0, None, 2),  # more than the best cause
        (150.0, 1e-9, 1),  # likewise, when there is no time for it
    ],
)
def test_causes_are_held_against_the_better_model_and_looked_for_again_where_it_beats_them(
    simulator: Simulator, monkeypatch: pytest.MonkeyPatch, takes: float, seconds: float | None, searches: int
) -> None:
    null = there(simulator, NOMINAL, HOLLOW)
    better = dataclasses.replace(null, cost=null.cost - takes, chi_fit=0.99 * null.chi_fit)
    asked: list[Fitted] = []

    def cause(at: str, below: float) -> Found:
        suspect = Suspect(("quadratic_drag", at), "QuadraticDrag", (NOMINAL,), (NOMINAL,))
        return Found(suspect, dataclasses.replace(null, cost=null.cost - below), log_odds=below)

    def search(team: Team, simulator: Simulator, base: Fitted, *more: Any, **how: Any) -> Search:
        asked.append(base)
        return Search(base, (cause("motor", 100.0) if len(asked) == 1 else cause("load", 90.0),))

    monkeypatch.setattr(gather, "fit_nominal", lambda simulator, factors: null)
    monkeypatch.setattr(gather, "search", search)
    monkeypatch.setattr(gather, "nominal_again", lambda *some: better if asked[-1] is null else None)
    with Team(1, deadline=Deadline(seconds)) as team:
        _, _, used, single, _ = gather._first(team, simulator, simulator, NOMINAL.factors, {}, [], lambda *said: None)
        left_out = team.deadline.left_out
    assert asked == [null, better][:searches]
    assert used is single.base is better
    places = [item.suspect.label[1] for item in single.found]
    assert places == ["motor", "load"][:searches]  # what the first search found stays
    assert single.found[0].log_odds == pytest.approx(100.0 - takes)
    assert left_out == ([] if seconds is None else ["everything from the nominal model as fitted again"])
