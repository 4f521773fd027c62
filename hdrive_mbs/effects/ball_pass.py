"""Balls that pass a flaw of the outer race."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.lateral_effect import LateralEffect
from hdrive_mbs.effects.speed_growth import grown
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class BallPass(LateralEffect):
    """Pulses of a force between ring and housing in one direction, at an order of the spin that is no whole number.

    F = A g(w) (cos(a) - r)/(1 - 2 r cos(a) + r^2),  a = n f + p,  g = (|w|/w_0)^m

    on the ring along the direction d, with the spin angle f of the ring and its speed w.  The pulse is the sum of
    r^(k-1) cos(k a), k = 1, 2, ...: A is the amplitude of the first harmonic and each further one has the share r of
    the one before.  For z balls of diameter D_b on the diameter D_p the order is n = z (1 - D_b/D_p cos(contact))/2 with
    a flaw of the outer race; slip makes it a little smaller.

    Source: kinematics and pulse trains of McFadden, Smith, J. Sound and Vibration 96 (1984) 69.  Leaves out slip that
    wanders, the ringing of the race after each pulse, and what the load makes of the size of each.
    """

    amplitude: float = parameter("N", "A of the first harmonic, 0-peak, at the reference speed", low=0.0, high=1e6, typical=(0.05, 500.0))
    phase: float = parameter("rad", "p, phase at spin angle 0", default=0.0, typical=(-np.pi, np.pi))
    order: float = parameter("1", "n, pulses per turn of the shaft", above=0.0, high=100.0, typical=(2.0, 12.0))
    sharpness: float = parameter("1", "r, each harmonic over the one before", default=0.5, low=0.0, high=0.95, typical=(0.05, 0.85))
    direction: float = parameter("rad", "d, of the flaw, from x towards y", default=-0.5 * np.pi, typical=(-np.pi, np.pi))
    growth: float = parameter("1", "m, power of the speed with which it grows", default=0.0, low=0.0, high=4.0, typical=(0.0, 2.0))
    reference_speed: float = parameter("rad/s", "w_0, where it has the amplitude A", default=500.0, above=0.0)

    acts_on: ClassVar[str] = "bearing"
    family: ClassVar[str] = "ball_pass"
    excites: ClassVar[bool] = True
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"direction": (0.0, 0.5 * np.pi)}
    decisive: ClassVar[tuple[str, ...]] = ("direction",)
    periodic: ClassVar[Mapping[str, str]] = {"order": "turn"}
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("amplitude", "phase"),)
    signature: ClassVar[str] = "pulses at an order of the spin that is no whole number, with its harmonics, at one housing"

    def pulse(self, angle: Value, speed: Value) -> Value:
        """Size of the force [N] at a spin angle [rad] and speed [rad/s]."""
        c, r = np.cos(self.order * angle + self.phase), self.sharpness
        size = self.amplitude * grown(speed, self.reference_speed, self.growth)
        return size * (c - r) / (1.0 - 2.0 * r * c + r**2)

    def force(self, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> tuple[Value, Value]:
        pulse = self.pulse(angle, speed)
        return np.cos(self.direction) * pulse, np.sin(self.direction) * pulse
