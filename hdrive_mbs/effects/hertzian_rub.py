"""A rotor that touches a ring that stiffens with the depth."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from hdrive_mbs.effects.rub import Rub
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class HertzianRub(Rub):
    """Rub with a force that grows with a power of the depth, and a damping in proportion to it.

    N = max(k p_0 (p/p_0)^n (1 + c p'), 0)

    Source: Hertz, n = 3/2; damping after K. H. Hunt, F. R. E. Crossley, J. Applied Mechanics 42 (1975) 440.  The force has no
    corner at the contact.  Leaves out the rest of what Rub leaves out.

    Raises ParameterError for a ``damping`` that is not in proportion to the force: give ``loss``.
    """

    exponent: float = parameter("1", "n", default=1.5, low=1.0, high=3.0)
    loss: float = parameter("s/m", "c of the damping", low=0.0, high=100.0, typical=(0.02, 2.0))

    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"gap": (1e-4,), "stiffness": (1e6,)}
    decisive: ClassVar[tuple[str, ...]] = ()
    leads: ClassVar[bool] = False

    def check(self) -> None:
        super().check()
        if self.damping != 0.0:
            raise ParameterError(f"HertzianRub.damping = {self.damping:g} N s/m would not be used. Give loss [s/m], or take DampedRub.")

    def normal(self, depth: Value, rate: Value) -> Value:
        return self.stiffness * self.reference_depth * (depth / self.reference_depth) ** self.exponent * (1.0 + self.loss * rate)
