"""A spring behind a dry slider (Jenkins element), of which laws with several make friction and hysteresis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hdrive_mbs.effects.fast_sliding import followed_share, mixed
from hdrive_mbs.expression import Value


@dataclass(frozen=True)
class Slider:
    """One element at a rate v of twist or angle, with its torque T as state and a limit L that may change with the moment.

    dT/dt = k v (1 - s),  s = max((|T| - (1 - r) L)/(r L), 0) where v T > 0, else 0;  its torque is T, at most L

    With the stored energy T^2/(2 k) the heat is never negative: |v| |T| s while |T| <= L.  A torque above a limit that has fallen
    (s > 1) gives |v| (L + |T| (s - 1)) where v T > 0, and |v| (|T| - L) where not.

    stiffness : k [N m/rad];  rounding : r, 0 for a sharp corner;  fastest_rate : see fast_sliding.py

    Source: Iwan, J. Applied Mechanics 33 (1966) 893; with a limit that follows the speed Lampaert, Swevers, Al-Bender (2003).
    """

    stiffness: float
    rounding: float
    fastest_rate: float

    def state_rate(self, torque: Value, limit: Value, rate: Value) -> Value:
        """dT/dt [N m/s]."""
        slip = self._slip(torque, limit, rate)
        share = self._share(limit, rate)
        if self.rounding > 0.0:
            share = np.where(slip > 0.0, self._share(limit, rate / self.rounding), share)
        return share * self.stiffness * rate * (1.0 - slip)

    def torque(self, torque: Value, limit: Value, rate: Value) -> Value:
        """What it resists the motion with [N m]."""
        return mixed(self._share(limit, rate), np.clip(torque, -limit, limit), limit, rate)

    def stored(self, torque: Value) -> Value:
        """T^2/(2 k) [J]."""
        return torque * torque / (2.0 * self.stiffness)

    def _share(self, limit: Value, rate: Value) -> Value:
        return followed_share(np.abs(rate) * (self.stiffness / limit), self.fastest_rate)

    def _slip(self, torque: Value, limit: Value, rate: Value) -> Value:
        size = np.abs(torque)
        if self.rounding == 0.0:
            slip = np.where(size >= limit, 1.0, 0.0)
        else:
            slip = np.maximum((size - (1.0 - self.rounding) * limit) / (self.rounding * limit), 0.0)
        return np.where(rate * torque > 0.0, slip, 0.0)


def spread_places(middle: float, spread: float, count: int) -> list[float]:
    """Slip places that grow by a constant factor from about middle/spread to middle spread: middle spread^((2 i - 1)/count - 1), i = 1.."""
    return [middle * spread ** ((2 * k + 1) / count - 1.0) for k in range(count)]
