"""A scene is a value: it prints, compares, copies with changes, and refuses what is not a train."""

from __future__ import annotations

import copy
import functools
import math
import pickle
from collections.abc import Callable
from dataclasses import FrozenInstanceError, dataclass
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.errors import HdriveError, KeywordError, ParameterError, PlaceError, SceneError
from hdrive_mbs.expression import Value
from hdrive_mbs.loads.law import LoadFunction
from hdrive_mbs.quantities import Described, table
from hdrive_mbs.scene import PlacedEffect
from tests.verification.scenes import train


def friction(coulomb: float = 1.0) -> hm.CoulombStribeckFriction:
    return hm.CoulombStribeckFriction(coulomb=coulomb)


def two_discs() -> dict[str, hm.Component]:
    return {"a": hm.Inertia(inertia=1.0), "s": hm.Shaft(stiffness=100.0), "b": hm.Inertia(inertia=2.0)}


def discs(*connections: tuple[str, ...], **more: hm.Component) -> hm.Scene:
    return hm.Scene(name="two discs", parts=two_discs() | more, connections=connections or [("a", "s", "b")])


# -- a value ----------------------------------------------------------------------------------------


def test_a_scene_prints_parts_with_units_connections_effects_and_senses() -> None:
    text = str(train().with_effect(friction(), at="load"))
    for piece in (
        "Scene 'train under verification'",
        "Motor(inertia=0.0015 kg m^2, characteristic=AsynchronousMotor(rated_power=550 W",
        "motor - input_shaft - gear - output_shaft - load",
        "coulomb_stribeck_friction at load: CoulombStribeckFriction(coulomb=1 N m",
    ):
        assert piece in text
    turns = dict(line.split() for line in text.split("turns per turn of the motor\n")[1].splitlines())
    assert turns == {"motor": "+1", "gear.wave_generator": "+1", "gear.flexspline": "-0.01", "load": "-0.01"}


def test_a_scene_that_cannot_be_solved_still_prints_and_says_why() -> None:
    parts = two_discs() | {"r": hm.Shaft(stiffness=1.0)}
    text = str(hm.Scene(name="x", parts=parts, connections=[("a", "s", "r", "b")]))
    assert "stiffness=100 N m/rad" in text
    assert "it cannot be solved: 's.b' has no inertia" in text


def test_a_function_prints_by_its_name() -> None:
    def weight(time: Value) -> Value:
        return 5.0

    assert "torque=LoadFunction(function=function weight)" in str(train(load=weight))


def test_equal_scenes_built_twice_are_equal_and_a_change_makes_them_differ() -> None:
    assert train() == train()
    assert hash(train()) == hash(train())
    assert train().with_effect(friction(), at="load") == train().with_effect(friction(), at="load")
    for other in (
        train().replacing({"motor.inertia": 2e-3}),
        train().with_effect(friction(), at="load"),
        train(ratio=80.0),
    ):
        assert other != train()
    assert train().with_effect(friction(1.0), at="load") != train().with_effect(friction(2.0), at="load")
    assert train().with_effect(friction(), at="load") != train().with_effect(friction(), at="motor")


def test_scenes_whose_parts_are_listed_in_another_order_are_equal_and_hash_alike() -> None:
    parts = two_discs()
    backwards = dict(reversed(parts.items()))
    one, other = (hm.Scene(name="x", parts=p, connections=[("a", "s", "b")]) for p in (parts, backwards))
    assert one == other
    assert hash(one) == hash(other)
    assert len({one, other}) == 1


def test_asking_for_the_network_does_not_change_the_value() -> None:
    asked, fresh = train(), train()
    assert asked.network() is asked.network()
    assert asked == fresh
    assert hash(asked) == hash(fresh)


def test_a_scene_cannot_be_changed_in_place() -> None:
    scene = train()
    with pytest.raises(FrozenInstanceError):
        scene.name = "other"  # type: ignore[misc]
    with pytest.raises(TypeError, match="item assignment"):
        scene.parts["motor"] = hm.Inertia(inertia=1.0)  # type: ignore[index]
    with pytest.raises(FrozenInstanceError):
        scene.parts["load"].inertia = 3.0  # type: ignore[attr-defined]
    parts = two_discs()
    built = hm.Scene(name="x", parts=parts, connections=[("a", "s", "b")])
    parts["a"] = hm.Inertia(inertia=7.0)
    assert built.parts["a"] == hm.Inertia(inertia=1.0)


@pytest.mark.parametrize("again", [lambda scene: pickle.loads(pickle.dumps(scene)), copy.deepcopy, copy.copy])
def test_a_scene_survives_pickling_and_copying(again: Callable[[hm.Scene], hm.Scene]) -> None:
    scene = train().with_effect(friction(), at="load")
    scene.network()
    other = again(scene)
    assert other == scene
    assert hash(other) == hash(scene)
    assert [body.name for body in other.network().bodies] == [body.name for body in scene.network().bodies]
    with pytest.raises(TypeError, match="item assignment"):
        other.parts["motor"] = hm.Inertia(inertia=1.0)  # type: ignore[index]


# -- changes ----------------------------------------------------------------------------------------


def test_a_value_is_replaced_in_a_copy_at_any_depth() -> None:
    scene = train().with_effect(friction(), at="load")
    changed = scene.replacing(
        {
            "motor.inertia": 2e-3,
            "motor.characteristic.breakdown_ratio": 3.0,
            "gear.stiffness.torque_1": 30.0,
            "load.torque.mean": 7.0,
            "coulomb_stribeck_friction.coulomb": 5.0,
            "gear.output_sense": "same",
        }
    )
    values = {name: item.value for name, item in changed.parameters().items()}
    assert values["motor.inertia"] == 2e-3
    assert values["motor.characteristic.breakdown_ratio"] == 3.0
    assert values["gear.stiffness.torque_1"] == 30.0
    assert values["load.torque.mean"] == 7.0
    assert values["coulomb_stribeck_friction.coulomb"] == 5.0
    assert {body.sense for body in changed.network().bodies} == {1}
    assert scene == train().with_effect(friction(), at="load")


def test_laws_parts_and_effects_are_replaced_whole() -> None:
    scene = train().with_effect(friction(), at="load", name="drag")
    changed = scene.replacing(
        {"load.torque": lambda time: 5.0 + 0.0 * time, "gear.stiffness": hm.CubicStiffness(linear=1e4, cubic=0.0)},
        motor=hm.Motor(inertia=3.0, characteristic=lambda w: -w),
        drag=hm.ViscousDrag(coefficient=0.5),
    )
    assert isinstance(changed.parts["load"].torque, LoadFunction)  # type: ignore[attr-defined]
    assert changed.parts["gear"].stiffness == hm.CubicStiffness(linear=1e4, cubic=0.0)  # type: ignore[attr-defined]
    assert changed.parts["motor"].inertia == 3.0  # type: ignore[attr-defined]
    assert changed.effect("drag") == PlacedEffect(name="drag", effect=hm.ViscousDrag(coefficient=0.5), at="load")


@pytest.mark.parametrize(
    ("path", "value", "kind", "message"),
    [
        ("motor.inertai", 1.0, PlaceError, r"No parameter 'inertai'\. Motor has: inertia.* Did you mean 'motor\.inertia'\?"),
        ("moter.inertia", 1.0, PlaceError, r"No part or effect 'moter'\. This scene has: motor.*Did you mean 'motor\.inertia'\?"),
        ("motor.inertia.value", 1.0, PlaceError, r"No parameter 'inertia\.value'"),
        ("motor.inertia", -1.0, ParameterError, r"Motor\.inertia = -1 kg m\^2: must be greater than 0"),
        ("motor.inertia", 0.0, ParameterError, r"Motor\.inertia = 0 kg m\^2: must be greater than 0"),
        ("motor.inertia", math.nan, ParameterError, r"Motor\.inertia = nan kg m\^2: must be a finite number"),
        ("motor.inertia", "2 g*cm^2", ParameterError, r"Motor\.inertia = '2 g\*cm\^2': must be a number, in kg m\^2"),
        ("motor.inertia", None, ParameterError, r"Motor\.inertia = None: must be a number"),
        ("motor.characteristic", 5.0, ParameterError, r"Motor\.characteristic = 5: must be a law .* or a Python function"),
        ("motor.characteristic", hm.AsynchronousMotor, ParameterError, r"is a class; give an object of it: AsynchronousMotor\(\.\.\.\)"),
        ("gear.stiffness", 3.2e4, ParameterError, r"HarmonicDrive\.stiffness = 32000: must be a law"),
        ("gear.stiffness", hm.Inertia(inertia=1.0), ParameterError, r"must be a law of the library or a Python function"),
        ("gear.damping_in_gap", "no", ParameterError, r"damping_in_gap = 'no': must be True or False"),
        ("gear.output_sense", "backwards", ParameterError, r"must be 'opposite' or 'same'"),
        ("gear.output_sense", 1, ParameterError, r"must be a text"),
        ("gear.ratio", 1.0, ParameterError, r"HarmonicDrive\.ratio = 1: must be greater than 1"),
        ("gear.stiffness.torque_2", 20.0, ParameterError, r"torque_2 = 20 N m is below torque_1 = 23\.5 N m"),
        ("motor", 5.0, SceneError, r"Part 'motor' is a float, not a component"),
        ("drag", 5.0, SceneError, r"'drag' is a float, not an effect"),
        ("drag.coulomb", -1.0, ParameterError, r"CoulombStribeckFriction\.coulomb = -1 N m: must be at least 0"),
        ("drag.coulmb", 1.0, PlaceError, r"No parameter 'coulmb'.*"),
    ],
)
def test_a_bad_change_is_refused_with_the_value_the_limit_and_the_way_out(
    path: str, value: Any, kind: type[HdriveError], message: str
) -> None:
    scene = train().with_effect(friction(), at="load", name="drag")
    with pytest.raises(kind, match=message):
        scene.replacing({path: value})


def test_free_parameters_name_value_unit_range_and_meaning() -> None:
    scene = train().with_effect(friction(2.5), at="load", name="drag")
    parameters = scene.parameters()
    coulomb = parameters["drag.coulomb"]
    assert (coulomb.value, coulomb.unit, coulomb.low, coulomb.high) == (2.5, "N m", 0.0, 1e3)
    assert str(coulomb) == "drag.coulomb = 2.5 N m  [0, 1000]  sliding torque T_C"
    assert str(parameters["motor.inertia"]) == "motor.inertia = 0.0015 kg m^2  (0, inf)  rotor inertia J_s"
    assert str(parameters["load.torque.mean"]) == "load.torque.mean = 20 N m  (-inf, inf)  mean torque"
    for path, item in parameters.items():
        assert item.path == path
        assert item.low <= item.value <= item.high
        assert scene.replacing({path: item.value}) == scene


# -- effects ----------------------------------------------------------------------------------------


def test_effects_are_named_by_their_type_and_numbered() -> None:
    scene = train().with_effect(friction(), at="load").with_effect(friction(), at="motor").with_effect(friction(), at="load", name="seal")
    assert [placed.name for placed in scene.effects] == ["coulomb_stribeck_friction", "coulomb_stribeck_friction_2", "seal"]
    assert {"coulomb_stribeck_friction.torque", "coulomb_stribeck_friction_2.torque", "seal.torque"} <= {
        channel.name for channel in scene.network().channels
    }


@pytest.mark.parametrize(
    ("effect", "at", "name", "kind", "message"),
    [
        (friction(), "gaer", None, PlaceError, r"No body 'gaer'\. This scene has: motor, .*load"),
        (
            friction(),
            "gear",
            None,
            PlaceError,
            r"CoulombStribeckFriction acts on a rotating body, but 'gear' is a connection\. Bodies: motor",
        ),
        (friction(), "ground", None, PlaceError, r"held by the ground"),
        (hm.CouplingBacklash(backlash=1e-3), "load", None, PlaceError, r"CouplingBacklash acts on a connection, but 'load' is a body"),
        (hm.CouplingBacklash(backlash=1e-3), "gaer", None, PlaceError, r"No connection 'gaer'\. This scene has: input_shaft, gear"),
        (hm.MeshFriction(loss_factor=0.1), "input_shaft", None, PlaceError, r"needs a connection with the flanges wave_generator"),
        (friction(), "load", "motor", SceneError, r"The name 'motor' is taken\. In use: gear, input_shaft"),
        (friction(), "load", "my friction", SceneError, r"Effect name 'my friction': use a plain word"),
        (hm.Inertia(inertia=1.0), "load", None, SceneError, r"is not an effect"),
        (hm.CoulombStribeckFriction, "load", None, SceneError, r"is not an effect"),
    ],
)
def test_an_effect_in_the_wrong_place_is_refused_at_once(
    effect: Any, at: str, name: str | None, kind: type[HdriveError], message: str
) -> None:
    with pytest.raises(kind, match=message):
        train().with_effect(effect, at=at, name=name)


def test_without_takes_an_effect_away_and_leaves_the_others() -> None:
    scene = train().with_effect(friction(), at="load").with_effect(friction(), at="motor")
    assert scene.without("coulomb_stribeck_friction_2") == train().with_effect(friction(), at="load")
    assert scene.without("coulomb_stribeck_friction").without("coulomb_stribeck_friction_2") == train()


def test_without_takes_a_part_and_its_joints_away() -> None:
    scene = discs(("a", "s", "b"), ("b", "r", "c"), r=hm.Shaft(stiffness=1.0), c=hm.Inertia(inertia=1.0))
    with pytest.raises(SceneError, match=r"Loose end: nothing is connected to 'r\.b'"):
        scene.without("c")
    joined = discs(("a", "s", "b"), ("b", "c"), c=hm.Inertia(inertia=1.0))
    assert joined.without("c") == discs()
    with pytest.raises(PlaceError, match=r"No effect or part 'x'\. This scene has: motor, input_shaft"):
        train().without("x")


def test_a_part_is_not_taken_away_from_under_an_effect() -> None:
    joined = discs(("a", "s", "b"), ("b", "c"), c=hm.Inertia(inertia=1.0)).with_effect(friction(), at="c", name="drag")
    with pytest.raises(PlaceError, match=r"Without 'c' the effect 'drag' at 'c' has no place; remove it first\. No body 'c'"):
        joined.without("c")
    assert joined.without("drag").without("c") == discs()


def test_a_part_without_flanges_can_be_taken_away() -> None:
    with_sensor = discs(e=hm.Sensor(quantity="a.angle"))
    assert with_sensor.without("e") == discs()


# -- what is not a train ------------------------------------------------------------------------------


def test_one_body_alone_is_a_scene() -> None:
    scene = hm.Scene(name="rotor", parts={"rotor": hm.Inertia(inertia=2.0, viscous=1.0)}, connections=[])
    response = hm.simulate(scene, 1.0, initial_speed=3.0, solver=hm.DormandPrince(relative_tolerance=1e-9, absolute_tolerance=1e-11))
    # J dw/dt = -c w
    assert response["rotor.speed"].values[-1] == pytest.approx(3.0 * math.exp(-0.5), rel=1e-8)


@pytest.mark.parametrize(
    ("connections", "kind", "message"),
    [
        (
            [("a", "s", "ground")],
            SceneError,
            r"Loose end: nothing is connected to 'b' \(Inertia\)\. Add it to a connection, e\.g\. \('b', 'ground'\)",
        ),
        ([("a", "s"), ("b", "ground")], SceneError, r"Loose end: nothing is connected to 's\.b' \(Shaft\)"),
        ([], SceneError, r"Loose end: nothing is connected to 'a'"),
        ([("a", "s", "c")], PlaceError, r"No place 'c'\. This scene has: a, s, b, s\.a, s\.b, ground"),
        ([("a", "s.c")], PlaceError, r"No place 's\.c'"),
        ([("a", "s", 5)], PlaceError, r"No place 5"),
        ([("a",)], SceneError, r"names at least two places"),
        ([("a", "a", "s", "b")], SceneError, r"joins 'a' to itself"),
        ("a-s-b", SceneError, r"must be a list of chains, like \[\('motor', 'shaft', 'load'\)\]"),
        (("a", "s", "b"), SceneError, r"must be a list of chains"),
    ],
)
def test_bad_connections_are_refused_with_the_way_out(connections: Any, kind: type[HdriveError], message: str) -> None:
    with pytest.raises(kind, match=message):
        hm.Scene(name="x", parts=two_discs(), connections=connections)


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        ({}, "has no parts"),
        ([hm.Inertia(inertia=1.0)], "has no parts"),
        ({"my motor": hm.Inertia(inertia=1.0)}, "Part name 'my motor': use a plain word"),
        ({"ground": hm.Inertia(inertia=1.0)}, "not 'ground'"),
        ({5: hm.Inertia(inertia=1.0)}, "Part name 5"),
        ({"a": 5}, "Part 'a' is a int, not a component"),
        ({"a": friction()}, "Part 'a' is a CoulombStribeckFriction, not a component"),
    ],
)
def test_bad_parts_are_refused(parts: Any, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        hm.Scene(name="x", parts=parts, connections=[])


def test_a_scene_needs_a_name() -> None:
    with pytest.raises(SceneError, match="Scene name None: must be a text"):
        hm.Scene(name=None, parts={"a": hm.Inertia(inertia=1.0)}, connections=[])  # type: ignore[arg-type]


def test_values_are_given_by_name_and_unknown_names_are_refused() -> None:
    with pytest.raises(KeywordError, match=r"Inertia\(1\.0\): values are given by name\. It has: inertia, viscous"):
        hm.Inertia(1.0)  # type: ignore[misc]
    with pytest.raises(KeywordError, match=r"No field 'mass'\. Inertia has: inertia, viscous"):
        hm.Inertia(inertia=1.0, mass=2.0)  # type: ignore[call-arg]
    with pytest.raises(
        ParameterError, match=r"^Inertia lacks what has no default: inertia \[kg m\^2\] : moment of inertia about the axis, above 0\.$"
    ):
        hm.Inertia()  # type: ignore[call-arg]
    with pytest.raises(ParameterError, match=r"Rotor lacks .*: polar_inertia \[kg m\^2\] .*; transverse_inertia \[kg m\^2\]"):
        hm.Rotor(mass=2.0)  # type: ignore[call-arg]
    with pytest.raises(ParameterError, match=r"Motor lacks .*: characteristic : torque law: a characteristic"):
        hm.Motor(inertia=1.0)  # type: ignore[call-arg]
    with pytest.raises(PlaceError, match=r"No field 'mass'\. Inertia has: inertia, viscous"):
        hm.Inertia(inertia=1.0).replacing(mass=2.0)


def test_a_name_spelt_wrongly_is_answered_with_the_right_one() -> None:
    with pytest.raises(KeywordError, match=r"No field 'inertai'\. Motor has: .*\. Did you mean 'inertia'\?$"):
        hm.Motor(inertai=1e-4, characteristic=lambda speed: 0.0 * speed)  # type: ignore[call-arg]
    with pytest.raises(AttributeError, match=r"^module 'hdrive_mbs' has no attribute 'HarmonicDrve'\. Did you mean 'HarmonicDrive'\?$"):
        hm.HarmonicDrve  # type: ignore[attr-defined]  # noqa: B018
    with pytest.raises(AttributeError, match=r"^module 'hdrive_mbs' has no attribute 'xyzzy'\.$"):
        hm.xyzzy  # type: ignore[attr-defined]  # noqa: B018


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: hm.HarmonicDrive(ratio=100.0, stiffness=lambda x, y: x * y),
            r"^HarmonicDrive\.stiffness = .* takes \(x, y\) .* \(twist\)\.",
        ),
        (
            lambda: hm.Load(inertia=1.0, torque=lambda a, w: a * w),
            r"^Load\.torque = .* \(a, w\) but is called with \(time\) or \(time, angle, sp",
        ),
        (lambda: hm.Motor(inertia=1.0, characteristic=lambda: 1.0), r"^Motor\.characteristic = .* \(\) .* \(speed\) or \(time, speed\)"),
        (lambda: hm.DriveTorque(characteristic=lambda a, b, c: 1.0), r"^DriveTorque\.characteristic = .* functools\.partial"),
        (lambda: hm.IdealSpeedMotor(motion=lambda t, a: t), r"^IdealSpeedMotor\.motion = .* is called with \(time\)"),
    ],
)
def test_a_function_that_cannot_be_called_as_a_law_is_refused_where_it_is_given(make: Callable[[], object], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        make()


def test_a_function_with_further_arguments_that_have_values_is_a_law() -> None:
    gear = hm.HarmonicDrive(ratio=100.0, stiffness=lambda twist, stiffness=2e4: stiffness * twist)
    assert gear.law.torque(1e-3) == 20.0
    assert hm.Motor(inertia=1.0, characteristic=functools.partial(lambda gain, speed: -gain * speed, 2.0)) is not None


def test_an_effect_in_the_place_of_a_law_is_answered_with_how_effects_are_added() -> None:
    arm = hm.EccentricLoad(mass=2.0, radius=0.3)
    message = (
        r"^Load\.torque = EccentricLoad\(.*\): must be a law .* kind 'effect': scene\.with_effect\(EccentricLoad\(\.\.\.\), at=\"\.\.\.\"\)"
    )
    with pytest.raises(ParameterError, match=message):
        hm.Load(inertia=1.0, torque=arm)  # type: ignore[arg-type]
    load = hm.Load(inertia=1.0, torque=hm.ConstantTorque(value=0.0))
    scene = hm.Scene(name="arm", parts={"arm": load}, connections=[]).with_effect(arm, at="arm")  # as it says
    assert [placed.at for placed in scene.effects] == ["arm"]


def test_a_law_of_another_part_is_answered_with_the_part_that_takes_it() -> None:
    constant, drive = hm.ConstantTorque(value=60.0), hm.TorqueHistory(times=(0.0, 1.0), torques=(1.0, 1.0))
    with pytest.raises(
        ParameterError, match=r"hm\.Load\(torque=ConstantTorque\(\.\.\.\)\) takes it; .* characteristic=lambda speed: 60\.0"
    ):
        hm.DriveTorque(characteristic=constant)  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match=r"hm\.DriveTorque\(characteristic=\.\.\.\) takes it"):
        hm.Load(inertia=1.0, torque=drive)  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match=r"hm\.HarmonicDrive\(stiffness=CubicStiffness\(\.\.\.\)\) takes it"):
        hm.Load(inertia=1.0, torque=hm.CubicStiffness(linear=1e4, cubic=0.0))  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match=r"hm\.Bearing\(law=LinearBearing\(\.\.\.\)\) takes it"):
        hm.Motor(inertia=1.0, characteristic=hm.LinearBearing.isotropic(radial=1e6, damping=0.0))  # type: ignore[arg-type]
    line = {"drive": hm.DriveTorque(characteristic=lambda speed: 60.0), "rotor": hm.Inertia(inertia=2.0)}  # as it says
    response = hm.simulate(hm.Scene(name="constant", parts=line, connections=[("drive", "rotor")]), 1.0)
    assert response["rotor.speed"].values[-1] == pytest.approx(30.0, rel=1e-9)


def test_parts_are_copied_and_pickled_whole() -> None:
    part = hm.Motor(inertia=1e-3, characteristic=hm.IdealSpeedMotor(motion=hm.ConstantSpeed(value=3.0)))
    assert pickle.loads(pickle.dumps(part)) == copy.deepcopy(part) == copy.copy(part) == part


def test_a_class_of_a_user_s_own_may_have_its_own_initialiser() -> None:
    @dataclass(frozen=True, kw_only=True)
    class Ring(hm.Inertia):
        def __init__(self, *, radius: float, mass: float) -> None:
            object.__setattr__(self, "inertia", mass * radius**2)
            object.__setattr__(self, "viscous", 0.0)
            self.__post_init__()

    assert Ring(radius=2.0, mass=3.0).inertia == 12.0


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (math.inf, r"TableTorque\.torques\[1\] = inf N m: must be a finite number"),
        (math.nan, r"TableTorque\.torques\[1\] = nan N m: must be a finite number"),
        ("1", r"TableTorque\.torques\[1\] = '1': must be a number, in N m"),
        (None, r"TableTorque\.torques\[1\] = None: must be a number, in N m"),
        (10**400, r"TableTorque\.torques\[1\]: must be a finite number, this one has over 300 digits"),
    ],
)
def test_a_bad_number_in_a_table_is_named_by_its_place(value: Any, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        hm.TableTorque(times=(0.0, 1.0), torques=(1.0, value))


@pytest.mark.parametrize("made", [tuple, list, np.array])
@pytest.mark.parametrize(
    ("value", "message"), [(-0.5, "must be at least 0.0 s"), (math.nan, "must be a finite number"), (math.inf, "finite")]
)
def test_one_bad_number_in_a_long_table_is_found_wherever_it_is(made: Callable[[Any], Any], value: float, message: str) -> None:
    @dataclass(frozen=True, kw_only=True)
    class Log(Described):
        times: tuple[float, ...] = table("s", "times", low=0.0)

    numbers = np.linspace(0.0, 1.0, 5000).tolist()
    kept = Log(times=made(numbers)).times
    assert kept == tuple(numbers)
    assert {type(item) for item in kept} == {float}
    with pytest.raises(ParameterError, match=rf"Log\.times\[1234\] = .*{message}"):
        Log(times=made([*numbers[:1234], value, *numbers[1235:]]))


def test_a_table_of_whole_numbers_or_of_none_is_one_of_floats() -> None:
    law = hm.TableTorque(times=np.array([0, 1]), torques=[1, np.float64(2.5)])  # type: ignore[arg-type]
    assert law.times == (0.0, 1.0)
    assert {type(item) for item in (*law.times, *law.torques)} == {float}


def test_a_table_must_be_a_sequence() -> None:
    with pytest.raises(ParameterError, match=r"TableTorque\.times = 5: must be a sequence of numbers in s"):
        hm.TableTorque(times=5, torques=(1.0, 2.0))  # type: ignore[arg-type]
