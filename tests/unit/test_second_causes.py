"""When a second cause is looked for beside a first one that leaves little, and when it is claimed."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis import second_cause
from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.nearly import nearly_right
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.screening import Look
from hdrive_mbs.diagnosis.search import Search, cheapest_looks
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import Suspect
from hdrive_mbs.diagnosis.tasks import Found
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.verdict import judge
from tests.unit.diagnosis_cases import bench, quiet

BENCH = bench()
DRAG = Added(hm.ViscousDrag(coefficient=0.01), "load", "drag")
RIPPLE = Added(hm.TorqueRipple(amplitude=0.1, order=2.0), "motor", "ripple")


@pytest.fixture(scope="module")
def fitted() -> tuple[Simulator, Fitted]:
    simulator = Simulator(BENCH.trials(quiet()[0]), 2.5e-4, 4)
    hypothesis = Hypothesis(factors_of(BENCH))
    return simulator, fit(simulator, hypothesis, np.zeros(hypothesis.size), steps=0)


def cheapest_first(team: Team, coarse: Simulator, some: list[Found], first: Found) -> tuple[Found, ...]:
    return tuple(sorted(some, key=lambda item: item.fitted.cost))


def second_to(simulator: Simulator, null: Fitted, one: Found) -> tuple[Search | None, tuple[Found, ...]]:
    """What is searched for a second cause, and the pairs that may be the best, beside the only one that was found."""
    with Team(1) as team:
        return second_cause.second_cause(team, simulator, null, {}, [], Search(null, (one,)), (), (), lambda stage, done, total: None)[:2]


def found(fitted: Fitted, added: tuple[Added, ...], leaves: float, odds: float) -> Found:
    """Causes that are said to leave so much."""
    hypothesis = Hypothesis(factors_of(BENCH), added)
    suspect = Suspect(added[-1].label, type(added[-1].effect).__name__, (hypothesis,), (hypothesis,))
    changed = dataclasses.replace(fitted, hypothesis=hypothesis, cost=1e5 - odds, chi_fit=leaves, chi_held=leaves)
    return Found(suspect, changed, odds)


@pytest.mark.parametrize(
    ("gap", "first", "pair", "both"),
    [
        (400.0, 1.05, 1.002, True),
        (400.0, 1.05, 1.02, False),  # another law of the first might take six tenths
        (400.0, 1.19, 1.06, False),  # what a law that is nearly right leaves of 400
        (400.0, 1.25, 1.10, True),
        (3.0, 1.08, 1.04, False),
        (3.0, 1.15, 1.07, True),  # more than a third of much
    ],
)
def test_of_the_little_that_a_first_cause_leaves_a_second_one_takes_most(
    fitted: tuple[Simulator, Fitted], gap: float, first: float, pair: float, both: bool
) -> None:
    one = found(fitted[1], (DRAG,), first, 5000.0)
    two = found(fitted[1], (DRAG, RIPPLE), pair, 5400.0)
    claim = judge(gap, [one], [two])
    assert claim.kind == "effect"
    assert claim.fit is (two if both else one)


@pytest.mark.parametrize(
    ("first", "after", "odds", "both"),
    [
        (1.15, 1.004, 5060.0, False),  # what one richer law of the drag may take
        (1.15, 1.004, 5600.0, True),  # more than a tenth of the first one's log odds
        (1.6, 1.004, 5060.0, True),  # more than a law that is nearly right leaves
    ],
)
def test_a_second_cause_of_the_first_ones_family_is_first_of_all_a_better_law_of_it(
    fitted: tuple[Simulator, Fitted], first: float, after: float, odds: float, both: bool
) -> None:
    other = Added(hm.ViscousDrag(coefficient=0.01), "motor", "drag_2")
    one = found(fitted[1], (DRAG,), first, 5000.0)
    two = found(fitted[1], (DRAG, other), after, odds)
    assert judge(400.0, [one], [two]).fit is (two if both else one)
    assert judge(400.0, [one], [found(fitted[1], (DRAG, RIPPLE), after, odds)]).fit is not one


@pytest.mark.parametrize(
    ("together", "odds", "kind"),
    [
        (1.008, 230_000.0, "effect"),
        (300.0, 230_000.0, "unknown"),  # explains too little
        (1.008, 91_510.0, "unknown"),  # hardly better than one of them
    ],
)
def test_two_causes_may_show_together_where_neither_shows_alone(
    fitted: tuple[Simulator, Fitted], together: float, odds: float, kind: str
) -> None:
    """The refitted model stands for one of them with its parameters, and the other by itself leaves more than it does."""
    one, two = found(fitted[1], (DRAG,), 1165.0, 91_500.0), found(fitted[1], (DRAG, RIPPLE), together, odds)
    claim = judge(1088.0, [one], [two])
    assert claim.kind == kind
    if kind == "effect":
        assert claim.fit is two
        assert claim.probabilities[DRAG.label] == claim.probabilities[RIPPLE.label] > 0.9
    assert judge(1088.0, [one]).kind == "unknown"


@pytest.mark.parametrize(
    ("seen", "odds", "other", "both"),
    [
        (1.53, 199_000.0, False, True),
        (2.60, 199_000.0, False, False),  # what the fits saw is worse too
        (1.53, 189_000.0, False, False),  # less than a tenth of the first one's log odds
        (1.53, 199_000.0, True, False),  # a richer law of the first
    ],
)
def test_a_second_cause_shows_by_its_odds_where_a_stretch_that_slips_rules_what_no_fit_saw(
    fitted: tuple[Simulator, Fitted], seen: float, odds: float, other: bool, both: bool
) -> None:
    second = Added(hm.ViscousDrag(coefficient=0.01), "motor", "drag_2") if other else RIPPLE
    one, two = found(fitted[1], (DRAG,), 2.53, 172_000.0), found(fitted[1], (DRAG, second), seen, odds)
    one, two = (
        dataclasses.replace(item, fitted=dataclasses.replace(item.fitted, chi_held=held)) for item, held in ((one, 2.23), (two, 4.05))
    )
    assert judge(628.0, [one], [two]).fit is (two if both else one)


@pytest.mark.parametrize(("more", "alike"), [(0.0002, True), (-0.001, True), (0.0003, False)])
def test_single_causes_that_leave_alike_are_not_told_apart_by_their_odds(
    fitted: tuple[Simulator, Fitted], more: float, alike: bool
) -> None:
    one, other = found(fitted[1], (DRAG,), 1.001, 1060.0), found(fitted[1], (RIPPLE,), 1.001 + more, 990.0)
    faint = found(fitted[1], (Added(hm.ViscousDrag(coefficient=0.01), "motor", "drag"),), 1.001, 3.0)  # less than an effect needs
    claim = judge(1.2, [one, other, faint])
    assert claim.fit is one
    assert claim.tied == ((RIPPLE.label,) if alike else ())
    chances = claim.probabilities
    assert chances[RIPPLE.label] == pytest.approx(0.5 * chances[DRAG.label] if alike else 0.0, abs=1e-6)
    assert chances[faint.suspect.label] < 1e-6
    assert sum(chances.values()) == pytest.approx(1.0)


def test_an_effect_that_takes_no_more_than_a_trace_is_not_claimed_whatever_its_odds(fitted: tuple[Simulator, Fitted]) -> None:
    """A null of our own eighteenth rotor set gave log odds of 67 to a mass on a support that took 4.5e-4."""
    assert judge(1.00049, [found(fitted[1], (DRAG,), 1.00004, 67.5)]).kind == "none"
    assert judge(0.99624, [found(fitted[1], (DRAG,), 0.99525, 152.2)]).kind == "effect"


def test_what_is_nearly_right_leaves_more_of_a_strong_gap_and_nothing_of_none() -> None:
    assert nearly_right(400.0) == pytest.approx(math.exp(0.03 * math.log(400.0)))
    assert nearly_right(0.99) == 1.0


@pytest.mark.parametrize(
    ("leaves", "second", "exchanged"),
    [(1.06, 1.001, True), (1.06, 1.03, False), (1.5, 1.3, True), (1.5, 1.45, False), (1.5, 1.6, False), (1.02, 1.0, None)],
)
def test_a_second_cause_is_followed_up_where_it_takes_most_of_little_or_a_part_of_much(
    fitted: tuple[Simulator, Fitted], monkeypatch: pytest.MonkeyPatch, leaves: float, second: float, exchanged: bool | None
) -> None:
    simulator, base = fitted
    monkeypatch.setattr(second_cause, "SCATTER", 0.0)  # as if its samples were many
    null = dataclasses.replace(base, cost=1e5, chi_fit=2.0, chi_held=2.0)
    one, two = found(base, (DRAG,), leaves, 60_000.0), found(base, (DRAG, RIPPLE), second, 61_000.0)
    asked: list[str] = []

    def named(name: str, answer: object) -> None:
        def answering(*arguments: object, **more: object) -> object:
            asked.append(name)
            return answer

        monkeypatch.setattr(second_cause, name, answering)

    named("joined", [])
    named("search", Search(base, (two,)))
    named("swapped", [])
    named("alone", [])
    named("recast", [])
    named("with_other_laws", [])
    named("moved", [])
    named("both_moved", [])
    named("contenders", (two,))
    search, pairs = second_to(simulator, null, one)
    assert ("search" in asked) is (exchanged is not None)
    assert ("swapped" in asked) is (exchanged is True)
    exchanged_in_place = [name for name in asked if name in ("with_other_laws", "recast")]
    assert exchanged_in_place == (["with_other_laws", "recast"] if second == 1.3 else [])  # only where the pair leaves much
    assert pairs == ((two,) if exchanged else ())
    assert (search is None) is (exchanged is None)


@pytest.mark.parametrize(
    ("pair_leaves", "share", "followed"),
    [
        (27.0, 0.25, True),  # of the logarithm 0.03: a few stretches rule the mean square
        (27.0, 0.15, False),
        (8.0, 0.15, True),  # of the logarithm 0.39
        (35.0, 0.25, True),
    ],
)
def test_a_pair_is_followed_up_by_its_share_of_the_logarithm_or_of_the_misfit_above_noise(
    fitted: tuple[Simulator, Fitted], monkeypatch: pytest.MonkeyPatch, pair_leaves: float, share: float, followed: bool
) -> None:
    simulator, base = fitted
    noise = 0.5 * int(np.count_nonzero(simulator.fit))
    null = dataclasses.replace(base, cost=noise + 9e4, chi_fit=400.0, chi_held=400.0)

    def costing(item: Found, cost: float) -> Found:
        return Found(item.suspect, dataclasses.replace(item.fitted, cost=cost), item.log_odds)

    one = costing(found(base, (DRAG,), 30.0, 60_000.0), noise + 2e4)
    pair = costing(found(base, (DRAG, RIPPLE), pair_leaves, 61_000.0), noise + (1.0 - share) * 2e4)
    told: list[Found] = []
    monkeypatch.setattr(second_cause, "joined", lambda *some: [])
    monkeypatch.setattr(second_cause, "search", lambda *some, **more: Search(base, (pair,)))
    monkeypatch.setattr(second_cause, "swapped", lambda team, coarse, best, *some: told.append(best) or [])
    for name in ("alone", "moved", "both_moved", "recast", "with_other_laws"):
        monkeypatch.setattr(second_cause, name, lambda *some: [])
    monkeypatch.setattr(second_cause, "contenders", cheapest_first)
    _, pairs = second_to(simulator, null, one)
    assert told == ([pair] if followed else [])
    assert pairs == ((pair,) if followed else ())


@pytest.mark.parametrize(
    ("leaves", "recast_leaves", "stages"),
    [
        (1.2, 1.15, ["laws", "causes", "laws"]),  # the cause that came in place of another has laws of its own
        (1.2, 1.05, ["laws", "causes"]),
        (1.2, None, ["laws", "causes"]),  # nothing better came: its laws are known
        (1.09, None, []),
    ],
)
def test_laws_and_causes_of_a_pair_are_exchanged_as_long_as_it_leaves_something_however_strong_the_gap(
    fitted: tuple[Simulator, Fitted], monkeypatch: pytest.MonkeyPatch, leaves: float, recast_leaves: float | None, stages: list[str]
) -> None:
    """Of a gap of 3000 a law that is nearly right leaves 1.27: what is enough to say nothing more is missing is no reason to keep it."""
    simulator, base = fitted
    null = dataclasses.replace(base, cost=1e5, chi_fit=3000.0, chi_held=3000.0)
    assert nearly_right(3000.0) > leaves
    other = Added(hm.QuadraticDrag(coefficient=0.01), "motor", "drag_2")
    one, pair = found(base, (DRAG,), 1.6, 60_000.0), found(base, (DRAG, RIPPLE), leaves, 61_000.0)
    better = [] if recast_leaves is None else [found(base, (DRAG, other), recast_leaves, 61_200.0)]
    asked: list[str] = []
    monkeypatch.setattr(second_cause, "joined", lambda *some: [pair])
    for name in ("swapped", "alone", "moved", "both_moved"):
        monkeypatch.setattr(second_cause, name, lambda *some: [])
    monkeypatch.setattr(second_cause, "with_other_laws", lambda *some: asked.append("laws") or [])
    monkeypatch.setattr(second_cause, "recast", lambda *some: asked.append("causes") or better)
    monkeypatch.setattr(second_cause, "contenders", cheapest_first)
    _, pairs = second_to(simulator, null, one)
    assert asked == stages
    assert pairs[0] is (better[0] if better else pair)


@pytest.mark.parametrize(
    ("joined_leaves", "told_leaves", "stages"),
    [
        (3.0, 1.05, ["laws"]),  # nothing is left to be looked for
        (3.0, 2.0, ["laws", "everything"]),  # the same pair is not told by other laws twice
        (95.0, 1.05, ["everything", "laws"]),  # it takes too little to be told first; beside what a search found, it is
    ],
)
def test_other_laws_of_what_was_put_together_come_before_a_search_among_everything(
    fitted: tuple[Simulator, Fitted], monkeypatch: pytest.MonkeyPatch, joined_leaves: float, told_leaves: float, stages: list[str]
) -> None:
    simulator, base = fitted
    null = dataclasses.replace(base, cost=1e5, chi_fit=400.0, chi_held=400.0)
    one = found(base, (DRAG,), 100.0, 6_000.0)
    pair, told = found(base, (DRAG, RIPPLE), joined_leaves, 60_000.0), found(base, (DRAG, RIPPLE), told_leaves, 61_000.0)
    searched = found(base, (DRAG, RIPPLE), 30.0, 60_100.0)
    asked: list[str] = []

    def search(*some: object, **more: object) -> Search:
        asked.append("everything")
        return Search(base, (searched,) if joined_leaves > 30.0 else ())

    monkeypatch.setattr(second_cause, "joined", lambda *some: [pair])
    monkeypatch.setattr(second_cause, "with_other_laws", lambda *some: asked.append("laws") or [told])
    monkeypatch.setattr(second_cause, "search", search)
    for name in ("swapped", "moved", "both_moved", "recast", "alone"):
        monkeypatch.setattr(second_cause, name, lambda *some: [])
    monkeypatch.setattr(second_cause, "contenders", cheapest_first)
    _, pairs = second_to(simulator, null, one)
    assert asked == stages
    assert pairs[0] is told


@pytest.mark.parametrize(
    ("told_leaves", "stages"),
    [
        (1.05, ["laws"]),
        (2.2, ["laws", "first again"]),  # laws alone do not do it
    ],
)
def test_the_first_cause_is_looked_for_again_only_where_other_laws_of_the_pair_leave_something(
    fitted: tuple[Simulator, Fitted], monkeypatch: pytest.MonkeyPatch, told_leaves: float, stages: list[str]
) -> None:
    """No other second cause is looked for: the pair leaves less than a fiftieth of what the first one does, above noise."""
    simulator, base = fitted
    null = dataclasses.replace(base, cost=1e5, chi_fit=3000.0, chi_held=3000.0)
    one = found(base, (DRAG,), 100.0, 6_000.0)
    pair = found(base, (DRAG, RIPPLE), 2.5, 60_000.0)
    told = found(base, (DRAG, RIPPLE), told_leaves, 61_000.0)
    asked: list[str] = []
    monkeypatch.setattr(second_cause, "joined", lambda *some: [pair])
    monkeypatch.setattr(second_cause, "with_other_laws", lambda *some: asked.append("laws") or [told])
    monkeypatch.setattr(second_cause, "alone", lambda *some: [found(base, (RIPPLE,), 200.0, 1_000.0)])
    monkeypatch.setattr(second_cause, "search", lambda *some, **more: asked.append("first again") or Search(base, ()))
    for name in ("swapped", "moved", "both_moved", "recast"):
        monkeypatch.setattr(second_cause, name, lambda *some: [])
    monkeypatch.setattr(second_cause, "contenders", cheapest_first)
    _, pairs = second_to(simulator, null, one)
    assert asked == stages
    assert pairs[0] is told


@pytest.mark.parametrize(("at", "stages"), [("motor", ["second cause", "first cause again"]), ("load", ["second cause"])])
def test_the_first_cause_is_not_looked_for_again_beside_another_law_of_itself(
    fitted: tuple[Simulator, Fitted], monkeypatch: pytest.MonkeyPatch, at: str, stages: list[str]
) -> None:
    """A ball that slips left 1.028 with one law and 1.024 with two of it, and was looked for again beside each for 68 of 174 s."""
    simulator, base = fitted
    null = dataclasses.replace(base, cost=1e5, chi_fit=3000.0, chi_held=3000.0)
    one, law = found(base, (DRAG,), 100.0, 6_000.0), Added(hm.ViscousDrag(coefficient=0.02), at, "drag_2")
    pair = found(base, (DRAG, law), 2.5, 60_000.0)
    asked: list[str] = []
    monkeypatch.setattr(second_cause, "joined", lambda *some: [pair])
    monkeypatch.setattr(second_cause, "alone", lambda *some: [found(base, (law,), 200.0, 1_000.0)])
    monkeypatch.setattr(second_cause, "search", lambda *some, report, **more: asked.append(report.args[1]) or Search(base, ()))
    for name in ("swapped", "moved", "both_moved", "recast", "with_other_laws"):
        monkeypatch.setattr(second_cause, name, lambda *some: [])
    monkeypatch.setattr(second_cause, "contenders", cheapest_first)
    second_to(simulator, null, one)
    assert asked == stages


@pytest.mark.parametrize("second", [RIPPLE, Added(hm.ViscousDrag(coefficient=0.01), "motor", "drag_2")])
def test_everything_is_looked_at_beside_the_first_where_the_same_phenomenon_elsewhere_is_all_that_is_known_to_explain_the_rest(
    fitted: tuple[Simulator, Fitted], monkeypatch: pytest.MonkeyPatch, second: Added
) -> None:
    """Friction at both ends of a stiff shaft may stand for friction and drag."""
    simulator, base = fitted
    null = dataclasses.replace(base, cost=1e5, chi_fit=3000.0, chi_held=3000.0)
    one, known, right = (
        found(base, (DRAG,), 1.6, 60_000.0),
        found(base, (DRAG, second), 1.03, 61_000.0),
        found(base, (DRAG, RIPPLE), 1.005, 61_500.0),
    )
    asked: list[str] = []
    monkeypatch.setattr(second_cause, "joined", lambda *some: [known])
    monkeypatch.setattr(second_cause, "search", lambda *some, **more: asked.append("search") or Search(base, (right,)))
    for name in ("swapped", "alone", "moved", "both_moved"):
        monkeypatch.setattr(second_cause, name, lambda *some: [])
    monkeypatch.setattr(second_cause, "contenders", cheapest_first)
    _, pairs = second_to(simulator, null, one)
    assert asked == ([] if second is RIPPLE else ["search"])
    assert pairs[0] is (known if second is RIPPLE else right)


def test_of_two_looks_at_one_suspect_the_cheaper_one_counts(fitted: tuple[Simulator, Fitted]) -> None:
    hypothesis = Hypothesis(factors_of(BENCH), (DRAG,))
    one, two = (Suspect(("viscous_drag", at), "ViscousDrag", (hypothesis,), (hypothesis,)) for at in ("load", "motor"))

    def look(cost: float) -> Look:
        return Look(hypothesis, hypothesis.start(), cost, fitted[1].residuals, hypothesis)

    first, closer, other = look(5.0), look(7.0), look(6.0)
    assert cheapest_looks([(one, first), (two, other), (one, closer)]) == [(one, first), (two, other)]
    assert cheapest_looks([(one, closer), (two, other)]) == [(two, other), (one, closer)]
