"""Asynchronous motor on a frequency inverter."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Self

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.motors.asynchronous import AsynchronousMotor
from hdrive_mbs.motors.profiles.profile import SpeedProfile
from hdrive_mbs.motors.profiles.ramp import SpeedRamp
from hdrive_mbs.quantities import option


@dataclass(frozen=True, kw_only=True)
class InverterMotor(AsynchronousMotor):
    """An induction motor fed with a changing frequency at constant voltage over frequency.

    M = 2 M_b x x_b / (x^2 + x_b^2),   x = w_s(t) - w,   x_b = s_b w_s,nominal

    At constant flux the torque depends on the slip *speed* x alone, so Kloss's curve of the name
    plate moves along the speed axis with w_s(t) = 2 pi f(t)/p.

    Source: constant-flux (V/f) operation as in any text on electrical drives, e.g. Leonhard,
    Control of Electrical Drives.  Leaves out the stator resistance, which weakens the torque below
    about a fifth of the rated frequency, and field weakening: above it the real motor has less torque.
    """

    feed: SpeedProfile = option("synchronous speed w_s(t) = 2 pi f(t)/p as a speed profile")

    def check(self) -> None:
        super().check()
        if not isinstance(self.feed, SpeedProfile):
            raise ParameterError(f"InverterMotor.feed = {self.feed!r}: must be a speed profile, e.g. SpeedRamp.")

    @classmethod
    def ramped(cls, *, ramp_time: float, **name_plate: Any) -> Self:
        """Fed from standstill to the line frequency in ramp_time [s]; the name plate as in AsynchronousMotor."""
        motor = AsynchronousMotor(**name_plate)
        return cls(**name_plate, feed=SpeedRamp(start=0.0, end=motor.synchronous_speed, duration=ramp_time))

    def torque(self, time: Value, speed: Value) -> Value:
        return self.torque_at_slip((self.feed.speed(time) - speed) / self.synchronous_speed)
