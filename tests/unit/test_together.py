"""A search for one cause ends where the best causes explain all together."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis import gather, together
from hdrive_mbs.diagnosis import search as searching
from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.search import Search
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import Suspect
from hdrive_mbs.diagnosis.tasks import Found
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.together import Together
from tests.unit.diagnosis_cases import bench, quiet

BENCH = bench()
DRAG = Added(hm.ViscousDrag(coefficient=0.01), "load", "drag")
RIPPLE = Added(hm.TorqueRipple(amplitude=0.1, order=2.0), "motor", "ripple")


@pytest.fixture(scope="module")
def simulator() -> Simulator:
    return Simulator(BENCH.trials(quiet()[0]), 2.5e-4, 4)


@pytest.fixture(scope="module")
def plain(simulator: Simulator) -> Fitted:
    hypothesis = Hypothesis(factors_of(BENCH))
    return fit(simulator, hypothesis, np.zeros(hypothesis.size), steps=0)


def found(plain: Fitted, leaves: float, *added: Added) -> Found:
    """Causes that are said to leave so much of a mean square of 100."""
    hypothesis = Hypothesis(factors_of(BENCH), added)
    suspect = Suspect(added[-1].label, type(added[-1].effect).__name__, (hypothesis,), (hypothesis,))
    noise = 0.5 * len(plain.residuals)
    cost = noise * (1.0 + np.log(leaves))
    z, curvature = hypothesis.start(), np.eye(hypothesis.size)
    fitted = dataclasses.replace(plain, hypothesis=hypothesis, z=z, curvature=curvature, cost=cost, chi_fit=leaves, chi_held=leaves)
    return Found(suspect, fitted, 1e6)


@pytest.mark.parametrize(
    ("first", "pair", "explained"),
    [
        (5.0, 1.0, True),
        (5.0, 1.13, True),  # laws that are nearly right leave 100^0.03 = 1.148
        (5.0, 1.2, False),
        (40.0, 1.7, True),  # less than a fiftieth of what the first leaves above noise
        (40.0, 1.9, False),
        (1.01, 1.0, False),  # the first leaves nothing
    ],
)
def test_pairs_are_asked_where_the_best_cause_leaves_something(
    simulator: Simulator, plain: Fitted, monkeypatch: pytest.MonkeyPatch, first: float, pair: float, explained: bool
) -> None:
    null = dataclasses.replace(plain, chi_fit=100.0, chi_held=100.0, cost=1e7)
    one, other, both = found(plain, first, DRAG), found(plain, 50.0, RIPPLE), found(plain, pair, DRAG, RIPPLE)
    monkeypatch.setattr(together, "joined", lambda team, coarse, best, others: [both] if best is one and others == (other,) else [])
    with Team(1) as team:
        asked = Together(team, simulator, null)
        assert asked.explain(Search(null, (one, other))) is explained
        assert not asked.explain(Search(null, ()))
    assert asked.with_first(dataclasses.replace(one, log_odds=3.0)) == ((both,) if explained else ())
    assert asked.with_first(other) == ()
    assert asked.with_first(None) == ()


def test_one_phenomenon_at_two_places_does_not_end_the_search_for_one_cause(
    simulator: Simulator, plain: Fitted, monkeypatch: pytest.MonkeyPatch
) -> None:
    null = dataclasses.replace(plain, chi_fit=100.0, chi_held=100.0, cost=1e7)
    elsewhere = Added(hm.ViscousDrag(coefficient=0.01), "motor", "drag_2")
    one, other, both = found(plain, 5.0, DRAG), found(plain, 50.0, elsewhere), found(plain, 1.0, DRAG, elsewhere)
    monkeypatch.setattr(together, "joined", lambda *some: [both])
    with Team(1) as team:
        assert not Together(team, simulator, null).explain(Search(null, (one, other)))


@pytest.mark.parametrize("explained", [True, False])
def test_nothing_is_looked_for_again_from_held_parameters_where_a_pair_explains_all(
    simulator: Simulator, plain: Fitted, monkeypatch: pytest.MonkeyPatch, explained: bool
) -> None:
    base = dataclasses.replace(plain, chi_fit=100.0, chi_held=100.0, cost=1e7)
    one = found(plain, 5.0, DRAG)
    one = dataclasses.replace(one, fitted=dataclasses.replace(one.fitted, typical=5.0))
    grounds: list[Fitted] = []

    def from_ground(self: object, model: Fitted, *more: object, **how: object) -> tuple[list[Found], list[object]]:
        grounds.append(model)
        return [one], []

    monkeypatch.setattr(searching._Work, "from_ground", from_ground)
    monkeypatch.setattr(searching._Work, "other_ways", lambda self, found, base, everything: found)
    monkeypatch.setattr(searching._Work, "fitted", lambda self, asked, words: [])
    monkeypatch.setattr(searching, "held", lambda simulator, base: plain)
    asked: list[Search] = []
    with Team(1) as team:
        found_ = searching.search(team, simulator, base, {}, [], explained=lambda so_far: asked.append(so_far) or explained)
    assert grounds == ([base] if explained else [base, plain])
    assert [item.found[0].fitted for item in asked] == [one.fitted]
    assert found_.found[0].fitted is one.fitted


def test_laws_at_the_place_of_the_gap_are_not_asked_for_then(simulator: Simulator, plain: Fitted, monkeypatch: pytest.MonkeyPatch) -> None:
    one, other, both = found(plain, 5.0, DRAG), found(plain, 50.0, RIPPLE), found(plain, 1.0, DRAG, RIPPLE)
    null = dataclasses.replace(plain, chi_fit=100.0, chi_held=100.0, cost=1e7)
    given: list[object] = []

    def search(*some: object, explained: object, **how: object) -> Search:
        so_far = Search(null, (one, other))
        assert explained(so_far)  # type: ignore[operator]
        return so_far

    def second_cause(*some: object) -> tuple[None, tuple[Found, ...], tuple[Found, ...]]:
        given.extend(some[-4:-1])
        raise InterruptedError

    monkeypatch.setattr(together, "joined", lambda *some: [both])
    for name, made in {
        "fit_nominal": lambda simulator, factors: null,
        "search": search,
        "nominal_again": lambda *some: None,
        "_ask_where": lambda *some: None,
        "_there": lambda *some: pytest.fail("a pair explains all"),
        "second_cause": second_cause,
    }.items():
        monkeypatch.setattr(gather, name, made)
    with Team(1) as team, pytest.raises(InterruptedError):
        gather.gather(simulator, simulator, factors_of(BENCH), {}, [], team)
    single, there, known = given
    assert isinstance(single, Search)
    assert there == ()
    assert known == (both,)
