"""The best single cause is joined with what its records show beside it, however little of that shows without it."""

from __future__ import annotations

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis import joined as joining
from hdrive_mbs.diagnosis.fit import fit
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.joined import joined
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import PARAMETER, Suspect
from hdrive_mbs.diagnosis.tasks import Found
from hdrive_mbs.diagnosis.team import Team
from tests.unit.diagnosis_cases import bench, records

BENCH = bench()
FACTORS = factors_of(BENCH)
DRAG = Added(hm.QuadraticDrag(coefficient=0.3), "load", "drag")
RIPPLE = Added(hm.TorqueRipple(amplitude=0.02, order=2.0, phase=0.4), "motor", "ripple")
WRONG = (
    Added(hm.EccentricLoad(mass=0.1, radius=0.1), "load", "eccentric"),
    Added(hm.KinematicError(amplitude=1e-5, order=2.0), "gear", "error"),
    Added(hm.CoulombStribeckFriction(coulomb=0.1), "motor", "friction"),
    Added(hm.CoulombStribeckFriction(coulomb=0.1), "load", "friction"),
)


@pytest.fixture(scope="module")
def simulator() -> Simulator:
    return Simulator(BENCH.trials(records((DRAG.effect, DRAG.at), (RIPPLE.effect, RIPPLE.at))[0]), 2.5e-4, 4)


def alone(simulator: Simulator, added: Added, steps: int = 4) -> Found:
    """One cause, fitted in a few steps."""
    one = Hypothesis(FACTORS, (added,))
    return Found(Suspect(added.label, type(added.effect).__name__, (one,), (one,)), fit(simulator, one, one.start(), steps=steps))


def inertia(simulator: Simulator) -> Found:
    """The load's inertia, let loose."""
    loose = Hypothesis(FACTORS, (), {"load_inertia": 10.0})
    return Found(Suspect((PARAMETER, "load"), PARAMETER, (loose,), (loose,)), fit(simulator, loose, np.zeros(loose.size), steps=4))


def test_what_shows_beside_the_best_is_joined_with_it_whatever_its_own_rank(simulator: Simulator) -> None:
    first, parameter = alone(simulator, DRAG, 12), inertia(simulator)
    # last of all, from a fit that ended in nothing like it
    astray = Added(hm.TorqueRipple(amplitude=2.0, order=2.0, phase=-2.5), "motor", "ripple")
    others = [parameter, *(alone(simulator, item) for item in WRONG), alone(simulator, astray, steps=0)]
    assert len(others) > joining.JOINED
    with Team(1) as team:
        pairs = joined(team, simulator, first, others)
        shown = {item.suspect.label for item in pairs} - {others[0].suspect.label}
        [*_, missed] = [item for item in others if item.suspect.label not in shown and item is not others[0]]
        again = joined(team, simulator, first, [missed, *(item for item in others if item is not missed)])
    assert len(pairs) <= joining.JOINED + 1
    assert others[0].suspect.label in {item.suspect.label for item in pairs}
    # what came next alone is joined, although others show more beside the best
    assert len(again) == joining.JOINED + 1
    assert missed.suspect.label in {item.suspect.label for item in again}
    best = min(pairs, key=lambda item: item.fitted.cost)
    assert best.fitted.hypothesis.labels == {DRAG.label, RIPPLE.label}
    assert best.suspect.label == RIPPLE.label
    assert first.fitted.typical > 1.1 > best.fitted.typical
    ripple = best.fitted.hypothesis.rescaled(best.fitted.z)[0].added[1].effect
    assert isinstance(ripple, hm.TorqueRipple)
    assert ripple.amplitude == pytest.approx(0.02, rel=0.1)


def test_a_parameter_is_joined_by_being_let_loose_and_nothing_is_joined_with_itself(simulator: Simulator) -> None:
    drag, parameter = alone(simulator, DRAG), inertia(simulator)
    with Team(1) as team:
        [beside_drag] = joined(team, simulator, drag, [drag, parameter])
        [beside_parameter] = joined(team, simulator, parameter, [parameter, drag])
        assert joined(team, simulator, drag, [drag]) == []
    for pair in (beside_drag, beside_parameter):
        assert pair.fitted.hypothesis.labels == {DRAG.label}
        assert set(pair.fitted.hypothesis.loose) == {"load_inertia"}
    assert beside_drag.suspect.law == PARAMETER
    assert beside_parameter.suspect.label == DRAG.label
    plain = Hypothesis(FACTORS)
    nothing = Found(Suspect(("none", ""), "none", (plain,), (plain,)), fit(simulator, plain, np.zeros(plain.size), steps=1))
    with Team(1) as team:
        assert joined(team, simulator, nothing, [drag]) == []
