"""Where two places of a law are alike, its other places are tried too."""

from __future__ import annotations

import dataclasses

import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.fit import fit
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.search import fit_nominal
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import suspects
from hdrive_mbs.diagnosis.tasks import Found
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.tied_places import tied_places
from hdrive_mbs.diagnosis.verdict import TIED
from tests.unit.diagnosis_cases import bench, records

BENCH = bench(shaft=True)
SIMULATOR = Simulator(BENCH.trials(records((hm.QuadraticDrag(coefficient=2e-6), "motor"), shaft=True)[0]), 2.5e-4, 16)
NULL = fit_nominal(SIMULATOR, factors_of(BENCH))
EVERYTHING = suspects(NULL.hypothesis, {}, candidates(BENCH.scene, [hm.QuadraticDrag, hm.ViscousDrag]))


def _found(law: str, at: str, log_odds: float) -> Found:
    [suspect] = [item for item in EVERYTHING if (item.law, item.label[1]) == (law, at)]
    hypothesis = suspect.all[0]
    return Found(suspect, fit(SIMULATOR, hypothesis, hypothesis.start(NULL.z), steps=6), log_odds)


@pytest.mark.parametrize(("behind", "asked"), [(0.5 * TIED, {"load"}), (2.0 * TIED, set[str]())])
def test_a_law_that_is_alike_at_two_places_is_tried_at_the_others(behind: float, asked: set[str]) -> None:
    best = _found("QuadraticDrag", "motor", 90.0)
    found = [best, dataclasses.replace(_found("QuadraticDrag", "wave_generator", 0.0), log_odds=90.0 - behind)]
    other = _found("ViscousDrag", "motor", 88.0)  # alone at its place: as far as it goes nothing is alike
    with Team(1) as team:
        more = tied_places(team, SIMULATOR, NULL, EVERYTHING, [*found, other], [best, other])
    assert {item.suspect.law for item in more} <= {"QuadraticDrag"}
    assert {item.suspect.label[1] for item in more} == asked


def test_a_hypothesis_of_parameters_has_no_other_places() -> None:
    everything = suspects(NULL.hypothesis, {"load_viscous": ["load_viscous"]}, [])
    with Team(1) as team:
        found = [Found(everything[0], NULL, 50.0)]
        assert tied_places(team, SIMULATOR, NULL, everything, found, found) == ()
