"""Motors and speed profiles."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.linalg import expm
from scipy.optimize import minimize_scalar

import hdrive_mbs as hm
from hdrive_mbs.components.speed_controller import SpeedController
from hdrive_mbs.conversions import rpm
from hdrive_mbs.errors import LawError, ParameterError, PlaceError, SceneError
from hdrive_mbs.expression import Value, gradient
from hdrive_mbs.loads.constant import ConstantTorque
from hdrive_mbs.motors.asynchronous import AsynchronousMotor
from hdrive_mbs.motors.characteristic import MotorCharacteristic, MotorFunction
from hdrive_mbs.motors.commanded import CommandedMotor
from hdrive_mbs.motors.ideal_speed import IdealSpeedMotor
from hdrive_mbs.motors.inverter import InverterMotor
from hdrive_mbs.motors.profiles.constant import ConstantSpeed
from hdrive_mbs.motors.profiles.profile import AngleFunction, SpeedFunction, SpeedProfile
from hdrive_mbs.motors.profiles.ramp import SpeedRamp
from hdrive_mbs.motors.profiles.table import SpeedTable
from hdrive_mbs.motors.servo import ServoMotor
from hdrive_mbs.motors.torque_speed_table import TorqueSpeedTable
from tests.unit.law_checks import assert_derivative_is_exact, assert_records_itself, run_on_engine
from tests.verification.scenes import train

# the motor of the reference train: 0.55 kW, 4 poles, 1410 rpm at 50 Hz, breakdown ratio 2.4
PLATE: dict[str, float] = {"rated_power": 550.0, "rated_speed": rpm(1410.0), "pole_pairs": 2.0, "breakdown_ratio": 2.4}
SYNCHRONOUS = 2.0 * math.pi * 50.0 / 2.0


def kloss() -> AsynchronousMotor:
    return AsynchronousMotor(**PLATE)


# -- speed profiles ----------------------------------------------------------------------------------

PROFILES: dict[str, SpeedProfile] = {
    "constant": ConstantSpeed(value=-12.0),
    "ramp": SpeedRamp(start=20.0, end=150.0, duration=0.5),
    "ramp down": SpeedRamp(start=150.0, end=-30.0, duration=0.25),
    "table": SpeedTable(times=(0.1, 0.3, 0.35, 1.0, 1.7), speeds=(5.0, 5.0, 100.0, 80.0, -10.0)),
    "table of two points": SpeedTable(times=(-1.0, 1.0), speeds=(0.0, 50.0)),
    "table of many points": SpeedTable(times=tuple(np.linspace(0.0, 2.0, 40)), speeds=tuple(50.0 * np.sin(np.linspace(0.0, 9.0, 40)))),
    "angles": hm.AngleTable(times=(-0.2, 0.1, 0.3, 0.35, 1.0, 1.7), angles=(1.0, 2.0, 5.0, 7.0, 3.0, -4.0)),
    "function": AngleFunction(function=lambda t: 10.0 * t - 3.0 * np.sin(4.0 * t)),
}


def corners(profile: SpeedProfile) -> list[float]:
    if isinstance(profile, (SpeedTable, hm.AngleTable)):
        return list(profile.times)
    return [0.0, profile.duration] if isinstance(profile, SpeedRamp) else []


@pytest.mark.parametrize("name", list(PROFILES))
def test_the_angle_of_a_profile_is_the_integral_of_its_speed(name: str) -> None:
    profile = PROFILES[name]
    for end in (0.05, 0.3, 0.5, 0.9, 1.7, 2.5, -0.4, -1.5):
        inside = [t for t in corners(profile) if min(0.0, end) < t < max(0.0, end)]
        places = [0.0, *sorted(inside, reverse=end < 0.0), end]
        pieces = [quad(lambda t: float(profile.speed(t)), a, b, epsabs=1e-13, epsrel=1e-13)[0] for a, b in itertools.pairwise(places)]
        # quad is asked for 1e-13; angles are up to 1e2 rad with 40 pieces summed
        assert float(profile.angle(end)) == pytest.approx(sum(pieces), abs=1e-11)


@pytest.mark.parametrize("name", list(PROFILES))
def test_the_speed_of_a_profile_is_the_derivative_of_its_angle_also_at_the_corners(name: str) -> None:
    profile = PROFILES[name]
    times = np.array([-1.5, -0.3, 0.0, 0.01, 0.2, 0.25, 0.5, 0.77, 1.9, 3.0, *corners(profile)])
    # both are evaluated in closed form: rounding of 1e2 rad/s
    np.testing.assert_allclose(gradient(profile.angle)(times) + 0.0 * times, profile.speed(times), rtol=0.0, atol=1e-11)


@pytest.mark.parametrize("name", list(PROFILES))
def test_every_profile_records_itself(name: str) -> None:
    times = np.random.default_rng(3).uniform(-0.5, 3.0, 200)
    assert_records_itself(PROFILES[name].angle, times)
    assert_records_itself(PROFILES[name].speed, times)


def test_a_ramp_holds_its_end_speeds_outside() -> None:
    ramp = PROFILES["ramp"]
    np.testing.assert_array_equal(ramp.speed(np.array([-1.0, 0.0, 0.25, 0.5, 9.0])), [20.0, 20.0, 85.0, 150.0, 150.0])


def test_a_speed_without_an_angle_says_what_to_give_instead() -> None:
    profile = SpeedFunction(function=lambda t: 10.0 + 0.0 * t)
    with pytest.raises(LawError, match="AngleFunction"):
        profile.angle(1.0)


@pytest.mark.parametrize(
    ("times", "speeds", "message"),
    [
        ((0.0, 2.0, 1.0), (0.0, 1.0, 2.0), r"SpeedTable\.times\[2\] = 1 s does not rise above times\[1\] = 2 s; sort"),
        ((0.0, 1.0), (0.0, math.nan), r"SpeedTable\.speeds\[1\] = nan rad/s: must be a finite number"),
        ((0.0, 1.0), (0.0,), "2 times and 1 speeds"),
        ((0.0,), (0.0,), "at least 2"),
    ],
)
def test_a_bad_speed_table_is_refused(times: tuple[float, ...], speeds: tuple[float, ...], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        SpeedTable(times=times, speeds=speeds)


@pytest.mark.parametrize("duration", [0.0, -1.0])
def test_a_ramp_of_no_length_is_refused(duration: float) -> None:
    with pytest.raises(ParameterError, match=r"SpeedRamp\.duration = .* s: must be greater than 0"):
        SpeedRamp(start=0.0, end=1.0, duration=duration)


# -- torque-speed characteristics --------------------------------------------------------------------


def test_kloss_goes_through_the_rated_point() -> None:
    # M_N = P/w: 550 W / 147.65 rad/s
    assert float(kloss().torque(0.0, rpm(1410.0))) == pytest.approx(550.0 / rpm(1410.0), rel=1e-12)


def test_kloss_goes_through_the_breakdown_point_as_its_maximum() -> None:
    motor = kloss()
    found = minimize_scalar(lambda w: -float(motor.torque(0.0, w)), bounds=(0.0, SYNCHRONOUS), method="bounded", options={"xatol": 1e-9})
    assert -found.fun == pytest.approx(2.4 * 550.0 / rpm(1410.0), rel=1e-12)
    # the maximum is flat: a value within 1e-16 leaves the place open to sqrt(1e-16)
    assert float(found.x) == pytest.approx(SYNCHRONOUS * (1.0 - motor.breakdown_slip), rel=1e-6)
    assert float(gradient(lambda w: motor.torque(0.0, w))(SYNCHRONOUS * (1.0 - motor.breakdown_slip))) == pytest.approx(0.0, abs=1e-12)


def test_kloss_gives_nothing_at_synchronous_speed_and_brakes_above_it() -> None:
    motor = kloss()
    assert float(motor.torque(0.0, SYNCHRONOUS)) == pytest.approx(0.0, abs=1e-12)
    slips = np.array([0.01, 0.06, 0.3, 1.0])
    np.testing.assert_allclose(motor.torque_at_slip(-slips), -motor.torque_at_slip(slips), rtol=1e-15)


def test_a_rated_speed_above_synchronous_speed_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"rated_speed = 1410 rad/s is not below the synchronous speed .*rpm\(\)"):
        AsynchronousMotor(**{**PLATE, "rated_speed": 1410.0})


def test_a_motor_on_the_line_frequency_is_the_kloss_motor() -> None:
    motor = InverterMotor(**PLATE, feed=ConstantSpeed(value=SYNCHRONOUS))
    speeds = np.linspace(-200.0, 400.0, 61)
    np.testing.assert_allclose(motor.torque(0.3, speeds), kloss().torque(0.3, speeds), rtol=1e-12, atol=1e-13)


def test_at_constant_flux_the_curve_moves_along_the_speed_axis() -> None:
    # at half the frequency the same torque at the same slip speed; the breakdown torque is the same
    half = InverterMotor(**PLATE, feed=ConstantSpeed(value=SYNCHRONOUS / 2.0))
    slip_speeds = np.linspace(-100.0, 100.0, 41)
    np.testing.assert_allclose(
        half.torque(0.0, SYNCHRONOUS / 2.0 - slip_speeds), kloss().torque(0.0, SYNCHRONOUS - slip_speeds), rtol=1e-11, atol=1e-12
    )


def test_a_ramped_inverter_reaches_the_line_frequency_at_the_end_of_its_ramp() -> None:
    motor = InverterMotor.ramped(ramp_time=0.4, **PLATE)
    assert float(motor.feed.speed(0.1)) == pytest.approx(SYNCHRONOUS / 4.0, rel=1e-12)
    assert float(motor.torque(0.1, SYNCHRONOUS / 4.0)) == pytest.approx(0.0, abs=1e-12)
    assert float(motor.torque(7.0, rpm(1410.0))) == pytest.approx(550.0 / rpm(1410.0), rel=1e-12)
    with pytest.raises(ParameterError, match="must be a speed profile"):
        InverterMotor(**PLATE, feed=50.0)  # type: ignore[arg-type]


def test_a_torque_table_has_straight_lines_between_its_points_and_the_stated_ends() -> None:
    speeds, torques = (0.0, 100.0, 150.0), (8.0, 10.0, 0.0)
    held = TorqueSpeedTable(speeds=speeds, torques=torques)
    longer = TorqueSpeedTable(speeds=speeds, torques=torques, extrapolate=True)
    w = np.array([-50.0, 0.0, 50.0, 100.0, 125.0, 150.0, 200.0])
    np.testing.assert_allclose(held.torque(0.0, w), [8.0, 8.0, 9.0, 10.0, 5.0, 0.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(longer.torque(0.0, w), [7.0, 8.0, 9.0, 10.0, 5.0, 0.0, -10.0], atol=1e-12)


@pytest.mark.parametrize(
    ("speeds", "torques", "message"),
    [
        ((0.0, 100.0, 50.0), (1.0, 1.0, 1.0), r"TorqueSpeedTable\.speeds\[2\] = 50 rad/s does not rise above speeds\[1\] = 100 rad/s"),
        ((0.0, 100.0), (1.0, math.nan), r"TorqueSpeedTable\.torques\[1\] = nan N m: must be a finite number"),
        ((0.0, 100.0), (1.0, 2.0, 3.0), "2 speeds and 3 torques"),
    ],
)
def test_a_bad_torque_table_is_refused(speeds: tuple[float, ...], torques: tuple[float, ...], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        TorqueSpeedTable(speeds=speeds, torques=torques)


STATIC: dict[str, MotorCharacteristic] = {
    "kloss": kloss(),
    "inverter": InverterMotor.ramped(ramp_time=0.4, **PLATE),
    "table": TorqueSpeedTable(speeds=(0.0, 60.0, 100.0, 150.0), torques=(8.0, 7.0, 10.0, 0.0), extrapolate=True),
    "table, held": TorqueSpeedTable(speeds=(0.0, 60.0, 100.0, 150.0), torques=(8.0, 7.0, 10.0, 0.0)),
    "function": MotorFunction(function=lambda speed: 5.0 * np.tanh((150.0 - speed) / 20.0)),
}


@pytest.mark.parametrize("name", list(STATIC))
def test_every_characteristic_records_itself(name: str) -> None:
    rng = np.random.default_rng(4)
    assert_records_itself(STATIC[name].torque, rng.uniform(0.0, 1.0, 300), rng.uniform(-50.0, 300.0, 300))


@pytest.mark.parametrize("name", list(STATIC))
def test_the_slope_of_every_characteristic_is_its_derivative(name: str) -> None:
    motor = STATIC[name]
    points = np.random.default_rng(5).uniform(-50.0, 300.0, 200)
    kinks = getattr(motor, "speeds", ())
    # step 1e-3 rad/s: third derivative of Kloss's curve < 12 M_b/(s_b w_s)^3 < 1e-2, h^2/6 f''' < 2e-9; rounding 1e-16*10/1e-3
    assert_derivative_is_exact(lambda w: motor.torque(0.2, w), points, 1e-3, kinks, 1e-8)


# -- servo -------------------------------------------------------------------------------------------

J, KP, KI, LIMIT, TARGET = 2e-3, 0.2, 3.0, 5.0, 100.0
"""Rotor alone: kg m^2, N m s/rad, N m/rad, N m, rad/s.  KI J < KP^2: well damped."""


def servo(**changes: Any) -> ServoMotor:
    values: dict[str, Any] = {
        "torque_limit": LIMIT, "proportional_gain": KP, "integral_gain": KI, "reference": ConstantSpeed(value=TARGET)
    }  # fmt: skip
    return ServoMotor(**(values | changes))


def alone(characteristic: MotorCharacteristic) -> hm.Scene:
    return hm.Scene(name="rotor alone", parts={"motor": hm.Motor(inertia=J, characteristic=characteristic)}, connections=[])


def test_a_servo_does_not_wind_up_while_it_is_at_its_limit() -> None:
    # until kp e = limit: w = (limit/J) t, I = 0, which ends at  t = (w_ref - limit/kp) J/limit
    leaves = (TARGET - LIMIT / KP) * J / LIMIT
    result, how = run_on_engine(alone(servo()), leaves - 1e-4, tolerance=1e-9)
    assert how == {"motor.integral (state equation)": "symbolic", "motor.torque": "symbolic"}
    np.testing.assert_allclose(result.speeds["motor"], LIMIT / J * result.times, rtol=1e-9, atol=1e-9)
    assert result.speeds["motor"][-1] > 0.74 * TARGET  # limit/kp = 25 rad/s below the target the command leaves the limit
    assert np.all(result.states["motor.integral"] == 0.0)


def test_a_servo_follows_the_linear_closed_loop_after_it_has_left_its_limit() -> None:
    # J e' = -(kp e + ki I), I' = e from e = limit/kp, I = 0
    leaves = (TARGET - LIMIT / KP) * J / LIMIT
    result, _ = run_on_engine(alone(servo()), 0.2, tolerance=1e-10)
    A = np.array([[-KP / J, -KI / J], [1.0, 0.0]])
    after = np.flatnonzero(result.times > leaves)
    assert len(after) > 20
    for k in after[:: max(1, len(after) // 50)]:
        t, w, integral = result.times[k], result.speeds["motor"][k], result.states["motor.integral"][k]
        e, expected = expm(A * (t - leaves)) @ np.array([LIMIT / KP, 0.0])
        # the step that crosses the corner is accepted with an error of about the tolerance times the speed
        assert TARGET - e == pytest.approx(w, abs=1e-6)
        assert expected == pytest.approx(integral, abs=1e-7)
    assert result.speeds["motor"][-1] == pytest.approx(TARGET, abs=2.0)


def test_a_loop_that_integrates_at_its_limit_would_overshoot_more() -> None:
    class WindsUp(ServoMotor):
        def integral_rate(self, error: Value, integral: Value, limit: Value) -> Value:
            return error + 0.0 * integral

    slow = {"integral_gain": 8.0, "proportional_gain": 0.15}
    held, _ = run_on_engine(alone(servo(**slow)), 0.5)
    wound, _ = run_on_engine(alone(WindsUp(torque_limit=LIMIT, reference=ConstantSpeed(value=TARGET), **slow)), 0.5)
    assert held.speeds["motor"].max() - TARGET < 0.6 * (wound.speeds["motor"].max() - TARGET)


def test_an_integral_beyond_the_limit_unwinds_also_without_a_proportional_part() -> None:
    law = servo(proportional_gain=0.0)
    beyond = 1.2 * LIMIT / KI
    assert float(law.integral_rate(2.0, beyond, LIMIT)) == 0.0
    assert float(law.integral_rate(-2.0, beyond, LIMIT)) == -2.0
    assert float(law.integral_rate(-2.0, -beyond, LIMIT)) == 0.0
    assert float(law.integral_rate(2.0, -beyond, LIMIT)) == 2.0
    assert float(law.integral_rate(2.0, 0.5 * beyond, LIMIT)) == 2.0


def test_the_torque_of_a_servo_stays_within_its_limit() -> None:
    scene = train(motor=servo())
    result, how = run_on_engine(scene, 0.1)
    network = scene.network()
    channel = next(channel for channel in network.channels if channel.name == "motor.torque")
    torque = channel.read(network.moment(result.times, result.angles, result.speeds, result.states))
    assert np.max(np.abs(torque)) == LIMIT
    assert how["motor.torque"] == "symbolic"


def test_the_current_loop_delays_the_torque_by_its_time_constant() -> None:
    # while the command stays at the limit:  M = limit (1 - exp(-t/lag)),  w = limit/J (t - lag (1 - exp(-t/lag)))
    lag = 2e-3
    result, how = run_on_engine(alone(servo(current_lag=lag)), 0.02, tolerance=1e-10)
    assert how["motor.lagged_torque (state equation)"] == "symbolic"
    t = result.times
    grown = 1.0 - np.exp(-t / lag)
    np.testing.assert_allclose(result.states["motor.lagged_torque"], LIMIT * grown, atol=1e-7)
    np.testing.assert_allclose(result.speeds["motor"], LIMIT / J * (t - lag * grown), atol=1e-6)


def test_a_servo_takes_a_plain_function_as_its_reference() -> None:
    result, _ = run_on_engine(alone(servo(reference=lambda t: 10.0 * np.sin(20.0 * t))), 0.3)
    late = result.times > 0.15
    # closed loop at 20 rad/s: |e/w_ref| = |J s^2|/|J s^2 + kp s + ki| at s = 20i: 0.8/|2.2 + 4i| = 0.175
    error = 10.0 * np.sin(20.0 * result.times[late]) - result.speeds["motor"][late]
    amplitude = 10.0 * abs(J * (20j) ** 2 / (J * (20j) ** 2 + KP * 20j + KI))
    assert np.max(np.abs(error)) == pytest.approx(amplitude, rel=0.02)  # the start has decayed by exp(-19 * 0.15) = 6 %


# -- controller and motor as two parts ---------------------------------------------------------------


def controlled(**changes: Any) -> hm.Scene:
    values: dict[str, Any] = {
        "motor": "motor", "proportional_gain": KP, "integral_gain": KI, "reference": ConstantSpeed(value=TARGET)
    }  # fmt: skip
    base = train(motor=CommandedMotor(torque_limit=LIMIT))
    return hm.Scene(
        name="controlled", parts={"controller": SpeedController(**(values | changes)), **base.parts}, connections=base.connections
    )


def test_a_commanded_motor_with_a_controller_is_a_servo() -> None:
    one, _ = run_on_engine(train(motor=servo()), 0.05)
    two, how = run_on_engine(controlled(), 0.05)
    assert how["motor.torque"] == how["controller.integral (state equation)"] == "symbolic"
    # the same equations; the engine sums two couplings in another order
    assert two.speeds["load"][-1] == pytest.approx(one.speeds["load"][-1], rel=1e-9)
    assert two.states["controller.integral"][-1] == pytest.approx(one.states["motor.integral"][-1], rel=1e-9)


def test_a_controller_can_stand_before_or_behind_the_motor_in_the_list_of_parts() -> None:
    scene = controlled()
    parts = dict(reversed(scene.parts.items()))
    assert list(parts)[-1] == "controller"
    again = hm.Scene(name="reversed", parts=parts, connections=scene.connections)
    assert {channel.name for channel in again.network().channels} == {channel.name for channel in scene.network().channels}


def test_feedback_from_the_output_counts_forward_although_the_output_turns_backwards() -> None:
    # At the motor kp/u = 0.02 N m s/rad and ki/u = 0.1 N m/rad on J = 1.74e-3 kg m^2 (rotor, wave generator, load/u^2):
    # poles at -5.7 +- 5.0i rad/s, so from the end of the ramp to 1.5 s the error falls to exp(-5.7 * 1.3) = 6e-4.
    gains = {"proportional_gain": 2.0, "integral_gain": 10.0}
    base = controlled(feedback="load", reference=SpeedRamp(start=0.0, end=1.0, duration=0.2), **gains)
    # a gear damped enough that its elastic vibration dies out faster than that, a flexspline heavy enough for long steps
    changes = {"load.torque": ConstantTorque(value=20.0), "gear.damping": 100.0, "gear.flexspline_inertia": 5e-3}
    scene = base.replacing(changes)
    assert next(body.sense for body in scene.network().bodies if body.name == "load") == -1
    result, _ = run_on_engine(scene, 1.5)
    # with the true, negative sense the feedback would be positive and run away to the torque limit
    assert result.speeds["load"][-1] == pytest.approx(1.0, abs=5e-3)
    assert result.speeds["motor"][-1] == pytest.approx(100.0, abs=0.5)


def watching(effect: hm.Effect | None = None, **sensor: Any) -> hm.Scene:
    """The controlled train with a tachometer in its loop."""
    tacho = hm.Sensor(**({"quantity": "motor.speed"} | sensor))
    base = controlled(feedback="tacho")
    scene = hm.Scene(name="watching", parts={**base.parts, "tacho": tacho}, connections=base.connections)
    return scene if effect is None else scene.with_effect(effect, at="tacho")


def test_a_controller_with_a_true_sensor_is_one_that_reads_the_motor() -> None:
    plain, _ = run_on_engine(controlled(), 0.05)
    read, how = run_on_engine(watching(), 0.05)
    assert how["controller.integral (state equation)"] == "symbolic"
    for name, speed in plain.speeds.items():
        np.testing.assert_array_equal(read.speeds[name], speed)


def test_a_false_gain_of_the_sensor_moves_the_speed_that_the_loop_holds() -> None:
    # steady: (1 + e) w = w_ref; the error of the loop decays within 1 s as that of a servo
    result, _ = run_on_engine(watching(hm.SensorGain(error=0.05)), 1.5)
    plain, _ = run_on_engine(controlled(), 1.5)
    assert plain.speeds["motor"][-1] == pytest.approx(TARGET, rel=1e-3)
    assert result.speeds["motor"][-1] == pytest.approx(TARGET / 1.05, rel=1e-3)


def test_a_sensor_at_the_output_counts_forward_in_the_loop() -> None:
    gains = {"proportional_gain": 2.0, "integral_gain": 10.0, "reference": SpeedRamp(start=0.0, end=1.0, duration=0.2)}
    changes = {"load.torque": ConstantTorque(value=20.0), "gear.damping": 100.0, "gear.flexspline_inertia": 5e-3}
    found = []
    for feedback in ("load", "copy"):
        base = controlled(feedback=feedback, **gains)
        parts = {**base.parts, "copy": hm.Sensor(quantity="tacho"), "tacho": hm.Sensor(quantity="load.speed")}
        result, _ = run_on_engine(hm.Scene(name="output", parts=parts, connections=base.connections).replacing(changes), 0.3)
        found.append(result.speeds["load"])
    np.testing.assert_array_equal(found[0], found[1])
    assert found[0][-1] > 0.3


def test_a_feedback_that_is_no_speed_is_refused() -> None:
    with pytest.raises(
        ParameterError, match=r"'controller' needs a speed in rad/s, but 'tacho' is in 'rad'\. Its feedback has to be a place"
    ):
        watching(quantity="motor.angle").network()
    with pytest.raises(ParameterError, match=r"'controller' needs a speed in rad/s, but 'tacho' is in 'V'"):
        watching(gain=0.01, unit="V").network()
    with pytest.raises(PlaceError, match=r"'controller' reads 'tach', which .* Its feedback has to be a place that turns, or a sensor"):
        controlled(feedback="tach").network()


def test_a_commanded_motor_without_a_controller_says_what_is_missing() -> None:
    with pytest.raises(PlaceError, match=r"CommandedMotor of 'motor' reads 'motor\.command'.*Add a part SpeedController\(motor='motor'"):
        train(motor=CommandedMotor(torque_limit=LIMIT)).network()


def test_a_controller_of_a_motor_that_takes_no_command_says_so() -> None:
    base = train()
    scene = hm.Scene(name="wrong", parts={**controlled().parts, "motor": base.parts["motor"]}, connections=base.connections)
    with pytest.raises(PlaceError, match="The characteristic of 'motor' must be a CommandedMotor"):
        scene.network()


def test_a_controller_of_an_unknown_motor_lists_the_bodies() -> None:
    with pytest.raises(PlaceError, match=r"No body 'engine'.*motor"):
        controlled(motor="engine").network()


def test_two_controllers_of_one_motor_are_refused() -> None:
    scene = controlled()
    twice = hm.Scene(name="twice", parts={**scene.parts, "second": scene.parts["controller"]}, connections=scene.connections)
    with pytest.raises(SceneError, match="'motor' has two speed controllers, the second is 'second'"):
        twice.network()


@pytest.mark.parametrize("limit", [0.0, -1.0, math.nan])
def test_a_torque_limit_that_is_not_positive_is_refused(limit: float) -> None:
    with pytest.raises(ParameterError, match=r"ServoMotor\.torque_limit"):
        servo(torque_limit=limit)


# -- prescribed motion -------------------------------------------------------------------------------


def test_an_ideal_motor_follows_its_profile_whatever_the_load() -> None:
    profile = SpeedRamp(start=0.0, end=150.0, duration=0.05)
    scene = train(motor=IdealSpeedMotor(motion=profile))
    result, how = run_on_engine(scene, 0.1)
    assert "motor" not in result.speeds
    network = scene.network()
    moment = network.moment(result.times, result.angles, result.speeds, result.states)
    np.testing.assert_allclose(moment.speed("motor"), profile.speed(result.times), rtol=0.0, atol=1e-11)
    assert result.speeds["gear.wave_generator"][-1] == pytest.approx(150.0, rel=0.02)
    assert how["input_shaft"] == "symbolic"


def test_the_torque_of_an_ideal_motor_accelerates_its_rotor_and_twists_the_shaft() -> None:
    scene = train(motor=IdealSpeedMotor(motion=SpeedRamp(start=0.0, end=150.0, duration=0.05)))
    result, _ = run_on_engine(scene, 0.1)
    network = scene.network()
    moment = network.moment(result.times, result.angles, result.speeds, result.states)
    read = {channel.name: channel.read for channel in network.channels}
    # rotor 1.5e-3 and half of the input shaft 1e-5; 150 rad/s in 0.05 s
    acceleration = np.where(result.times < 0.05, 150.0 / 0.05, 0.0)
    expected = (1.5e-3 + 0.5e-5) * acceleration + read["input_shaft.torque"](moment)
    np.testing.assert_allclose(read["motor.torque"](moment), expected, rtol=0.0, atol=1e-9)


def test_an_ideal_motor_takes_an_angle_as_a_plain_function() -> None:
    scene = train(motor=IdealSpeedMotor(motion=lambda t: 50.0 * t + 0.1 * np.sin(30.0 * t)))
    result, _ = run_on_engine(scene, 0.02)
    moment = scene.network().moment(result.times, result.angles, result.speeds, result.states)
    np.testing.assert_allclose(moment.speed("motor"), 50.0 + 3.0 * np.cos(30.0 * result.times), rtol=1e-12)


def test_an_ideal_motor_refuses_a_speed_without_an_angle() -> None:
    with pytest.raises(ParameterError, match="no closed-form angle"):
        IdealSpeedMotor(motion=SpeedFunction(function=lambda t: 1.0 + 0.0 * t))


# -- all of them on the engine -----------------------------------------------------------------------

ALL: dict[str, MotorCharacteristic] = STATIC | {
    "servo": servo(),
    "servo with current loop": servo(current_lag=1e-3),
    "ideal, ramp": IdealSpeedMotor(motion=PROFILES["ramp"]),
    "ideal, table": IdealSpeedMotor(motion=PROFILES["table of many points"]),
    "inverter, table": InverterMotor(**PLATE, feed=PROFILES["table"]),
}


@pytest.mark.parametrize("name", list(ALL))
def test_every_motor_runs_on_the_engine_without_a_python_callback(name: str) -> None:
    result, how = run_on_engine(train(motor=ALL[name]), 0.02)
    assert "symbolic" in how.values()
    assert np.isfinite(result.speeds["load"][-1])
    assert result.speeds["gear.wave_generator"][-1] != 0.0


def test_an_unknown_keyword_of_a_motor_is_refused_by_name() -> None:
    keywords: dict[str, Any] = PLATE | {"breakdown_ratios": 2.4}
    with pytest.raises(TypeError, match="breakdown_ratios"):
        AsynchronousMotor(**keywords)
