"""A neighbour that shakes a support."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.lateral_effect import LateralEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class GroundVibration(LateralEffect):
    """A force of a fixed frequency on a housing.

    F = A sin(f t + p) along the direction d

    A ground that moves by z sin(f t) under a support of stiffness k gives A = k z, its damping left aside.

    Source: excitation through the foundation, e.g. Den Hartog, Mechanical Vibrations (1956), 2.9.  Leaves out that the
    ground shakes the other supports too: add one effect each.
    """

    amplitude: float = parameter("N", "A, 0-peak", low=0.0, high=1e6, typical=(0.01, 1e3))
    frequency: float = parameter("rad/s", "f", above=0.0, high=1e5, typical=(50.0, 5e3))
    phase: float = parameter("rad", "p, phase at t = 0", default=0.0, typical=(-np.pi, np.pi))
    direction: float = parameter("rad", "d, from x towards y", default=0.0, typical=(-0.5 * np.pi, 0.5 * np.pi))

    acts_on: ClassVar[str] = "support"
    family: ClassVar[str] = "ground_vibration"
    excites: ClassVar[bool] = True
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"direction": (0.0, 0.5 * np.pi)}
    decisive: ClassVar[tuple[str, ...]] = ("direction",)
    periodic: ClassVar[Mapping[str, str]] = {"frequency": "time"}
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("amplitude", "phase"),)
    signature: ClassVar[str] = "vibration at one frequency that stays where it is when the speed changes, largest at one housing"

    def force(self, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> tuple[Value, Value]:
        push = self.amplitude * np.sin(self.frequency * time + self.phase)
        return np.cos(self.direction) * push, np.sin(self.direction) * push
