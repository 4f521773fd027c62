"""Drag and dry friction that differ between the two senses of rotation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import TorqueEffect
from hdrive_mbs.effects.places import torsional_bodies
from hdrive_mbs.expression import Value
from hdrive_mbs.network.network import Network
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class UnequalDrag(TorqueEffect):
    """What forward rotation meets more than backward rotation.

    tau = -(c |w| + T |tanh(w/w_0)|)/2

    so the drag is larger by c |w| and the friction by T forward than backward, and their mean is as in the model.  Drag in one
    sense only is c with half of it as ViscousDrag.  Backwards the effect itself drives, which the drag of the model must outweigh.

    Source: friction identified for each sense of rotation, as usual for robot joints, e.g. Armstrong-Helouvry, Control of Machines with
    Friction (1991).  Leaves out a drop with speed (PreslidingFriction has both).
    """

    viscous: float = parameter("N m s/rad", "c, more drag forward than backward", default=0.0, low=-1e3, high=1e3, typical=(-1.0, 1.0))
    friction: float = parameter("N m", "T, more dry friction forward than backward", default=0.0, low=-1e3, high=1e3, typical=(-5.0, 5.0))
    smoothing_speed: float = parameter("rad/s", "speed w_0 of the smooth step through zero", default=0.01, above=0.0)

    family: ClassVar[str] = "unequal_drag"
    signature: ClassVar[str] = "torque at the same speed and load that is larger in one sense of rotation than in the other"

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        return -0.5 * (self.viscous * np.abs(speed) + self.friction * np.abs(np.tanh(speed / self.smoothing_speed)))

    @classmethod
    def places(cls, network: Network) -> tuple[str, ...]:
        return torsional_bodies(network)
