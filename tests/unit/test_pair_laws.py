"""The causes of a pair are told by other laws."""

from __future__ import annotations

import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.from_the_best import with_choices
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.pair_laws import told_otherwise, with_other_laws
from hdrive_mbs.diagnosis.pairs import contenders
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import suspects
from hdrive_mbs.diagnosis.team import Team
from tests.unit.diagnosis_cases import bench, fitted_pair, records

BENCH = bench()


@pytest.mark.parametrize("law_of_friction_comes", [0, 1])
def test_friction_with_the_wrong_law_beside_a_drag_gets_the_right_one(law_of_friction_comes: int) -> None:
    friction = hm.LubricatedFriction(coulomb=0.5, smoothing_speed=0.3, asymmetry=0.2)
    planted = ((hm.QuadraticDrag(coefficient=0.3), "load"), (friction, "motor"))
    both = Simulator(BENCH.trials(records(*planted)[0]), 2.5e-4, 4)
    factors = factors_of(BENCH)
    tried = candidates(BENCH.scene, [hm.CoulombStribeckFriction, hm.LubricatedFriction, hm.QuadraticDrag, hm.TorqueRipple])
    everything = suspects(Hypothesis(factors), {}, tried)
    found = [Added(hm.QuadraticDrag(coefficient=0.3), "load", "drag")]
    found.insert(law_of_friction_comes, Added(hm.CoulombStribeckFriction(coulomb=0.5), "motor", "friction"))
    pair = fitted_pair(both, factors, *found)
    with Team(1) as team:
        others = with_other_laws(team, both, [pair], everything)
        best, *_ = contenders(team, both, [pair, *others], pair)
    assert pair.fitted.typical > 1.1 > best.fitted.typical
    assert best.fitted.hypothesis.labels == pair.fitted.hypothesis.labels  # the same causes
    law = best.fitted.hypothesis.rescaled(best.fitted.z)[0].added[law_of_friction_comes].effect
    assert isinstance(law, hm.LubricatedFriction)
    assert law.smoothing_speed == pytest.approx(0.3, rel=0.2)
    assert best.suspect.label == best.fitted.hypothesis.added[-1].label


def test_another_law_begins_with_the_order_that_was_found_and_with_that_of_a_harmonic_that_leads() -> None:
    """Of an error no step leads from one order to another one."""
    tried = candidates(BENCH.scene, [hm.HarmonicKinematicError, hm.BeatingKinematicError, hm.QuadraticDrag])
    everything = suspects(Hypothesis(factors_of(BENCH)), {}, tried)
    error = hm.HarmonicKinematicError(amplitude=1e-6, order=2.0, third_amplitude=2e-5, third_phase=0.3, offset=1e-5)
    full = Hypothesis(factors_of(BENCH), (Added(error, "gear", "error"), Added(hm.QuadraticDrag(coefficient=0.3), "load", "drag")))
    begun = [added.effect for added in told_otherwise(full, 0, everything)]
    assert all(isinstance(item, hm.BeatingKinematicError) for item in begun)
    assert [(item.order, item.amplitude, item.third_amplitude, item.offset) for item in begun[:2]] == [
        (2.0, 1e-6, 2e-5, 1e-5),
        (6.0, 2e-5, 0.0, 1e-5),
    ]
    assert not list(told_otherwise(full, 1, everything))  # no other law of a drag was given


def test_a_ripple_of_one_order_is_told_as_a_harmonic_of_lower_ones() -> None:
    ripple = hm.TorqueRipple(amplitude=0.02, order=36.0, phase=0.4, second_amplitude=0.01, second_phase=-1.1)
    told = {item.order: item for item in hm.RippleSpectrum(order=1.0).telling(ripple)}
    assert sorted(told) == [6.0, 12.0]  # 36 = 6 * 6 = 3 * 12; 36 = 9 * 4 is beyond the sixth harmonic
    assert (told[12.0].third_amplitude, told[12.0].third_phase) == (0.02, 0.4)
    assert (told[12.0].sixth_amplitude, told[12.0].sixth_phase) == (0.01, -1.1)
    assert (told[6.0].sixth_amplitude, told[6.0].first_amplitude, told[6.0].fifth_amplitude) == (0.02, 0.0, 0.0)
    assert hm.RippleSpectrum(order=1.0).telling(hm.TorqueRipple(amplitude=0.02, order=13.0)) == ()
    assert hm.RippleSpectrum(order=1.0).telling(hm.Cogging(amplitude=0.02, order=12.0)) == ()


def test_cogging_found_beside_a_drag_gets_the_ripple_whose_third_harmonic_it_is() -> None:
    """In our own 28th drive set, c04, labels open, cogging of order 36 beside ripple of order 12 and friction left 1.27, and 1.01 so."""
    spectrum = hm.RippleSpectrum(order=2.0, first_amplitude=0.06, first_phase=1.0, third_amplitude=0.2, third_phase=0.3)
    planted = ((hm.QuadraticDrag(coefficient=0.3), "load"), (spectrum, "motor"))
    both = Simulator(BENCH.trials(records(*planted)[0]), 2.5e-4, 4)
    factors = factors_of(BENCH)
    tried = candidates(BENCH.scene, [hm.TorqueRipple, hm.RippleSpectrum, hm.QuadraticDrag])
    everything = suspects(Hypothesis(factors), {}, tried)
    cogging = hm.TorqueRipple(amplitude=0.2, order=6.0, phase=0.3)
    pair = fitted_pair(both, factors, Added(hm.QuadraticDrag(coefficient=0.3), "load", "drag"), Added(cogging, "motor", "ripple"))
    with Team(1) as team:
        best, *_ = contenders(team, both, [pair, *with_other_laws(team, both, [pair], everything)], pair)
    assert pair.fitted.typical > 1.1 > best.fitted.typical
    law = best.fitted.hypothesis.rescaled(best.fitted.z)[0].added[1].effect
    assert isinstance(law, hm.RippleSpectrum)
    assert law.order == 2.0
    assert law.first_amplitude == pytest.approx(0.06, rel=0.1)
    assert law.third_amplitude == pytest.approx(0.2, rel=0.05)


def test_a_choice_that_another_law_may_not_have_leaves_it_as_it_was() -> None:
    beating = hm.BeatingKinematicError(amplitude=1e-6, order=3.0)
    plain = hm.KinematicError(amplitude=1e-5, order=6.0, follows="flexspline")
    assert with_choices(beating, plain) == beating.replacing(order=6.0)  # what it follows is no choice of it
    assert with_choices(plain, beating) == plain.replacing(order=3.0)
    assert with_choices(plain, hm.HarmonicKinematicError(amplitude=1e-6, order=4.0)) == plain.replacing(order=4.0, follows="wave_generator")
    assert with_choices(hm.QuadraticDrag(coefficient=0.3), plain) == hm.QuadraticDrag(coefficient=0.3)
