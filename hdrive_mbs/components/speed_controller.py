"""Speed controller as a part of its own."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from hdrive_mbs.components.component import Component
from hdrive_mbs.expression import Value
from hdrive_mbs.motors.speed_loop import SpeedLoop
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.node import Node
from hdrive_mbs.quantities import option


@dataclass(frozen=True, kw_only=True)
class SpeedController(SpeedLoop, Component):
    """PI speed control of a motor whose characteristic is a CommandedMotor.

    The law is that of SpeedLoop.  Speeds are forward speeds of the feedback place: on the output
    of a drive the reference is positive too when the motor turns forward, whatever the gears do to
    the sense.  With a sensor as feedback, ``Sensor(quantity="motor.speed", ...)``, the loop gets what that shows, with its steps and the
    effects on it, like a lag; the error channel then counts from there.  The part has no flange.

    The network refuses a feedback that is neither with a PlaceError, and one that is not in rad/s with a ParameterError.
    """

    motor: str = option("name of the motor part")
    feedback: str | None = option("place whose speed is controlled, or sensor of a speed (the motor if not given)", default=None)

    def build(self, name: str, draft: Draft) -> None:
        asked_by = f"SpeedController {name!r}"
        draft.body(self.motor, asked_by)
        feedback = self.feedback or self.motor
        speed = self._speed_of(draft.body(feedback, asked_by)) if draft.has_body(feedback) else self._shown_by(feedback, draft, asked_by)
        limit = draft.read_channel(
            f"{self.motor}.torque_limit", asked_by=asked_by, hint=f"The characteristic of {self.motor!r} must be a CommandedMotor."
        )
        self.add_loop(name, self.motor, draft, speed=speed, limit=limit)

    def _speed_of(self, node: Node) -> Callable[[Moment], Value]:
        return lambda moment: moment.speed(node.name)

    def _shown_by(self, sensor: str, draft: Draft, asked_by: str) -> Callable[[Moment], Value]:
        hint = "Its feedback has to be a place that turns, or a sensor that reads the speed of one."
        return draft.read_speed(sensor, asked_by=asked_by, hint=hint)
