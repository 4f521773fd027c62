"""A bearing or seal that pushes across the displacement and feeds whirl."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.bearing_effect import BearingEffect
from hdrive_mbs.effects.speed_growth import grown
from hdrive_mbs.expression import Value
from hdrive_mbs.network.bearing_draft import Across, BearingDraft
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class BearingCrossCoupling(BearingEffect):
    """Skew stiffness k_xy = -k_yx = q of a bearing.

    F = q g (-(1 + e) y, (1 - e) x)/(1 + f r^2),   g = sign(w) |w/w_0|^n,  and g = 1 for n = 0

    on the ring, with the displacement (x, y) of the ring against the housing and its spin w.  A positive q turns with the spin and feeds
    forward whirl; without other damping than c at the same place, whirl at w_k grows where q > c w_k.  n = 0 acts at
    standstill too, turning about +z whatever the spin.  e makes both entries unlike; f limits what grows.

    Source: the destabilising force of seals and films (H. Thomas, Bull. AIM 71 (1958) 1039; J. S. Alford, J. Engineering for
    Power 87 (1965) 333; R. Gasch et al., Rotordynamik (2006), ch. 11).  Leaves out the direct
    stiffness, damping and mass of the film, and the torque that it takes from the spin: the power that whirl gains
    comes from nowhere.
    """

    stiffness: float = parameter("N/m", "q, force per displacement across it", low=-1e10, high=1e10, typical=(1e2, 5e7))
    exponent: float = parameter("1", "n: how it grows with the spin; 0 not at all, 1 for films", default=0.0, low=0.0, high=4.0)
    reference_speed: float = parameter("rad/s", "w_0, spin at which the force is that of q", default=1000.0, above=0.0)
    asymmetry: float = parameter("1", "e, by which the two entries differ", default=0.0, low=-1.0, high=1.0)
    fading: float = parameter("1/m^2", "f, by which the force falls with the square of the displacement", default=0.0, low=0.0)

    family: ClassVar[str] = "bearing_cross_coupling"
    signature: ClassVar[str] = (
        "less damping of forward and more of backward whirl, in steps and blows; beyond a speed whirl at a natural frequency that grows"
    )
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"stiffness": (1e6, 5e6, 1e3), "exponent": (0.0, 1.0, 2.0)}

    def added(self, s: Across, v: Across, law: BearingDraft) -> Mapping[str, Value]:
        x, y = s["x"], s["y"]
        size: Value = self.stiffness
        if self.exponent != 0.0:
            ratio = v["phi"] / self.reference_speed
            size = size * (ratio if self.exponent == 1.0 else np.sign(ratio) * grown(v["phi"], self.reference_speed, self.exponent))
        if self.fading != 0.0:
            size = size / (1.0 + self.fading * (x * x + y * y))
        return {"x": (1.0 + self.asymmetry) * size * y, "y": -(1.0 - self.asymmetry) * size * x}
