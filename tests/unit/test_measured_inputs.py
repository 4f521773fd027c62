"""Inputs as they were measured: held tables, motor torques, angles, and forces across the axis.

A free body adds up what pushes it, so momentum is the check: m v and J w are the area under the table.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.linalg import expm

import hdrive_mbs as hm
from hdrive_mbs.expression import gradient, record, variable
from hdrive_mbs.tables import EDGE, held
from tests.unit.law_checks import assert_records_itself

TIMES = (0.0, 0.001, 0.002, 0.004, 0.005)
VALUES = (2.0, -1.0, 5.0, 3.0, 0.0)
AREA = 0.001 * 2.0 + 0.001 * -1.0 + 0.002 * 5.0 + 0.001 * 3.0
"""Of the held values over the whole table."""
ALIGNED = 0.0005
"""A step that meets every time of the table [s]."""


def free_rotor(force: hm.LateralForce, *, offset: float = 0.0) -> hm.Scene:
    """A rotor that nothing holds, pushed at a distance along its axis."""
    parts: dict[str, hm.Component] = {"rotor": hm.Rotor(mass=2.5, polar_inertia=0.02, transverse_inertia=0.015), "hammer": force}
    if offset == 0.0:
        return hm.Scene(name="free", parts=parts, connections=[("hammer", "rotor")])
    parts["piece"] = hm.RigidSection(length=offset)
    return hm.Scene(name="free", parts=parts, connections=[("rotor", "piece", "hammer")])


# -- held tables ---------------------------------------------------------------------------------------


def test_a_held_table_keeps_each_value_until_the_next_time_and_its_edges_are_centred() -> None:
    edge = EDGE * 0.001
    for k, time in enumerate(TIMES):
        before = VALUES[max(k - 1, 0)]
        assert held(time - edge, TIMES, VALUES) == before
        assert held(time + edge, TIMES, VALUES) == VALUES[k]
        assert held(time, TIMES, VALUES) == pytest.approx(0.5 * (before + VALUES[k]), abs=1e-9)
    assert held(-1.0, TIMES, VALUES) == 2.0
    assert held(1.0, TIMES, VALUES) == 0.0


def test_a_held_table_records_itself() -> None:
    assert_records_itself(lambda time: held(time, TIMES, VALUES), np.random.default_rng(5).uniform(-0.001, 0.006, 300))


def test_a_held_table_is_recorded_once_for_the_same_tuples_and_read_anew_from_what_can_change() -> None:
    times, values = [0.0, 1.0, 2.0], [1.0, 2.0, 3.0]
    tables = [record(held(variable("t"), TIMES, VALUES)).data for _ in range(2)]
    assert tables[0] is tables[1]
    assert record(held(variable("t"), tuple(times), tuple(values))).data is not tables[0]
    assert held(1.5, times, values) == 2.0
    values[1] = 7.0
    assert held(1.5, times, values) == 7.0


# -- forces across the axis ----------------------------------------------------------------------------


@pytest.mark.parametrize("solver", [hm.RungeKutta4(step=ALIGNED), hm.Trapezoidal(step=ALIGNED)], ids=["explicit", "implicit"])
def test_a_free_rotor_takes_up_the_area_under_a_held_force_exactly_when_steps_meet_its_times(solver: hm.Solver) -> None:
    force = hm.LateralForce(times=TIMES, forces_x=VALUES, forces_y=tuple(-3.0 * value for value in VALUES), held=True)
    response = hm.simulate(free_rotor(force), 0.006, solver=solver)
    # rounding apart: the edges lie symmetrically about steps, and all rules are symmetric
    assert response["rotor.x_rate"].values[-1] == pytest.approx(AREA / 2.5, rel=1e-9)
    assert response["rotor.y_rate"].values[-1] == pytest.approx(-3.0 * AREA / 2.5, rel=1e-9)
    assert set(response.lowering.values()) <= {"native", "symbolic"}


def test_without_holding_the_force_runs_straight_between_its_points() -> None:
    response = hm.simulate(free_rotor(hm.LateralForce(times=TIMES, forces_y=VALUES)), 0.005, solver=hm.RungeKutta4(step=ALIGNED))
    assert response["rotor.y_rate"].values[-1] == pytest.approx(np.trapezoid(VALUES, TIMES) / 2.5, rel=1e-12)
    np.testing.assert_array_equal(response["rotor.x"].values, 0.0)
    np.testing.assert_allclose(response["hammer.force_y"].at(np.array(TIMES)), VALUES, atol=1e-12)
    assert "hammer.force_x" not in response


def test_a_force_away_from_the_centre_tilts_the_rotor() -> None:
    force = hm.LateralForce(times=TIMES, forces_x=VALUES, forces_y=VALUES, held=True)
    response = hm.simulate(free_rotor(force, offset=0.3), 0.006, solver=hm.RungeKutta4(step=ALIGNED))
    # a force at distance a along +z has the moments M_y = a F_x and M_x = -a F_y; tilts stay under 1e-4 rad
    assert response["rotor.theta_rate"].values[-1] == pytest.approx(0.3 * AREA / 0.015, rel=1e-6)
    assert response["rotor.psi_rate"].values[-1] == pytest.approx(-0.3 * AREA / 0.015, rel=1e-6)
    assert response["rotor.x_rate"].values[-1] == pytest.approx(AREA / 2.5, rel=1e-6)


def test_a_rotor_in_a_bearing_answers_a_sampled_blow_like_the_exact_oscillator() -> None:
    sample, stiffness, damping, mass = 2.5e-4, 4e6, 300.0, 2.5
    times = sample * np.arange(40)
    blow = np.where(times < 3e-3, 500.0 * np.sin(np.pi * times / 3e-3), 0.0)
    scene = hm.Scene(
        name="in a bearing",
        parts={
            "rotor": hm.Rotor(mass=mass, polar_inertia=0.02, transverse_inertia=0.015),
            "bearing": hm.Bearing(law=hm.LinearBearing.isotropic(radial=stiffness, damping=damping, axial=1e6, tilt=1e4)),
            "hammer": hm.LateralForce(times=tuple(times), forces_x=tuple(blow), held=True),
        },
        connections=[("rotor", "bearing"), ("hammer", "rotor")],
    )
    response = hm.simulate(scene, 40 * sample, solver=hm.RungeKutta4(step=sample / 10.0))
    # m x'' + d x' + k x = F_k held for a sample, from sample to sample by the matrix exponential
    rates = np.array([[0.0, 1.0, 0.0], [-stiffness / mass, -damping / mass, 1.0 / mass], [0.0, 0.0, 0.0]])
    moved, state, exact = expm(rates * sample), np.zeros(3), []
    for force in blow:
        exact.append(state[0])
        state[2] = force
        state = moved @ state
    # RK4 errs by (w h)^4/120 a radian, w = 1265 rad/s, over 12.6 rad: 1e-7; edges inside a step by their width, 1e-3/10 of h
    np.testing.assert_allclose(response["rotor.x"].at(times), exact, rtol=0.0, atol=1e-5 * np.max(np.abs(exact)))


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"times": TIMES}, "neither forces_x nor forces_y"),
        ({"times": TIMES, "forces_x": (1.0, 2.0)}, "5 times and 2 forces_x"),
        ({"times": (0.0, 1.0, 1.0), "forces_y": (1.0, 2.0, 3.0)}, r"times\[2\] = 1 s does not rise"),
        ({"times": (0.0, 1.0), "forces_y": (1.0, math.nan)}, r"forces_y\[1\] = nan N: must be a finite number"),
    ],
)
def test_a_bad_force_is_refused(fields: dict[str, tuple[float, ...]], message: str) -> None:
    with pytest.raises(hm.ParameterError, match=message):
        hm.LateralForce(**fields)


def test_a_force_on_what_cannot_move_is_refused() -> None:
    force = hm.LateralForce(times=TIMES, forces_x=VALUES)
    rotor = hm.Rotor(mass=2.5, polar_inertia=0.02, transverse_inertia=0.015)
    held_one = hm.Scene(name="held", parts={"rotor": rotor, "hammer": force}, connections=[("hammer", "ground"), ("rotor", "ground")])
    with pytest.raises(hm.SceneError, match=r"'hammer' pushes the ground"):
        held_one.network()
    turning = hm.Scene(name="turning", parts={"disc": hm.Inertia(inertia=0.1), "hammer": force}, connections=[("hammer", "disc")])
    with pytest.raises(hm.SceneError, match=r"no inertia \(0 kg\)"):
        turning.network()


# -- motor torque over time ----------------------------------------------------------------------------


@pytest.mark.parametrize("holding", [True, False])
def test_a_motor_turns_by_the_area_under_its_torque(holding: bool) -> None:
    history = hm.TorqueHistory(times=TIMES, torques=VALUES, held=holding)
    motor = hm.Motor(inertia=0.004, characteristic=history)
    scene = hm.Scene(name="motor", parts={"motor": motor, "disc": hm.Inertia(inertia=0.006)}, connections=[("motor", "disc")])
    response = hm.simulate(scene, 0.006, solver=hm.RungeKutta4(step=ALIGNED))
    area = AREA if holding else float(np.trapezoid(VALUES, TIMES))
    assert response["motor.speed"].values[-1] == pytest.approx(area / 0.01, rel=1e-9)


@pytest.mark.parametrize("holding", [True, False])
def test_a_torque_history_records_itself_and_does_not_look_at_the_speed(holding: bool) -> None:
    history = hm.TorqueHistory(times=TIMES, torques=VALUES, held=holding)
    times = np.random.default_rng(6).uniform(-0.001, 0.006, 300)
    assert_records_itself(lambda time: history.torque(time, 0.0), times)
    np.testing.assert_array_equal(history.torque(times, -50.0), history.torque(times, 80.0))


def test_a_bad_torque_history_is_refused() -> None:
    with pytest.raises(hm.ParameterError, match=r"TorqueHistory\.times\[1\] = 0 s does not rise above times\[0\] = 0 s"):
        hm.TorqueHistory(times=(0.0, 0.0), torques=(1.0, 1.0))


# -- angles over time ----------------------------------------------------------------------------------


def test_an_angle_table_is_a_natural_spline_counted_from_its_value_at_time_zero() -> None:
    times, angles = (-0.2, 0.1, 0.3, 0.6), (1.0, 2.0, 5.0, 4.0)
    motion = hm.AngleTable(times=times, angles=angles)
    spline = CubicSpline(times, angles, bc_type="natural")
    inside = np.linspace(-0.2, 0.6, 50)
    np.testing.assert_allclose(motion.angle(inside), spline(inside) - spline(0.0), atol=1e-13)
    acceleration = gradient(gradient(motion.angle))
    np.testing.assert_allclose(acceleration(inside), spline(inside, 2), atol=1e-11)
    # beyond the table it turns on at the speed of its end
    assert motion.angle(1.6) - motion.angle(0.6) == pytest.approx(float(spline(0.6, 1)), rel=1e-12)
    assert acceleration(np.array([1.6, -0.5])) == pytest.approx([0.0, 0.0])


def test_a_rotor_follows_its_measured_angle_through_a_shaft() -> None:
    times = np.linspace(0.0, 0.2, 81)
    motion = hm.AngleTable(times=tuple(times), angles=tuple(30.0 * times + 0.02 * np.sin(40.0 * times)))
    scene = hm.Scene(
        name="following",
        parts={
            "motor": hm.Motor(inertia=0.01, characteristic=hm.IdealSpeedMotor(motion=motion)),
            "shaft": hm.Shaft(stiffness=500.0, damping=0.1),
            "disc": hm.Inertia(inertia=0.02),
        },
        connections=[("motor", "shaft", "disc")],
    )
    start = {"disc.speed": float(motion.speed(0.0))}
    response = hm.simulate(scene, 0.2, solver=hm.RungeKutta4(step=1e-4), initial=start)
    np.testing.assert_allclose(response["motor.angle"].values, motion.angle(response.times), atol=1e-12)
    # J a'' = k (m - a) + d (m' - a') with the motion m as input: a step of RK4 errs by (w h)^5/120, w = 158 rad/s, 2000 steps: 2e-8
    disc, at = response["disc.angle"], response.times[10:-10]
    acceleration = response["disc.acceleration"].at(at)
    twist, rate = motion.angle(at) - disc.at(at), motion.speed(at) - response["disc.speed"].at(at)
    np.testing.assert_allclose(0.02 * acceleration, 500.0 * twist + 0.1 * rate, atol=1e-9)
