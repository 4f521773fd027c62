"""Weight of an eccentric mass."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import Effect, add_body_torque, moving_body
from hdrive_mbs.effects.places import turning_bodies
from hdrive_mbs.effects.torque_ripple import TorqueRipple
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class EccentricLoad(Effect):
    """Weight of a mass off the axis of a horizontal shaft (an arm, an unbalanced drum).

    tau = -m g r sin(a + a_0) - B sin(2 a + q)  in true sense,  from  V = -m g r cos(a + a_0) - B/2 cos(2 a + q)

    where a is the true angle of the body.  Up is against gravity: at a + a_0 = 0 the mass hangs
    straight down, at pi/2 it is level, at pi it stands above the axis.  For a shaft inclined to
    the horizontal by i put gravity = g cos(i).  B is what a linkage or a counter spring adds twice a turn.

    Source: statics.  Leaves out the inertia of the mass: its m r^2 (plus its own) belongs to the
    inertia of the part, so motion tells m r and a_0 but neither m nor r alone: a search holds r.  Also leaves out
    what the weight does to the bearings, and that the mass shakes what can move across the axis: at stations of a
    rotor line, where that is an Unbalance, it is not searched.
    """

    mass: float = parameter("kg", "mass m", low=0.0, high=1e4, typical=(0.05, 50.0))
    radius: float = parameter("m", "distance r of its centre from the axis", low=0.0, high=10.0)
    start_angle: float = parameter(
        "rad", "a_0, true angle from hanging straight down when the body's angle is 0", default=0.0, typical=(-np.pi, np.pi)
    )
    second_torque: float = parameter("N m", "B, torque twice a turn, 0-peak", default=0.0, low=0.0, high=1e5, typical=(5e-3, 50.0))
    second_phase: float = parameter("rad", "q, phase of B at angle 0", default=0.0, typical=(-np.pi, np.pi))
    gravity: float = parameter("m/s^2", "acceleration g of gravity across the shaft", default=9.80665, low=0.0, high=30.0)

    family: ClassVar[str] = "eccentric_load"
    signature: ClassVar[str] = "torque at once per turn of the body at every speed, and a rest position that the body swings back to"
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("mass", "start_angle"), ("second_torque", "second_phase"))
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"radius": (0.1,)}

    @classmethod
    def places(cls, network: Network) -> tuple[str, ...]:
        """Bodies that only turn: a station of a rotor line would be shaken by the mass as well."""
        return tuple(place for place in turning_bodies(network) if place not in network.positions)

    def twins(self, sense: int) -> tuple[TorqueRipple, ...]:
        """Where a motor sits, a ripple once a turn gives the same torque."""
        turned = np.pi if sense > 0 else 0.0
        return (
            TorqueRipple(
                amplitude=self.mass * self.gravity * self.radius,
                order=1.0,
                phase=self.start_angle + turned,
                second_amplitude=self.second_torque,
                second_phase=self.second_phase + turned,
            ),
        )

    def apply(self, draft: Draft, place: str, name: str) -> None:
        body = moving_body(self, draft, place)

        def torque(moment: Moment) -> Value:
            angle = body.sense * moment.angle(body.name)
            weight = self.mass * self.gravity * self.radius * np.sin(angle + self.start_angle)
            if self.second_torque != 0.0:
                weight = weight + self.second_torque * np.sin(2.0 * angle + self.second_phase)
            return -body.sense * weight

        add_body_torque(self, draft, body.name, name, torque)
