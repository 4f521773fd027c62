"""One support that is damped more or less than it should be."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from hdrive_mbs.effects.support_effect import SupportEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.network.bearing_draft import SupportDraft
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class SupportDampingChange(SupportEffect):
    """The damper of one foundation, scaled.

    F = (1 + e) d x'

    in place of d x', for the displacement x of the housing.

    Source: none needed, a wrong value of the data sheet.  Leaves out damping that is not viscous.
    """

    change: float = parameter("1", "e, damping more than in the model, as a share of it", low=-1.0, high=1e3, typical=(-0.9, 9.0))

    family: ClassVar[str] = "support_damping"
    signature: ClassVar[str] = "another height of resonances and another decay, at the same frequencies, where this housing moves"
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"change": (-0.5, 1e-4, 1.0)}

    def added(self, direction: str, x: Value, rate: Value, support: SupportDraft) -> Value:
        return self.change * support.damping[direction] * rate
