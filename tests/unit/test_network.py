"""The equations of a scene: ratios, senses, reactions, held and prescribed places."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.components.rigid_coupling import RigidCoupling
from hdrive_mbs.components.sensor import Sensor
from hdrive_mbs.errors import LawError, PlaceError, SceneError
from hdrive_mbs.motors.ideal_speed import IdealSpeedMotor
from hdrive_mbs.motors.profiles.constant import ConstantSpeed
from hdrive_mbs.network.elements import Connection
from hdrive_mbs.network.network import Network

TIGHT = hm.DormandPrince(relative_tolerance=1e-9, absolute_tolerance=1e-11)


def gear(ratio: float = 50.0, **fields: Any) -> hm.HarmonicDrive:
    values: dict[str, Any] = {"stiffness": lambda twist: 1e4 * twist, "damping": 20.0, "flexspline_inertia": 1e-3}
    return hm.HarmonicDrive(ratio=ratio, **(values | {"wave_generator_inertia": 1e-4} | fields))


def scene(parts: Mapping[str, hm.Component], *connections: tuple[str, ...]) -> hm.Scene:
    return hm.Scene(name="under test", parts=parts, connections=connections)


def ratios(network: Network) -> dict[str, float]:
    return {body.name: body.ratio for body in network.bodies}


def load(inertia: float = 0.2, torque: float = 0.0) -> hm.Load:
    return hm.Load(inertia=inertia, torque=hm.ConstantTorque(value=torque), viscous=0.5)


def turning(speed: float = 10.0) -> hm.Motor:
    return hm.Motor(inertia=1e-3, characteristic=IdealSpeedMotor(motion=ConstantSpeed(value=speed)))


# -- ratios and senses of the harmonic drive ------------------------------------------------------

CONNECTIONS = {
    "flexspline": [("motor", "gear.wave_generator"), ("gear.flexspline", "load")],
    "circular_spline": [("motor", "gear.wave_generator"), ("gear.flexspline", "ground"), ("gear.circular_spline", "load")],
}


@pytest.mark.parametrize(
    ("output", "sense", "expected"),
    [
        # w_fs = w_wg/i + (1 - 1/i) w_cs with i = -u (opposite) or +u (same)
        ("flexspline", "opposite", -1.0 / 50.0),
        ("flexspline", "same", 1.0 / 50.0),
        # held flexspline: w_cs = -w_wg/(i - 1), so u + 1 in the sense of the input, or u - 1 against it
        ("circular_spline", "opposite", 1.0 / 51.0),
        ("circular_spline", "same", -1.0 / 49.0),
    ],
)
def test_the_output_turns_by_the_ratio_of_its_connection_and_in_its_sense(output: str, sense: str, expected: float) -> None:
    train = scene(
        {"motor": turning(), "gear": gear(output_sense=sense, circular_spline_inertia=1e-3), "load": load()}, *CONNECTIONS[output]
    )
    network = train.network()
    assert ratios(network)["load"] == pytest.approx(expected, abs=1e-12)
    assert {body.name: body.sense for body in network.bodies}["load"] == math.copysign(1, expected)
    # and so it does when it runs: after 1 s all vibration has decayed (rate d/(2J) = 20/0.4 = 50 1/s)
    response = hm.simulate(train, 1.0)
    assert response["load.speed"].values[-1] == pytest.approx(10.0 * expected, rel=1e-6)
    # the drag of the load is T along the flexspline, or (1 - 1/i) T along the circular spline
    share = 1.0 if output == "flexspline" else 1.0 + (1.0 if sense == "opposite" else -1.0) / 50.0
    assert response["gear.twist"].values[-1] == pytest.approx(0.5 * 10.0 * abs(expected) / share / 1e4, rel=1e-4)


def test_a_free_circular_spline_that_is_held_by_nothing_does_not_count_in_the_ideal_ratio() -> None:
    differential = scene(
        {"motor": turning(), "gear": gear(circular_spline_inertia=0.1), "load": load(), "ring": hm.Inertia(inertia=1.0)},
        ("motor", "gear", "load"),
        ("gear.circular_spline", "ring"),
    )
    found = ratios(differential.network())
    assert found["load"] == pytest.approx(-1.0 / 50.0, abs=1e-9)
    assert found["ring"] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("output", ["flexspline", "circular_spline"])
def test_the_reactions_on_the_three_flanges_of_a_gear_sum_to_zero(output: str) -> None:
    train = scene({"motor": turning(), "gear": gear(circular_spline_inertia=1e-3), "load": load(torque=7.0)}, *CONNECTIONS[output])
    network = train.network()
    moment = network.random_moment(np.random.default_rng(1), 20)
    mesh = network.connection("gear")
    contributions = mesh.contribution(moment)
    senses = {body.name: body.sense for body in network.bodies} | {motion.name: motion.sense for motion in network.motions}
    true_sense = [senses[name] * torque for name, torque in contributions.items()]
    torque = mesh.value(moment)
    np.testing.assert_allclose(sum(true_sense), 0.0, atol=1e-12 * np.max(np.abs(torque)))


def test_the_housing_carries_the_difference_of_output_and_input_torque() -> None:
    # held circular spline, output backwards: true-sense torques T/u + T + housing = 0 on the mesh, so the
    # mesh puts (1 + 1/u) T on the housing, against the sense of the flexspline's load
    train = scene({"motor": turning(), "gear": gear(), "load": load(torque=12.0)}, ("motor", "gear", "load"))
    response = hm.simulate(train, 1.0)
    torque = response["gear.torque"].values[-1]
    assert torque == pytest.approx(12.0 + 0.5 * 0.2, rel=1e-6)
    assert abs(response["gear.housing_torque"].values[-1]) == pytest.approx((1.0 + 1.0 / 50.0) * torque, rel=1e-12)


def test_two_gears_in_series_multiply_their_ratios_and_their_senses() -> None:
    parts = {"motor": turning(), "first": gear(50.0), "shaft": hm.Shaft(stiffness=500.0, damping=1.0), "second": gear(80.0)}
    train = scene(parts | {"load": load(0.05, torque=40.0)}, ("motor", "first", "shaft", "second", "load"))
    network = train.network()
    assert ratios(network)["load"] == pytest.approx(1.0 / 4000.0, abs=1e-12)
    assert ratios(network)["first.flexspline"] == pytest.approx(-1.0 / 50.0, abs=1e-12)
    response = hm.simulate(train, 1.0, initial_speed=10.0)
    assert response["load.speed"].values[-1] == pytest.approx(10.0 / 4000.0, rel=1e-3)
    assert response["first.flexspline.speed"].values[-1] == pytest.approx(-10.0 / 50.0, rel=1e-3)
    assert response["motor.torque"].values[-1] == pytest.approx((40.0 + 0.5 * 10.0 / 4000.0) / 4000.0, rel=1e-3)


def test_gears_with_one_output_forward_and_one_backward_turn_the_load_backwards() -> None:
    parts = {"motor": turning(), "first": gear(50.0, output_sense="same"), "second": gear(80.0), "load": load()}
    assert ratios(scene(parts, ("motor", "first", "second", "load")).network())["load"] == pytest.approx(-1.0 / 4000.0, abs=1e-12)


# -- rigid joints -----------------------------------------------------------------------------------


def test_parts_that_are_joined_rigidly_are_one_body_with_the_sum_of_their_inertias() -> None:
    parts = {
        "motor": turning(),
        "coupling": RigidCoupling(inertia=0.01),
        "shaft": hm.Shaft(stiffness=100.0, inertia=0.04, share_a=0.25, share_b=0.75),
        "disc": hm.Inertia(inertia=0.5),
        "load": load(0.2),
    }
    network = scene(parts, ("motor", "coupling", "shaft", "disc", "load")).network()
    assert [motion.name for motion in network.motions if motion.name != "ground"] == ["motor"]
    (body,) = network.bodies
    assert body.inertia == pytest.approx(0.75 * 0.04 + 0.5 + 0.2)
    assert network.places["coupling.b"] == network.places["shaft.a"] == "motor"
    assert network.places["load"] == network.places["disc"] == network.places["shaft.b"]


def test_a_rigid_coupling_in_the_middle_of_a_train_carries_the_motion() -> None:
    parts = {"a": hm.Inertia(inertia=1.0), "coupling": RigidCoupling(), "b": hm.Inertia(inertia=3.0), "s": hm.Shaft(stiffness=16.0)}
    response = hm.simulate(scene(parts, ("a", "coupling", "b", "s", "ground")), 1.0, initial={"a.speed": 1.0}, solver=TIGHT)
    assert response["b.speed"].values[-1] == response["a.speed"].values[-1]
    assert response["a.speed"].values[-1] == pytest.approx(math.cos(math.sqrt(16.0 / 4.0) * 1.0), abs=1e-7)


def test_two_shafts_in_a_row_need_an_inertia_between_them() -> None:
    parts = {"a": hm.Inertia(inertia=1.0), "s": hm.Shaft(stiffness=1.0), "r": hm.Shaft(stiffness=1.0), "b": hm.Inertia(inertia=1.0)}
    bare = scene(parts, ("a", "s", "r", "b"))
    with pytest.raises(SceneError, match=r"'s\.b' has no inertia \(0 kg m\^2\).*put an Inertia there"):
        bare.network()
    assert len(bare.replacing({"r.inertia": 1e-3}).network().bodies) == 3


def test_a_shaft_between_two_places_of_one_body_can_never_twist_and_is_refused() -> None:
    parts = {"disc": hm.Inertia(inertia=1.0), "shaft": hm.Shaft(stiffness=10.0)}
    with pytest.raises(SceneError, match="Both ends of 'shaft' are joined to 'disc'"):
        scene(parts, ("disc", "shaft", "disc")).network()
    with pytest.raises(SceneError, match=r"Both ends of 'shaft' are joined to 'ground'"):
        scene(parts | {"other": hm.Shaft(stiffness=1.0)}, ("ground", "shaft", "ground"), ("disc", "other", "ground")).network()


def test_shafts_in_parallel_add_their_stiffness() -> None:
    # a ring: disc - s - disc - r - disc
    parts = {"a": hm.Inertia(inertia=1.0), "s": hm.Shaft(stiffness=5.0), "b": hm.Inertia(inertia=2.0), "r": hm.Shaft(stiffness=3.0)}
    ring = scene(parts, ("a", "s", "b", "r", "a"))
    assert hm.modes(ring).undamped == pytest.approx([math.sqrt(8.0 * (1.0 + 0.5))], rel=1e-9)


def test_a_connection_that_is_named_twice_counts_once() -> None:
    parts = {"a": hm.Inertia(inertia=1.0), "s": hm.Shaft(stiffness=5.0), "b": hm.Inertia(inertia=2.0)}
    once, twice = scene(parts, ("a", "s", "b")), scene(parts, ("a", "s", "b"), ("a", "s.a"), ("a", "s", "b"))
    assert hm.modes(twice).undamped == pytest.approx(hm.modes(once).undamped, rel=1e-12)


# -- the ground -------------------------------------------------------------------------------------


def test_a_disc_on_a_shaft_to_the_ground_oscillates_as_the_closed_form() -> None:
    # q = (w0/W) sin(W t) exp(-z w t), w = sqrt(k/J) = 5, z = d/(2 sqrt(k J)) = 0.03, W = w sqrt(1 - z^2)
    parts = {"disc": hm.Inertia(inertia=2.0), "shaft": hm.Shaft(stiffness=50.0, damping=0.6)}
    response = hm.simulate(scene(parts, ("disc", "shaft", "ground")), 2.0, initial_speed=3.0, solver=TIGHT)
    w, z = 5.0, 0.6 / (2.0 * math.sqrt(50.0 * 2.0))
    damped = w * math.sqrt(1.0 - z * z)
    t = response.times
    expected = 3.0 / damped * np.sin(damped * t) * np.exp(-z * w * t)
    np.testing.assert_allclose(response["disc.angle"].values, expected, atol=1e-7)


def test_the_reference_turns_by_exactly_one_also_when_a_shaft_holds_it() -> None:
    parts = {"disc": hm.Inertia(inertia=2.0), "shaft": hm.Shaft(stiffness=50.0)}
    assert ratios(scene(parts, ("disc", "shaft", "ground")).network()) == {"disc": 1.0}


def test_a_motor_joined_to_the_ground_stands_still() -> None:
    parts = {
        "motor": hm.Motor(inertia=1.0, characteristic=lambda w: 5.0 - w),
        "s": hm.Shaft(stiffness=4.0),
        "disc": hm.Inertia(inertia=1.0),
    }
    response = hm.simulate(scene(parts, ("motor", "s", "disc"), ("motor", "ground")), 1.0, initial={"disc.speed": 1.0}, solver=TIGHT)
    assert response["motor.torque"].values[-1] == 5.0
    assert response["disc.speed"].values[-1] == pytest.approx(math.cos(2.0), abs=1e-7)


def test_a_scene_in_which_nothing_can_move_is_refused() -> None:
    with pytest.raises(SceneError, match="no body that can move"):
        scene({"disc": hm.Inertia(inertia=1.0)}, ("disc", "ground")).network()
    with pytest.raises(SceneError, match="no body that can move"):
        scene({"motor": turning()}).network()


# -- prescribed motions -------------------------------------------------------------------------------


def test_a_prescribed_motion_drives_its_neighbour_as_the_closed_form_and_tells_its_torque() -> None:
    # J q'' = k (A sin(Wt) - q), q(0) = q'(0) = 0:  q = A w^2/(w^2 - W^2) (sin(Wt) - W/w sin(wt))
    A, W, J, k, rotor = 0.3, 3.0, 0.5, 8.0, 0.01
    w = math.sqrt(k / J)
    parts = {
        "motor": hm.Motor(inertia=rotor, characteristic=IdealSpeedMotor(motion=lambda t: A * np.sin(W * t))),
        "s": hm.Shaft(stiffness=k),
        "disc": hm.Inertia(inertia=J),
    }
    response = hm.simulate(scene(parts, ("motor", "s", "disc")), 3.0, solver=TIGHT)
    t = response.times
    q = A * w**2 / (w**2 - W**2) * (np.sin(W * t) - W / w * np.sin(w * t))
    np.testing.assert_allclose(response["disc.angle"].values, q, atol=1e-7)
    np.testing.assert_allclose(response["motor.angle"].values, A * np.sin(W * t), atol=1e-14)
    np.testing.assert_allclose(response["motor.speed"].values, A * W * np.cos(W * t), atol=1e-14)
    needed = -rotor * A * W**2 * np.sin(W * t) + k * (A * np.sin(W * t) - response["disc.angle"].values)
    np.testing.assert_allclose(response["motor.torque"].values, needed, atol=1e-12)


def test_a_shaft_between_two_prescribed_places_has_its_torque_and_moves_nothing_else() -> None:
    parts = {
        "motor": hm.Motor(inertia=1.0, characteristic=IdealSpeedMotor(motion=lambda t: 2.0 * t)),
        "s": hm.Shaft(stiffness=7.0, damping=0.5),
        "brake": hm.Motor(inertia=1.0, characteristic=IdealSpeedMotor(motion=lambda t: 1.5 * t)),
        "disc": hm.Inertia(inertia=1.0),
        "r": hm.Shaft(stiffness=1.0),
    }
    response = hm.simulate(scene(parts, ("motor", "s", "brake"), ("disc", "r", "ground")), 1.0)
    np.testing.assert_allclose(response["s.torque"].values, 7.0 * 0.5 * response.times + 0.5 * 0.5, rtol=1e-12)
    np.testing.assert_array_equal(response["disc.angle"].values, 0.0)


def test_a_motion_that_cannot_be_differentiated_is_refused_by_name() -> None:
    parts = {"motor": hm.Motor(inertia=1.0, characteristic=IdealSpeedMotor(motion=math.sin)), "s": hm.Shaft(stiffness=1.0)}
    with pytest.raises(LawError, match=r"motion of 'motor' must be written with numpy functions"):
        scene(parts | {"disc": hm.Inertia(inertia=1.0)}, ("motor", "s", "disc")).network()


# -- power and channels -------------------------------------------------------------------------------


def test_every_connection_takes_from_the_bodies_the_power_of_its_torque() -> None:
    parts = {"motor": hm.Motor(inertia=1.0, characteristic=lambda w: 0.0 * w), "s": hm.Shaft(stiffness=40.0, damping=2.0), "gear": gear()}
    network = scene(parts | {"load": load()}, ("motor", "s", "gear", "load")).network()
    moment = network.random_moment(np.random.default_rng(2), 50)
    connections = [element for element in network.elements if isinstance(element, Connection)]
    assert {element.name for element in connections} == {"s", "gear"}
    for element in connections:
        given = sum(torque * moment.speed(name) for name, torque in element.contribution(moment).items())
        np.testing.assert_allclose(element.power(moment), -given, rtol=1e-9, atol=1e-9)
    energy = sum(0.5 * body.inertia * moment.speed(body.name) ** 2 for body in network.bodies)
    np.testing.assert_allclose(network.kinetic_energy(moment), energy, rtol=1e-12)


def test_an_unknown_connection_of_a_network_is_a_key_error() -> None:
    with pytest.raises(KeyError, match="gaer"):
        scene({"motor": turning(), "gear": gear(), "load": load()}, ("motor", "gear", "load")).network().connection("gaer")


def test_a_sensor_of_what_is_not_there_lists_what_is() -> None:
    parts = {"disc": hm.Inertia(inertia=1.0), "encoder": Sensor(quantity="disk.angle")}
    with pytest.raises(PlaceError, match=r"'encoder' reads 'disk\.angle', which this scene does not have.*disc\.angle"):
        scene(parts).network()


def test_sensors_may_read_each_other_but_not_in_a_circle() -> None:
    chain = {"disc": hm.Inertia(inertia=1.0), "b": Sensor(quantity="a", gain=2.0), "a": Sensor(quantity="disc.angle", gain=3.0)}
    response = hm.simulate(scene(chain), 0.1, initial_speed=1.0)
    np.testing.assert_allclose(response["b"].values, 6.0 * response["disc.angle"].values, rtol=1e-14)
    assert response.units["b"] == "rad"
    circle = {"disc": hm.Inertia(inertia=1.0), "a": Sensor(quantity="b"), "b": Sensor(quantity="a")}
    with pytest.raises(SceneError, match="cannot depend on itself"):
        scene(circle).network()
