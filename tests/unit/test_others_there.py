"""At the place of the best law those of other families are tried that were fitted at other places alone."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.choosing import above_noise
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.from_the_best import others_there
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import PARAMETER, suspects
from hdrive_mbs.diagnosis.tasks import RIVAL, Found
from hdrive_mbs.effects.effect import Effect
from tests.unit.diagnosis_cases import bench, quiet, standing

BENCH = bench()
SIMULATOR = Simulator(BENCH.trials(quiet()[0]), 2.5e-4, 16)
NOMINAL = Hypothesis(factors_of(BENCH))
EVERYTHING = suspects(NOMINAL, {}, candidates(BENCH.scene, [hm.FrictionByAngle, hm.DahlFriction, hm.PreslidingFriction, hm.MeshFriction]))
BY_ANGLE = hm.FrictionByAngle(mean=0.4)
DAHL = hm.DahlFriction(coulomb=0.7, presliding=2e-3, exponent=1.6)


def fitted(hypothesis: Hypothesis, cost: float) -> Fitted:
    z = hypothesis.start(np.linspace(-1.0, 1.0, len(NOMINAL.factors)) * cost)
    return dataclasses.replace(standing(hypothesis, np.eye(hypothesis.size)), z=z, cost=cost, chi_fit=1.0 + cost, chi_held=1.0 + cost)


def found(effect: Effect, place: str, cost: float) -> Found:
    [suspect] = [item for item in EVERYTHING if item.law == type(effect).__name__ and item.label[1] == place]
    return Found(suspect, fitted(Hypothesis(NOMINAL.factors, (Added(effect, place, "effect"),)), cost))


def test_a_friction_of_the_motor_is_tried_at_the_load_where_the_best_sits() -> None:
    """Across the gear: with the exponent that was found, and torque and angle as they begin at the load."""
    best, second = found(BY_ANGLE, "load", 0.1), found(DAHL, "motor", 0.2)
    worse = found(hm.PreslidingFriction(coulomb=0.5, presliding=1e-3), "motor", 0.3)
    [(suspect, task)] = others_there([best, second, worse], fitted(NOMINAL, 0.9), EVERYTHING, SIMULATOR)
    assert (suspect.label, suspect.law) == (("friction", "load"), "DahlFriction")
    added = task.hypothesis.added[-1]
    values = {path.rpartition(".")[2]: value for path, value in task.hypothesis.values(task.z).items() if path.startswith(f"{added.name}.")}
    own = suspect.all[0].added[-1].effect
    assert isinstance(own, hm.DahlFriction)
    assert {name: values[name] for name in ("coulomb", "presliding", "exponent")} == {
        "coulomb": pytest.approx(own.coulomb),
        "presliding": pytest.approx(own.presliding),
        "exponent": pytest.approx(1.6),
    }
    assert own.coulomb != 0.7
    assert own.exponent != 1.6
    nominal = task.hypothesis.nominal_part(task.z)
    np.testing.assert_allclose(nominal, best.fitted.hypothesis.nominal_part(best.fitted.z), rtol=1e-12)
    assert task.leading == pytest.approx(1.1)
    assert task.beat == pytest.approx(0.1 + RIVAL)


def test_what_was_fitted_there_or_cannot_sit_there_is_not_tried_again() -> None:
    best, second, there = found(BY_ANGLE, "load", 0.1), found(DAHL, "motor", 0.2), found(DAHL, "load", 0.3)
    base = fitted(NOMINAL, 0.9)
    assert others_there([best, second, there], base, EVERYTHING, SIMULATOR) == []
    assert others_there([best, found(hm.MeshFriction(loss_factor=0.1), "gear", 0.2)], base, EVERYTHING, SIMULATOR) == []
    assert others_there([best, found(BY_ANGLE, "motor", 0.2)], base, EVERYTHING, SIMULATOR) == []  # ``elsewhere`` has done that
    parameter = dataclasses.replace(best, suspect=dataclasses.replace(best.suspect, law=PARAMETER))
    assert others_there([parameter, second], base, EVERYTHING, SIMULATOR) == []
    assert others_there([], base, EVERYTHING, SIMULATOR) == []


def test_noise_lies_below_one_standard_deviation_five_times_in_six() -> None:
    """Sqrt(2/n) of the mean square of n samples: drawn 4000 times, the share is right within three of its own standard deviations."""
    simulator = Simulator(BENCH.trials(quiet()[0]), 2.5e-4, 16)
    samples = int(np.count_nonzero(simulator.fit))
    drawn = np.random.default_rng(6).chisquare(samples, 4000) / samples
    wanted = 0.5 * math.erfc(1.0 / math.sqrt(2.0))
    assert np.mean(drawn > above_noise(simulator)) == pytest.approx(wanted, abs=3.0 * math.sqrt(wanted * (1.0 - wanted) / 4000))
