"""Motor with a prescribed motion."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.motors.characteristic import MotorCharacteristic
from hdrive_mbs.motors.profiles.profile import AngleFunction, SpeedFunction, SpeedProfile
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.node import Node
from hdrive_mbs.quantities import option


@dataclass(frozen=True, kw_only=True)
class IdealSpeedMotor(MotorCharacteristic):
    """The rotor follows a given motion, whatever torque that needs.

    angle(t) is the exact integral of the profile's speed, or a plain function of time.  The
    channel ``<name>.torque`` is the torque that the motion takes:  J d2(angle)/dt2 - sum of the
    other torques on the rotor.  Leaves out that every motor has a limit: look at this torque.  On an
    unbalanced rotor it lacks m (e_x y'' - e_y x''), what the whirl of its centre of mass takes (its mean is the
    power that bearings and shaft dissipate over the speed), which the channel's description says then.
    A motion that does not start from rest at t = 0 needs a train that starts with it.
    """

    motion: SpeedProfile | Callable[[Value], Value] = option(
        "speed profile, or angle [rad] as a function of time [s]", called_with=(("time",),)
    )

    def check(self) -> None:
        if isinstance(self.motion, SpeedFunction):
            raise ParameterError(
                "IdealSpeedMotor.motion is a SpeedFunction, which has no closed-form angle; give AngleFunction(function=angle) "
                "or a profile (SpeedRamp, SpeedTable)."
            )
        if not isinstance(self.motion, SpeedProfile):
            object.__setattr__(self, "motion", AngleFunction(function=self.motion))

    def drive(self, name: str, node: Node, draft: Draft) -> None:
        assert isinstance(self.motion, SpeedProfile)
        draft.prescribe(node.name, self.motion.angle)
        lacks = ", without what the whirl of its unbalance takes" if node.mass.static_unbalance or node.mass.product_unbalance else ""
        draft.add_channel(f"{name}.torque", "N m", f"torque that {name} needs to keep its motion{lacks}", draft.holding_torque(node))
