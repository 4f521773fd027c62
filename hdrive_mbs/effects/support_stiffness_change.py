"""One support that is stiffer or softer than it should be."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from hdrive_mbs.effects.support_effect import SupportEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.network.bearing_draft import SupportDraft
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class SupportStiffnessChange(SupportEffect):
    """The spring of one foundation, scaled.

    F = (1 + e) S(x)

    in place of S(x), for the displacement x of the housing.

    Source: none needed, a wrong value of the data sheet.  Leaves out that a softer foundation is usually damped otherwise too.
    """

    change: float = parameter("1", "e, stiffness more than in the model, as a share of it", low=-0.95, high=100.0, typical=(-0.7, 2.0))

    family: ClassVar[str] = "support_stiffness"
    signature: ClassVar[str] = "shifted resonances, most in modes that move this housing; linear, the same at every amplitude"
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"change": (-0.2, 1e-4, 0.2)}

    def added(self, direction: str, x: Value, rate: Value, support: SupportDraft) -> Value:
        return self.change * support.spring(direction, x)
