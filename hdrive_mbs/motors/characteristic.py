"""What every motor characteristic offers."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.node import Node
from hdrive_mbs.quantities import Described, option


@dataclass(frozen=True, kw_only=True)
class MotorCharacteristic(Described):
    """Air-gap torque of a motor.

    The torque belongs to the characteristic alone: seed F (5) put into (1) would count the rotor
    inertia twice, so (1) takes M_s(n) directly.
    """

    _kind: ClassVar[str] = "motor characteristic"
    _use: ClassVar[str] = "hm.Motor(characteristic={name}(...)) or hm.DriveTorque(characteristic=...) takes it"

    def torque(self, time: Value, speed: Value) -> Value:
        """Torque [N m] at a time [s] and rotor speed [rad/s]."""
        raise NotImplementedError

    def drive(self, name: str, node: Node, draft: Draft) -> None:
        """Put the characteristic on the rotor.  Override for a motor that prescribes its motion."""

        def torque(moment: object) -> Value:
            return self.torque(moment.time, moment.speed(node.name))  # type: ignore[attr-defined]

        draft.add_torque(f"{name}.torque", node.name, torque, is_motor=True)
        draft.add_channel(f"{name}.torque", "N m", f"air-gap torque of {name}", torque)


@dataclass(frozen=True, kw_only=True)
class MotorFunction(MotorCharacteristic):
    """A plain Python function of (speed) or (time, speed).  A scene file cannot hold it."""

    function: Callable[..., Value] = option(
        "torque [N m] as function of speed, or of time and speed", called_with=(("speed",), ("time", "speed"))
    )

    def torque(self, time: Value, speed: Value) -> Value:
        needed = [item for item in inspect.signature(self.function).parameters.values() if item.default is item.empty]
        return self.function(speed) if len(needed) == 1 else self.function(time, speed)
