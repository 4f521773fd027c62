"""A rotor that touches a ring around it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.lateral_effect import LateralEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class Rub(LateralEffect):
    """Contact with friction between a rotor and a ring that stands still.

    N = max(k p (p/p_0)^(n-1) + d p', 0) for p = r - g > 0, else 0;   F = -N (e_r + mu tanh(v/v_0) e_t),   T = -mu tanh(v/v_0) N R

    for the distance r of the rotor's centre from that of the ring, e_r from there to the rotor, e_t at +90 degrees, and the
    sliding speed v = R w + r' . e_t of the surface.  Forward spin drives backward whirl.  n = 1: linear, n = 3/2: Hertz.

    Source: Jeffcott rotor with rub, e.g. A. Muszynska, Rotordynamics (2005), ch. 5; F. K. Choy, J. Padovan, J. Sound and
    Vibration 113 (1987) 529.  Leaves out motion of the ring, heat (which bends the shaft), wear, and sticking (below v_0 it
    creeps).  The centre is counted from the axis of the line without load: under weight the rotor starts below it, at its
    static deflection.  The force has a corner at r = g; a fixed step has to resolve the contact, 1/30 of the period of the
    rotor on the wall or less.
    """

    gap: float = parameter("m", "g, radial gap", above=0.0, high=0.1, typical=(1e-6, 1e-3))
    stiffness: float = parameter("N/m", "k of the wall", low=0.0, high=1e12, typical=(1e5, 1e8))
    damping: float = parameter("N s/m", "d of the wall", default=0.0, low=0.0, high=1e7)
    friction: float = parameter("1", "mu", default=0.0, low=0.0, high=2.0, typical=(0.02, 0.3))
    radius: float = parameter("m", "R of the surface that rubs", above=0.0, high=10.0, typical=(2e-3, 0.2))
    centre_x: float = parameter("m", "centre of the ring in x", default=0.0, low=-0.1, high=0.1, typical=(-1e-4, 1e-4))
    centre_y: float = parameter("m", "centre of the ring in y", default=0.0, low=-0.1, high=0.1, typical=(-1e-4, 1e-4))
    exponent: float = parameter("1", "n", default=1.0, low=1.0, high=3.0)
    reference_depth: float = parameter("m", "p_0, depth at which k is the force over the depth; only if n > 1", default=1e-5, above=0.0)
    smoothing_speed: float = parameter("m/s", "v_0 of the smooth step of friction through zero", default=0.05, above=0.0)

    acts_on: ClassVar[str] = "rotor"
    family: ClassVar[str] = "rub"
    signature: ClassVar[str] = (
        "clipped resonances that are drawn to higher speed, harmonics and subharmonics in bursts, backward parts, a brake on the spin"
    )
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"gap": (1e-5, 3e-5, 1e-4, 2e-4, 3e-4, 5e-4), "stiffness": (1e6,)}
    decisive: ClassVar[tuple[str, ...]] = ("gap",)
    reaches: ClassVar[Mapping[str, tuple[float, ...]]] = {"gap": (0.98, 0.9, 0.7)}
    leads: ClassVar[bool] = True

    def normal(self, depth: Value, rate: Value) -> Value:
        """Force of the wall at a depth that grows at a rate [N], before what would pull is cut off."""
        wall = self.stiffness * depth
        if self.exponent != 1.0:
            wall = wall * (depth / self.reference_depth) ** (self.exponent - 1.0)
        return wall if self.damping == 0.0 else wall + self.damping * rate

    def _contact(self, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> tuple[Value, Value, Value, Value]:
        """Normal force, friction force along e_t, and e_r."""
        x, y = x - self.centre_x, y - self.centre_y
        square = x * x + y * y
        r = np.sqrt(np.maximum(square, self.gap**2))
        c, s = x / r, y / r
        normal = np.where(square > self.gap**2, np.maximum(self.normal(r - self.gap, c * x_rate + s * y_rate), 0.0), 0.0)
        sliding = self.radius * speed + c * y_rate - s * x_rate
        return normal, self.friction * np.tanh(sliding / self.smoothing_speed) * normal, c, s

    def force(self, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> tuple[Value, Value]:
        normal, rubbing, c, s = self._contact(speed, x, y, x_rate, y_rate)
        return -normal * c + rubbing * s, -normal * s - rubbing * c

    def torque(self, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> Value | None:
        return -self.radius * self._contact(speed, x, y, x_rate, y_rate)[1]
