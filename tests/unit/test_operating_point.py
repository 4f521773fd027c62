"""Steady operating points: balance of torques, gaps, corners, and no answer where there is none."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.errors import AnalysisError, HdriveError, LawError, ParameterError, PlaceError
from hdrive_mbs.motors.ideal_speed import IdealSpeedMotor
from hdrive_mbs.motors.profiles.constant import ConstantSpeed
from hdrive_mbs.motors.servo import ServoMotor
from hdrive_mbs.network.draft import Draft
from models.harmonic_drive_train import build as drive_train
from models.harmonic_drive_train import motor
from tests.verification.scenes import LOST_MOTION, catalogue, train

U = 50.0
A, B = 2.0, 0.05
"""Motor torque A - B w: N m and N m s/rad."""


def geared(load: Any, stiffness: Any = None, motor: Any = None) -> hm.Scene:
    parts = {
        "motor": hm.Motor(inertia=1e-3, characteristic=motor if motor is not None else lambda w: A - B * w),
        "gear": hm.HarmonicDrive(ratio=U, stiffness=stiffness if stiffness is not None else lambda twist: 2e4 * twist, damping=5.0),
        "load": hm.Load(inertia=0.3, torque=load),
    }
    return hm.Scene(name="geared", parts=parts, connections=[("motor", "gear", "load")])


def test_motor_and_load_balance_at_the_speed_of_the_closed_form() -> None:
    # A - B w = T/u
    point = hm.operating_point(geared(hm.ConstantTorque(value=30.0)))
    assert point.motor_speed == pytest.approx((A - 30.0 / U) / B, rel=1e-12)
    assert point.torques["gear"] == pytest.approx(30.0, rel=1e-9)
    # twist = T/k = a_motor/u - a_load in forward angles, with the motor held at its angle 0
    assert point.angles["motor"] / U - point.angles["load"] == pytest.approx(30.0 / 2e4, rel=1e-9)
    assert point.speeds["load"] == pytest.approx(point.motor_speed / U, rel=1e-12)
    assert point.residual < 1e-9
    assert (point.in_gap, point.at_corner) == ((), ())


def test_a_load_that_grows_with_speed_balances_at_the_root_of_its_quadratic() -> None:
    # A - B w = (c/u) (w/u)^2
    c = 40.0
    point = hm.operating_point(geared(hm.QuadraticLoad(coefficient=c)))
    k = c / U**3
    assert point.motor_speed == pytest.approx((-B + math.sqrt(B * B + 4.0 * k * A)) / (2.0 * k), rel=1e-10)


def test_of_two_speeds_at_which_the_torques_balance_the_stable_one_is_taken() -> None:
    # Kloss: 0.03 N m is balanced near synchronous speed on the falling branch, and on the rising one below 0 only
    scene = train(load=hm.ConstantTorque(value=100.0))
    point = hm.operating_point(scene)
    assert 130.0 < point.motor_speed < 50.0 * math.pi
    motor = scene.parts["motor"].characteristic  # type: ignore[attr-defined]
    assert float(motor.torque(0.0, point.motor_speed)) == pytest.approx(1.0, rel=1e-9)
    assert float(motor.torque(0.0, point.motor_speed + 1.0)) < 1.0


def test_without_any_balance_the_point_is_at_rest() -> None:
    point = hm.operating_point(geared(hm.ConstantTorque(value=30.0), motor=lambda w: 0.0 * w))
    assert point.motor_speed == 0.0
    assert point.torques["gear"] == pytest.approx(30.0, rel=1e-9)


def test_a_given_speed_and_a_given_torque_replace_what_the_scene_has() -> None:
    scene = geared(hm.ConstantTorque(value=30.0))
    point = hm.operating_point(scene, motor_speed=7.0, torque=-12.0)
    assert point.motor_speed == 7.0
    assert point.torques["gear"] == pytest.approx(-12.0, rel=1e-9)
    assert scene == geared(hm.ConstantTorque(value=30.0)) or callable(scene.parts["motor"].characteristic.function)  # type: ignore[attr-defined]


def test_a_disc_on_a_shaft_to_the_ground_hangs_at_torque_over_stiffness() -> None:
    parts = {"arm": hm.Load(inertia=1.0, torque=hm.ConstantTorque(value=4.0)), "shaft": hm.Shaft(stiffness=80.0)}
    point = hm.operating_point(hm.Scene(name="hanging", parts=parts, connections=[("arm", "shaft", "ground")]))
    assert point.angles["arm"] == pytest.approx(-4.0 / 80.0, rel=1e-9)


def test_a_prescribed_motor_carries_any_load_and_turns_as_prescribed_or_as_asked() -> None:
    scene = geared(hm.QuadraticLoad(coefficient=1e5), motor=IdealSpeedMotor(motion=lambda t: 9.0 * t + t * t))
    for asked, speed in ((None, 9.0), (4.0, 4.0)):
        point = hm.operating_point(scene, motor_speed=asked)
        assert point.motor_speed == pytest.approx(speed, rel=1e-12)
        assert point.torques["gear"] == pytest.approx(1e5 * (speed / U) ** 2, rel=1e-9)
        assert point.speeds["load"] == pytest.approx(speed / U, rel=1e-12)


def test_a_speed_that_contradicts_a_prescribed_motion_is_refused() -> None:
    motor = IdealSpeedMotor(motion=ConstantSpeed(value=9.0))
    brake = hm.Motor(inertia=1.0, characteristic=IdealSpeedMotor(motion=ConstantSpeed(value=9.0)))
    scene = geared(hm.ConstantTorque(value=1.0), motor=motor)
    parts = dict(scene.parts) | {"s": hm.Shaft(stiffness=1.0), "brake": brake}
    two = hm.Scene(name="two", parts=parts, connections=[("motor", "gear", "load"), ("motor", "s", "brake")])
    assert hm.operating_point(two).motor_speed == pytest.approx(9.0)
    with pytest.raises(
        ParameterError, match=r"motor_speed = 4 rad/s would turn 'motor' at 4 rad/s, but its motion is prescribed with 9 rad/s"
    ):
        hm.operating_point(two, motor_speed=4.0)


def test_the_integral_of_a_speed_controller_holds_the_load_at_the_wanted_speed() -> None:
    motor = ServoMotor(torque_limit=5.0, proportional_gain=0.2, integral_gain=4.0, reference=ConstantSpeed(value=60.0))
    point = hm.operating_point(geared(hm.ConstantTorque(value=30.0), motor=motor))
    # no error is left, so ki I = T/u
    assert point.motor_speed == pytest.approx(60.0, rel=1e-6)
    assert point.states["motor.integral"] == pytest.approx(30.0 / U / 4.0, rel=1e-6)


# -- gap and corners ----------------------------------------------------------------------------------


def test_without_torque_the_gear_is_in_its_gap() -> None:
    point = hm.operating_point(geared(hm.ConstantTorque(value=0.0), stiffness=catalogue()), motor_speed=0.0)
    assert point.in_gap == ("gear",)
    assert abs(point.angles["motor"] / U - point.angles["load"]) <= LOST_MOTION / 2.0
    assert point.torques["gear"] == 0.0


@pytest.mark.parametrize("torque", [23.5, -23.5, 98.0])
def test_at_a_corner_of_the_catalogue_law_the_point_says_so(torque: float) -> None:
    point = hm.operating_point(geared(hm.ConstantTorque(value=torque), stiffness=catalogue()), motor_speed=0.0)
    assert point.at_corner == ("gear",)
    assert point.torques["gear"] == pytest.approx(torque, rel=1e-9)


@pytest.mark.parametrize("torque", [0.1, 4.0, 23.4, 23.6, 60.0, 120.0, 1e4, -5.0, -150.0])
def test_every_torque_has_its_twist_by_the_inverse_of_the_law(torque: float) -> None:
    law = catalogue()
    point = hm.operating_point(geared(hm.ConstantTorque(value=torque), stiffness=law), motor_speed=0.0)
    assert point.angles["motor"] / U - point.angles["load"] == pytest.approx(float(law.twist(torque)), rel=1e-7)
    assert (point.in_gap, point.at_corner) == ((), ())


def test_a_law_for_plain_numbers_has_the_same_point_as_one_for_arrays() -> None:
    def with_if(twist: float) -> float:
        return 2e4 * twist if twist > 0.0 else 1e4 * twist

    load = hm.ConstantTorque(value=30.0)
    same = hm.operating_point(geared(load, stiffness=lambda twist: np.where(twist > 0.0, 2e4 * twist, 1e4 * twist)))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", hm.LoweringWarning)
        point = hm.operating_point(geared(load, stiffness=with_if))
    assert point.angles == pytest.approx(same.angles, rel=1e-9, abs=1e-15)


def test_backlash_in_a_shaft_is_a_gap_too() -> None:
    scene = train(load=hm.ConstantTorque(value=0.0)).with_effect(hm.CouplingBacklash(backlash=0.01), at="output_shaft")
    assert set(hm.operating_point(scene, motor_speed=0.0).in_gap) == {"gear", "output_shaft"}


# -- no answer --------------------------------------------------------------------------------------------


def test_a_law_that_cannot_carry_the_load_has_no_operating_point() -> None:
    saturating = geared(hm.ConstantTorque(value=30.0), stiffness=lambda twist: 20.0 * np.tanh(1e3 * twist))
    with pytest.raises(
        AnalysisError, match=r"No steady operating point at 28 rad/s: .* N m stay unbalanced\. Give another motor_speed or torque"
    ):
        hm.operating_point(saturating)
    assert hm.operating_point(saturating, torque=19.0).torques["gear"] == pytest.approx(19.0, rel=1e-6)


@pytest.mark.parametrize(
    ("arguments", "kind", "message"),
    [
        ({"motor_speed": math.nan}, ParameterError, r"motor_speed = nan rad/s: must be a finite number"),
        ({"motor_speed": math.inf}, ParameterError, r"motor_speed = inf rad/s: must be a finite number"),
        ({"torque": math.nan}, ParameterError, r"ConstantTorque\.value = nan N m: must be a finite number"),
    ],
)
def test_a_bad_argument_is_refused(arguments: dict[str, float], kind: type[HdriveError], message: str) -> None:
    with pytest.raises(kind, match=message):
        hm.operating_point(geared(hm.ConstantTorque(value=1.0)), **arguments)


def test_a_load_torque_needs_a_load() -> None:
    parts = {"a": hm.Inertia(inertia=1.0), "s": hm.Shaft(stiffness=1.0), "b": hm.Inertia(inertia=1.0)}
    scene = hm.Scene(name="two discs", parts=parts, connections=[("a", "s", "b")])
    for ask in (hm.operating_point, hm.modes):
        with pytest.raises(PlaceError, match=r"Scene 'two discs' has no Load part, so a load torque of 5 N m has no place"):
            ask(scene, torque=5.0)
    with pytest.raises(PlaceError, match="no Load part"):
        hm.torsional_campbell(scene, [1.0, 2.0], torque=5.0)


def test_a_speed_controller_settles_at_its_reference_with_the_load_in_its_integral() -> None:
    # steady: e = 0, so w = w_ref; the integral alone holds the load: ki I = M/u
    servo = hm.ServoMotor(torque_limit=9.0, proportional_gain=0.35, integral_gain=4.0, reference=hm.ConstantSpeed(value=100.0))
    scene = train().replacing({"motor.characteristic": servo, "load.torque": hm.ConstantTorque(value=20.0)})
    point = hm.operating_point(scene)
    assert point.motor_speed == pytest.approx(100.0, rel=1e-9)
    assert point.states["motor.integral"] == pytest.approx(20.0 / 100.0 / 4.0, rel=1e-9)
    assert point.torques["gear"] == pytest.approx(20.0, rel=1e-9)


@pytest.mark.parametrize("torque", [2.0, 5.0, 20.0, -5.0])
def test_a_law_with_a_narrow_steep_ramp_is_balanced(torque: float) -> None:
    def steep(twist: Any) -> Any:
        return np.sign(twist) * np.interp(np.abs(twist), [0.0, 1.3e-3, 1.31e-3, 4e-3], [0.0, 0.0, 6.6, 140.0])

    point = hm.operating_point(train().replacing({"gear.stiffness": steep}), torque=torque, motor_speed=100.0)
    assert point.torques["gear"] == pytest.approx(torque, rel=1e-8)


def test_a_lag_of_the_motor_does_not_change_where_it_balances_the_load() -> None:
    # its state starts at zero torque, at which the motor seems to give nothing at any speed
    plain = hm.operating_point(drive_train())
    lagging = hm.operating_point(drive_train().with_effect(hm.ActuatorLag(time_constant=0.01), at="motor"))
    assert lagging.motor_speed == pytest.approx(plain.motor_speed, rel=1e-9)
    assert lagging.torques == pytest.approx(dict(plain.torques), rel=1e-9)
    # the torque that it delivers is the load over the ratio
    assert lagging.states["actuator_lag.lagged"] == pytest.approx(20.0 / 100.0, rel=1e-9)


def test_a_lag_of_the_load_does_not_change_where_the_motor_balances_it() -> None:
    plain = hm.operating_point(drive_train())
    lagging = hm.operating_point(drive_train().with_effect(hm.LoadLag(time_constant=0.01), at="load"))
    assert lagging.motor_speed == pytest.approx(plain.motor_speed, rel=1e-9)
    assert lagging.torques == pytest.approx(dict(plain.torques), rel=1e-9)
    # in the forward sense the load of 20 N m drives with -20
    assert abs(lagging.states["load_lag.lagged"]) == pytest.approx(20.0, rel=1e-9)


def test_friction_in_the_mesh_is_carried_by_the_motor_and_does_not_hold_the_train() -> None:
    plain = hm.operating_point(drive_train())
    friction = hm.MeshFriction(loss_factor=0.2, no_load=0.05)
    point = hm.operating_point(drive_train().with_effect(friction, at="gear.mesh"))
    # M = T/u (1 + mu) + T_0, with tanh(156/0.5) = 1
    assert point.torques["input_shaft"] == pytest.approx(20.0 / 100.0 * 1.2 + 0.05, rel=1e-9)
    assert point.torques["gear"] == pytest.approx(20.0, rel=1e-9)
    # the asynchronous motor gives that torque at a speed a little lower
    assert motor().torque(0.0, point.motor_speed) == pytest.approx(0.29, rel=1e-9)
    assert point.motor_speed < plain.motor_speed
    # asked at a speed, the motor's balance does not count
    asked = hm.operating_point(drive_train().with_effect(friction, at="gear.mesh"), motor_speed=100.0)
    assert asked.torques["input_shaft"] == pytest.approx(0.29, rel=1e-9)


@dataclass(frozen=True, kw_only=True)
class WobbleOfThisTest(Effect):
    """A torque on a body with a phase that runs at a rate of its own, which no operating point has."""

    tried: ClassVar[bool] = False

    def apply(self, draft: Draft, place: str, name: str) -> None:
        phase = draft.add_running_state(f"{name}.phase", unit="rad", rate=lambda moment: 3.0 + 0.0 * moment.time)
        draft.add_torque(name, place, lambda moment: 0.1 * np.sin(moment.state(phase)))


def test_a_torque_with_a_phase_that_runs_on_has_no_operating_point() -> None:
    scene = geared(hm.ConstantTorque(value=5.0)).with_effect(WobbleOfThisTest(), at="motor", name="wobble")
    with pytest.raises(
        LawError, match=r"wobble: its torque depends on the state 'wobble\.phase', which goes on with the rotation.*add_state"
    ):
        hm.operating_point(scene)
    # in time it is a torque like any other: 0.1 sin(3 t) on all that turns
    response = hm.simulate(scene, 0.05)
    np.testing.assert_allclose(response["wobble.phase"].values, 3.0 * response.times, rtol=0.0, atol=1e-9)
