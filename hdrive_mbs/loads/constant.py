"""Constant load torque."""

from __future__ import annotations

from dataclasses import dataclass

from hdrive_mbs.expression import Value
from hdrive_mbs.loads.law import LoadLaw
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class ConstantTorque(LoadLaw):
    """M = const, also at standstill (a hanging weight, not a brake)."""

    value: float = parameter("N m", "torque that resists forward rotation")

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        return self.value + 0.0 * time
