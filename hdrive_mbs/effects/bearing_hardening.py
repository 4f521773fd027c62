"""A bearing that stiffens without bound beyond a length."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.bearing_effect import BearingEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.network.bearing_draft import Across, BearingDraft
from hdrive_mbs.quantities import parameter

_SMALL, _LARGE = 1e-3, 20.0
"""r/l below which the series is taken, and beyond which the factor stays (a run that gets there has diverged)."""


@dataclass(frozen=True, kw_only=True)
class BearingHardening(BearingEffect):
    """The spring of a bearing, scaled by sinh(r/l)/(r/l).

    F = S(u) sinh(z)/z,  z = r/l,  in place of S(u):  S (1 + z^2/6 + ...), and exponential for r > l

    for the displacement u of the ring against the housing, r = |u|, counted from where the bearing carries no load.

    Source: a usual form of a spring that hits a soft stop; its first term is BearingCubicStiffness with b = k/(6 l^2).  Leaves out
    damping; the form is a fit, not a contact law.
    """

    rate: float = parameter("1/m", "1/l: at r = l the force is 18 % above the bearing's", low=0.0, high=1e9, typical=(1e3, 1e6))

    family: ClassVar[str] = "bearing_cubic_stiffness"
    signature: ClassVar[str] = "resonances that bend to higher speed with the amplitude, jumps in run-up and run-down, odd harmonics"
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"rate": (1e4, 3e4, 1e5, 3e5)}

    def added(self, s: Across, v: Across, law: BearingDraft) -> Mapping[str, Value]:
        square = self.rate**2 * (s["x"] * s["x"] + s["y"] * s["y"])
        z = np.sqrt(np.clip(square, _SMALL**2, _LARGE**2))
        more = np.where(square < _SMALL**2, square / 6.0, np.sinh(z) / z - 1.0)
        return {key: more * law.spring(key, s, v) for key in "xy"}
