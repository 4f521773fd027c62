"""A cause that came out best without the one it was found beside is tried at its other places."""

from __future__ import annotations

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.again_elsewhere import again_elsewhere
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.fit import fit
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.search import fit_nominal
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import suspects
from hdrive_mbs.diagnosis.tasks import Found
from hdrive_mbs.diagnosis.team import Team
from tests.unit.diagnosis_cases import bench, records

BENCH = bench(shaft=True)
FACTORS = factors_of(BENCH)


def test_a_gear_that_creeps_is_found_from_an_input_shaft_that_was_taken_for_it() -> None:
    """And nothing is run where the best of them is no better than what a search had found first."""
    planted = records((hm.Creep(compliance=5e-5, relaxation_time=0.03), "gear"), shaft=True)
    simulator = Simulator(BENCH.trials(planted[1]), 2.5e-4, 4)
    null = fit_nominal(simulator, FACTORS)
    everything = suspects(Hypothesis(FACTORS), {}, candidates(BENCH.scene, [hm.Creep, hm.HiddenMode]))
    shaft = next(item for item in everything if item.label == ("creep", "input_shaft"))
    wrong = Found(shaft, fit(simulator, shaft.all[0], shaft.all[0].start(null.hypothesis.nominal_part(null.z)), steps=25))
    first = Found(next(item for item in everything if item.law == "HiddenMode"), null)
    assert wrong.fitted.cost < null.cost
    with Team(1) as team:
        found = again_elsewhere(team, simulator, null, everything, first, [wrong])
        assert again_elsewhere(team, simulator, null, everything, wrong, [wrong]) == ()
        assert again_elsewhere(team, simulator, null, everything, first, []) == ()
    best = min(found, key=lambda item: item.fitted.cost)
    assert best.suspect.label == ("creep", "gear")
    assert best.fitted.typical < 1.1 < wrong.fitted.typical
