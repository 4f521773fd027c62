"""A rotor that touches a damped ring."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from hdrive_mbs.effects.rub import Rub
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class DampedRub(Rub):
    """Rub with a wall whose damping is looked for too.

    N = max(k p + d p', 0)

    Source: the Kelvin-Voigt wall of e.g. F. K. Choy, J. Padovan, J. Sound and Vibration 113 (1987) 529.  Leaves out what Rub leaves
    out; with a damping the force steps to d p' at the contact.
    """

    damping: float = parameter("N s/m", "d of the wall", low=0.0, high=1e7, typical=(20.0, 5e3))

    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"gap": (1e-4,), "stiffness": (1e6,)}
    decisive: ClassVar[tuple[str, ...]] = ()
    leads: ClassVar[bool] = False
