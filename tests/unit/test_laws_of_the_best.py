"""From which values the other laws of the best label begin, and what it may imitate."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.from_the_best import other_laws, twins
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import Suspect, suspects
from hdrive_mbs.diagnosis.tasks import Found, Task
from hdrive_mbs.diagnosis.verdict import judge
from models import rotor_bench
from tests.unit.diagnosis_cases import standing
from tests.unit.rotor_bench_records import compiled, recorded

BENCH = rotor_bench.bench()
PLACE = "section_2"
NOMINAL = Hypothesis(factors_of(BENCH))
EVERYTHING = [
    item
    for item in suspects(
        NOMINAL, {}, candidates(BENCH.scene, [hm.PhasedCrack, hm.BreathingCrack, hm.SteepCrack, hm.MomentCrack, hm.Keyway])
    )
    if item.label[1] == PLACE
]
CRACK = hm.MomentCrack(compliance=4e-8, position=0.4, angle=0.5, closing_moment=200.0)
KEYWAY = hm.Keyway(compliance=2e-8, position=0.4, angle=0.5)


def fitted(hypothesis: Hypothesis, cost: float) -> Fitted:
    return replace(standing(hypothesis, np.eye(hypothesis.size)), cost=cost, chi_fit=2.0, chi_held=2.0)


def found(effect: hm.CrackEffect, cost: float) -> Found:
    [suspect] = [item for item in EVERYTHING if item.law == type(effect).__name__]
    return Found(suspect, fitted(Hypothesis(NOMINAL.factors, (Added(effect, PLACE, "crack"),)), cost))


def begun(asked: list[tuple[Suspect, Task]]) -> set[tuple[str, float, float]]:
    effects = [task.hypothesis.added[-1].effect for _, task in asked]
    return {(type(item).__name__, round(item.position, 9), round(item.angle, 9)) for item in effects if isinstance(item, hm.CrackEffect)}


def test_they_begin_with_the_values_of_the_next_best_law_too() -> None:
    """A crack with a phase of its own leaves open on which side it is, which one that the weight opens tells."""
    phased = found(hm.PhasedCrack(compliance=3e-8, position=0.38, angle=-0.8, phase=2.9), 10.0)
    by_weight = found(hm.BreathingCrack(compliance=2e-8, position=0.5, angle=2.1), 20.0)
    base = fitted(NOMINAL, 90.0)
    assert begun(other_laws([phased, by_weight], base, EVERYTHING)) == {
        (law, *values) for law in ("SteepCrack", "MomentCrack") for values in ((0.38, -0.8), (0.5, 2.1))
    }
    alone = begun(other_laws([phased], base, EVERYTHING))
    assert alone == {(law, 0.38, -0.8) for law in ("SteepCrack", "BreathingCrack", "MomentCrack")}


def test_a_crack_is_held_against_the_keyway_that_it_may_imitate() -> None:
    simulator = Simulator(BENCH.trials(recorded("bump", compiled("bump", 0.02), noisy=False)), rotor_bench.STEP)
    base = fitted(NOMINAL, 90.0)
    asked = twins([found(CRACK, 10.0)], base, EVERYTHING, simulator)
    assert begun(asked) == {("Keyway", 0.4, 0.5)}
    assert twins([found(CRACK, 10.0), found(KEYWAY, 10.5)], base, EVERYTHING, simulator) == []  # it is there
    assert twins([found(KEYWAY, 10.0)], base, EVERYTHING, simulator) == []


def test_what_imitates_a_simpler_cause_is_not_tied_with_it() -> None:
    """Both leave alike, with log odds 38 apart; the other way round the keyway is tied, as no crack is an end of its range."""
    crack, keyway = (replace(found(effect, 10.0), log_odds=odds) for effect, odds in ((CRACK, 15000.0), (KEYWAY, 15038.0)))
    labels = {type(item.fitted.hypothesis.added[-1].effect).__name__: item.suspect.label for item in (crack, keyway)}
    claim = judge(400.0, [keyway, crack])
    assert claim.tied == ()
    assert claim.probabilities[labels["Keyway"]] > 100.0 * claim.probabilities[labels["MomentCrack"]]
    claim = judge(400.0, [replace(crack, log_odds=15076.0), keyway])
    assert claim.tied == (labels["Keyway"],)
