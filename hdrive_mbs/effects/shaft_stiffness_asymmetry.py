"""A shaft that bends more easily one way than across all along a section: a flat, a long keyway."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.whole_shaft_effect import WholeShaftEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class ShaftStiffnessAsymmetry(WholeShaftEffect):
    """Bending stiffness (1 + a) K_b in one plane that turns with the shaft and (1 - a) K_b across it.

    F = -a K_b R(2 b) q,   R(c) = [[cos c, sin c], [sin c, -cos c]] over the planes x and y,   b = phi + angle

    with the torque on the spin that gives back what it stores.  The weight makes a 2x of it, which peaks at half the
    critical speed; between the critical speeds of both planes whirl grows without bound if damping does not hold it.

    Source: R. Gasch et al., Rotordynamik (2006), ch. 12; the linear parametric shaft.  Leaves out that torsion and tension couple in.
    """

    asymmetry: float = parameter("1", "a, share by which it is stiffer along b", low=-0.5, high=0.5, typical=(-0.1, 0.1))
    angle: float = parameter(
        "rad",
        "direction of the stiffer plane, from x towards y at spin angle 0",
        default=0.0,
        low=-math.pi,
        high=math.pi,
        typical=(-1.6, 1.6),
    )

    family: ClassVar[str] = "shaft_asymmetry"
    signature: ClassVar[str] = "2x that peaks at half the critical speed, no 1x of its own; steady whatever the balancing"
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"asymmetry": (0.01,), "angle": (-0.78, 0.0, 0.78, 1.57)}
    half_turn: ClassVar[frozenset[str]] = frozenset({"angle"})
    decisive: ClassVar[tuple[str, ...]] = ("angle",)

    def pair(
        self, stiffness: float, s: Value, t: Value, s_rate: Value, t_rate: Value, angle: Value, spin: Value
    ) -> tuple[Value, Value, Value]:
        twice = 2.0 * angle + 2.0 * self.angle
        c, d = self.asymmetry * stiffness * np.cos(twice), self.asymmetry * stiffness * np.sin(twice)
        return c * s + d * t, d * s - c * t, 2.0 * c * s * t - d * (s * s - t * t)
