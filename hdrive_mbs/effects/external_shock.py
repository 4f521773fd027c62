"""A knock from outside."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.lateral_effect import LateralEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class ExternalShock(LateralEffect):
    """A half sine of force on a housing, once.

    F = A sin(pi (t - s)/b) for s < t < s + b,  else 0,  along the direction d

    A search does not try it: its beginning would have to be known to within its length.

    Source: half-sine pulse of shock tests (IEC 60068-2-27).  Leaves out what knocks, and a second knock: add one
    effect each.
    """

    amplitude: float = parameter("N", "A, peak", low=0.0, high=1e7, typical=(1.0, 1e4))
    start: float = parameter("s", "s, beginning", low=0.0, high=1e6)
    length: float = parameter("s", "b, length", default=2e-3, above=0.0, high=10.0, typical=(5e-4, 0.02))
    direction: float = parameter("rad", "d, from x towards y", default=0.0, typical=(-np.pi, np.pi))

    acts_on: ClassVar[str] = "support"
    family: ClassVar[str] = "external_shock"
    excites: ClassVar[bool] = True
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("amplitude", "direction"),)
    signature: ClassVar[str] = "one ringing of all modes at a time that has nothing to do with the rotation, first at one housing"

    def force(self, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> tuple[Value, Value]:
        part = np.clip((time - self.start) / self.length, 0.0, 1.0)
        push = self.amplitude * np.sin(np.pi * part)
        return np.cos(self.direction) * push, np.sin(self.direction) * push
