"""Linear run-up or run-down."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hdrive_mbs.expression import Value
from hdrive_mbs.motors.profiles.profile import SpeedProfile
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class SpeedRamp(SpeedProfile):
    """w = start + (end - start) t / duration for 0 <= t < duration, then end (before: start).

    angle = start t + (end - start) t^2 / (2 duration), then straight on.  The acceleration jumps
    at both ends.
    """

    start: float = parameter("rad/s", "speed at t = 0")
    end: float = parameter("rad/s", "speed from t = duration on")
    duration: float = parameter("s", "time of the ramp", above=0.0)

    def angle(self, time: Value) -> Value:
        rate = (self.end - self.start) / self.duration
        during = self.start * time + 0.5 * rate * time * time
        after = self.end * time - 0.5 * (self.end - self.start) * self.duration
        return np.where(time < 0.0, self.start * time, np.where(time < self.duration, during, after))

    def speed(self, time: Value) -> Value:
        return self.start + (self.end - self.start) * np.clip(time / self.duration, 0.0, 1.0)
