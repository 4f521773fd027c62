"""Drag with a power of speed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import TorqueEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class PowerDrag(TorqueEffect):
    """Drag between laminar and fully rough flow.

    tau = -T |w/w_r|^n sign(w)

    Source: Blasius' law of turbulent friction in smooth ducts has n = 7/4, fully rough flow and fans n = 2 (QuadraticDrag),
    laminar flow n = 1 (ViscousDrag), e.g. Schlichting, Boundary-Layer Theory.  Leaves out the change from one to the other
    within a record.
    """

    drag: float = parameter("N m", "T, drag at the reference speed", low=0.0, high=1e4, typical=(1e-3, 50.0))
    exponent: float = parameter("1", "n, power of speed", default=2.0, low=1.0, high=4.0, typical=(1.4, 2.6))
    reference_speed: float = parameter("rad/s", "w_r", default=100.0, above=0.0, high=1e5)

    family: ClassVar[str] = "quadratic_drag"
    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = "torque that grows with a power of speed; unseen at low speed"
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"reference_speed": (2.0, 200.0)}

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        return -self.drag * np.sign(speed) * np.abs(speed / self.reference_speed) ** self.exponent
