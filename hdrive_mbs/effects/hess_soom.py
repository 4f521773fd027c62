"""Sliding torque that drops with the speed like a hyperbola, and may differ in both senses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.effects.speed_growth import grown
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter

SPEED_STARTS: Mapping[str, tuple[float, ...]] = {"stribeck_speed": (0.1, 5.0), "asymmetry_speed": (1.0,)}
"""Speeds from which searches of the laws that have it begin."""


@dataclass(frozen=True, kw_only=True)
class HessSoomSliding:
    """The fields of such a torque, for the laws that have it; they come before a law's own.

    L(w) = T_C (1 + a tanh(w/w_a)) (1 + d/(1 + |w/w_S|^p))

    Source: Hess, Soom, J. Tribology 112 (1990) 147, with p = 2; that the senses are unequal, and come apart over a speed, is our own.
    A small w_a, like the default, is a step through zero.
    """

    coulomb: float = parameter("N m", "sliding torque T_C", low=0.0, high=1e3, typical=(5e-3, 50.0))
    drop: float = parameter("1", "d, share by which breaking away takes more", default=0.0, low=0.0, high=10.0, typical=(0.02, 2.0))
    stribeck_speed: float = parameter("rad/s", "speed w_S of the drop", default=1.0, above=0.0, typical=(0.01, 20.0))
    stribeck_exponent: float = parameter("1", "p, shape of the drop", default=1.5, low=0.25, high=4.0, typical=(0.5, 2.5))
    asymmetry: float = parameter("1", "a, share by which forward friction is larger", default=0.0, low=-0.9, high=0.9, typical=(-0.3, 0.3))
    asymmetry_speed: float = parameter(
        "rad/s", "speed w_a over which the senses come apart: 76 % of it there", default=1e-3, above=0.0, typical=(1e-3, 30.0)
    )

    def sliding_torque(self, speed: Value) -> Value:
        """L(w) [N m]."""
        size = self.coulomb * (1.0 + self.asymmetry * np.tanh(speed / self.asymmetry_speed))
        if self.drop == 0.0:
            return size
        return size * (1.0 + self.drop / (1.0 + grown(speed, self.stribeck_speed, self.stribeck_exponent)))
