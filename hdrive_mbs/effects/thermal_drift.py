"""Friction that drifts while a machine warms up."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import TorqueEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class ThermalDrift(TorqueEffect):
    """Drag and dry friction of a body that change exponentially with time.

    tau = -(1 - exp(-t/h)) (c w + T tanh(w/w_0))

    with the time t of the run.  The changes c and T add to what the model has, and are negative where a lubricant
    thins as it warms; taken alone they may then drive, which the friction of the model must outweigh.

    Source: a body of one heat capacity that warms under a constant loss (Newton's law of cooling), with friction in
    proportion to its temperature in the first order.  Leaves out that the loss itself changes with the run; every
    run starts cold at t = 0.
    """

    viscous_change: float = parameter(
        "N m s/rad", "c, change of viscous drag in the end", default=0.0, low=-1e3, high=1e3, typical=(-10.0, 10.0)
    )
    friction_change: float = parameter(
        "N m", "T, change of dry friction in the end", default=0.0, low=-1e3, high=1e3, typical=(-20.0, 20.0)
    )
    time_constant: float = parameter("s", "h, time in which it warms up", above=0.0, typical=(0.3, 300.0))
    smoothing_speed: float = parameter("rad/s", "speed w_0 of the smooth step through zero", default=0.01, above=0.0)

    kind: ClassVar[str] = "parametric"
    family: ClassVar[str] = "thermal_drift"
    signature: ClassVar[str] = "torque at the same speed and load that creeps from one level to another over a record"

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        size = self.viscous_change * speed + self.friction_change * np.tanh(speed / self.smoothing_speed)
        return -(1.0 - np.exp(-time / self.time_constant)) * size
