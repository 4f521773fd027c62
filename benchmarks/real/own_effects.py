"""Friction of robot joints and weights on discs, as a user would write effects of their own: one file, no registration."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

import hdrive_mbs as hm
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class CouplingFriction(hm.TwistEffect):
    """Dry and viscous friction on the relative speed of a connection.

    tau = T_C tanh(v/v_0) + c v

    Source: Coulomb, and Petroff for the viscous part.  Leaves out sticking, and what friction owes to load and heat.
    """

    coulomb: float = parameter("N m", "T_C", low=0.0, typical=(0.01, 20.0))
    coefficient: float = parameter("N m s/rad", "c", low=0.0, default=0.0, typical=(1e-3, 5.0))
    smoothing_speed: float = parameter("rad/s", "v_0, speed of the smooth step through zero", above=0.0, default=0.03, typical=(0.003, 0.3))

    family: ClassVar[str] = "coupling_friction"
    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = "torque on both ends of a connection that changes sign with the relative speed"

    def torque(self, time: Value, twist: Value, rate: Value) -> Value:
        return self.coulomb * np.tanh(rate / self.smoothing_speed) + self.coefficient * rate


@dataclass(frozen=True, kw_only=True)
class JointFriction(hm.TorqueEffect):
    """Dry friction of one joint.

    tau = -T_C tanh(w/w_0)

    Source: Coulomb.  The library's law has a Stribeck drop besides, which slow records like these do not show.  Leaves out sticking.
    """

    coulomb: float = parameter("N m", "T_C", low=0.0, typical=(0.05, 20.0))
    smoothing_speed: float = parameter("rad/s", "w_0, speed of the smooth step through zero", above=0.0, default=0.03, typical=(0.003, 0.3))

    family: ClassVar[str] = "friction"
    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = "torque that changes sign with the direction of motion"

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        return -self.coulomb * np.tanh(speed / self.smoothing_speed)


@dataclass(frozen=True, kw_only=True)
class DiscWeight(hm.RotorUnbalance):
    """Unbalance of a disc in its own plane: weights that are screwed into its holes.

    F = U w^2 exp(i (f + p))

    Source: ISO 21940-2 (static unbalance).  Leaves out the width of the disc: the library's law can lie anywhere beside it.
    """

    lever: float = parameter("m", "0: in the plane of the disc", default=0.0)
