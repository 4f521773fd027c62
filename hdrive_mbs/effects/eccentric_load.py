"""Weight of an eccentric mass."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import Effect, add_body_torque, moving_body
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class EccentricLoad(Effect):
    """Weight of a mass off the axis of a horizontal shaft (an arm, an unbalanced drum).

    tau = -m g r sin(a + a_0)  in true sense,  from the potential  V = -m g r cos(a + a_0)

    where a is the true angle of the body.  Up is against gravity: at a + a_0 = 0 the mass hangs
    straight down, at pi/2 it is level, at pi it stands above the axis.  For a shaft inclined to
    the horizontal by i put gravity = g cos(i).

    Source: statics.  Leaves out the inertia of the mass: its m r^2 (plus its own) belongs to the
    inertia of the part.  Also leaves out what the weight does to the bearings.
    """

    mass: float = parameter("kg", "mass m", low=0.0, high=1e4, typical=(0.05, 50.0))
    radius: float = parameter("m", "distance r of its centre from the axis", low=0.0, high=10.0, typical=(0.02, 0.5))
    start_angle: float = parameter(
        "rad", "a_0, true angle from hanging straight down when the body's angle is 0", default=0.0, typical=(-np.pi, np.pi)
    )
    gravity: float = parameter("m/s^2", "acceleration g of gravity across the shaft", default=9.80665, low=0.0, high=30.0)

    family: ClassVar[str] = "eccentric_load"
    signature: ClassVar[str] = "torque at once per turn of the body at every speed, and a rest position that the body swings back to"

    def apply(self, draft: Draft, place: str, name: str) -> None:
        body = moving_body(self, draft, place)

        def torque(moment: Moment) -> Value:
            angle = body.sense * moment.angle(body.name)
            return -body.sense * self.mass * self.gravity * self.radius * np.sin(angle + self.start_angle)

        add_body_torque(self, draft, body.name, name, torque)
