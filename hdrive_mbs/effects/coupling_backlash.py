"""Backlash in a connection."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import LawEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class CouplingBacklash(LawEffect):
    """A dead zone in the twist of a connection, with one-sided contact.

    tau = max(T(x - b/2, v), 0) for x > b/2,  min(T(x + b/2, v), 0) for x < -b/2,  else 0

    where T(x, v) is the law of the connection without backlash.  Damping acts in contact only, and
    a separating flank does not pull.  b = 0 is the old law unchanged.

    Source: Nordin, Gutman, Automatica 38 (2002) 1633 (dead-zone model with damped contact).  Leaves
    out losses of impact other than the connection's damping, whose torque jumps at a fast
    contact, and the oil film in the gap.  Hysteresis at the same connection acts across the gap.
    """

    backlash: float = parameter("rad", "full width b of the gap", low=0.0, high=0.2, typical=(1e-5, 0.05))

    family: ClassVar[str] = "backlash"
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"backlash": (1.5e-5, 1e-4, 7e-4, 4e-3)}
    signature: ClassVar[str] = "no torque over a range of twist; knocking at load reversals, a lower resonance at small amplitude"

    def changed(self, law: Callable[[Value, Value], Value]) -> Callable[[Value, Value], Value]:
        half = 0.5 * self.backlash
        if half == 0.0:
            return law

        def torque(twist: Value, rate: Value) -> Value:
            ahead = np.maximum(law(twist - half, rate), 0.0)
            behind = np.minimum(law(twist + half, rate), 0.0)
            return np.where(twist > half, ahead, np.where(twist < -half, behind, 0.0))

        return torque
