"""A rub at one angle of a turn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.effect import Effect, add_body_torque, moving_body
from hdrive_mbs.effects.places import torsional_bodies
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network
from hdrive_mbs.quantities import parameter

_ANGLES = tuple(float(angle) for angle in np.linspace(-np.pi, np.pi, 4, endpoint=False))


@dataclass(frozen=True, kw_only=True)
class RubAtAngle(Effect):
    """Dry friction of a body about one angle of its turn.

    tau = -T tanh(w/w_0) exp(k (cos(a - a_0) - 1))

    with the true angle a of the body: near a_0 a bell of the width 1/sqrt(k).

    Source: none needed, a seal, brake disc or bearing that touches at a high spot; the bell is von Mises' (1918), a Gauss curve that closes
    after a turn.  Leaves out presliding and wear.
    """

    friction: float = parameter("N m", "T at the angle", low=0.0, high=1e3, typical=(1e-4, 20.0))
    angle: float = parameter("rad", "a_0", default=0.0, typical=(-np.pi, np.pi))
    sharpness: float = parameter("1", "k", default=10.0, above=0.0, high=1e4, typical=(1.0, 300.0))
    smoothing_speed: float = parameter("rad/s", "speed w_0 of the smooth step through zero", default=0.01, above=0.0)

    family: ClassVar[str] = "friction_by_angle"
    dissipative: ClassVar[bool] = True
    leads: ClassVar[bool] = True
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"angle": _ANGLES, "sharpness": (3.0,)}
    decisive: ClassVar[tuple[str, ...]] = ("angle",)
    signature: ClassVar[str] = "torque against the motion for a part of each turn, always at the same angle"

    def apply(self, draft: Draft, place: str, name: str) -> None:
        body = moving_body(self, draft, place)

        def torque(moment: Moment) -> Value:
            bell = np.exp(self.sharpness * (np.cos(body.sense * moment.angle(body.name) - self.angle) - 1.0))
            return -self.friction * np.tanh(moment.speed(body.name) / self.smoothing_speed) * bell

        add_body_torque(self, draft, body.name, name, torque)

    @classmethod
    def places(cls, network: Network) -> tuple[str, ...]:
        return torsional_bodies(network)
