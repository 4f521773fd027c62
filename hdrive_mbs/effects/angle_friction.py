"""The shape of dry friction whose size depends on the angle of a body."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import Effect, add_body_torque, moving_body
from hdrive_mbs.effects.places import torsional_bodies
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class AngleFriction(Effect):
    """A torque against the motion of a body,  tau = -tanh(w/w_0) T(a),  with its true angle a and its speed w."""

    smoothing_speed: float = parameter("rad/s", "speed w_0 of the smooth step through zero", default=0.01, above=0.0)

    family: ClassVar[str] = "friction_by_angle"

    @abstractmethod
    def size(self, angle: Value) -> Value:
        """T [N m] at a true angle [rad]."""

    def apply(self, draft: Draft, place: str, name: str) -> None:
        body = moving_body(self, draft, place)

        def torque(moment: Moment) -> Value:
            return -np.tanh(moment.speed(body.name) / self.smoothing_speed) * self.size(body.sense * moment.angle(body.name))

        add_body_torque(self, draft, body.name, name, torque)

    @classmethod
    def places(cls, network: Network) -> tuple[str, ...]:
        return torsional_bodies(network)
