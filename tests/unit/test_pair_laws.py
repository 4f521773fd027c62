"""The causes of a pair are told by other laws."""

from __future__ import annotations

import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.diagnose import factors_of
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.pair_laws import with_other_laws
from hdrive_mbs.diagnosis.pairs import contenders
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
