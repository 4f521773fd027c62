"""What an effect says about itself: kind, family, where a search begins, where it may sit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import pytest

import hdrive_mbs as hm
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.effects.places import PLACES, connections, gears, motors, turning_bodies
from hdrive_mbs.errors import ParameterError, PlaceError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.network import Network
from hdrive_mbs.quantities import parameter, table
from hdrive_mbs.quantity import Quantity
from models import drive_bench, harmonic_drive_train, robot_joint_line, rotor_bench, two_rotor_line


@dataclass(frozen=True, kw_only=True)
class SealDrag(hm.TorqueEffect):
    """A drag of a user's own."""

    scale: float = parameter("N m", "drag", low=0.0, high=5.0, typical=(1e-3, 1.0))
    weights: tuple[float, ...] = table("1", "shares", default=(1.0,), low=0.0, typical=(0.1, 0.9))

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        return -self.scale * speed


def test_a_class_without_a_family_is_its_own_and_a_subclass_keeps_one_that_is_given() -> None:
    class OtherSeal(SealDrag):
        """Not of the family of its base, which gave none."""

    class StickySeal(hm.CoulombStribeckFriction):
        """Of the family of its base."""

    assert (SealDrag.family, SealDrag(scale=1.0).family, OtherSeal.family) == ("seal_drag", "seal_drag", "other_seal")
    assert StickySeal.family == "friction"


def test_laws_of_one_phenomenon_share_a_family() -> None:
    families = {
        "friction": (hm.CoulombStribeckFriction, hm.LuGreFriction, hm.DahlFriction, hm.LubricatedFriction),
        "hysteresis": (hm.BoucWenHysteresis, hm.MaxwellSlipHysteresis, hm.IwanHysteresis),
        "backlash": (hm.CouplingBacklash, hm.LostMotion, hm.FilmBacklash, hm.SoftWindup),
        "kinematic_error": (hm.KinematicError, hm.HarmonicKinematicError, hm.BeatingKinematicError),
        "torque_ripple": (hm.TorqueRipple, hm.Cogging),
        "hidden_mode": (hm.HiddenMode, hm.FlexibleInertia),
        "sensor_delay": (hm.SensorLag, hm.SensorDelay),
    }
    for family, kinds in families.items():
        assert {kind.family for kind in kinds} == {family}


@pytest.mark.parametrize(
    ("name", "value", "allowed"), [("kind", "strange", "hidden state"), ("acts_on", "wheel", "gear, coupling, motor, sensor")]
)
def test_an_unknown_kind_or_place_is_refused_where_the_class_is_written(name: str, value: str, allowed: str) -> None:
    with pytest.raises(ParameterError, match=rf"Odd\.{name} = '{value}': must be one of .*{allowed}"):
        type("Odd", (hm.TorqueEffect,), {name: value, "__annotations__": {}})


def test_a_typical_range_is_shown_and_kept_apart_from_the_allowed_one() -> None:
    assert "scale [N m] : drag, at least 0, at most 5, typically 0.001 to 1" in (SealDrag.__doc__ or "")
    assert "weights [1] : shares, at least 0, typically 0.1 to 0.9" in (SealDrag.__doc__ or "")
    assert SealDrag(scale=4.0).scale == 4.0  # outside the typical range, inside the allowed one
    (free,) = SealDrag(scale=4.0).free_parameters()
    assert (free.low, free.high, free.quantity.typical) == (0.0, 5.0, (1e-3, 1.0))


@pytest.mark.parametrize(
    ("typical", "words"),
    [((-1.0, 1.0), "-1 = -1 N m: must be at least 0.0"), ((1.0, 9.0), "9 = 9 N m: must be at most 5.0"), ((2.0, 1.0), "must rise")],
)
def test_a_typical_range_outside_the_allowed_one_is_refused(typical: tuple[float, float], words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        parameter("N m", "drag", low=0.0, high=5.0, typical=typical)
    with pytest.raises(ParameterError, match="greater than 0"):
        Quantity(unit="1", doc="share", above=0.0, typical=(0.0, 1.0))


def test_places_of_the_drive_bench_are_named_once_each() -> None:
    network = drive_bench.build().network()
    assert turning_bodies(network) == ("motor", "wave_generator", "gear.flexspline", "load")
    assert connections(network) == ("input_shaft", "gear", "output_shaft")
    assert (gears(network), motors(network)) == (("gear",), ("motor",))


def test_a_torque_between_bodies_is_no_connection_to_put_an_effect_at() -> None:
    scene = harmonic_drive_train.build().with_effect(hm.MeshFriction(loss_factor=0.1), at="gear", name="friction")
    assert "friction" in {element.name for element in scene.network().elements}
    assert "friction" not in connections(scene.network())


def test_a_piece_of_shaft_that_bends_is_no_place_for_play_or_slip_and_a_coupling_beside_it_is() -> None:
    joint = robot_joint_line.build().network()
    bending = set(PLACES["shaft"](joint))
    assert bending
    assert "gear" not in hm.JointSlip.places(joint)
    for kind in (hm.CouplingBacklash, hm.BoucWenHysteresis, hm.JointSlip, hm.Creep):
        assert "coupling" in kind.places(joint)
        assert not bending & set(kind.places(joint))
    assert PLACES["connection"](rotor_bench.build().network()) == ()
    piece = sorted(PLACES["shaft"](rotor_bench.build().network()))[0]
    rotor_bench.build().with_effect(hm.JointSlip(slip_torque=5.0, slip_rate=1e-3), at=piece).network()  # who asks for it has it


def test_a_prescribed_motor_and_what_the_ground_holds_are_no_places() -> None:
    motion = hm.SpeedRamp(start=0.0, end=10.0, duration=1.0)
    network = harmonic_drive_train.build().replacing({"motor.characteristic": hm.IdealSpeedMotor(motion=motion)}).network()
    assert "motor" not in turning_bodies(network)
    assert "gear.circular_spline" not in turning_bodies(network)
    assert motors(network) == ()


def test_on_a_rotor_line_only_what_turns_is_a_place() -> None:
    scene = two_rotor_line.build()
    network = scene.network()
    bodies = turning_bodies(network)
    assert {"rotor_1", "rotor_2"} <= set(bodies)
    assert not any(name.endswith((".x", ".y", ".z", ".psi", ".theta")) for name in bodies)
    for place in bodies:
        assert scene.with_effect(hm.ViscousDrag(coefficient=1e-3), at=place).network() is not None
    for place in motors(network):
        scene.with_effect(hm.MotorScale(error=0.1), at=place).network()


def test_an_effect_of_a_users_own_can_name_its_places() -> None:
    @dataclass(frozen=True, kw_only=True)
    class LoadOnly(Effect):
        """Acts at the last body."""

        acts_on: ClassVar[str] = "body"

        @classmethod
        def places(cls, network: Network) -> tuple[str, ...]:
            return turning_bodies(network)[-1:]

        def apply(self, draft: Draft, place: str, name: str) -> None:
            draft.body(place)

    assert LoadOnly.places(drive_bench.build().network()) == ("load",)
    turning = {"body", "connection", "gear", "coupling", "motor", "sensor", "load"}
    assert set(PLACES) == turning | {"rotor", "station", "bearing", "support", "shaft", "drive end", "probe", "surface"}


def test_a_motor_is_told_from_a_load_that_has_a_torque_law_too() -> None:
    scene = drive_bench.build()
    with pytest.raises(PlaceError, match=r"'load' is none\. Motors: motor\."):
        scene.with_effect(hm.MotorScale(error=0.1), at="load")
    with pytest.raises(PlaceError, match=r"No body 'moter'"):
        scene.with_effect(hm.MotorScale(error=0.1), at="moter")
