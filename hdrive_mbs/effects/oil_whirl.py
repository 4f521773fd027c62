"""Whirl of an oil film at a little less than half the speed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.lateral_effect import LateralEffect
from hdrive_mbs.effects.speed_growth import grown
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class OilWhirl(LateralEffect):
    """A force between ring and housing that turns with a share of the spin.

    F = A g(w) exp(i (q f + p)),  g = (|w|/w_0)^n (1 + tanh((|w| - w_1)/w_2))/2,  F = F_x + i F_y on the ring

    with the spin angle f of the ring and its speed w.  Without an onset w_1 the last factor is left out.

    Source: a film whose mean speed is a little below half that of the journal (Muszynska, Rotordynamics, 2005, 4.2:
    q = 0.42 to 0.49), its vibration put in as it is.  Leaves out why it whirls: neither the limit cycle of the film nor
    the lock to a natural frequency (whip) comes out, and the line does not act back on it.
    """

    amplitude: float = parameter("N", "A, 0-peak, at the reference speed", low=0.0, high=1e6, typical=(0.1, 2e3))
    phase: float = parameter("rad", "p, phase at spin angle 0", default=0.0, typical=(-np.pi, np.pi))
    ratio: float = parameter("1", "q, speed of the whirl over that of the spin", default=0.47, above=0.0, high=1.0, typical=(0.4, 0.5))
    growth: float = parameter("1", "n, power of the speed with which it grows", default=0.0, low=0.0, high=4.0)
    reference_speed: float = parameter("rad/s", "w_0, where it has the amplitude A", default=500.0, above=0.0)
    onset: float = parameter("rad/s", "w_1, speed at which it sets in; 0: none", default=0.0, low=0.0, high=1e5)
    onset_width: float = parameter("rad/s", "w_2, over which it sets in", default=20.0, above=0.0)

    acts_on: ClassVar[str] = "bearing"
    family: ClassVar[str] = "oil_whirl"
    excites: ClassVar[bool] = True
    periodic: ClassVar[Mapping[str, str]] = {"ratio": "turn"}
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("amplitude", "phase"),)
    signature: ClassVar[str] = "forward whirl at 0.42 to 0.49 of the speed, strongest at one bearing"

    def force(self, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> tuple[Value, Value]:
        size = self.amplitude * grown(speed, self.reference_speed, self.growth)
        if self.onset > 0.0:
            size = size * (0.5 + 0.5 * np.tanh((np.abs(speed) - self.onset) / self.onset_width))
        turned = self.ratio * angle + self.phase
        return size * np.cos(turned), size * np.sin(turned)
