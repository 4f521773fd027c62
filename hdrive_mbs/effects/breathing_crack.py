"""A crack that opens and closes once a turn under the weight."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hdrive_mbs.effects.crack_effect import CrackEffect
from hdrive_mbs.errors import PlaceError
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import option, parameter


@dataclass(frozen=True, kw_only=True)
class BreathingCrack(CrackEffect):
    """A crack that is open when it points down and shut when it points up: CrackEffect with

    g = (1 + cos b)/2,  or  g = (1 + tanh(s cos b)/tanh s)/2 with a steepness s,  or g = 1 (always open)

    b is the angle between the crack and the weight, so the weight has to bend the shaft more than the vibration does.
    Between bearings the lower side is in tension; on an overhang it is the upper one: turn the angle by pi.

    Source: I. W. Mayes, W. G. R. Davies, J. Vibration, Acoustics, Stress, Reliability in Design 106 (1984) 139 (cosine); R. Gasch, J. Sound
    and Vibration 160 (1993) 313 (hinge; a large s is his switching crack).  Leaves out breathing by vibration (MomentCrack), the coupling
    of bending with torsion and tension, and damping in the crack.
    """

    steepness: float = parameter("1", "s; 0 for the cosine", default=0.0, low=0.0, high=50.0)
    always_open: bool = option("whether it never shuts (a notch): then there is no 1x, and 2x alone", default=False)

    def check_gravity(self, gravity: tuple[float, float], place: str) -> None:
        if gravity == (0.0, 0.0) and not self.always_open:
            raise PlaceError(
                f"BreathingCrack at {place!r} opens and shuts by the weight, and no gravity acts across the axis. "
                "Add a Gravity part, take a MomentCrack, or say always_open=True."
            )

    def opening(self, moment: Value, cosine: Value, sine: Value, gravity: tuple[float, float]) -> tuple[Value, Value]:
        if self.always_open:
            return 1.0, 0.0
        down, slope = gravity[0] * cosine + gravity[1] * sine, gravity[1] * cosine - gravity[0] * sine
        if self.steepness < 1e-3:
            return 0.5 * (1.0 + down), 0.5 * slope
        bent, full = np.tanh(self.steepness * down), np.tanh(self.steepness)
        return 0.5 * (1.0 + bent / full), 0.5 * self.steepness * slope * (1.0 - bent * bent) / full
