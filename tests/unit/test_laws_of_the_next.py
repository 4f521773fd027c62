"""Other laws of the next label are tried where it takes nearly as much as the best."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.from_the_best import NEXT, laws_of_the_next, other_laws
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.suspects import suspects
from hdrive_mbs.diagnosis.tasks import Found
from hdrive_mbs.effects.effect import Effect
from tests.unit.diagnosis_cases import bench, standing

BENCH = bench()
NOMINAL = Hypothesis(factors_of(BENCH))
LAWS: list[type[Effect]] = [hm.FrictionByAngle, hm.CoulombStribeckFriction, hm.LubricatedFriction, hm.DahlFriction]
EVERYTHING = suspects(NOMINAL, {}, candidates(BENCH.scene, LAWS))
BASE = dataclasses.replace(standing(NOMINAL, np.eye(NOMINAL.size)), cost=1000.0)


def found(effect: Effect, gain: float) -> Found:
    """A law at the motor that takes so much of the misfit."""
    [suspect] = [item for item in EVERYTHING if (item.law, item.label[1]) == (type(effect).__name__, "motor")]
    hypothesis = Hypothesis(NOMINAL.factors, (Added(effect, "motor", "effect"),))
    return Found(suspect, dataclasses.replace(standing(hypothesis, np.eye(hypothesis.size)), cost=1000.0 - gain))


BEST = found(hm.FrictionByAngle(mean=0.4), 900.0)


@pytest.mark.parametrize(("behind", "tried"), [(0.5 * NEXT, {"LubricatedFriction", "DahlFriction"}), (2.0 * NEXT, set[str]())])
def test_laws_of_friction_are_tried_where_one_comes_near_friction_over_the_angle(behind: float, tried: set[str]) -> None:
    second = found(hm.CoulombStribeckFriction(coulomb=0.4), 900.0 * (1.0 - behind))
    asked = laws_of_the_next([BEST, second], BASE, EVERYTHING)
    assert {suspect.law for suspect, _ in asked} == tried
    assert {suspect.label for suspect, _ in asked} <= {("friction", "motor")}
    assert not {suspect.law for suspect, _ in other_laws([BEST, second], BASE, EVERYTHING)} & {"LubricatedFriction", "DahlFriction"}
    for suspect, task in asked:
        effect = task.hypothesis.added[-1].effect
        assert (type(effect).__name__, getattr(effect, "coulomb", None)) == (suspect.law, pytest.approx(0.4))


def test_without_a_next_label_nothing_is_tried() -> None:
    assert laws_of_the_next([BEST], BASE, EVERYTHING) == []
    assert laws_of_the_next([], BASE, EVERYTHING) == []
