"""Effects on sensors: readings against closed forms, true quantities left alone, motion changed only by a controller that reads."""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.components.sensor import Sensor
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.effects.places import angle_sensors, sensors
from hdrive_mbs.errors import PlaceError, SceneError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.quantities import option, parameter

FIXED = hm.RungeKutta4(step=1e-4)
TIGHT = hm.DormandPrince(relative_tolerance=1e-10, absolute_tolerance=1e-12, max_step=1e-3)


@dataclass(frozen=True, kw_only=True)
class ReadingBrake(hm.Component):
    """A controller of a user's own: brakes a body in proportion to what a sensor shows."""

    place: str = option("body that is braked")
    sensor: str = option("sensor that is read")
    gain: float = parameter("1", "torque per reading")

    def build(self, name: str, draft: Draft) -> None:
        body, reading = draft.body(self.place).name, draft.read_channel(self.sensor, asked_by=name)
        draft.add_torque(f"{name}.brake", body, lambda moment: -self.gain * reading(moment))


def wheel(*more: tuple[str, hm.Component], torque: object = 3.0, **sensor: object) -> hm.Scene:
    """A free wheel of 0.5 kg m^2 with a driving torque, and an encoder on it."""
    drive = hm.Motor(inertia=0.5, characteristic=torque if callable(torque) else lambda time, speed: torque + 0.0 * time)
    encoder = Sensor(**{"quantity": "wheel.angle", **sensor})
    return hm.Scene(name="wheel", parts={"wheel": drive, "encoder": encoder, **dict(more)}, connections=[])


def swinging(amplitude: float, frequency: float) -> hm.Scene:
    """A wheel that is made to swing: angle = A sin(w t)."""

    def motion(time: Value) -> Value:
        return amplitude * np.sin(frequency * time)

    motor = hm.Motor(inertia=1.0, characteristic=hm.IdealSpeedMotor(motion=motion))
    free = hm.Inertia(inertia=1.0)
    parts = {"wheel": motor, "shaft": hm.Shaft(stiffness=1.0), "far": free, "encoder": Sensor(quantity="wheel.angle")}
    return hm.Scene(name="swinging", parts=parts, connections=[("wheel", "shaft", "far")])


def test_gain_and_offset_change_the_reading_and_nothing_else() -> None:
    scene = wheel().with_effect(hm.SensorGain(error=0.1), at="encoder").with_effect(hm.SensorOffset(offset=-0.2), at="encoder")
    response = hm.simulate(scene, 0.5, solver=TIGHT)
    # angle of a free wheel under a constant torque: M t^2/(2 J)
    angle = 0.5 * 3.0 / 0.5 * response.times**2
    np.testing.assert_allclose(response["wheel.angle"].values, angle, atol=1e-9)
    np.testing.assert_allclose(response["encoder"].values, 1.1 * angle - 0.2, atol=1e-9)
    np.testing.assert_array_equal(response["encoder.true"].values, response["wheel.angle"].values)
    assert response.units["encoder"] == response.units["encoder.true"] == "rad"


def test_effects_act_in_the_order_in_which_they_are_added() -> None:
    gain, offset = hm.SensorGain(error=1.0), hm.SensorOffset(offset=1.0)
    first = hm.simulate(wheel().with_effect(gain, at="encoder").with_effect(offset, at="encoder"), 0.01)
    last = hm.simulate(wheel().with_effect(offset, at="encoder").with_effect(gain, at="encoder"), 0.01)
    assert (first["encoder"].values[0], last["encoder"].values[0]) == (1.0, 2.0)


def test_a_sensor_rounds_what_is_left_of_the_quantity() -> None:
    # 1 step per 0.01 rad: the disturbed value is rounded, the rounded one is not disturbed
    scene = wheel(resolution=0.01).with_effect(hm.SensorOffset(offset=0.004), at="encoder")
    response = hm.simulate(scene, 0.5)
    expected = 0.01 * np.floor((response["wheel.angle"].values + 0.004) / 0.01 + 0.5)
    np.testing.assert_allclose(response["encoder"].values, expected, atol=1e-12)


def test_quantisation_keeps_within_half_a_step_and_repeats_its_steps() -> None:
    response = hm.simulate(wheel().with_effect(hm.SensorQuantisation(resolution=0.05), at="encoder"), 1.0)
    steps = response["encoder"].values / 0.05
    np.testing.assert_allclose(steps, np.round(steps), atol=1e-9)
    assert np.max(np.abs(response["encoder"].values - response["wheel.angle"].values)) <= 0.025 + 1e-12
    assert len(np.unique(np.round(steps))) > 20


def test_a_sensor_that_reads_a_sensor_sees_its_disturbed_reading() -> None:
    scene = wheel(("copy", Sensor(quantity="encoder", gain=2.0))).with_effect(hm.SensorGain(error=0.5), at="encoder")
    response = hm.simulate(scene, 0.2)
    np.testing.assert_allclose(response["copy"].values, 3.0 * response["wheel.angle"].values, rtol=1e-12)


def test_lag_follows_a_step_exponentially() -> None:
    lag = 0.02
    scene = wheel(torque=0.0).with_effect(hm.SensorLag(time_constant=lag), at="encoder")
    response = hm.simulate(scene, 0.2, solver=TIGHT, initial={"wheel.angle": 0.7})
    np.testing.assert_allclose(response["encoder"].values, 0.7 * (1.0 - np.exp(-response.times / lag)), atol=1e-9)


@pytest.mark.parametrize("effect", [hm.SensorLag(time_constant=0.01), hm.SensorDelay(delay=0.01)], ids=["lag", "delay"])
def test_lag_and_delay_show_a_steady_ramp_late_by_their_time(effect: Effect) -> None:
    scene = wheel(torque=0.0).with_effect(effect, at="encoder")
    response = hm.simulate(scene, 0.4, solver=TIGHT, initial={"wheel.speed": 5.0})
    late = response.times > 0.3  # exp(-0.3/0.01) = 1e-13 for the lag; the delay settles with exp(-3 t/0.01)
    np.testing.assert_allclose(response["encoder"].values[late], 5.0 * (response.times[late] - 0.01), atol=1e-8)


@pytest.mark.parametrize("frequency", [50.0, 150.0])
def test_delay_shifts_a_vibration_in_phase_alone(frequency: float) -> None:
    delay = 5e-3
    response = hm.simulate(swinging(1.0, frequency).with_effect(hm.SensorDelay(delay=delay), at="encoder"), 0.5, solver=TIGHT)
    settled = response.times > 0.1  # exp(-3 * 0.1/0.005) = 1e-26
    basis = np.exp(1j * frequency * response.times[settled])
    fit = np.linalg.lstsq(np.column_stack([basis.imag, basis.real]), response["encoder"].values[settled], rcond=None)[0]
    shown = complex(fit[0], fit[1])
    angle = frequency * delay
    assert abs(shown) == pytest.approx(1.0, rel=1e-6)  # an all-pass
    # the Pade approximant of order 2 errs by (w t)^5/720 in phase, in the first order of (w t)^2
    assert abs(cmath.phase(shown * cmath.exp(1j * angle))) < 1.1 * angle**5 / 720.0 + 1e-7


def test_eccentric_encoder_errs_with_its_true_angle() -> None:
    scene = wheel(torque=20.0).with_effect(hm.EncoderEccentricity(amplitude=0.02, order=2.0, phase=0.4), at="encoder")
    response = hm.simulate(scene, 1.0)
    angle = response["wheel.angle"].values
    assert np.ptp(angle) > 2.0 * math.pi
    np.testing.assert_allclose(response["encoder"].values, angle + 0.02 * np.sin(2.0 * angle + 0.4), atol=1e-12)


EVERY = (
    hm.SensorGain(error=0.3),
    hm.SensorOffset(offset=0.1),
    hm.SensorLag(time_constant=0.02),
    hm.SensorDelay(delay=0.02),
    hm.EncoderEccentricity(amplitude=0.1),
    hm.SensorQuantisation(resolution=0.1),
)


@pytest.mark.parametrize("effect", EVERY, ids=lambda effect: type(effect).__name__)
def test_the_motion_changes_only_where_a_controller_reads_the_sensor(effect: Effect) -> None:
    watching = hm.simulate(wheel(torque=3.0), 0.5, solver=FIXED)
    disturbed = hm.simulate(wheel(torque=3.0).with_effect(effect, at="encoder"), 0.5, solver=FIXED)
    np.testing.assert_array_equal(disturbed["wheel.angle"].values, watching["wheel.angle"].values)
    assert np.max(np.abs(disturbed["encoder"].values - watching["encoder"].values)) > 1e-3
    brake = ("brake", ReadingBrake(place="wheel", sensor="encoder", gain=20.0))
    held, misled = (hm.simulate(scene, 0.5, solver=FIXED) for scene in (wheel(brake), wheel(brake).with_effect(effect, at="encoder")))
    assert np.max(np.abs(held["wheel.angle"].values - misled["wheel.angle"].values)) > 1e-3


def test_sensors_are_the_places_and_encoders_those_that_read_angles() -> None:
    more = ("tacho", Sensor(quantity="wheel.speed")), ("copy", Sensor(quantity="encoder"))
    network = wheel(*more).with_effect(hm.SensorGain(error=0.1), at="encoder").network()
    assert sensors(network) == hm.SensorGain.places(network) == ("encoder", "tacho", "copy")
    assert angle_sensors(network) == hm.EncoderEccentricity.places(network) == ("encoder", "copy")


def test_eccentricity_of_a_tachometer_is_refused() -> None:
    with pytest.raises(PlaceError, match=r"reads the angle of a place, but 'tacho' reads 'wheel\.speed'"):
        wheel(("tacho", Sensor(quantity="wheel.speed"))).with_effect(hm.EncoderEccentricity(amplitude=0.1), at="tacho")


def test_a_scene_without_sensors_says_how_to_add_one() -> None:
    scene = hm.Scene(name="bare", parts={"wheel": hm.Inertia(inertia=1.0)}, connections=[])
    for place in ("wheel", "encoder"):
        with pytest.raises(PlaceError, match=r"none; add a part like Sensor\(quantity='load\.angle'\)"):
            scene.with_effect(hm.SensorGain(error=0.1), at=place)


def test_sensors_that_read_each_other_are_still_refused() -> None:
    scene = wheel(("copy", Sensor(quantity="encoder")), quantity="copy")
    with pytest.raises(PlaceError, match="reads the angle of a place"):
        scene.with_effect(hm.EncoderEccentricity(amplitude=0.1), at="encoder")
    with pytest.raises(SceneError, match="cannot depend on itself"):
        scene.with_effect(hm.SensorGain(error=0.1), at="encoder").network()


def test_a_sensor_effect_of_a_users_own_needs_one_law() -> None:
    @dataclass(frozen=True, kw_only=True)
    class Saturation(hm.SensorEffect):
        """Clipped reading."""

        limit: float = parameter("1", "largest reading", above=0.0)

        def reading(self, time: Value, value: Value) -> Value:
            return np.clip(value, -self.limit, self.limit)

    @dataclass(frozen=True, kw_only=True)
    class Drift(hm.MemorySensorEffect):
        """A zero that runs away."""

        rate: float = parameter("1/s", "drift")

        def states(self) -> Mapping[str, str]:
            return {"zero": "1"}

        def state_rate(self, name: str, time: Value, value: Value, state: Mapping[str, Value]) -> Value:
            return self.rate + 0.0 * value

        def reading(self, time: Value, value: Value, state: Mapping[str, Value]) -> Value:
            return value + state["zero"]

    scene = wheel().with_effect(Drift(rate=2.0), at="encoder", name="drift").with_effect(Saturation(limit=0.5), at="encoder")
    response = hm.simulate(scene, 0.5, solver=TIGHT)
    expected = np.minimum(3.0 * response.times**2 + 2.0 * response.times, 0.5)
    np.testing.assert_allclose(response["encoder"].values, expected, atol=1e-9)
    assert Saturation.family == "saturation"
    assert Saturation.places(scene.network()) == ("encoder",)
