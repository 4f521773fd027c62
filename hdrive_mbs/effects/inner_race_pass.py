"""Balls that pass a flaw of the inner race."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.ball_pass import BallPass
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class InnerRacePass(BallPass):
    """Pulses like those of BallPass whose direction turns with the shaft and whose size follows the load on the flaw.

    F = P(f) (1 + cos(f + d - b))/2 exp(i (f + d)),  F = F_x + i F_y on the ring

    with the pulses P of BallPass, the flaw at the angle d of the ring at spin angle 0 and the load along b: sidebands
    one order apart.  Here the order is n = z (1 + D_b/D_p cos(contact))/2.

    Source: McFadden, Smith, J. Sound and Vibration 96 (1984) 69, with a load zone of a half cosine all round.  Leaves out
    what BallPass does, and a load zone of another width.
    """

    order: float = parameter("1", "n, pulses per turn of the shaft", above=0.0, high=100.0, typical=(3.0, 14.0))
    load_direction: float = parameter("rad", "b, from x towards y", default=-0.5 * np.pi)

    decisive: ClassVar[tuple[str, ...]] = ()
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"direction": (-0.5 * np.pi, 0.0, 0.5 * np.pi, np.pi)}
    signature: ClassVar[str] = "pulses at an order of the spin that is no whole number, with sidebands one order apart, at one housing"

    def force(self, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> tuple[Value, Value]:
        at = angle + self.direction
        size = self.pulse(angle, speed) * (0.5 + 0.5 * np.cos(at - self.load_direction))
        return size * np.cos(at), size * np.sin(at)
