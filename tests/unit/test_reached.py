"""Laws that show only beyond some distance begin at what their place reaches."""

from __future__ import annotations

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.ground import screen_from
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.reached import Reached, begun_near, reaches
from hdrive_mbs.diagnosis.simulator import Simulator
from models import rotor_bench
from tests.unit.rotor_bench_records import bench, compiled, factors, recorded

NAMES = ("youngs_modulus", "rotor_1_mass", "bearing_damping")
PLACE = "rotor_2"


@pytest.fixture(scope="module")
def free() -> dict[str, np.ndarray]:
    """What the bench measures without a rub."""
    return compiled("steps", 0.4)


@pytest.fixture(scope="module")
def farthest(free: dict[str, np.ndarray]) -> float:
    return float(np.max(np.hypot(free["r2_x"], free["r2_y"])))


def simulator_of(columns: dict[str, np.ndarray]) -> Simulator:
    return Simulator(bench().trials(recorded("steps", columns, noisy=True)), rotor_bench.STEP, 2)


def fitted_to(simulator: Simulator, steps: int) -> Fitted:
    hypothesis = Hypothesis(factors(*NAMES))
    return fit(simulator, hypothesis, np.zeros(hypothesis.size), steps=steps)


def rubbing(gap: float, base: Hypothesis) -> Hypothesis:
    rub = hm.Rub(gap=gap, stiffness=1e6, radius=0.1)
    return Hypothesis(base.factors, (Added(rub, PLACE, "rub"),))


def test_how_far_a_rotor_goes_is_what_its_probes_would_see_at_most(free: dict[str, np.ndarray], farthest: float) -> None:
    simulator = simulator_of(free)
    reached = Reached(simulator, fitted_to(simulator, 0))
    assert reached(PLACE) == pytest.approx(farthest, rel=5e-3)  # the record and the trial begin 31 nm apart, 4e-3 of it
    assert reached("section_1") == 0.0


def test_a_rub_begins_below_the_largest_distance_too(free: dict[str, np.ndarray], farthest: float) -> None:
    simulator = simulator_of(free)
    base = fitted_to(simulator, 0)
    starts = tuple(rubbing(gap, base.hypothesis) for gap in (1e-5, 1e-4))
    found = [item.added[-1].effect.gap for item in begun_near(starts, Reached(simulator, base))]
    assert found[:2] == [1e-5, 1e-4]
    assert found[2:] == pytest.approx([share * farthest for share in hm.Rub.reaches["gap"]], rel=5e-3)
    assert reaches(starts[0])
    assert not reaches(base.hypothesis)
    still = Hypothesis(base.hypothesis.factors, (Added(hm.Rub(gap=1e-5, stiffness=1e6, radius=0.1), "section_1", "rub"),))
    assert begun_near((still,), Reached(simulator, base)) == (still,)


def test_a_rub_that_hardly_touches_is_seen_from_there(farthest: float) -> None:
    rub = hm.Rub(gap=0.96 * farthest, stiffness=3e6, friction=0.1, radius=0.1)
    simulator = simulator_of(compiled("steps", 0.4, rotor_bench.build("steps").with_effect(rub, at=PLACE)))
    base = fitted_to(simulator, 5)
    known = tuple(rubbing(gap, base.hypothesis) for gap in hm.Rub.starts["gap"])
    screen = screen_from(simulator, base)
    before, after = screen.look(known), screen.look(begun_near(known, Reached(simulator, base)))
    assert before is not None
    assert after is not None
    planted = Hypothesis(base.hypothesis.factors, (Added(rub, PLACE, "rub"),))
    gain = base.cost - fit(simulator, planted, planted.start(base.z), steps=25).cost  # all that there is to be seen
    assert gain > 15.0
    assert before.cost > base.cost - 0.1  # a rotor that goes 7.8 um does not touch a ring with a gap of 10 um
    assert after.cost < base.cost - 0.5 * gain  # one step of a look, from another gap
