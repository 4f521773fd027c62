"""Load torque that rises to a constant value."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hdrive_mbs.expression import Value
from hdrive_mbs.loads.law import LoadLaw
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class RampTorque(LoadLaw):
    """M = start + (end - start) (t - begin)/duration within the ramp, start before, end after."""

    start: float = parameter("N m", "torque before the ramp")
    end: float = parameter("N m", "torque after the ramp")
    duration: float = parameter("s", "time of the ramp", above=0.0)
    begin: float = parameter("s", "time at which the ramp begins", default=0.0)

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        return self.start + (self.end - self.start) * np.clip((time - self.begin) / self.duration, 0.0, 1.0)
