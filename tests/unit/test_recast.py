"""A cause of a pair is exchanged for others at its place."""

from __future__ import annotations

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.pairs import contenders
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.recast import recast
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import suspects
from hdrive_mbs.diagnosis.team import Team
from tests.unit.diagnosis_cases import bench, fitted_pair, records

BENCH = bench()


def test_drag_that_was_taken_for_friction_of_the_same_load_is_found_beside_the_other_cause() -> None:
    planted = ((hm.QuadraticDrag(coefficient=0.3), "load"), (hm.CoulombStribeckFriction(coulomb=0.05), "motor"))
    both = Simulator(BENCH.trials(records(*planted)[0]), 2.5e-4, 4)
    factors = factors_of(BENCH)
    tried = candidates(BENCH.scene, [hm.CoulombStribeckFriction, hm.QuadraticDrag, hm.TorqueRipple, hm.ViscousDrag])
    everything = suspects(Hypothesis(factors), {"load_viscous": ["load_viscous"]}, tried)
    found = [
        Added(hm.CoulombStribeckFriction(coulomb=1.0), "load", "friction"),
        Added(hm.CoulombStribeckFriction(coulomb=0.05), "motor", "friction_2"),
    ]
    for first, second in (found, found[::-1]):
        pair = fitted_pair(both, factors, first, second)
        with Team(1) as team:
            others = recast(team, both, [pair], everything)
            best, *_ = contenders(team, both, [pair, *others], pair)
        assert best.fitted.hypothesis.labels == {("quadratic_drag", "load"), ("friction", "motor")}
        assert best.fitted.typical < 1.1 < pair.fitted.typical
        assert best.suspect.label == best.fitted.hypothesis.added[-1].label
        for item in others:  # one cause stays, the other one's place too
            labels = item.fitted.hypothesis.labels
            assert len(labels & pair.fitted.hypothesis.labels) == 1
            assert {at for _, at in labels} == {"load", "motor"}
