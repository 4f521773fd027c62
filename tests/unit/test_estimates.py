"""What is reported of a field whose size may be zero: nothing."""

from __future__ import annotations

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.estimates import effect_estimates
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.effects.hidden_mode import HiddenMode
from tests.unit.diagnosis_cases import scene, standing


def told(effect: Effect, at: str, *vague: str) -> dict[str, bool]:
    """Which fields are called identifiable where records determine every search coordinate to 0.01, and those of vague fields to 10.

    A size of coordinate 1 is then known to its prior alone, which is as wide as it is large.
    """
    hypothesis = Hypothesis((), (Added(effect, at, "x"),))
    loose = np.concatenate([np.full(item.size, item.path in {f"x.{name}" for name in vague}) for item in hypothesis.unknowns])
    curvature = np.diag(np.where(loose, 1e-2, 1e4))
    fitted = standing(hypothesis, curvature)
    improved = hypothesis.scene(scene(), fitted.z)
    return {item.name.removeprefix("x."): item.identifiable for item in effect_estimates(fitted, improved, "x")}


FRICTION = hm.CoulombStribeckFriction(coulomb=0.05, drop=0.4, stribeck_speed=0.3, smoothing_speed=0.02)


def test_a_stribeck_speed_is_not_identifiable_where_the_drop_is_not_nor_anything_where_the_friction_is_not() -> None:
    sure = {"coulomb": True, "drop": True, "stribeck_speed": True, "smoothing_speed": True}
    assert told(FRICTION, "motor") == sure
    assert told(FRICTION, "motor", "drop") == {**sure, "drop": False, "stribeck_speed": False}
    assert not any(told(FRICTION, "motor", "coulomb").values())


def test_a_phase_is_not_identifiable_where_its_amplitude_is_not() -> None:
    ripple = hm.TorqueRipple(amplitude=0.02, order=5.0, phase=0.4, second_amplitude=0.01, second_phase=-1.8)
    found = told(ripple, "motor")
    assert found["second_amplitude"]
    assert found["second_phase"]
    found = told(ripple, "motor", "second_amplitude")
    assert not found["second_amplitude"]
    assert not found["second_phase"]
    assert found["amplitude"]
    assert found["phase"]


@pytest.mark.parametrize("vague", ["inertia", "hardening"])
def test_a_field_that_acts_through_other_sizes_too_keeps_its_interval(vague: str) -> None:
    """Frequency and damping of a mode say nothing without its inertia; without its hardening they do."""
    found = told(HiddenMode(inertia=0.1, natural_frequency=200.0, damping_ratio=0.05, hardening=1e3), "load", vague)
    assert found["natural_frequency"] == found["damping_ratio"] == (vague != "inertia")
