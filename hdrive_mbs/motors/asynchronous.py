"""Asynchronous motor from its name plate (Kloss)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.motors.characteristic import MotorCharacteristic
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class AsynchronousMotor(MotorCharacteristic):
    """Static torque-speed curve of an induction motor by Kloss's equation.

    M(s) = 2 M_b s s_b / (s^2 + s_b^2),  s = 1 - w/w_s,  w_s = 2 pi f / p

    with the breakdown torque M_b = breakdown_ratio * M_N and the breakdown slip from the rated
    point (M_N, s_N):  s_b = s_N (lambda + sqrt(lambda^2 - 1)), lambda = breakdown_ratio.

    Source: Kloss 1909 as in any text on electrical machines (stator resistance neglected); the
    characteristic of seed F Fig. 4.  Leaves out electrical transients, saddle torque and skin
    effect; in the braking and generating quadrants it is the same odd curve in s.
    """

    rated_power: float = parameter("W", "shaft power at the rated point", above=0.0)
    rated_speed: float = parameter("rad/s", "speed at the rated point", above=0.0)
    pole_pairs: float = parameter("1", "number of pole pairs p", low=1.0)
    line_frequency: float = parameter("Hz", "line frequency f", default=50.0, above=0.0)
    breakdown_ratio: float = parameter("1", "breakdown torque over rated torque", above=1.0)

    def check(self) -> None:
        if self.rated_speed >= self.synchronous_speed:
            raise ParameterError(
                f"AsynchronousMotor.rated_speed = {self.rated_speed:g} rad/s is not below the synchronous speed "
                f"{self.synchronous_speed:g} rad/s (2 pi f/p); check pole_pairs, line_frequency and the unit (rpm()?)."
            )

    @property
    def synchronous_speed(self) -> float:
        """2 pi f / p [rad/s]."""
        return 2.0 * math.pi * self.line_frequency / self.pole_pairs

    @property
    def rated_torque(self) -> float:
        """Rated power over rated speed [N m]."""
        return self.rated_power / self.rated_speed

    @property
    def breakdown_torque(self) -> float:
        """M_b [N m]."""
        return self.breakdown_ratio * self.rated_torque

    @property
    def breakdown_slip(self) -> float:
        """s_b, from Kloss's equation through the rated point."""
        rated_slip = 1.0 - self.rated_speed / self.synchronous_speed
        return rated_slip * (self.breakdown_ratio + math.sqrt(self.breakdown_ratio**2 - 1.0))

    def torque(self, time: Value, speed: Value) -> Value:
        return self.torque_at_slip(1.0 - speed / self.synchronous_speed)

    def torque_at_slip(self, slip: Value) -> Value:
        """Kloss's equation [N m]."""
        s_b = self.breakdown_slip
        return 2.0 * self.breakdown_torque * s_b * slip / (slip * slip + s_b * s_b)
