"""Fan or pump load."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hdrive_mbs.expression import Value
from hdrive_mbs.loads.law import LoadLaw
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class QuadraticLoad(LoadLaw):
    """M = k w |w|: a fan or centrifugal pump by the affinity laws.

    Leaves out the laminar part at low speed and the static head of a pump.
    """

    coefficient: float = parameter("N m s^2/rad^2", "k, torque per speed squared", low=0.0)

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        return self.coefficient * speed * np.abs(speed)
