"""The best laws again from other values of what decides whether they show."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.other_starts import LAWS, MOST, farthest, from_other_starts, going_on, others
from hdrive_mbs.diagnosis.periods import Periods
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.search import Depth, _Work, is_inexact
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import PARAMETER, Suspect, suspects
from hdrive_mbs.diagnosis.tasks import FIRST, Found
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.effects.effect import Effect
from tests.unit.diagnosis_cases import bench, records

BENCH = bench()
RUB = hm.RubAtAngle(friction=4.0, angle=2.0, sharpness=8.0)


@pytest.fixture(scope="module")
def simulator() -> Simulator:
    """One record of the small drive bench whose load rubs at one angle."""
    return Simulator(BENCH.trials(records((RUB, "load"))[0]), 2.5e-4, 4)


@pytest.fixture(scope="module")
def base(simulator: Simulator) -> Fitted:
    factors = factors_of(BENCH)
    return fit(simulator, Hypothesis(factors), np.zeros(len(factors)), steps=25)


def begun(effect: Effect, at: str = "load") -> Hypothesis:
    return Hypothesis(factors_of(BENCH), (Added(effect, at, "cause"),))


def found(simulator: Simulator, effect: Effect, chi: float, law: str = "", at: str = "load") -> Found:
    """An effect as it is, with this mean square and the cost that goes with it."""
    hypothesis = begun(effect, at)
    fitted = dataclasses.replace(fit(simulator, hypothesis, hypothesis.start(), steps=0), chi_fit=chi, chi_held=chi, cost=1e4 * chi)
    return Found(Suspect((type(effect).family, at), law or type(effect).__name__, (hypothesis,), (hypothesis,)), fitted)


@pytest.mark.parametrize(
    ("angle", "nearest"), [(0.1, 0.0), (6.2, 0.0), (-3.1, 3.14), (3.2, 3.14), (-1.5, -1.57), (1.6, 1.57)], ids=lambda value: f"{value}"
)
def test_an_angle_begins_at_all_others_but_the_nearest_the_shorter_way_round(angle: float, nearest: float) -> None:
    crack = hm.MomentCrack(compliance=1.4e-7, position=0.12, angle=angle, closing_moment=1016.0)
    turned = others(crack, [crack])
    assert sorted(item.angle for item in turned if isinstance(item, hm.MomentCrack)) == sorted({0.0, 1.57, 3.14, -1.57} - {nearest})
    assert {dataclasses.replace(item, angle=angle) for item in turned if isinstance(item, hm.MomentCrack)} == {crack}


@pytest.mark.parametrize(
    "turning",
    [hm.Keyway(compliance=1.4e-7, position=0.12), hm.ShaftStiffnessAsymmetry(asymmetry=0.02)],
    ids=lambda item: type(item).__name__,
)
@pytest.mark.parametrize(("angle", "nearest"), [(1.5, 1.57), (-1.5, 1.57), (2.3, -0.78), (-2.4, 0.78), (3.1, 0.0)])
def test_what_says_the_same_after_half_a_turn_is_not_begun_there(turning: Effect, angle: float, nearest: float) -> None:
    own = turning.replacing(angle=angle)
    begun_at = [float(item.angle) for item in others(own, [own])]
    assert sorted(begun_at) == sorted({-0.78, 0.0, 0.78, 1.57} - {nearest})


def test_two_decisive_fields_begin_at_all_combinations_but_one_and_keep_what_they_have_where_they_do_not_change() -> None:
    crack = hm.PhasedCrack(compliance=1e-7, position=0.5, angle=1.4, phase=-1.4)
    turned = {(item.angle, item.phase) for item in others(crack, [crack]) if isinstance(item, hm.PhasedCrack)}
    assert turned == {(a, p) for a in (0.0, 1.4) for p in (0.0, 1.57, 3.14, -1.4)} - {(1.4, -1.4)}


def test_a_frequency_begins_at_the_nearest_others_by_their_logarithm() -> None:
    known = sorted(hm.HiddenMode.starts["natural_frequency"])
    low, high = known[2:4]
    middle = 0.5 * (math.sqrt(low * high) + 0.5 * (low + high))  # nearer to the lower one by its difference alone
    mode = hm.HiddenMode(inertia=1e-2, natural_frequency=middle, damping_ratio=0.05)
    begun_at = [item.natural_frequency for item in others(mode, [mode]) if isinstance(item, hm.HiddenMode)]
    assert begun_at == sorted(set(known) - {high}, key=lambda value: abs(math.log(value / middle)))[:MOST]
    assert low in begun_at


def test_what_the_law_names_no_values_for_begins_at_those_of_the_search() -> None:
    @dataclasses.dataclass(frozen=True, kw_only=True)
    class Bare(hm.RubAtAngle):
        """The same law without values of its own."""

        tried: ClassVar[bool] = False
        starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {}

    bare = Bare(friction=1.0, angle=0.1, sharpness=3.0)
    starts = [bare.replacing(angle=value) for value in (-1.0, 0.0, 0.0, 1.0)]
    assert [item.angle for item in others(bare, starts) if isinstance(item, Bare)] == [1.0, -1.0]


def test_a_law_with_nothing_decisive_or_one_start_begins_nowhere_else() -> None:
    friction = hm.CoulombStribeckFriction(coulomb=0.3)
    assert others(friction, [friction, friction]) == []


def test_laws_of_the_best_label_alone_begin_again_and_each_once(simulator: Simulator) -> None:
    everything = suspects(Hypothesis(factors_of(BENCH)), {}, candidates(BENCH.scene, hm.RubAtAngle))
    best, elsewhere = found(simulator, RUB, 3.0), found(simulator, RUB, 4.0, at="motor")
    asked = from_other_starts([best, elsewhere], everything)
    assert {suspect.label for suspect, _ in asked} == {best.suspect.label}
    assert len(asked) == len(hm.RubAtAngle.starts["angle"]) - 1
    z = best.fitted.hypothesis.rescaled(best.fitted.z)[1]
    for _, task in asked:
        values, rub = task.hypothesis.values(task.z), task.hypothesis.added[-1].effect
        assert values["cause.friction"] == pytest.approx(RUB.friction)
        assert values["cause.sharpness"] == pytest.approx(RUB.sharpness)
        assert isinstance(rub, hm.RubAtAngle)
        assert rub.angle in hm.RubAtAngle.starts["angle"]
        assert abs(math.remainder(rub.angle - RUB.angle, math.tau)) > math.pi / 4
        np.testing.assert_array_equal(task.z[: len(factors_of(BENCH))], z[: len(factors_of(BENCH))])
        assert task.steps == FIRST
    assert from_other_starts([best], everything, {(best.suspect.label, best.suspect.law)}) == []
    assert from_other_starts([], everything) == []
    assert from_other_starts([found(simulator, RUB, 3.0, PARAMETER), best], everything) == []


def test_no_more_than_a_few_laws_begin_again(simulator: Simulator) -> None:
    [rub] = [
        item for item in suspects(Hypothesis(factors_of(BENCH)), {}, candidates(BENCH.scene, hm.RubAtAngle)) if item.label[1] == "load"
    ]
    names = [f"law {k}" for k in range(LAWS + 2)]
    asked = from_other_starts([found(simulator, RUB, 3.0, name) for name in names], [dataclasses.replace(rub, law=name) for name in names])
    assert list(dict.fromkeys(suspect.law for suspect, _ in asked)) == names[:LAWS]


def test_of_what_was_begun_elsewhere_the_one_that_falls_fastest_goes_on_beside_the_cheapest(simulator: Simulator) -> None:
    plain = found(simulator, RUB, 3.0)

    def at(*costs: float) -> Found:
        return dataclasses.replace(plain, fitted=dataclasses.replace(plain.fitted, cost=costs[-1], history=costs))

    slow, slower, fast, faster, still = at(104.0, 101.0), at(104.0, 102.0), at(400.0, 300.0), at(900.0, 350.0), at(310.0)
    assert going_on([faster, fast, slower, slow, still], 2, 6) == [slow, slower, faster]
    assert going_on([fast, still, slow], 2, 6) == [slow, fast, still]
    assert going_on([slow], 2, 6) == [slow]
    assert going_on([], 2, 6) == []


def test_a_rub_that_was_fitted_at_the_wrong_angle_is_found_at_the_right_one(simulator: Simulator, base: Fitted) -> None:
    everything = suspects(base.hypothesis, {}, candidates(BENCH.scene, hm.RubAtAngle))
    wrong = begun(RUB.replacing(angle=-1.5, friction=0.5))
    hollow = fit(simulator, wrong, wrong.start(base.z), steps=25)
    rub = Found(Suspect((hm.RubAtAngle.family, "load"), "RubAtAngle", (wrong,), (wrong,)), hollow)
    assert hollow.chi_fit > 2.0
    with Team(1) as team:
        work = _Work(team, simulator, lambda stage, done, total: None, Depth(), Periods)
        best = min(work.other_ways([rub], base, everything), key=lambda item: item.fitted.cost)
    right = begun(RUB)
    least = fit(simulator, right, right.start(base.z), steps=25)
    assert base.cost - hollow.cost < 0.01 * (base.cost - least.cost)
    assert best.fitted.cost - least.cost < 0.01 * (base.cost - least.cost)  # the search fits it on to its end
    values = best.fitted.hypothesis.values(best.fitted.z)
    assert math.remainder(values["cause.angle"] - RUB.angle, math.tau) == pytest.approx(0.0, abs=0.1)  # of a bell 0.35 wide


def test_what_leaves_nothing_is_left_as_it_is(simulator: Simulator, base: Fitted) -> None:
    right = begun(RUB)
    least = fit(simulator, right, right.start(base.z), steps=25)
    item = Found(Suspect((hm.RubAtAngle.family, "load"), "RubAtAngle", (right,), (right,)), least)
    assert not is_inexact([item], base)
    with Team(1) as team:
        work = _Work(team, simulator, lambda stage, done, total: None, Depth(), Periods)
        assert work.other_ways([item], base, []) == [item]


def test_the_farthest_start_is_that_farthest_in_what_is_searched_and_named() -> None:
    starts = [hm.LubricatedFriction(coulomb=1.0, smoothing_speed=a, stribeck_speed=b) for a in (0.01, 0.3) for b in (0.1, 5.0)]
    found = hm.LubricatedFriction(coulomb=7.0, smoothing_speed=0.02, stribeck_speed=0.2)
    assert farthest(found, starts) == starts[3]
    assert farthest(starts[3], starts) == starts[0]
    assert farthest(hm.QuadraticDrag(coefficient=0.3), [hm.QuadraticDrag(coefficient=0.1)]) == hm.QuadraticDrag(coefficient=0.1)
