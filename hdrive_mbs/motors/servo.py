"""Servo motor: torque limit and PI speed control in one."""

from __future__ import annotations

from dataclasses import dataclass

from hdrive_mbs.motors.commanded import CommandedMotor
from hdrive_mbs.motors.speed_loop import SpeedLoop
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.node import Node


@dataclass(frozen=True, kw_only=True)
class ServoMotor(SpeedLoop, CommandedMotor):
    """A motor with its speed controller:  M = kp e + ki I within +-torque_limit.

    e = w_ref(t) - w of its own rotor, dI/dt = e with anti-windup; laws, sources and what they leave
    out in SpeedLoop and CommandedMotor.  For feedback from another place use a CommandedMotor and a
    SpeedController.
    """

    def drive(self, name: str, node: Node, draft: Draft) -> None:
        command = self.add_loop(name, name, draft, speed=lambda moment: moment.speed(node.name), limit=lambda moment: self.torque_limit)
        self.deliver(name, node, draft, command)
