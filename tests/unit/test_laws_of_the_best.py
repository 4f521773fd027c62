"""From which values the other laws of the best label begin."""

from __future__ import annotations

import numpy as np

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.diagnose import factors_of
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.from_the_best import other_laws
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.suspects import Suspect, suspects
from hdrive_mbs.diagnosis.tasks import Found, Task
from models import rotor_bench

BENCH = rotor_bench.bench()
PLACE = "section_2"
NOMINAL = Hypothesis(factors_of(BENCH))
EVERYTHING = [
    item
    for item in suspects(NOMINAL, {}, candidates(BENCH.scene, [hm.PhasedCrack, hm.BreathingCrack, hm.SteepCrack]))
    if item.label[1] == PLACE
]


def fitted(hypothesis: Hypothesis, cost: float) -> Fitted:
    return Fitted(
        hypothesis,
        hypothesis.start(),
        residuals=np.zeros(0),
        cost=cost,
        curvature=np.eye(hypothesis.size),
        converged=True,
        steps=0,
        chi_fit=2.0,
        chi_held=2.0,
        typical=2.0,
        misfit_held=cost,
    )


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
    assert begun(other_laws([phased, by_weight], base, EVERYTHING)) == {("SteepCrack", 0.38, -0.8), ("SteepCrack", 0.5, 2.1)}
    alone = begun(other_laws([phased], base, EVERYTHING))
    assert alone == {(law, 0.38, -0.8) for law in ("SteepCrack", "BreathingCrack")}
