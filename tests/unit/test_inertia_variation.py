"""An inertia that varies with its angle, against conserved energy, Hamilton's equations and closed forms."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import hdrive_mbs as hm
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.errors import ParameterError, PlaceError, SceneError
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.quantities import parameter
from models import rotor_bench

TIGHT = hm.DormandPrince(relative_tolerance=1e-10, absolute_tolerance=1e-12, max_step=1e-3)
INERTIA, STIFFNESS, RATIO = 0.5, 1e4, 50.0


def wheel() -> hm.Scene:
    return hm.Scene(name="wheel", parts={"wheel": hm.Motor(inertia=INERTIA, characteristic=lambda speed: 0.0 * speed)}, connections=[])


def arm() -> hm.Scene:
    """Motor, gear, arm."""
    parts = {
        "motor": hm.Motor(inertia=1e-3, characteristic=lambda time, speed: 0.3 * np.sin(9.0 * time) + 0.0 * speed),
        "gear": hm.HarmonicDrive(ratio=RATIO, stiffness=lambda twist: STIFFNESS * twist, damping=0.0),
        "arm": hm.Inertia(inertia=INERTIA),
    }
    return hm.Scene(name="arm", parts=parts, connections=[("motor", "gear", "arm")])


def sense_of_arm(scene: hm.Scene) -> int:
    """In which its true angle counts against the forward one, from the motor to it."""
    return next(body.sense for body in scene.network().bodies if body.name == "arm")


def test_a_free_wheel_turns_as_its_kinetic_energy_says() -> None:
    """(1 + r(a)) w^2 stays what it was."""
    law = hm.InertiaVariation(variation=0.6, order=3.0, phase=0.4)
    response = hm.simulate(wheel().with_effect(law, at="wheel", name="it"), 2.0, solver=TIGHT, initial_speed=8.0)
    angle, speed = response["wheel.angle"].values, response["wheel.speed"].values
    share = 0.6 * np.sin(3.0 * angle + 0.4)
    np.testing.assert_allclose(speed, 8.0 * np.sqrt((1.0 + 0.6 * math.sin(0.4)) / (1.0 + share)), rtol=1e-7)
    np.testing.assert_allclose(response["it.share"].values, share, atol=1e-12)
    assert np.ptp(speed) > 5.0


@pytest.mark.parametrize("order", [("first", "second"), ("second", "first")])
def test_an_arm_on_a_gear_moves_as_hamilton_says(order: tuple[str, str]) -> None:
    """Two variations at one place, with p = J (1 + r) w:  da/dt = p/(J (1 + r)),  dp/dt = T + J r' w^2/2."""
    laws = {"first": hm.InertiaVariation(variation=0.4, order=1.0, phase=0.9), "second": hm.InertiaVariation(variation=0.3, phase=-0.5)}
    scene = arm()
    for name in order:
        scene = scene.with_effect(laws[name], at="arm", name=name)
    sense = sense_of_arm(scene)
    start = {"motor.speed": 100.0, "arm.speed": sense * 1.5}
    response = hm.simulate(scene, 0.6, solver=TIGHT, initial=start, sample_step=0)

    def share(angle: float) -> tuple[float, float]:
        """Of the forward angle: r and dr/dq."""
        true = sense * angle
        slope = 0.4 * math.cos(true + 0.9) + 0.6 * math.cos(2.0 * true - 0.5)
        return 0.4 * math.sin(true + 0.9) + 0.3 * math.sin(2.0 * true - 0.5), sense * slope

    def rates(t: float, y: np.ndarray) -> list[float]:
        motor, angle, speed, momentum = y
        torque = STIFFNESS * (motor / RATIO - angle)
        r, slope = share(angle)
        turning = momentum / (INERTIA * (1.0 + r))
        return [speed, turning, (0.3 * math.sin(9.0 * t) - torque / RATIO) / 1e-3, torque + 0.5 * INERTIA * slope * turning**2]

    begin = [0.0, 0.0, 100.0, INERTIA * (1.0 + share(0.0)[0]) * 1.5]
    found = solve_ivp(rates, (0.0, 0.6), begin, t_eval=response.times, rtol=1e-10, atol=1e-12, method="DOP853").y
    np.testing.assert_allclose(response["motor.angle"].values, found[0], atol=1e-6)
    np.testing.assert_allclose(sense * response["arm.angle"].values, found[1], atol=1e-6)
    plain = hm.simulate(arm(), 0.6, solver=TIGHT, initial=start)
    assert np.max(np.abs(sense * plain["arm.angle"].at(response.times) - found[1])) > 0.01
    balance = hm.energy_balance(response)
    assert balance.energy_error < 1e-7
    assert balance.momentum_error < 1e-7
    held = 0.5 * INERTIA * response["arm.speed"].values ** 2 * (response["first.share"].values + response["second.share"].values)
    names = [name for name in balance.stored if name.startswith(("first", "second"))]
    np.testing.assert_allclose(sum(balance.stored[name] for name in names), held, atol=1e-9)
    for name in names:  # nothing becomes heat
        np.testing.assert_allclose(balance.dissipated[name], 0.0, atol=1e-7 * balance.energy_scale)


def test_inertias_at_both_ends_of_a_gear_move_as_hamilton_says() -> None:
    """Motor and arm, each with p = J (1 + r) w:  da/dt = p/(J (1 + r)),  dp/dt = T + J r' w^2/2; engine and compiled run."""
    motor_inertia, motor_share = 1e-3, 0.2
    scene = arm().with_effect(hm.InertiaVariation(variation=motor_share, order=1.0, phase=0.3), at="motor", name="first")
    scene = scene.with_effect(hm.InertiaVariation(variation=0.4, order=2.0, phase=0.9), at="arm", name="second")
    sense = sense_of_arm(scene)
    start = {"motor.speed": 100.0, "arm.speed": sense * 2.0}
    response = hm.simulate(scene, 0.4, solver=TIGHT, initial=start, sample_step=0)

    def shares(motor: float, angle: float) -> tuple[float, float, float, float]:
        """Of the forward angles: r and dr/dq of both."""
        first = motor_share * math.sin(motor + 0.3), motor_share * math.cos(motor + 0.3)
        true = 2.0 * sense * angle + 0.9
        return *first, 0.4 * math.sin(true), 0.8 * sense * math.cos(true)

    def rates(t: float, y: np.ndarray) -> list[float]:
        motor, angle, of_motor, of_arm = y
        r, slope, s, bend = shares(motor, angle)
        fast, slow = of_motor / (motor_inertia * (1.0 + r)), of_arm / (INERTIA * (1.0 + s))
        torque = STIFFNESS * (motor / RATIO - angle)
        drive = 0.3 * math.sin(9.0 * t) - torque / RATIO
        return [fast, slow, drive + 0.5 * motor_inertia * slope * fast**2, torque + 0.5 * INERTIA * bend * slow**2]

    r, _, s, _ = shares(0.0, 0.0)
    begin = [0.0, 0.0, motor_inertia * (1.0 + r) * 100.0, INERTIA * (1.0 + s) * 2.0]
    found = solve_ivp(rates, (0.0, 0.4), begin, t_eval=response.times, rtol=1e-10, atol=1e-12, method="DOP853").y
    np.testing.assert_allclose(response["motor.angle"].values, found[0], atol=1e-6)
    np.testing.assert_allclose(sense * response["arm.angle"].values, found[1], atol=1e-6)
    assert hm.energy_balance(response).energy_error < 1e-7
    run = CompiledLine(scene.network(), ["motor.angle", "arm.angle"]).run(401, 1e-3, step=1e-4, speeds={"motor": 100.0, "arm": 2.0})
    np.testing.assert_allclose(run.values["motor.angle"], response["motor.angle"].at(run.times), atol=1e-5)
    np.testing.assert_allclose(run.values["arm.angle"], response["arm.angle"].at(run.times), atol=1e-6)


def test_a_swing_is_slower_where_the_inertia_is_larger() -> None:
    """f = sqrt(k/(J (1 + A sin p))) about angle 0."""
    parts = {"disc": hm.Inertia(inertia=0.1), "shaft": hm.Shaft(stiffness=1e3, damping=0.0)}
    spring = hm.Scene(name="spring", parts=parts, connections=[("disc", "shaft", "ground")])
    for phase in (math.pi / 2.0, -math.pi / 2.0, 0.0):
        scene = spring.with_effect(hm.InertiaVariation(variation=0.4, phase=phase), at="disc")
        frequency = hm.modes(scene).undamped[0]
        assert frequency == pytest.approx(math.sqrt(1e3 / (0.1 * (1.0 + 0.4 * math.sin(phase)))), rel=1e-6)


def test_a_place_whose_motion_is_given_needs_the_torque_of_lagrange() -> None:
    """T = J (1 + r) dw/dt + J r' w^2/2 plus what the shaft takes."""
    motion = hm.IdealSpeedMotor(motion=hm.SpeedRamp(start=2.0, end=30.0, duration=1.0))
    parts = {
        "wheel": hm.Motor(inertia=INERTIA, characteristic=motion),
        "shaft": hm.Shaft(stiffness=1e3, damping=1.0),
        "disc": hm.Inertia(inertia=0.1),
    }
    scene = hm.Scene(name="held", parts=parts, connections=[("wheel", "shaft", "disc")])
    scene = scene.with_effect(hm.InertiaVariation(variation=0.3, order=2.0, phase=0.2), at="wheel")
    response = hm.simulate(scene, 0.8, solver=TIGHT, initial_speed=2.0)
    angle = 2.0 * response["wheel.angle"].values + 0.2
    own = INERTIA * (1.0 + 0.3 * np.sin(angle)) * 28.0 + 0.5 * INERTIA * 0.6 * np.cos(angle) * response["wheel.speed"].values ** 2
    np.testing.assert_allclose(response["wheel.torque"].values, own + response["shaft.torque"].values, atol=1e-6)


def test_what_cannot_be_is_refused() -> None:
    scene = wheel().with_effect(hm.InertiaVariation(variation=0.7), at="wheel")
    scene = scene.with_effect(hm.InertiaVariation(variation=0.4, order=1.0), at="wheel")
    with pytest.raises(ParameterError, match=r"by up to 0\.4 of it, with what else varies there 1\.1: must be below 1 together"):
        scene.network()
    with pytest.raises(PlaceError, match="moves across the axis too"):
        rotor_bench.build().with_effect(hm.InertiaVariation(variation=0.1), at="rotor_1")


@dataclass(frozen=True, kw_only=True)
class SharedMass(Effect):
    """A mass that hangs between two bodies.

    tau = -m (dw_1/dt + dw_2/dt)

    Source: made up.  Leaves out all else.
    """

    mass: float = parameter("kg m^2", "m", low=0.0)

    tried: ClassVar[bool] = False

    def apply(self, draft: Draft, place: str, name: str) -> None:
        draft.add_matrix(name, (), ("motor", place), stiffness=np.zeros((2, 2)), mass=np.full((2, 2), self.mass))


def test_where_masses_are_shared_with_other_bodies_it_is_refused() -> None:
    """Its torque is that of the place's own inertia: a matrix of masses would make it another one."""
    shared = arm().with_effect(SharedMass(mass=1e-4), at="arm", name="mass")
    shared.network()
    with pytest.raises(SceneError, match="inertia of 'arm' varies with its angle, but 'mass' joins masses there"):
        shared.with_effect(hm.InertiaVariation(variation=0.1), at="arm").network()


@pytest.mark.parametrize("shared", [False, True])
def test_it_acts_through_all_else_on_its_body(shared: bool) -> None:
    """Friction and a resonance beside it, put there before or after, change what accelerates the body; engine and compiled run agree."""
    law = hm.InertiaVariation(variation=0.4, order=1.0, phase=0.9)
    friction = hm.LuGreFriction(coulomb=5.0, breakaway=7.0, stribeck_speed=0.1, stiffness=2e3, damping=5.0)
    beside = [(friction, "friction"), (hm.HiddenMode(inertia=0.1, natural_frequency=60.0), "mode")]
    scene = arm().with_effect(law, at="arm", name="it") if shared else arm()
    for effect, name in beside:
        scene = scene.with_effect(effect, at="arm", name=name)
    scene = scene if shared else scene.with_effect(law, at="arm", name="it")
    network = scene.network()
    sense = sense_of_arm(scene)
    names = ["arm.angle", "arm.speed", "motor.speed", "it.torque"]
    run = CompiledLine(network, names).run(26, 0.002, step=1e-4, speeds={"motor": 100.0, "arm": 2.0})
    start = {"motor.speed": 100.0, "arm.speed": 2.0 * sense}
    response = hm.simulate(scene, 0.05, solver=hm.RungeKutta4(step=1e-4), initial=start)
    for name in names:
        wanted = response[name].at(run.times)
        np.testing.assert_allclose(run.values[name], wanted, rtol=0.0, atol=1e-6 * np.max(np.abs(wanted)), err_msg=name)
    torques = [response[f"{name}.torque"].values for name in ("friction", "mode")]
    share, angle = response["it.share"].values, response["arm.angle"].values
    speed, acceleration = response["arm.speed"].values, sense * response["arm.acceleration"].values
    gear = STIFFNESS * response["gear.twist"].values
    slope = sense * 0.4 * np.cos(angle + 0.9)
    expected = (gear + sum(torques) - 0.5 * INERTIA * slope * speed**2) / (INERTIA * (1.0 + share))
    np.testing.assert_allclose(acceleration, expected, rtol=1e-6, atol=1e-6 * np.max(np.abs(expected)))
