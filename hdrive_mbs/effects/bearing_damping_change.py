"""One bearing that is damped more or less than it should be."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.bearing_effect import BearingEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.network.bearing_draft import Across, BearingDraft
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class BearingDampingChange(BearingEffect):
    """The damper of a bearing, scaled in x and y.

    F = (1 + e) D u'

    in place of D u', for the displacement u of the ring against the housing.

    Source: none needed, a wrong value of the data sheet.  Leaves out axial and tilt damping, and damping that a law
    has beyond its constant matrix (JournalBearing), which all stay.
    """

    change: float = parameter("1", "e, damping more than in the model, as a share of it", low=-1.0, high=1e3, typical=(-0.9, 9.0))

    family: ClassVar[str] = "bearing_damping"
    signature: ClassVar[str] = "another height of resonances and another decay, at the same frequencies"
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"change": (-0.5, 1e-4, 1.0)}

    def added(self, s: Across, v: Across, law: BearingDraft) -> Mapping[str, Value]:
        return {key: self.change * law.damper(key, v) for key in "xy"}
