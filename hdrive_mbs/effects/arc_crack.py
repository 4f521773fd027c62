"""A crack that is open over an arc of its own, shorter or longer than half a turn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.steep_crack import SteepCrack
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class ArcCrack(SteepCrack):
    """SteepCrack that opens and shuts where the cosine of its angle to the weight passes a value of its own, not zero: CrackEffect with

    g = (tanh(s (cos b - w)) + tanh(s (1 + w)))/(tanh(s (1 - w)) + tanh(s (1 + w)))

    which is 1 where the crack points down and 0 where it points up; with w = 0 it is the SteepCrack.  With w > 0 it is open over less than
    half a turn, with w < 0 over more.

    Source: that the cosine is a weak model of how a crack breathes under the weight, also of shallow ones, M. A. Al-Shudeifat, E. A.
    Butcher, J. Sound and Vibration 330 (2011) 526; the form with two numbers is ours.  It comes within 0.008 (root mean square over a
    turn) of the powers cos^m(b/2), m = 3 to 6, and within 0.03 of straight ramps between two angles.  Leaves out what BreathingCrack does.
    """

    opens_at: float = parameter(
        "1", "w, cosine of the angle to the weight at which it opens", default=0.0, low=-1.0, high=1.0, typical=(-1.0, 1.0)
    )

    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {**SteepCrack.starts, "opens_at": (0.0,)}

    def opening(self, moment: Value, cosine: Value, sine: Value, gravity: tuple[float, float]) -> tuple[Value, Value]:
        if self.always_open or self.steepness < 1e-3:
            return super().opening(moment, cosine, sine, gravity)
        down, slope = gravity[0] * cosine + gravity[1] * sine, gravity[1] * cosine - gravity[0] * sine
        s, w = self.steepness, self.opens_at
        shut = np.tanh(s * (1.0 + w))
        whole = np.tanh(s * (1.0 - w)) + shut
        bent = np.tanh(s * (down - w))
        return (bent + shut) / whole, s * slope * (1.0 - bent * bent) / whole
