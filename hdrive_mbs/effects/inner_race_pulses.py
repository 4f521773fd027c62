"""Balls that knock on a flaw of the inner race while it passes the loaded zone."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.inner_race_pass import InnerRacePass
from hdrive_mbs.effects.speed_growth import grown
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class InnerRacePulses(InnerRacePass):
    """Pulses with a mean on a flaw that turns with the shaft, felt in a loaded zone.

    F = g(w) (B + A sum(r^(k-1) cos(k a))) q(f + d - b) exp(i (f + d)),  a = n f + p,  F = F_x + i F_y on the ring
    q(u) = max(0, 1 - (1 - cos(u))/(2 e))^(3/2) + q_0,  g = (|w|/w_0)^m

    Pulses that only push have a mean of B = A/(2 r), which adds forces at orders 0, 1 and 2 of the spin.
    e = 0.5 loads half of the race, as a bearing without play does, e > 1 all of it.

    Source: McFadden, Smith, J. Sound and Vibration 96 (1984) 69, with the load distribution of Stribeck for balls (T. A. Harris, Rolling
    Bearing Analysis, chapter on internal load distribution).  Leaves out what InnerRacePass does, but for the width of the zone.
    """

    mean: float = parameter("N", "B, mean of the pulses at the reference speed", default=0.0, low=0.0, high=1e6, typical=(0.05, 500.0))
    load_zone: float = parameter("1", "e, of the load distribution", default=0.5, low=0.05, high=10.0, typical=(0.2, 2.0))
    unloaded: float = parameter("1", "q_0, share felt outside of the zone too", default=0.05, low=0.0, high=1.0)

    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"direction": (-0.5 * np.pi,), "load_zone": (0.6,)}

    def pulse(self, angle: Value, speed: Value) -> Value:
        """Size of the force where the load is largest [N] at a spin angle [rad] and speed [rad/s]."""
        return InnerRacePass.pulse(self, angle, speed) + self.mean * grown(speed, self.reference_speed, self.growth)

    def force(self, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> tuple[Value, Value]:
        at = angle + self.direction
        load = np.maximum(1.0 - (1.0 - np.cos(at - self.load_direction)) / (2.0 * self.load_zone), 0.0) ** 1.5 + self.unloaded
        size = self.pulse(angle, speed) * load
        return size * np.cos(at), size * np.sin(at)
