"""Speed controller as a part of its own."""

from __future__ import annotations

from dataclasses import dataclass

from hdrive_mbs.components.component import Component
from hdrive_mbs.motors.speed_loop import SpeedLoop
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.quantities import option


@dataclass(frozen=True, kw_only=True)
class SpeedController(SpeedLoop, Component):
    """PI speed control of a motor whose characteristic is a CommandedMotor.

    The law is that of SpeedLoop.  Speeds are forward speeds of the feedback place: on the output
    of a drive the reference is positive too when the motor turns forward, whatever the gears do to
    the sense.  The part has no flange.
    """

    motor: str = option("name of the motor part")
    feedback: str | None = option("place whose speed is controlled (the motor if not given)", default=None)

    def build(self, name: str, draft: Draft) -> None:
        asked_by = f"SpeedController {name!r}"
        draft.body(self.motor, asked_by)
        place = draft.body(self.feedback or self.motor, asked_by).name
        limit = draft.read_channel(
            f"{self.motor}.torque_limit", asked_by=asked_by, hint=f"The characteristic of {self.motor!r} must be a CommandedMotor."
        )
        self.add_loop(name, self.motor, draft, speed=lambda moment: moment.speed(place), limit=limit)
