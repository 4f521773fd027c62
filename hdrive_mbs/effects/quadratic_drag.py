"""Drag that grows with the square of speed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import TorqueEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class QuadraticDrag(TorqueEffect):
    """Drag of turbulent flow: fans, churned oil, windage.

    tau = -c |w| w

    Source: the fan law (torque goes with the square of speed at constant flow coefficient), as in
    Modelica.Mechanics.Rotational.Sources.QuadraticSpeedDependentTorque.  Leaves out the laminar part
    at low speed (add ViscousDrag) and the change of density with temperature.
    """

    coefficient: float = parameter("N m s^2/rad^2", "drag coefficient c", low=0.0, high=1e3, typical=(1e-7, 10.0))

    family: ClassVar[str] = "quadratic_drag"
    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = "torque that grows with the square of speed; unseen at low speed"

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        return -self.coefficient * np.abs(speed) * speed
