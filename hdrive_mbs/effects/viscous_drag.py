"""Viscous drag on a body."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.effect import TorqueEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class ViscousDrag(TorqueEffect):
    """Drag of a lubricant film on the absolute speed.

    tau = -c w

    Source: Petroff's law of the concentric journal (1883).  Leaves out the fall of viscosity with
    temperature and shear.
    """

    coefficient: float = parameter("N m s/rad", "drag coefficient c", low=0.0, high=1e3, typical=(1e-5, 10.0))

    family: ClassVar[str] = "viscous_drag"
    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = "torque that grows in proportion to speed; coasting down is exponential"

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        return -self.coefficient * speed
