"""A rotor that cuts into a soft coat."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from hdrive_mbs.effects.rub import Rub
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class CoatedRub(Rub):
    """Rub on an abradable coat that gives way.

    N = max(k p/(1 + p/p_c) + d p', 0)

    The coat bears k p_c at most, as a material that is crushed or cut does.

    Source: our own, the simplest curve from a stiffness to a limit.  Leaves out that a cut coat does not come back, and what Rub
    leaves out.

    Raises ParameterError for an ``exponent``: the coat has its own curve.
    """

    coat_depth: float = parameter("m", "p_c, depth at which the coat bears half of its most", above=0.0, high=0.1, typical=(1e-5, 3e-4))
    damping: float = parameter("N s/m", "d of the wall", low=0.0, high=1e7, typical=(20.0, 5e3))

    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"gap": (1e-4,), "stiffness": (1e6,), "coat_depth": (5e-5,)}
    decisive: ClassVar[tuple[str, ...]] = ()
    leads: ClassVar[bool] = False

    def check(self) -> None:
        super().check()
        if self.exponent != 1.0:
            raise ParameterError(f"CoatedRub.exponent = {self.exponent:g} would not be used. Leave it at 1, or take HertzianRub.")

    def normal(self, depth: Value, rate: Value) -> Value:
        return self.stiffness * depth / (1.0 + depth / self.coat_depth) + self.damping * rate
