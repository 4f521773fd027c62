"""A crack that opens and closes once a turn at spin angles of its own."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.crack_effect import CrackEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class PhasedCrack(CrackEffect):
    """A crack whose opening is tied to the spin angle f alone, with a phase of its own: CrackEffect with

    g = (1 + cos(f - p))/2

    so that front and phase are found apart from each other.  With p = -angle - pi/2 (weight along -y) it is the
    BreathingCrack; bow, heat and a misaligned bearing turn the moment that opens a crack away from the weight.

    Source: the cosine law of I. W. Mayes, W. G. R. Davies, J. Vibration, Acoustics, Stress, Reliability in Design 106 (1984) 139;
    the free phase is ours.  Leaves out breathing by vibration (MomentCrack) and what BreathingCrack leaves out.
    """

    phase: float = parameter("rad", "p, spin angle at which it is most open", default=0.0, typical=(-math.pi, math.pi))

    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {
        "compliance": (1e-8, 1e-7),
        "position": (0.3, 0.7),
        "angle": (0.0, 1.57),
        "phase": (0.0, 1.57, 3.14, -1.57),
    }

    decisive: ClassVar[tuple[str, ...]] = ("angle", "phase")
    half_turn: ClassVar[frozenset[str]] = frozenset({"angle"})
    leads: ClassVar[bool] = True

    def opening(self, moment: Value, cosine: Value, sine: Value, gravity: tuple[float, float]) -> tuple[Value, Value]:
        c, s = np.cos(self.angle + self.phase), np.sin(self.angle + self.phase)
        return 0.5 * (1.0 + c * cosine + s * sine), 0.5 * (s * cosine - c * sine)
