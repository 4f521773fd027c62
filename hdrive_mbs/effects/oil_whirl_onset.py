"""Whirl of an oil film that sets in at a speed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.lateral_effect import LateralEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class OilWhirlOnset(LateralEffect):
    """A force between ring and housing that turns with a share of the spin, above a threshold of stability.

    F = A (1 + tanh((|w| - w_1)/w_2))/2 exp(i (q f + p)),  F = F_x + i F_y on the ring

    with the spin angle f of the ring and its speed w.  OilWhirl is there at every speed; here the threshold w_1 is
    searched.

    Source: a film is stable below a threshold speed (Muszynska, Rotordynamics, 2005, 4.2); its vibration put in as it
    is.  Leaves out the limit cycle of the film, its lock to a natural frequency (whip) and hysteresis of the threshold.
    """

    amplitude: float = parameter("N", "A, 0-peak, far above the onset", low=0.0, high=1e6, typical=(0.1, 2e3))
    phase: float = parameter("rad", "p, phase at spin angle 0", default=0.0, typical=(-np.pi, np.pi))
    ratio: float = parameter("1", "q, speed of the whirl over that of the spin", default=0.47, above=0.0, high=1.0, typical=(0.4, 0.5))
    onset: float = parameter("rad/s", "w_1, speed at which it sets in", above=0.0, high=1e5, typical=(100.0, 2e3))
    onset_width: float = parameter("rad/s", "w_2, over which it sets in", default=30.0, above=0.0)

    acts_on: ClassVar[str] = "bearing"
    family: ClassVar[str] = "oil_whirl"
    excites: ClassVar[bool] = True
    periodic: ClassVar[Mapping[str, str]] = {"ratio": "turn"}
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("amplitude", "phase"),)
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"ratio": (0.45,), "onset": (250.0, 450.0, 650.0)}
    signature: ClassVar[str] = "forward whirl at 0.42 to 0.49 of the speed from some speed on, strongest at one bearing"

    def force(self, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> tuple[Value, Value]:
        size = self.amplitude * (0.5 + 0.5 * np.tanh((np.abs(speed) - self.onset) / self.onset_width))
        turned = self.ratio * angle + self.phase
        return size * np.cos(turned), size * np.sin(turned)
