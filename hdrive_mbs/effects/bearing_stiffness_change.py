"""One bearing that is stiffer or softer than it should be."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.bearing_effect import BearingEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.network.bearing_draft import Across, BearingDraft
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class BearingStiffnessChange(BearingEffect):
    """The spring of a bearing, scaled in x and y.

    F = (1 + e) S(u)

    in place of S(u), for the displacement u of the ring against the housing.

    Source: none needed, a wrong preload or a wrong value of the data sheet.  Leaves out axial and tilt stiffness, which stay.  Both
    bearings at once are a parameter of the model, not this effect.
    """

    change: float = parameter("1", "e, stiffness more than in the model, as a share of it", low=-0.95, high=100.0, typical=(-0.7, 2.0))

    family: ClassVar[str] = "bearing_stiffness"
    signature: ClassVar[str] = "shifted resonances, most in modes that move this bearing; linear, the same at every amplitude"
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"change": (-0.2, 1e-4, 0.2)}

    def added(self, s: Across, v: Across, law: BearingDraft) -> Mapping[str, Value]:
        return {key: self.change * law.spring(key, s, v) for key in "xy"}
