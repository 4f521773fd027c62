"""Rigid coupling, sensor, and the values that parts refuse."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.components.rigid_coupling import RigidCoupling
from hdrive_mbs.components.sensor import Sensor
from hdrive_mbs.errors import ParameterError, PlaceError, SceneError
from hdrive_mbs.loads.constant import ConstantTorque
from tests.unit.law_checks import run_on_engine
from tests.verification.scenes import train


def with_parts(**parts: hm.Component) -> hm.Scene:
    """The train with more parts that have no flange."""
    base = train()
    return hm.Scene(name="train with more parts", parts={**base.parts, **parts}, connections=base.connections)


def read(scene: hm.Scene, name: str) -> Any:
    return next(channel for channel in scene.network().channels if channel.name == name)


# -- rigid coupling ----------------------------------------------------------------------------------


def coupled() -> hm.Scene:
    return hm.Scene(
        name="coupled",
        parts={
            "motor": hm.Motor(inertia=2e-3, characteristic=lambda speed: 3.0 + 0.0 * speed),
            "coupling": RigidCoupling(inertia=5e-4),
            "load": hm.Load(inertia=1.5e-3, torque=ConstantTorque(value=1.0)),
        },
        connections=[("motor", "coupling", "load")],
    )


def test_a_rigid_coupling_makes_one_body_of_both_sides() -> None:
    bodies = coupled().network().bodies
    assert [body.name for body in bodies] == ["motor"]
    assert bodies[0].inertia == pytest.approx(2e-3 + 5e-4 + 1.5e-3, rel=1e-15)


def test_both_sides_of_a_rigid_coupling_accelerate_as_one_mass() -> None:
    scene = coupled()
    result, _ = run_on_engine(scene, 0.1)
    # (3 - 1) N m on 4e-3 kg m^2
    assert result.speeds["motor"][-1] == pytest.approx(2.0 / 4e-3 * 0.1, rel=1e-9)
    moment = scene.network().moment(result.times, result.angles, result.speeds, result.states)
    for channel in ("motor.speed", "load.speed"):
        np.testing.assert_array_equal(read(scene, channel).read(moment), result.speeds["motor"])


def test_an_elastic_train_is_not_changed_by_a_massless_rigid_coupling() -> None:
    base = train()
    scene = hm.Scene(
        name="with coupling",
        parts={**base.parts, "coupling": RigidCoupling()},
        connections=[("motor", "coupling", "input_shaft", "gear", "output_shaft", "load")],
    )
    plain, _ = run_on_engine(base, 0.02)
    rigid, _ = run_on_engine(scene, 0.02)
    assert set(rigid.speeds) == set(plain.speeds)
    np.testing.assert_array_equal(rigid.speeds["load"], plain.speeds["load"])


def test_a_loose_end_of_a_coupling_is_refused() -> None:
    with pytest.raises(SceneError, match=r"Loose end: nothing is connected to 'coupling\.b'"):
        hm.Scene(
            name="loose",
            parts={"motor": hm.Inertia(inertia=1.0), "coupling": RigidCoupling()},
            connections=[("motor", "coupling.a")],
        )


# -- sensor ------------------------------------------------------------------------------------------


def test_a_sensor_reads_its_quantity_with_gain_and_offset() -> None:
    scene = with_parts(pickup=Sensor(quantity="load.speed", gain=-2.0, offset=0.25))
    result, _ = run_on_engine(scene, 0.02)
    moment = scene.network().moment(result.times, result.angles, result.speeds, result.states)
    speed = read(scene, "load.speed").read(moment)
    np.testing.assert_array_equal(read(scene, "pickup").read(moment), -2.0 * speed + 0.25)
    assert np.ptp(speed) > 0.0


def test_an_encoder_reads_whole_steps_and_errs_by_half_a_step_at_most() -> None:
    step = 2.0 * math.pi / 4096.0
    encoder = Sensor(quantity="motor.angle", resolution=step)
    angle = np.random.default_rng(7).uniform(-20.0, 20.0, 1000)
    reading = np.asarray(encoder.reading(angle))
    # 1e4 steps of rounding 1e-16 each
    np.testing.assert_allclose(reading / step, np.round(reading / step), atol=1e-9)
    assert np.max(np.abs(reading - angle)) <= 0.5 * step * (1.0 + 1e-9)
    assert np.max(np.abs(reading - angle)) > 0.45 * step


def test_a_sensor_has_the_unit_of_its_quantity_unless_another_is_given() -> None:
    scene = with_parts(
        torque=Sensor(quantity="gear.torque"),
        volts=Sensor(quantity="torque", gain=0.05, unit="V"),
        copy=Sensor(quantity="volts"),
        early=Sensor(quantity="copy"),
    )
    assert [read(scene, name).unit for name in ("torque", "volts", "copy", "early")] == ["N m", "V", "V", "V"]


def test_a_sensor_of_a_sensor_reads_its_reading() -> None:
    scene = with_parts(first=Sensor(quantity="second", gain=3.0), second=Sensor(quantity="motor.speed", offset=1.0))
    network = scene.network()
    names = [body.name for body in network.bodies]
    moment = network.moment(0.0, dict.fromkeys(names, 0.0), dict.fromkeys(names, 2.0), {})
    assert read(scene, "first").read(moment) == 3.0 * (2.0 + 1.0)


def test_a_sensor_of_an_unknown_quantity_lists_those_that_exist() -> None:
    with pytest.raises(PlaceError, match=r"'pickup' reads 'load\.sped', which this scene does not have\..*load\.speed.*gear\.torque"):
        with_parts(pickup=Sensor(quantity="load.sped")).network()


def test_sensors_that_read_each_other_are_refused() -> None:
    with pytest.raises(SceneError, match="a reads b reads a: a reading cannot depend on itself"):
        with_parts(a=Sensor(quantity="b"), b=Sensor(quantity="a")).network()
    with pytest.raises(SceneError, match="cannot depend on itself"):
        with_parts(c=Sensor(quantity="a"), a=Sensor(quantity="b"), b=Sensor(quantity="a")).network()


def test_a_sensor_without_gain_or_with_a_negative_step_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"Sensor\.gain = 0 reads nothing"):
        Sensor(quantity="load.speed", gain=0.0)
    with pytest.raises(ParameterError, match=r"Sensor\.resolution = -1: must be at least 0"):
        Sensor(quantity="load.speed", resolution=-1.0)


# -- values that parts refuse ------------------------------------------------------------------------


@pytest.mark.parametrize("inertia", [0.0, -1e-3, math.nan, math.inf])
def test_an_inertia_that_is_not_positive_and_finite_is_refused(inertia: float) -> None:
    parts: list[tuple[type[hm.Component], dict[str, Any]]] = [
        (hm.Motor, {"characteristic": lambda speed: 0.0 * speed}),
        (hm.Inertia, {}),
        (hm.Load, {"torque": ConstantTorque(value=1.0)}),
    ]
    for part, others in parts:
        name = part.__name__
        with pytest.raises(ParameterError, match=rf"{name}\.inertia = .* kg m\^2: must be (greater than 0|a finite number)"):
            part(inertia=inertia, **others)


def test_a_negative_inertia_of_a_coupling_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"RigidCoupling\.inertia = -1 kg m\^2: must be at least 0"):
        RigidCoupling(inertia=-1.0)


@pytest.mark.parametrize("part", [hm.Motor, hm.Inertia, hm.Shaft, hm.Load, hm.HarmonicDrive, RigidCoupling, Sensor])
def test_an_unknown_keyword_of_a_part_is_refused_by_name(part: type[hm.Component]) -> None:
    keywords: dict[str, Any] = {"inerta": 1.0}
    with pytest.raises(TypeError, match="inerta"):
        part(**keywords)
