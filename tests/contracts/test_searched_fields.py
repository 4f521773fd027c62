"""What a search leaves where it is, of every law that it tries, and why.

A field that a law has but no search moves is as if the law did not have it: of a pipe that hangs askew on a housing seven times the noise
was left while its direction stayed at 0 (our own tenth rotor set, c02), of a foot half of the gap (fourth, c12).
"""

from __future__ import annotations

import pytest

from hdrive_mbs.diagnosis.candidates import _quantities, _searched, known_effects
from hdrive_mbs.effects.effect import Effect

ANYWHERE = {
    "reference_speed": "a scale that the size absorbs",
    "reference_depth": "a scale that the size absorbs",
    "gravity": "known",
    "fastest_rate": "a bound for the integration",
    "smoothing_speed": "rounds a corner more finely than records show",
    "rounding": "rounds a corner more finely than records show",
}
OF_LAWS = {
    "InnerRacePass.load_direction": "the weight's",
    "InnerRacePulses.load_direction": "the weight's",
    "InnerRacePulses.unloaded": "small beside the loaded zone",
    "BearingAnisotropy.angle": "a bearing's own axes are taken to be x and y",
    "HertzianClearance.exponent": "that of rollers; balls have BallBearing",
    "BearingCrossCoupling.asymmetry": "FadingCrossCoupling",
    "BearingCrossCoupling.fading": "FadingCrossCoupling",
    "BreathingCrack.cross_share": "SteepCrack",
    "BreathingCrack.steepness": "SteepCrack",
    "PhasedCrack.cross_share": "SteepCrack",
    "SeriesCompliance.relaxation_time": "Creep",
    "CoulombStribeckFriction.breakaway": "given by the drop",
    "LuGreFriction.breakaway": "given by the drop",
    "LuGreFriction.viscous": "ViscousDrag",
    "BoucWenHysteresis.exponent": "IwanHysteresis and SpreadSlipHysteresis have other corners",
    "BoucWenHysteresis.shape": "that of a loop without a bulge",
    "Looseness.play": "LooseBolt",
    "MeshFriction.no_load": "friction of the wave generator does the same",
    "MeshPreslidingFriction.no_load": "friction of the wave generator does the same",
    "Misalignment.lever": "moves the same forces along the shaft",
    "OilWhirl.growth": "VaryingOilWhirl",
    "OilWhirl.onset": "OilWhirlOnset, VaryingOilWhirl",
    "OilWhirl.onset_width": "VaryingOilWhirl",
    "OilWhirlOnset.growth": "VaryingOilWhirl",
    "OilWhirlOnset.onset_width": "VaryingOilWhirl",
    "ProbeGain.curvature": "a probe that is not linear is seen at its calibration",
    "Rub.damping": "DampedRub",
    "Rub.exponent": "HertzianRub",
    "HertzianRub.damping": "DampedRub",
    "HertzianRub.exponent": "that of balls and edges",
    "DampedRub.exponent": "HertzianRub",
    "CoatedRub.exponent": "HertzianRub",
}
SEARCHED = [kind for kind in known_effects() if kind.__module__.startswith("hdrive_mbs.") and _searched(kind)]


@pytest.mark.parametrize("kind", SEARCHED, ids=lambda kind: kind.__name__)
def test_a_field_that_no_search_moves_has_a_reason(kind: type[Effect]) -> None:
    left = {name for name, item in _quantities(kind).items() if item.typical is None and name not in kind.starts}
    assert {name for name in left if name not in ANYWHERE} == {
        name.partition(".")[2] for name in OF_LAWS if name.partition(".")[0] == kind.__name__
    }


def test_reasons_name_laws_that_are_searched() -> None:
    names = {kind.__name__ for kind in SEARCHED}
    assert {key.partition(".")[0] for key in OF_LAWS} <= names
