"""Whether a gap lies at another place than what is claimed for it."""

from __future__ import annotations

import dataclasses

import pytest

from hdrive_mbs.diagnosis import sentences
from hdrive_mbs.diagnosis.elsewhere import LEAVES, elsewhere, wave_generators
from hdrive_mbs.diagnosis.result import NOWHERE, Diagnosis, Place
from models import drive_bench
from tests.unit import diagnosis_samples

ROTOR = Place(at="rotor_2", probability=0.996, gain=900.0, share=0.9)
SUPPORT = Place(at="bearing_2.housing", probability=0.003, gain=600.0, share=0.8)


def test_a_law_that_leaves_something_does_not_keep_its_place_against_the_one_located() -> None:
    assert elsewhere((ROTOR, SUPPORT), {"bearing_2"}, 1.06) is ROTOR


@pytest.mark.parametrize(
    ("places", "at", "left"),
    [
        ((ROTOR, SUPPORT), {"bearing_2"}, LEAVES),  # it leaves noise
        ((ROTOR, SUPPORT), {"bearing_2", "rotor_2"}, 1.06),  # one of two is there
        ((ROTOR, SUPPORT), set[str](), 1.06),  # nothing is claimed
        ((dataclasses.replace(ROTOR, sensor=True), SUPPORT), {"bearing_2"}, 1.06),
        ((dataclasses.replace(ROTOR, at=NOWHERE), SUPPORT), {"bearing_2"}, 1.06),
        ((dataclasses.replace(ROTOR, probability=0.98), SUPPORT), {"bearing_2"}, 1.06),  # not sure
        ((ROTOR, dataclasses.replace(SUPPORT, probability=0.02)), {"bearing_2"}, 1.06),  # not excluded
        ((), {"bearing_2"}, 1.06),
    ],
)
def test_a_claim_keeps_its_place(places: tuple[Place, ...], at: set[str], left: float) -> None:
    assert elsewhere(places, at, left) is None


def _claimed(left: float) -> Diagnosis:
    """Friction of the load that leaves so many times the noise, of a gap that is located at the motor."""
    found = diagnosis_samples.effect()
    places = (dataclasses.replace(ROTOR, at="motor"), dataclasses.replace(SUPPORT, at="load"))
    return dataclasses.replace(found, gaps=diagnosis_samples.gaps(34.2, 28.1, left), where=places)


@pytest.mark.parametrize(("left", "doubted"), [(1.01, False), (1.07, True), (27.0, True)])
def test_the_report_doubts_a_claim_by_its_place(left: float, doubted: bool) -> None:
    found = _claimed(left)
    assert (found.elsewhere is not None) == doubted
    assert ("by its place the gap lies at motor, not at load" in sentences.inexact(found).lower()) == doubted
    assert any("leaves noise alone" in line for line in sentences.where_sentences(found)) == (not doubted)


def test_without_stretches_held_out_nothing_is_doubted() -> None:
    assert dataclasses.replace(_claimed(1.07), gaps=()).elsewhere is None


def test_friction_of_the_teeth_is_not_doubted_by_the_wave_generator_that_it_brakes() -> None:
    network = drive_bench.bench().scene.network()
    braked = dataclasses.replace(ROTOR, at="wave_generator"), dataclasses.replace(SUPPORT, at="gear")
    assert wave_generators(network, {"gear"}) == {"wave_generator"}
    assert wave_generators(network, {"input_shaft", "load"}) == frozenset()
    assert elsewhere(braked, {"gear"}, 1.06) is braked[0]
    assert elsewhere(braked, {"gear"}, 1.06, {"wave_generator"}) is None


@pytest.mark.parametrize("left", [1.07, 27.0])
@pytest.mark.parametrize(("gear", "doubted"), [("gear", False), ("load", True)])
def test_the_report_does_not_doubt_friction_of_the_teeth_either(left: float, gear: str, doubted: bool) -> None:
    """Claimed at the gear, located at the wave generator."""
    found = _claimed(left)
    [cause] = found.causes
    where = (dataclasses.replace(ROTOR, at="wave_generator"), dataclasses.replace(SUPPORT, at=gear))
    again = dataclasses.replace(found, causes=(dataclasses.replace(cause, at=gear),), where=where)
    assert ("the gap lies at wave_generator" in sentences.inexact(again)) == doubted
