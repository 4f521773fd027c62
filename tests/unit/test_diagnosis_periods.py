"""Orders and frequencies that stand out in residuals, and laws that begin there."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import ClassVar

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.beginnings import ASIDE, begun_at, beside, widths_of
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.locate.motion import motion_of
from hdrive_mbs.diagnosis.periods import MOST, TIME, TURN, Periods
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import suspects
from hdrive_mbs.diagnosis.turning import reference_shaft
from models import rotor_bench
from tests.unit.diagnosis_cases import bench, quiet

BENCH = bench()


@pytest.fixture(scope="module")
def simulator() -> Simulator:
    """The small drive bench: 1.6 s at 1 kHz, the motor turns up to 140 rad/s and back."""
    return Simulator([trial for record in quiet() for trial in BENCH.trials(record)], 2.5e-4, 1)


@pytest.fixture(scope="module")
def fitted(simulator: Simulator) -> Fitted:
    hypothesis = Hypothesis(factors_of(BENCH))
    return fit(simulator, hypothesis, np.zeros(hypothesis.size), steps=0)


def left(simulator: Simulator, fitted: Fitted, over: str, *parts: tuple[float, float]) -> Fitted:
    """The fit with noise and sines (periods per radian or second, amplitude) for residuals."""
    rng = np.random.default_rng(3)
    residuals = rng.normal(size=simulator.size)
    for k, trial in enumerate(simulator.trials):
        angle = reference_shaft(motion_of(simulator, k, fitted.hypothesis, fitted.z))[1]
        at = trial.times if over == TIME else angle
        for segment in simulator.segments:
            if segment.trial == k:
                residuals[segment.span] += sum(size * np.sin(period * at + 0.4) for period, size in parts)
    return dataclasses.replace(fitted, residuals=residuals)


def turned(simulator: Simulator, fitted: Fitted) -> float:
    """Widest range of angles [rad]."""
    motions = (motion_of(simulator, k, fitted.hypothesis, fitted.z) for k in range(len(simulator.trials)))
    return max(float(np.ptp(reference_shaft(motion)[1])) for motion in motions)


@pytest.mark.parametrize("order", [3.57, 5.434])
def test_an_order_is_found_within_half_a_period_over_the_record(simulator: Simulator, fitted: Fitted, order: float) -> None:
    found = Periods(simulator, left(simulator, fitted, TURN, (order, 1.0))).standing_out(TURN, 2.0, 7.0)
    assert found[0] == pytest.approx(order, abs=np.pi / turned(simulator, fitted))


def test_strong_synchronous_vibration_does_not_hide_a_faint_order(simulator: Simulator, fitted: Fitted) -> None:
    found = Periods(simulator, left(simulator, fitted, TURN, (1.0, 3.0), (3.57, 1.0))).standing_out(TURN, 2.0, 7.0)
    assert min(abs(item - 3.57) for item in found) < np.pi / turned(simulator, fitted)


def test_a_frequency_is_found_and_one_above_half_the_sample_rate_is_not_looked_for(simulator: Simulator, fitted: Fitted) -> None:
    periods = Periods(simulator, left(simulator, fitted, TIME, (333.0, 1.0)))
    found = periods.standing_out(TIME, 50.0, 1e6)
    assert found[0] == pytest.approx(333.0, abs=np.pi / 1.6)
    assert 1 <= len(found) <= MOST
    assert max(found) <= np.pi / 1e-3


def test_a_frequency_that_every_few_samples_show_as_another_one_is_begun_at_too(simulator: Simulator, fitted: Fitted) -> None:
    coarse = Simulator(simulator.trials, 2.5e-4, 4)
    base = fit(coarse, fitted.hypothesis, np.zeros(fitted.hypothesis.size), steps=0)
    residuals = np.random.default_rng(3).normal(size=coarse.size)
    for segment in coarse.segments:
        residuals[segment.span] += np.sin(1100.0 * coarse.trials[segment.trial].times[::4])
    found = Periods(coarse, dataclasses.replace(base, residuals=residuals)).standing_out(TIME, 50.0, 5e3)
    # 1100 rad/s, sampled at 250 Hz, looks like 2 pi 250 - 1100 = 470.8 rad/s
    assert found[0] == pytest.approx(500.0 * np.pi - 1100.0, abs=np.pi / 1.6)
    assert min(abs(item - 1100.0) for item in found) < np.pi / 1.6
    assert max(found) <= np.pi / 1e-3


def test_no_period_is_named_where_the_range_is_narrower_than_the_record_can_tell(simulator: Simulator, fitted: Fitted) -> None:
    narrow = 3.0 + 6.0 / turned(simulator, fitted)
    assert Periods(simulator, left(simulator, fitted, TURN, (3.0, 1.0))).standing_out(TURN, 3.0, narrow) == ()


class _Given:
    """Says what it is told to have found."""

    def __init__(self, found: Mapping[str, tuple[float, ...]]) -> None:
        self.found = found

    def standing_out(self, over: str, low: float, high: float) -> tuple[float, ...]:
        assert low < high
        return self.found[over]


def test_laws_with_a_period_begin_at_what_stands_out_and_others_stay() -> None:
    scene = rotor_bench.bench().scene
    kinds: list[type[hm.Effect]] = [hm.OilWhirlOnset, hm.BallPassHarmonics, hm.GroundVibration, hm.RotorUnbalance]
    for suspect in suspects(Hypothesis(()), {}, candidates(scene, kinds)):
        periods = _Given({TURN: (0.43, 0.47), TIME: ()})
        begun = begun_at(suspect.all, periods)  # type: ignore[arg-type]
        effects = [item.added[-1].effect for item in begun]
        match effects[0]:
            case hm.OilWhirlOnset():
                assert [(item.ratio, item.onset) for item in effects] == [  # type: ignore[attr-defined]
                    (ratio, onset) for ratio in (0.43, 0.47) for onset in hm.OilWhirlOnset.starts["onset"]
                ]
            case hm.BallPassHarmonics():  # each order in two directions
                assert [item.order for item in effects] == [0.43, 0.43, 0.47, 0.47]  # type: ignore[attr-defined]
                assert {item.direction for item in effects} == {0.0, 0.5 * np.pi}  # type: ignore[attr-defined]
            case _:
                assert [list(item.fields()) for item in effects] == [list(item.added[-1].effect.fields()) for item in suspect.all]
        assert {item.added[-1].name for item in begun} == {suspect.all[0].added[-1].name}


def test_many_periods_and_many_starts_make_about_a_dozen_and_two_periods_at_least() -> None:
    scene = rotor_bench.bench().scene
    periods = _Given({TURN: (0.41, 0.43, 0.45, 0.46, 0.47, 0.48), TIME: ()})
    for kind, starts, tried in ((hm.OilWhirlOnset, 3, 4), (hm.BallPassHarmonics, 2, 6)):
        for suspect in suspects(Hypothesis(()), {}, candidates(scene, [kind])):
            begun = begun_at(suspect.all, periods)  # type: ignore[arg-type]
            name = next(iter(kind.periodic))
            assert len({getattr(item.added[-1].effect, name) for item in begun}) == tried
            assert len(begun) == tried * starts
    many = tuple(Hypothesis((), (Added(hm.OilWhirlOnset(amplitude=1.0, onset=100.0 + k), "bearing_1", "whirl"),)) for k in range(9))
    assert len(begun_at(many, periods)) == 2 * len(many)  # type: ignore[arg-type]


def test_a_law_whose_direction_is_tried_keeps_all_of_its_directions() -> None:
    """Periods are not among the starts that are thinned out: they come from the records."""
    for one in candidates(rotor_bench.bench().scene, [hm.InnerRacePass]):
        assert {item.effect.direction for item in one.starts} == set(hm.InnerRacePass.starts["direction"])  # type: ignore[attr-defined]
        assert len({item.effect.order for item in one.starts}) == 1  # type: ignore[attr-defined]


@pytest.mark.parametrize("kind", [hm.BallPass, hm.BallPassHarmonics, hm.GroundVibration], ids=lambda kind: kind.__name__)
def test_a_force_along_a_line_is_looked_at_along_two_axes(kind: type[hm.Effect]) -> None:
    """At right angles to it its amplitude has no slope, and neither has its direction."""
    for one in candidates(rotor_bench.bench().scene, [kind]):
        assert {item.effect.direction for item in one.first} == {0.0, 0.5 * np.pi}  # type: ignore[attr-defined]


def test_beside_a_period_lie_others_by_parts_of_what_the_records_tell_apart(simulator: Simulator, fitted: Fitted) -> None:
    start = Hypothesis((), (Added(hm.BallPass(amplitude=1.0, order=3.1), "bearing_1", "pass"),))
    widths = widths_of(start, Periods(simulator, fitted))
    turns = turned(simulator, fitted) / (2.0 * np.pi)
    assert widths == {"order": pytest.approx(1.0 / turns)}
    orders = [item.added[-1].effect.order for item in beside(start, widths)]  # type: ignore[attr-defined]
    np.testing.assert_allclose(orders, 3.1 + np.array(ASIDE) / turns)
    assert len(beside(start, {"order": 100.0})) == 3  # those below zero are left out
    assert beside(start, {"order": np.inf}) == ()


@dataclasses.dataclass(frozen=True, kw_only=True)
class Chatter(hm.Effect):
    """A user's own law, with a frequency that it asks to begin at."""

    amplitude: float = hm.parameter("N m", "amplitude", low=0.0, typical=(0.1, 10.0))
    frequency: float = hm.parameter("rad/s", "frequency", above=0.0, typical=(10.0, 1e3))

    periodic: ClassVar[Mapping[str, str]] = {"frequency": "time"}
    tried: ClassVar[bool] = False

    def apply(self, draft: object, place: str, name: str) -> None:
        raise NotImplementedError


def test_an_own_law_takes_part(simulator: Simulator, fitted: Fitted) -> None:
    start = Hypothesis(factors_of(BENCH), (Added(Chatter(amplitude=0.1, frequency=100.0), "load", "chatter"),))
    begun = begun_at((start,), Periods(simulator, left(simulator, fitted, TIME, (333.0, 1.0))))
    first = begun[0].added[-1].effect
    assert isinstance(first, Chatter)
    assert first.frequency == pytest.approx(333.0, abs=np.pi / 1.6)
    assert first.amplitude == 0.1
