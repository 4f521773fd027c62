"""Load torque with a sinusoidal part."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.expression import Value
from hdrive_mbs.loads.law import LoadLaw
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class SineTorque(LoadLaw):
    """M(t) = mean + amplitude * sin(2 pi frequency t + phase); amplitude is 0-peak."""

    mean: float = parameter("N m", "mean torque")
    amplitude: float = parameter("N m", "amplitude, 0-peak")
    frequency: float = parameter("Hz", "frequency", low=0.0)
    phase: float = parameter("rad", "phase at t = 0", default=0.0)

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        return self.mean + self.amplitude * np.sin(2.0 * math.pi * self.frequency * time + self.phase)
