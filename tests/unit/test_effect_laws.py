"""The laws of the effects against closed forms and hand integrals."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hdrive_mbs.analysis.time_response import Response, simulate
from hdrive_mbs.components.harmonic_drive import HarmonicDrive
from hdrive_mbs.components.inertia import Inertia
from hdrive_mbs.components.load import Load
from hdrive_mbs.components.motor import Motor
from hdrive_mbs.components.shaft import Shaft
from hdrive_mbs.conversions import rpm
from hdrive_mbs.effects.bouc_wen_hysteresis import BoucWenHysteresis
from hdrive_mbs.effects.coulomb_stribeck_friction import CoulombStribeckFriction
from hdrive_mbs.effects.coupling_backlash import CouplingBacklash
from hdrive_mbs.effects.eccentric_load import EccentricLoad
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.effects.kinematic_error import KinematicError
from hdrive_mbs.effects.lugre_friction import LuGreFriction
from hdrive_mbs.effects.maxwell_slip_hysteresis import MaxwellSlipHysteresis
from hdrive_mbs.effects.mesh_friction import MeshFriction
from hdrive_mbs.effects.quadratic_drag import QuadraticDrag
from hdrive_mbs.effects.torque_ripple import TorqueRipple
from hdrive_mbs.effects.viscous_drag import ViscousDrag
from hdrive_mbs.engine.solvers import DormandPrince
from hdrive_mbs.errors import ParameterError, PlaceError
from hdrive_mbs.loads.constant import ConstantTorque
from hdrive_mbs.motors.asynchronous import AsynchronousMotor
from hdrive_mbs.network.elements import Connection
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network
from hdrive_mbs.scene import Scene

TIGHT = DormandPrince(relative_tolerance=1e-10, absolute_tolerance=1e-12, max_step=1e-3)


def wheel(inertia: float, effect: Effect, torque: float = 0.0) -> Scene:
    """One inertia with a constant driving torque and an effect."""
    part = Load(inertia=inertia, torque=ConstantTorque(value=-torque))
    return Scene(name="wheel", parts={"wheel": part}, connections=[]).with_effect(effect, at="wheel", name="it")


def drive(*, ratio: float = 50.0, motor_torque: Callable[..., object] = lambda speed: 0.0 * speed, load_torque: float = 0.0) -> Scene:
    """Motor, gear with a straight spring, load: no shafts, no losses."""
    return Scene(
        name="drive",
        parts={
            "motor": Motor(inertia=1e-3, characteristic=motor_torque),
            "gear": HarmonicDrive(ratio=ratio, stiffness=lambda twist: 1e4 * twist, damping=20.0),
            "load": Load(inertia=0.5, torque=ConstantTorque(value=load_torque)),
        },
        connections=[("motor", "gear", "load")],
    )


def moment_of(network: Network, angles: dict[str, float], speeds: dict[str, float]) -> Moment:
    return network.moment(0.0, angles, speeds, {state.name: 0.0 for state in network.states})


def final(response: Response, channel: str) -> float:
    return float(response[channel].values[-1])


# -- drags --------------------------------------------------------------------------------------------


def test_viscous_drag_coasts_down_exponentially() -> None:
    response = simulate(wheel(0.2, ViscousDrag(coefficient=0.5)), 1.0, solver=TIGHT, initial={"wheel.speed": 30.0})
    # J dw/dt = -c w
    expected = 30.0 * np.exp(-0.5 / 0.2 * response.times)
    np.testing.assert_allclose(response["wheel.speed"].values, expected, rtol=1e-8)


@pytest.mark.parametrize("start", [30.0, -30.0])
def test_quadratic_drag_coasts_down_hyperbolically(start: float) -> None:
    response = simulate(wheel(0.2, QuadraticDrag(coefficient=0.03)), 1.0, solver=TIGHT, initial={"wheel.speed": start})
    # J dw/dt = -c |w| w  gives  w = w0/(1 + c |w0| t/J)
    expected = start / (1.0 + 0.03 * abs(start) / 0.2 * response.times)
    np.testing.assert_allclose(response["wheel.speed"].values, expected, rtol=1e-8)


# -- dry friction -----------------------------------------------------------------------------------------


def test_stribeck_friction_falls_from_breakaway_to_sliding_torque() -> None:
    law = CoulombStribeckFriction(coulomb=5.0, breakaway=8.0, stribeck_speed=0.1, smoothing_speed=1e-4)
    # tanh(10) = 1 - 4e-9; at w_S the drop is 3 N m/e
    np.testing.assert_allclose(-law.torque(0.0, 0.0, np.array([1e-3, 0.1, 10.0])), [8.0, 5.0 + 3.0 / math.e, 5.0], rtol=1e-4)
    np.testing.assert_array_equal(law.torque(0.0, 0.0, np.array([-0.3, 0.0])), [-law.torque(0.0, 0.0, 0.3), 0.0])


def test_breakaway_below_sliding_torque_is_refused() -> None:
    for kind, more in ((CoulombStribeckFriction, {}), (LuGreFriction, {"stiffness": 1e3})):
        with pytest.raises(ParameterError, match=r"breakaway = 3 N m is below coulomb = 5 N m"):
            kind(coulomb=5.0, breakaway=3.0, **more)


@pytest.mark.parametrize("speed", [-2.0, -0.05, 0.01, 0.1, 3.0])
def test_lugre_friction_slides_on_the_stribeck_curve(speed: float) -> None:
    law = LuGreFriction(coulomb=5.0, breakaway=8.0, stribeck_speed=0.1, stiffness=2e3, damping=5.0, viscous=2.0)
    stribeck = 5.0 + 3.0 * math.exp(-((speed / 0.1) ** 2))
    # the bristle settles as exp(-s_0 |w| t/g): 40 time constants leave nothing
    settled = 40.0 * stribeck / (2e3 * abs(speed))
    bristle = solve_ivp(
        lambda t, y: [law.state_rate("bristle_torque", t, 0.0, speed, {"bristle_torque": y[0]})],
        (0.0, settled),
        [0.0],
        rtol=1e-10,
        atol=1e-12,
        method="LSODA",
    ).y[0, -1]
    sliding = -law.torque(0.0, 0.0, speed, {"bristle_torque": bristle})
    assert sliding == pytest.approx(math.copysign(stribeck, speed) + 2.0 * speed, rel=1e-8)


def test_lugre_friction_builds_up_as_dahl_found() -> None:
    # without a Stribeck drop  dy/dx = s_0 (1 - y/T_C)  gives  y = T_C (1 - exp(-s_0 x/T_C))
    law = LuGreFriction(coulomb=5.0, stiffness=2e3)
    speed, time = 0.02, np.linspace(0.0, 0.5, 50)
    bristle = solve_ivp(
        lambda t, y: [law.state_rate("bristle_torque", t, 0.0, speed, {"bristle_torque": y[0]})],
        (0.0, 0.5),
        [0.0],
        t_eval=time,
        rtol=1e-11,
        atol=1e-12,
    ).y[0]
    np.testing.assert_allclose(bristle, 5.0 * (1.0 - np.exp(-2e3 * speed * time / 5.0)), atol=1e-8)


def test_lugre_friction_holds_where_regularised_friction_creeps() -> None:
    push = 2.5  # half of the sliding torque of 5 N m
    lugre = simulate(wheel(0.1, LuGreFriction(coulomb=5.0, stiffness=2e3, damping=10.0), push), 2.0, solver=TIGHT)
    smooth = simulate(wheel(0.1, CoulombStribeckFriction(coulomb=5.0, smoothing_speed=0.01), push), 2.0, solver=TIGHT)
    half = np.searchsorted(lugre.times, 1.0)
    held = lugre["wheel.angle"].values[half:]
    # bristles bent by about 2.5 N m/(2e3 N m/rad) stay where they are, to the accuracy of the solver, and carry the push
    assert np.ptp(held) < 1e-8
    assert final(lugre, "it.bristle_torque") == pytest.approx(push, rel=1e-6)
    # T = T_C tanh(w/w_0)  gives the speed of creep
    assert final(smooth, "wheel.speed") == pytest.approx(0.01 * math.atanh(push / 5.0), rel=1e-6)


def test_lugre_friction_breaks_away_above_its_breakaway_torque() -> None:
    law = LuGreFriction(coulomb=5.0, breakaway=8.0, stribeck_speed=0.1, stiffness=2e3, damping=10.0)
    below, above = (simulate(wheel(0.1, law, push), 1.0, solver=TIGHT) for push in (4.9, 8.5))
    # above: the Stribeck drop is gone in no time, then dw/dt = (8.5 - 5)/0.1
    assert abs(final(below, "wheel.speed")) < 1e-6
    assert final(above, "wheel.speed") == pytest.approx(35.0, rel=0.05)


def test_fading_bristle_damping_keeps_the_passivity_that_a_constant_one_loses() -> None:
    law = LuGreFriction(coulomb=1.0, breakaway=4.0, stribeck_speed=0.1, stiffness=1e3, damping=50.0)
    speed, bristle = 0.3, 4.0  # just broken away: the bristle still holds T_S, the sliding torque has dropped
    sliding = 1.0 + 3.0 * math.exp(-9.0)
    deflection_rate = speed - speed * bristle / sliding
    stored = bristle * deflection_rate

    def heat(drag: float) -> float:
        return drag * speed - stored

    assert heat(bristle + 50.0 * deflection_rate) < 0.0  # constant s_1
    assert heat(-law.torque(0.0, 0.0, speed, {"bristle_torque": bristle})) > 0.0


def test_lugre_friction_without_sliding_torque_is_viscous_drag() -> None:
    law = LuGreFriction(coulomb=0.0, stiffness=1e3, damping=5.0, viscous=2.0)
    assert not law.states()
    assert law.torque(0.0, 0.0, 3.0, {}) == -6.0
    with pytest.raises(ParameterError, match="coulomb = 0 N m with breakaway = 2 N m"):
        LuGreFriction(coulomb=0.0, breakaway=2.0, stiffness=1e3)


# -- mesh friction ------------------------------------------------------------------------------------------


def kloss() -> AsynchronousMotor:
    return AsynchronousMotor(rated_power=550.0, rated_speed=rpm(1410), pole_pairs=2, breakdown_ratio=2.4)


@pytest.mark.parametrize(("load", "efficiency"), [(100.0, 1.0 / 1.3), (-100.0, 1.0 - 0.3)])
def test_mesh_friction_takes_its_share_in_both_senses_of_power(load: float, efficiency: float) -> None:
    scene = drive(motor_torque=kloss(), load_torque=load).with_effect(MeshFriction(loss_factor=0.3), at="gear", name="it")
    response = simulate(scene, 1.0, solver=TIGHT, initial_speed=rpm(1500))
    motor_power = final(response, "motor.torque") * final(response, "motor.speed")
    load_power = load * abs(final(response, "load.speed"))
    assert math.copysign(1.0, motor_power) == math.copysign(1.0, load)
    measured = load_power / motor_power if load > 0.0 else motor_power / load_power
    # steady: the slowest decay is that of the gear's mode, 20/(2 * 0.417) = 24 1/s on the reduced inertia
    # 0.5 * 2.5/3 kg m^2, so exp(-24) = 4e-11 of the start is left
    assert measured == pytest.approx(efficiency, rel=1e-8)


def test_mesh_friction_takes_the_ratio_from_the_gear() -> None:
    for ratio in (30.0, 160.0):
        scene = drive(ratio=ratio).with_effect(MeshFriction(loss_factor=0.25, no_load=0.04), at="gear", name="it")
        network = scene.network()
        turned = {"motor": 0.0, "load": -2e-3}  # twist 2e-3 rad, 20 N m through the spring
        speeds = {"motor": 50.0, "load": 50.0 / ratio}
        (channel,) = (item for item in network.channels if item.name == "it.torque")
        torque = float(channel.read(moment_of(network, turned, speeds)))
        assert torque == pytest.approx(-(0.04 + 0.25 * 20.0 / ratio), rel=1e-12)  # tanh(100) = 1


def differential() -> Scene:
    """A drive whose circular spline can turn, on a spring to the ground."""
    return Scene(
        name="differential",
        parts={
            "motor": Motor(inertia=1e-3, characteristic=lambda speed: 0.0 * speed),
            "gear": HarmonicDrive(ratio=50.0, stiffness=lambda twist: 1e4 * twist, circular_spline_inertia=1e-2),
            "load": Load(inertia=0.5, torque=ConstantTorque(value=0.0)),
            "mount": Shaft(stiffness=1e5, damping=1.0),
        },
        connections=[("motor", "gear", "load"), ("gear.circular_spline", "mount", "ground")],
    )


def test_mesh_friction_reacts_on_the_circular_spline() -> None:
    network = differential().with_effect(MeshFriction(loss_factor=0.2, no_load=0.1), at="gear", name="it").network()
    (element,) = (item for item in network.elements if item.name == "it")
    sense = {body.name: body.sense for body in network.bodies}
    angles = {"motor": 3.0, "load": 0.058, "gear.circular_spline": 1e-3}
    speeds = {"motor": 20.0, "load": 0.4, "gear.circular_spline": -0.7}
    torque = element.contribution(moment_of(network, angles, speeds))
    assert set(torque) == {"motor", "gear.circular_spline"}
    assert torque["motor"] < -0.1
    # no torque from outside: the true-sense torques of an internal friction sum to zero
    assert sum(sense[name] * value for name, value in torque.items()) == 0.0
    # all turning as one rigid piece: nothing slides
    true = 5.0
    rigid = {name: s * true for name, s in sense.items()}
    assert set(element.contribution(moment_of(network, angles, rigid)).values()) == {0.0}


# -- kinematic error -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("order", [2.0, 4.0])
def test_kinematic_error_shows_at_its_order_with_the_resonance_of_the_train(order: float) -> None:
    amplitude, phase, speed, ratio, stiffness, inertia = 3e-4, 0.7, 20.0, 50.0, 1e4, 0.5
    scene = Scene(
        name="unloaded",
        parts={
            "motor": Motor(inertia=1e4, characteristic=lambda speed: 0.0 * speed),  # a flywheel: its speed stays
            "gear": HarmonicDrive(ratio=ratio, stiffness=lambda twist: stiffness * twist),
            "load": Load(inertia=inertia, torque=ConstantTorque(value=0.0)),
        },
        connections=[("motor", "gear", "load")],
    ).with_effect(KinematicError(amplitude=amplitude, order=order, phase=phase), at="gear")
    # J q'' = K (w t/u + A sin(n w t + p) - q)  has the steady solution
    # q = w t/u + A/(1 - (n w)^2 J/K) sin(n w t + p); start on it
    grown = amplitude / (1.0 - (order * speed) ** 2 * inertia / stiffness)
    start = {
        "motor.speed": speed,
        "load.angle": -grown * math.sin(phase),  # the output turns backwards
        "load.speed": -(speed / ratio + grown * order * speed * math.cos(phase)),
    }
    response = simulate(scene, 0.5, solver=TIGHT, initial=start)
    error = -response["load.angle"].values - response["motor.angle"].values / ratio
    expected = grown * np.sin(order * speed * response.times + phase)
    # the flywheel gives way: a torque below K A/u = 0.06 N m on 1e4 kg m^2 for 0.5 s turns it by less than 1e-6 rad,
    # 2e-8 rad at the output
    np.testing.assert_allclose(error, expected, atol=2e-8)
    assert np.ptp(response["kinematic_error.error"].values) == pytest.approx(2.0 * amplitude, rel=1e-4)


def test_kinematic_error_follows_the_true_angle_of_the_flange() -> None:
    amplitude, order, phase = 1e-3, 3.0, 0.4
    for follows, true_angle in (("wave_generator", 1.7), ("flexspline", -0.6)):  # forward angle of the load +0.6
        scene = drive().with_effect(KinematicError(amplitude=amplitude, order=order, phase=phase, follows=follows), at="gear")
        network = scene.network()
        moment = moment_of(network, {"motor": 1.7, "load": 0.6}, {"motor": 0.0, "load": 0.0})
        expected = 1.7 / 50.0 - 0.6 + amplitude * math.sin(order * true_angle + phase)
        assert network.connection("gear").stretch(moment) == pytest.approx(expected, rel=1e-13)


def test_kinematic_error_counts_the_angle_from_the_circular_spline() -> None:
    bare = differential().network()
    network = differential().with_effect(KinematicError(amplitude=1e-3, order=2.0, phase=0.3), at="gear").network()
    sense = {body.name: body.sense for body in network.bodies}

    def error(angles: dict[str, float]) -> float:
        moment = moment_of(network, angles, dict.fromkeys(angles, 0.0))
        return float(network.connection("gear").stretch(moment) - bare.connection("gear").stretch(moment))

    turned = {"motor": 0.9, "load": 0.02, "gear.circular_spline": 0.1}
    # the whole drive turned by one radian in true sense: the same teeth meet
    together = {name: value + sense[name] * 1.0 for name, value in turned.items()}
    relative = sense["motor"] * 0.9 - sense["gear.circular_spline"] * 0.1
    assert error(turned) == pytest.approx(1e-3 * math.sin(2.0 * relative + 0.3), rel=1e-9)
    assert error(together) == pytest.approx(error(turned), rel=1e-9)


def test_kinematic_error_acts_back_on_the_wave_generator() -> None:
    network = drive().with_effect(KinematicError(amplitude=1e-3, order=2.0), at="gear").network()
    gear = network.connection("gear")
    moment = moment_of(network, {"motor": 0.3, "load": -5e-3}, {"motor": 7.0, "load": 0.1})
    torque = gear.value(moment)
    # dx/dq of the wave generator is 1/u + A n cos(n q)
    assert gear.contribution(moment)["motor"] == pytest.approx(-torque * (1.0 / 50.0 + 2e-3 * math.cos(0.6)), rel=1e-12)
    assert gear.contribution(moment)["load"] == pytest.approx(torque, rel=1e-12)


@pytest.mark.parametrize("build", [drive, differential])
def test_effects_of_a_gear_leave_its_reactions_in_balance(build: Callable[[], Scene]) -> None:
    scene = (
        build()
        .with_effect(KinematicError(amplitude=1e-3), at="gear")
        .with_effect(BoucWenHysteresis(torque_limit=3.0, yield_twist=1e-3), at="gear")
        .with_effect(MeshFriction(loss_factor=0.2, no_load=0.1), at="gear")
    )
    network = scene.network()
    moving = {"motor": 0.31, "load": 4e-3, "gear.circular_spline": 2e-4}
    angles = {body.name: moving[body.name] for body in network.bodies}
    speeds = {body.name: 10.0 * moving[body.name] for body in network.bodies}
    moment = network.moment(0.0, angles, speeds, {"bouc_wen_hysteresis.z": 0.6})
    sense = {body.name: body.sense for body in network.bodies} | {"ground": 1}
    ring = "gear.circular_spline" if "gear.circular_spline" in sense else "ground"
    for element, channel in (("gear", "gear.housing_torque"), ("mesh_friction", "mesh_friction.housing_torque")):
        (found,) = (item for item in network.elements if item.name == element)
        torque = {name: sense[name] * value for name, value in found.contribution(moment).items()}
        assert abs(torque[ring]) > 0.01
        # what a gear puts on its three flanges sums to zero in true sense
        assert abs(sum(torque.values())) < 1e-13 * sum(map(abs, torque.values()))
        (read,) = (item.read for item in network.channels if item.name == channel)
        assert read(moment) == pytest.approx(torque[ring], rel=1e-13)


@pytest.mark.parametrize("effect", [KinematicError(amplitude=1e-4), MeshFriction(loss_factor=0.1)])
def test_effects_of_a_gear_refuse_a_shaft_and_name_the_gears(effect: Effect) -> None:
    with pytest.raises(PlaceError, match=r"'mount' has a, b\. Such connections: gear, gear\.mesh\."):
        differential().with_effect(effect, at="mount")


def test_kinematic_error_refuses_an_unknown_flange() -> None:
    with pytest.raises(ParameterError, match="must be 'wave_generator' or 'flexspline'"):
        KinematicError(amplitude=1e-4, follows="output")


# -- hysteresis ------------------------------------------------------------------------------------------------


def bouc_wen_path(law: BoucWenHysteresis, turning_points: list[float], speed: float) -> tuple[np.ndarray, np.ndarray]:
    """Twist and torque along straight strokes at a speed."""
    twist, torque, z, here = [], [], 0.0, 0.0
    for target in turning_points:
        rate = math.copysign(speed, target - here)
        time = np.linspace(0.0, abs(target - here) / speed, 4001)
        solution = solve_ivp(
            lambda t, y, rate=rate: [law.state_rate("z", t, 0.0, rate, {"z": y[0]})],
            (0.0, time[-1]),
            [z],
            t_eval=time,
            rtol=1e-11,
            atol=1e-13,
        )
        twist.append(here + rate * time)
        torque.append(law.torque(0.0, 0.0, rate, {"z": solution.y[0]}))
        z, here = float(solution.y[0, -1]), target
    return np.concatenate(twist), np.concatenate(torque)


@pytest.mark.parametrize("speed", [1e-3, 10.0])
def test_bouc_wen_loop_has_the_area_of_the_hand_integral_at_every_speed(speed: float) -> None:
    limit, width, top = 6.0, 2e-4, 0.9
    law = BoucWenHysteresis(torque_limit=limit, yield_twist=width, exponent=1.0, shape=0.5, fastest_rate=1e9)
    # n = 1, b = 1/2, rising twist:  dx = x_y dz for z < 0  and  dx = x_y dz/(1 - z) for z > 0, so the loop between
    # -z_m and z_m spans 2 a = x_y (z_m - ln(1 - z_m)) and  area = 2 T_h x_y (-z_m - ln(1 - z_m) - z_m^2/2)
    half = 0.5 * width * (top - math.log(1.0 - top))
    area = 2.0 * limit * width * (-top - math.log(1.0 - top) - 0.5 * top**2)
    twist, torque = bouc_wen_path(law, [*[half, -half] * 6, half, -half, half], speed)
    loop_twist, loop_torque = twist[-8002:], torque[-8002:]
    assert np.max(loop_torque) == pytest.approx(limit * top, rel=1e-6)
    # trapezoidal rule on 4000 intervals per stroke: error of the order of 1e-7
    assert np.trapezoid(loop_torque, loop_twist) == pytest.approx(area, rel=1e-5)


def test_bouc_wen_starts_with_its_stiffness_and_ends_at_its_limit() -> None:
    law = BoucWenHysteresis(torque_limit=6.0, yield_twist=2e-4, exponent=3.0, shape=0.8, fastest_rate=1e9)
    twist, torque = bouc_wen_path(law, [4e-3], 1.0)
    # dT/dx = T_h/x_y at z = 0; 20 yield twists saturate to exp(-60)
    assert torque[1] / twist[1] == pytest.approx(6.0 / 2e-4, rel=1e-5)
    assert torque[-1] == pytest.approx(6.0, rel=1e-9)


def test_bouc_wen_that_would_not_be_passive_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"shape = 0\.4: must be at least 0\.5"):
        BoucWenHysteresis(torque_limit=6.0, yield_twist=2e-4, shape=0.4)


STEP = 2.0**-20
"""Twist step [rad]: with powers of two every element reaches its limit exactly, so Euler's rule makes no error."""
STIFFNESS = (2.0**15, 2.0**14, 2.0**13)
LIMITS = (4.0, 6.0, 8.0)


def maxwell_path(law: MaxwellSlipHysteresis, turning_points: list[float]) -> tuple[np.ndarray, np.ndarray]:
    """Twist and torque in quasi-static steps of STEP from a twist of zero."""
    state = dict.fromkeys(law.states(), 0.0)
    twist, torque, here = [0.0], [0.0], 0.0
    for target in turning_points:
        step = math.copysign(STEP, target - here)
        for _ in range(round(abs(target - here) / STEP)):
            rates = {name: law.state_rate(name, 0.0, here, step, state) for name in state}
            state = {name: float(state[name] + rates[name]) for name in state}  # rate * time with time 1
            here += step
            twist.append(here)
            torque.append(float(law.torque(0.0, here, step, state)))
    return np.array(twist), np.array(torque)


def virgin(twist: np.ndarray) -> np.ndarray:
    """Torque on first loading: sum(min(k_i x, L_i))."""
    return np.sum([np.minimum(k * twist, limit) for k, limit in zip(STIFFNESS, LIMITS, strict=True)], axis=0)


def test_maxwell_slip_obeys_masing_exactly() -> None:
    law = MaxwellSlipHysteresis(stiffness=STIFFNESS, torque_limit=LIMITS, rounding=0.0)
    top = 700 * STEP
    twist, torque = maxwell_path(law, [top, -top, top])
    first, second, third = slice(0, 701), slice(700, 2101), slice(2100, 3501)
    np.testing.assert_array_equal(torque[first], virgin(twist[first]))
    # Masing: from a turning point on, the virgin curve doubled
    np.testing.assert_array_equal(torque[second], torque[700] - 2.0 * virgin((top - twist[second]) / 2.0))
    np.testing.assert_array_equal(torque[third], torque[2100] + 2.0 * virgin((twist[third] + top) / 2.0))
    assert torque[3500] == torque[700]
    # the third element has not slipped: it would at 8/2^13 = 1024 steps
    assert abs(torque[700]) < sum(LIMITS)


def test_maxwell_slip_closes_inner_loops_and_forgets_them() -> None:
    law = MaxwellSlipHysteresis(stiffness=STIFFNESS, torque_limit=LIMITS, rounding=0.0)
    top, inner = 900 * STEP, 300 * STEP
    straight = maxwell_path(law, [top, -top])[1]
    detour = maxwell_path(law, [top, inner, inner + 200 * STEP, inner, -top])[1]
    # back at the start of the inner loop the torque is as before, and the path goes on as if it had not been
    np.testing.assert_array_equal(detour[-(1200 + 1) :], straight[-(1200 + 1) :])


def test_maxwell_slip_loses_the_area_of_its_sliders() -> None:
    law = MaxwellSlipHysteresis(stiffness=STIFFNESS, torque_limit=LIMITS, rounding=0.0)
    top = 3000 * STEP
    twist, torque = maxwell_path(law, [top, -top, top])
    # each slider slips by 2 (2 a - 2 L/k) per cycle against L
    area = sum(4.0 * limit * (top - limit / k) for k, limit in zip(STIFFNESS, LIMITS, strict=True))
    assert np.trapezoid(torque[3000:], twist[3000:]) == pytest.approx(area, rel=1e-12)


def test_rounded_maxwell_slip_stays_within_its_rounding_of_the_sharp_law() -> None:
    sharp = MaxwellSlipHysteresis(stiffness=STIFFNESS, torque_limit=LIMITS, rounding=0.0)
    points = [900 * STEP, -700 * STEP, 800 * STEP]
    exact = maxwell_path(sharp, points)[1]
    for rounding in (0.2, 0.1):
        difference = np.abs(maxwell_path(sharp.replacing(rounding=rounding), points)[1] - exact)
        assert 0.0 < difference.max() < rounding * sum(LIMITS)


def test_maxwell_slip_needs_pairs_of_stiffness_and_limit() -> None:
    with pytest.raises(ParameterError, match="2 values of stiffness and 1 of torque_limit"):
        MaxwellSlipHysteresis(stiffness=(1.0, 2.0), torque_limit=(1.0,))
    with pytest.raises(ParameterError, match="at least one"):
        MaxwellSlipHysteresis(stiffness=(), torque_limit=())


# -- backlash ---------------------------------------------------------------------------------------------------


def straight_law(twist: np.ndarray, rate: np.ndarray) -> np.ndarray:
    return 200.0 * twist + 0.5 * rate


def test_backlash_is_as_wide_as_said_in_a_torque_twist_sweep() -> None:
    torque = CouplingBacklash(backlash=0.01).changed(straight_law)
    twist = np.linspace(-0.02, 0.02, 40001)
    swept = torque(twist, 0.0 * twist)
    free = twist[swept == 0.0]
    assert np.ptp(free) == pytest.approx(0.01, abs=2e-6)  # two steps of the sweep
    np.testing.assert_allclose(swept[twist > 0.005], 200.0 * (twist[twist > 0.005] - 0.005), atol=1e-12)
    np.testing.assert_allclose(swept, -swept[::-1], atol=1e-12)


def test_backlash_damps_in_contact_only_and_never_pulls() -> None:
    torque = CouplingBacklash(backlash=0.01).changed(straight_law)
    assert torque(0.004, 3.0) == 0.0  # in the gap
    assert torque(0.006, 3.0) == pytest.approx(200.0 * 0.001 + 1.5)  # closing
    assert torque(0.006, -3.0) == 0.0  # separating faster than the spring follows: 0.2 - 1.5 < 0
    assert torque(-0.006, 3.0) == 0.0
    assert torque(-0.006, -3.0) == pytest.approx(-1.7)


def test_no_backlash_is_the_law_itself() -> None:
    assert CouplingBacklash(backlash=0.0).changed(straight_law) is straight_law


def test_coupling_with_backlash_transmits_nothing_in_its_gap() -> None:
    scene = differential().with_effect(CouplingBacklash(backlash=0.004), at="mount")
    response = simulate(scene, 0.2, initial={"gear.circular_spline.speed": 1.0})
    twist, torque = response["mount.twist"].values, response["mount.torque"].values
    assert np.max(np.abs(twist)) > 0.002
    assert (torque[np.abs(twist) <= 0.002] == 0.0).all()
    assert (torque * twist >= 0.0).all()


# -- ripple and weight ----------------------------------------------------------------------------------------------


def test_torque_ripple_has_its_order_in_the_angle_and_grows_with_the_motor_torque() -> None:
    scene = drive(motor_torque=kloss()).with_effect(TorqueRipple(amplitude=0.2, relative=0.1, order=6.0, phase=0.3), at="motor", name="it")
    response = simulate(scene, 0.1, initial_speed=20.0)
    angle, motor = response["motor.angle"].values, response["motor.torque"].values
    np.testing.assert_allclose(response["it.torque"].values, (0.2 + 0.1 * motor) * np.sin(6.0 * angle + 0.3), atol=1e-12)
    assert np.ptp(motor) > 1.0


def test_torque_ripple_in_proportion_needs_a_motor_torque() -> None:
    with pytest.raises(PlaceError, match=r"'gear\.wave_generator' has none\. Such parts: motor, load"):
        drive().with_effect(TorqueRipple(relative=0.1, order=6.0), at="gear.wave_generator")


def test_eccentric_load_rests_where_statics_says_on_a_body_that_turns_backwards() -> None:
    # the load torque R resists forward rotation, and forward is backwards here: it pushes the load in true
    # positive sense until  m g r sin(a + a_0) = R
    mass, radius, start, push = 4.0, 0.3, 0.2, 7.0
    scene = drive(load_torque=push).with_effect(EccentricLoad(mass=mass, radius=radius, start_angle=start), at="load")
    # critically damped: inertia 0.5 + 50^2 * 1e-3 = 3 kg m^2, stiffness m g r cos(0.64) = 9.4 N m/rad, c = 2 sqrt(3 * 9.4);
    # after 15 s exp(-1.77 * 15) (1 + 1.77 * 15) = 1e-10 of the swing is left
    scene = scene.with_effect(ViscousDrag(coefficient=10.6), at="load")
    response = simulate(scene, 15.0, solver=TIGHT)
    expected = math.asin(push / (mass * 9.80665 * radius)) - start
    assert expected > 0.4
    assert final(response, "load.angle") == pytest.approx(expected, abs=1e-7)


def test_eccentric_load_swings_as_a_pendulum() -> None:
    mass, radius, inertia = 2.0, 0.25, 0.2
    arm = Scene(name="arm", parts={"arm": Inertia(inertia=inertia)}, connections=[]).with_effect(
        EccentricLoad(mass=mass, radius=radius), at="arm"
    )
    response = simulate(arm, 3.0, solver=TIGHT, initial={"arm.angle": 1e-4})
    # small swings: w^2 = m g r/J (to 1 part in (1e-4)^2/16)
    frequency = math.sqrt(mass * 9.80665 * radius / inertia)
    np.testing.assert_allclose(response["arm.angle"].values, 1e-4 * np.cos(frequency * response.times), atol=1e-10)
    # large swings: J w^2/2 - m g r cos(a) stays
    high = simulate(arm, 3.0, solver=TIGHT, initial={"arm.angle": 2.5})
    energy = 0.5 * inertia * high["arm.speed"].values ** 2 - mass * 9.80665 * radius * np.cos(high["arm.angle"].values)
    np.testing.assert_allclose(energy, energy[0], rtol=1e-8)


def test_eccentric_load_on_held_ground_is_refused() -> None:
    with pytest.raises(PlaceError, match="held by the ground"):
        drive().with_effect(EccentricLoad(mass=1.0, radius=0.1), at="gear.circular_spline")


def test_effects_add_up_at_one_connection() -> None:
    # hysteresis beside, backlash inside, kinematic error on the twist: 4 states and two bodies stay symbolic
    scene = (
        drive(motor_torque=kloss(), load_torque=5.0)
        .with_effect(MaxwellSlipHysteresis(stiffness=(3e4, 2e4, 1e4, 5e3), torque_limit=(2.0, 3.0, 4.0, 4.0)), at="gear")
        .with_effect(KinematicError(amplitude=3e-4), at="gear")
        .with_effect(CouplingBacklash(backlash=1e-3), at="gear")
        .with_effect(MeshFriction(loss_factor=0.2), at="gear")
    )
    response = simulate(scene, 0.05)
    assert "python" not in response.lowering.values()
    assert sum(isinstance(element, Connection) for element in scene.network().elements) == 2
