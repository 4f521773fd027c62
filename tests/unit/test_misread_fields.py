"""Functions, units and classes that would be taken for something else are refused with the way out."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from models.harmonic_drive_train import build
from tests.unit.diagnosis_cases import bench, quiet


def motor(function: Callable[..., Any]) -> hm.Motor:
    return hm.Motor(inertia=1.0, characteristic=function)


def load(function: Callable[..., Any]) -> hm.Load:
    return hm.Load(inertia=1.0, torque=function)


def drive(**fields: Any) -> hm.HarmonicDrive:
    return hm.HarmonicDrive(ratio=100.0, **{"stiffness": hm.LinearStiffness(constant=1e4), **fields})


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (
            lambda: motor(lambda time: 1.0),
            r"called with \(speed\), so 'time' would get the speed. Give one of \(speed\) or \(time, speed\)",
        ),
        (lambda: motor(lambda speed, time: 1.0), r"'speed' would get the time"),
        (lambda: load(lambda speed: 0.3 * speed), r"'speed' would get the time. Give one of \(time\) or \(time, angle, speed\)"),
        (lambda: load(lambda time, speed, angle: 0.0), r"'speed' would get the angle"),
    ],
)
def test_a_function_whose_arguments_say_something_else_is_refused(make: Callable[[], Any], words: str) -> None:
    with pytest.raises(hm.ParameterError, match=words):
        make()


def test_names_that_say_nothing_else_are_taken() -> None:
    motor(lambda w: 60.0 - w)
    motor(lambda t, omega: t + omega)
    motor(lambda x: x)
    load(lambda t: t)
    load(lambda t, angle, speed, factor=2.0: factor * speed)
    drive(stiffness=lambda angle: 1e4 * angle)  # a twist is an angle


def test_damping_that_cannot_leave_out_a_gap_is_refused() -> None:
    def slack(twist: Any) -> Any:
        return 1e4 * np.where(np.abs(twist) < 1e-3, 0.0, twist)

    with pytest.raises(hm.ParameterError, match="no torque about zero twist but names no gap"):
        drive(stiffness=slack, damping=1.0, damping_in_gap=False)
    drive(stiffness=slack, damping=1.0)
    drive(damping=1.0, damping_in_gap=False)  # without a gap there is nothing to leave out


def test_a_stiffness_law_with_other_arguments_is_named() -> None:
    class Rated(hm.StiffnessLaw):
        def torque(self, twist: Any, rate: Any) -> Any:  # type: ignore[override]
            return twist + rate

    with pytest.raises(hm.LawError, match=r"Rated\.torque takes \(twist.*rate.*\).* but is called with \(twist\)"):
        drive(stiffness=Rated())


def test_a_class_without_its_decorator_is_named() -> None:
    class Bare(hm.TorqueEffect):
        size: float = hm.parameter("N m", "torque", default=1.0)

    for fields in ({"size": 1.0}, {}):
        with pytest.raises(
            hm.ParameterError, match=r"Bare has the fields size but is no dataclass: put @dataclass\(frozen=True, kw_only=True\)"
        ):
            Bare(**fields)


def test_a_sensor_gives_no_quantity_another_unit_without_a_gain() -> None:
    def with_sensor(**fields: Any) -> hm.Scene:
        scene = build()
        return hm.Scene(
            name="bench", parts={**scene.parts, "enc": hm.Sensor(quantity="load.angle", **fields)}, connections=scene.connections
        )

    with pytest.raises(hm.ParameterError, match=r"enc: its unit is 'deg', but it reads load\.angle in 'rad' with a gain of 1"):
        with_sensor(unit="deg").network()
    for fields in ({}, {"unit": "rad"}, {"unit": "deg", "gain": 180.0 / np.pi}):
        units = {channel.name: channel.unit for channel in with_sensor(**fields).network().channels}
        assert units["enc"] == fields.get("unit", "rad")


def test_the_law_of_an_input_gets_arrays() -> None:
    record = quiet()[0]
    seen: list[Any] = []

    def law(times: Any, values: Any) -> hm.TableTorque:
        seen.append((times, values))
        return hm.TableTorque(times=times, torques=2.0 * values)

    made = bench()
    twice = {**made.inputs, "load_torque": hm.Input(path="load.torque", law=law)}
    (trial,) = hm.Bench(scene=made.scene, knowledge=made.knowledge, measured=made.measured, inputs=twice).trials(record)
    (times, values) = seen[-1]
    assert isinstance(times, np.ndarray)
    np.testing.assert_array_equal(values, record["load_torque"].values)
    assert trial.scene.parts["load"].torque.torques == tuple(2.0 * values)  # type: ignore[attr-defined]
