"""Constant speed."""

from __future__ import annotations

from dataclasses import dataclass

from hdrive_mbs.expression import Value
from hdrive_mbs.motors.profiles.profile import SpeedProfile
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class ConstantSpeed(SpeedProfile):
    """w(t) = value,  angle = value t."""

    value: float = parameter("rad/s", "speed")

    def angle(self, time: Value) -> Value:
        return self.value * time

    def speed(self, time: Value) -> Value:
        return self.value + 0.0 * time
