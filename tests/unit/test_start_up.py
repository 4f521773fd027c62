"""Figures of a start-up against closed forms."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import hdrive_mbs as hm
from models.harmonic_drive_train import build

TIGHT = hm.DormandPrince(relative_tolerance=1e-10, absolute_tolerance=1e-12)


def test_a_lone_motor_rises_as_its_time_constant_says() -> None:
    # J dw/dt = T0 - c w:  w = T0/c (1 - e^(-c t/J)),  95 % at J/c ln 20
    inertia, torque, drag = 0.01, 2.0, 0.05
    scene = hm.Scene(
        name="motor alone",
        parts={"motor": hm.Motor(inertia=inertia, viscous=drag, characteristic=lambda speed: torque + 0.0 * speed)},
        connections=[],
    )
    result = hm.start_up(scene, 20.0 * inertia / drag, solver=TIGHT)
    # after 18 time constants, where the average begins, e^-18 = 1.5e-8 of the speed is missing
    assert result.final_speed == pytest.approx(torque / drag, rel=1.5e-8)
    # 1.5e-8 of the speed is 1.5e-8/0.05 time constants at 95 %; the Hermite error is h^4/384 with h < 0.01 s = 1/20 time constant
    assert result.rise_time == pytest.approx(inertia / drag * math.log(20.0), rel=1e-6)
    assert result.overshoot < 1e-7
    assert result.status == "complete"


def test_lost_motion_is_taken_up_when_the_motor_has_turned_half_of_it() -> None:
    # constant torque M on J = J_motor + J_wg turns freely:  u phi0/2 = M t^2/(2 J);  the machine stands still meanwhile
    gap, ratio, torque = hm.arcmin(9.0), 100.0, 0.4
    law = hm.PiecewiseLinearStiffness(lost_motion=gap, stiffness_1=3.2e4, stiffness_2=6.4e4, stiffness_3=11e4, torque_1=23.5, torque_2=98.0)
    scene = hm.Scene(
        name="gap",
        parts={
            "motor": hm.Motor(inertia=1.5e-3, characteristic=lambda speed: torque + 0.0 * speed),
            "gear": hm.HarmonicDrive(ratio=ratio, stiffness=law, wave_generator_inertia=2e-4),
            "load": hm.Load(inertia=0.5, torque=lambda time: 0.0 * time),
        },
        connections=[("motor", "gear", "load")],
    )
    result = hm.start_up(scene, 0.1, solver=TIGHT)
    # the angle is a parabola, which cubic Hermite interpolation holds exactly
    assert result.take_up_time == {"gear": pytest.approx(math.sqrt(gap * ratio * 1.7e-3 / torque), rel=1e-9)}


def test_damping_in_the_gap_gives_torque_before_the_take_up() -> None:
    result = hm.start_up(build(), 0.02)
    before = result["gear.torque"].between(0.0, result.take_up_time["gear"])
    assert np.max(np.abs(before.values)) > 0.0
    assert abs(float(result["gear.twist"].at(result.take_up_time["gear"]))) == pytest.approx(hm.arcmin(4.5), rel=1e-9)


def test_peaks_and_final_values_are_those_of_the_histories() -> None:
    scene = build(load=hm.ConstantTorque(value=20.0))
    result = hm.start_up(scene, 1.2)
    torque = result["gear.torque"].values
    assert result.peak_torque["gear"] == np.max(torque) == torque[np.argmax(np.abs(torque))]
    assert result["gear.torque"].at(result.peak_time["gear"]) == pytest.approx(result.peak_torque["gear"])
    # settled: the gear carries the load; the ringing (decay about 8 1/s from 90 N m) has fallen to less than 0.02 N m
    assert result.final_torque["gear"] == pytest.approx(20.0, abs=0.02)
    assert result.final_torque["input_shaft"] == pytest.approx(0.2, abs=2e-4)
    # the breakdown torque is passed on the way up:  2.4 * 550 W/(1410 rpm)
    assert result.peak_motor_torque == pytest.approx(2.4 * 550.0 / (1410.0 * math.pi / 30.0), rel=1e-3)
    # final speed: Kloss's torque equals 20/100 N m, on the stable branch
    speeds = np.linspace(140.0, 157.07, 200001)
    characteristic = scene.parts["motor"].characteristic  # type: ignore[attr-defined]
    balanced = speeds[np.argmin(np.abs(characteristic.torque(0.0, speeds) - 0.2))]
    assert result.final_speed == pytest.approx(balanced, rel=1e-4)
    assert 0.0 < result.overshoot < 0.1
    assert float(result["motor.speed"].at(result.rise_time)) == pytest.approx(0.95 * result.final_speed, rel=1e-9)


def test_a_run_that_is_too_short_says_so() -> None:
    result = hm.start_up(build(), 0.03)
    assert "not steady" in result.status
    assert "longer duration" in result.status


def test_a_motor_without_torque_does_not_start() -> None:
    scene = build().replacing({"motor.characteristic": lambda speed: 0.0 * speed, "load.torque": hm.ConstantTorque(value=0.0)})
    result = hm.start_up(scene, 0.02)
    assert result.status == "complete; the motor does not start"
    assert math.isnan(result.rise_time)
    assert math.isnan(result.take_up_time["gear"])


def test_a_start_up_is_a_response_and_is_saved_as_one(tmp_path: Path) -> None:
    result = hm.start_up(build(), 0.05)
    assert isinstance(result, hm.Response)
    copy = hm.load(result.save(tmp_path / "start.npz"))
    assert isinstance(copy, hm.StartUp)
    assert copy.take_up_time == result.take_up_time
    np.testing.assert_array_equal(copy["motor.speed"].values, result["motor.speed"].values)


def test_the_motor_must_be_known() -> None:
    parts = {"a": hm.Inertia(inertia=1.0), "s": hm.Shaft(stiffness=1e3), "b": hm.Inertia(inertia=1.0)}
    scene = hm.Scene(name="no motor", parts=parts, connections=[("a", "s", "b")])
    with pytest.raises(hm.SceneError, match="has none"):
        hm.start_up(scene, 0.1)
    with pytest.raises(hm.SceneError, match=r"'load' is not a motor of this scene. Motors: motor"):
        hm.start_up(build(), 0.1, motor="load")
