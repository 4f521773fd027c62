"""Two causes of one part that only fit another part together."""

from __future__ import annotations

import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.both_moved import both_moved
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.fit import fit
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.pairs import contenders, moved
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import suspects
from hdrive_mbs.diagnosis.tasks import Found
from hdrive_mbs.diagnosis.team import Team
from tests.unit.diagnosis_cases import DISTURBED, bench, fitted_pair, records

BENCH = bench()
FACTORS = factors_of(BENCH)
GROUPS = {name: [name] for name in ("motor_viscous", "load_viscous", "flexspline_stiffness")}
TRIED = candidates(BENCH.scene, [hm.ThermalDrift, hm.CoulombStribeckFriction, hm.QuadraticDrag])
EVERYTHING = suspects(Hypothesis(FACTORS), GROUPS, TRIED)
WARMING = hm.ThermalDrift(viscous_change=-0.35, time_constant=0.4)


def _with_a_parameter(simulator: Simulator, added: Added, name: str) -> Found:
    """An effect, and a parameter as its second cause, fitted."""
    hypothesis = Hypothesis(FACTORS, (added,), {name: 10.0})
    suspect = next(item for item in EVERYTHING if item.label == ("parameter", name))
    return Found(suspect, fit(simulator, hypothesis, hypothesis.start(), steps=12))


def test_a_drag_that_warms_and_the_drag_itself_go_to_the_other_part_together() -> None:
    simulator = Simulator(BENCH.trials(records((WARMING, "load"), errors=DISTURBED | {"load_viscous": 9.0})[0]), 2.5e-4, 4)
    pair = _with_a_parameter(simulator, Added(hm.ThermalDrift(viscous_change=-5e-4, time_constant=0.4), "motor", "drift"), "motor_viscous")
    with Team(1) as team:
        one = contenders(team, simulator, [pair, *moved(team, simulator, [pair], TRIED)], pair)
        both = both_moved(team, simulator, [pair], TRIED, EVERYTHING)
        best, *_ = contenders(team, simulator, [pair, *both], pair)
    [found] = [item for item in both if item.fitted.hypothesis.labels == {("thermal_drift", "load")}]
    assert set(found.fitted.hypothesis.loose) == {"load_viscous"}
    assert found.suspect.label == ("parameter", "load_viscous")
    assert best.fitted.hypothesis.labels == {("thermal_drift", "load")}
    assert best.fitted.typical < 1.1 < min(one[0].fitted.typical, pair.fitted.typical)


def test_two_effects_of_one_part_go_to_the_other_part_together() -> None:
    planted = ((hm.QuadraticDrag(coefficient=0.3), "load"), (hm.CoulombStribeckFriction(coulomb=1.0), "load"))
    simulator = Simulator(BENCH.trials(records(*planted)[0]), 2.5e-4, 4)
    first = Added(hm.QuadraticDrag(coefficient=2e-6), "motor", "drag")
    pair = fitted_pair(simulator, FACTORS, first, Added(hm.CoulombStribeckFriction(coulomb=0.02), "motor", "friction"))
    with Team(1) as team:
        both = both_moved(team, simulator, [pair], TRIED, EVERYTHING)
        best, *_ = contenders(team, simulator, [pair, *both], pair)
    assert best.fitted.hypothesis.labels == {("quadratic_drag", "load"), ("friction", "load")}
    assert best.suspect.label == ("friction", "load")
    assert best.fitted.typical < 1.1 < pair.fitted.typical


@pytest.mark.parametrize("beside", ["load_viscous", "flexspline_stiffness"])
def test_causes_of_two_parts_are_not_moved_together(beside: str) -> None:
    simulator = Simulator(BENCH.trials(records(names=("staircase",))[0]), 2.5e-4, 4)
    pair = _with_a_parameter(simulator, Added(hm.ThermalDrift(viscous_change=-5e-4, time_constant=0.4), "motor", "drift"), beside)
    apart = fitted_pair(
        simulator,
        FACTORS,
        Added(hm.QuadraticDrag(coefficient=2e-6), "motor", "drag"),
        Added(hm.CoulombStribeckFriction(coulomb=0.02), "load", "friction"),
    )
    with Team(1) as team:
        assert both_moved(team, simulator, [pair], TRIED, EVERYTHING) == []
        assert both_moved(team, simulator, [apart], TRIED, EVERYTHING) == []
