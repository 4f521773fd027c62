"""The adaptive solver does not step over what a table over time holds."""

from __future__ import annotations

import math

import pytest

import hdrive_mbs as hm
from hdrive_mbs.analysis.time_tables import for_tables, longest_step


def train(load: hm.LoadLaw) -> hm.Scene:
    """A free mass of 2 kg m^2 that the load alone moves."""
    return hm.Scene(
        name="free mass",
        parts={"motor": hm.Motor(inertia=0.5, characteristic=lambda w: 0.0 * w), "load": hm.Load(inertia=1.5, torque=load)},
        connections=[("motor", "load")],
    )


def triangle(start: float, width: float, peak: float = 200.0) -> hm.TableTorque:
    return hm.TableTorque(times=(0.0, start, start + width / 2, start + width), torques=(0.0, 0.0, peak, 0.0))


@pytest.mark.parametrize("width", [4e-3, 1e-3, 2e-4])
@pytest.mark.parametrize("start", [0.5031, 0.5047, 0.5062])
def test_a_pulse_much_shorter_than_the_longest_step_gives_its_whole_impulse(start: float, width: float) -> None:
    # J dw = -integral of the load torque = -peak * width / 2, whatever the solver's longest step of 10 ms
    response = hm.simulate(train(triangle(start, width)), 1.0)
    assert response["motor.speed"].values[-1] == pytest.approx(-200.0 * width / 2 / 2.0, rel=1e-3)


def test_the_step_is_half_the_time_over_three_neighbouring_points() -> None:
    assert longest_step(train(triangle(0.5, 2e-3)), 1.0) == pytest.approx(1e-3)
    assert longest_step(train(hm.TableTorque(times=(0.0, 0.1, 0.3), torques=(0.0, 1.0, 0.0))), 1.0) == pytest.approx(0.15)


def test_a_steep_edge_sets_no_limit_but_a_pulse_of_two_edges_does() -> None:
    edge = hm.TableTorque(times=(0.0, 0.5, 0.5 + 1e-9, 1.0), torques=(0.0, 0.0, 5.0, 5.0))
    pulse = hm.TableTorque(times=(0.0, 0.5, 0.5 + 1e-9, 0.502, 0.502 + 1e-9, 1.0), torques=(0.0, 0.0, 5.0, 5.0, 0.0, 0.0))
    assert longest_step(train(edge), 1.0) == pytest.approx(0.25)
    assert longest_step(train(pulse), 1.0) == pytest.approx(1e-3)


def test_a_repeating_table_counts_its_seam_and_all_its_points() -> None:
    # over the seam the points are 2.99, 3.0, 3.02 s
    law = hm.TableTorque(times=(0.0, 0.02, 2.99, 3.0), torques=(0.0, 1.0, 1.0, 0.0), periodic=True)
    assert longest_step(train(law), 1.0) == pytest.approx((0.01 + 0.02) / 2)


def test_points_after_the_end_of_the_run_set_no_limit() -> None:
    assert longest_step(train(triangle(5.0, 1e-3)), 1.0) == pytest.approx((5.0 + 5e-4) / 2)


def test_without_a_table_over_time_the_solver_stays_as_it_is() -> None:
    scene = train(hm.ConstantTorque(value=1.0))
    solver = hm.DormandPrince()
    assert longest_step(scene, 1.0) == math.inf
    assert for_tables(solver, scene, 1.0) is solver


def test_a_shorter_step_of_the_user_and_a_constant_step_stay() -> None:
    scene = train(triangle(0.5, 2e-3))
    for solver in (hm.DormandPrince(max_step=1e-4), hm.RungeKutta4(step=5e-3)):
        assert for_tables(solver, scene, 1.0) is solver
