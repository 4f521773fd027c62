"""Whirl of an oil film whose share of the spin changes with the speed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from hdrive_mbs.effects.drifting_share import add_drift
from hdrive_mbs.effects.lateral_effect import Push, Stretches
from hdrive_mbs.effects.oil_whirl import OilWhirl
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class VaryingOilWhirl(OilWhirl):
    """OilWhirl at q w + s (|w|/w_0 - 1) w, a share of the speed w that is q at the reference speed and changes with it.

    F = A g(w) exp(i (q f + d + p)),  d' = s (|w|/w_0 - 1) w,  g = (|w|/w_0)^n (1 + tanh((|w| - w_1)/w_2))/2

    with the spin angle f of the ring.  d is a state that begins at 0 and runs on, ``<effect>.drift``; all else as in OilWhirl.

    Source: the mean speed of a film over that of the journal depends on how far the journal is out of the centre, and that on the
    speed (Muszynska, Rotordynamics, 2005, 4.2); the straight line is ours.  Leaves out what OilWhirl does, and that the film
    goes over from one state to another with a delay (OilWhirlCycle).
    """

    growth: float = parameter("1", "n, power of the speed with which it grows", default=0.0, low=0.0, high=4.0, typical=(0.0, 3.0))
    slope: float = parameter("1", "s, change of the share per reference speed", default=0.0, low=-0.5, high=0.5, typical=(-0.05, 0.05))
    onset: float = parameter("rad/s", "w_1, speed at which it sets in", above=0.0, high=1e5, typical=(100.0, 2e3))
    onset_width: float = parameter("rad/s", "w_2, over which it sets in", default=60.0, above=0.0, typical=(5.0, 300.0))

    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"onset": (250.0, 450.0, 650.0), "growth": (0.0, 2.0), "onset_width": (60.0,)}
    signature: ClassVar[str] = "forward whirl at 0.42 to 0.49 of the speed, a share that changes with the speed, strongest at one bearing"

    def pushing(self, draft: Draft, stretches: Stretches, name: str) -> Push:
        drift = add_drift(draft, stretches, name, self.slope, self.reference_speed)

        def push(moment: Moment, time: Value, angle: Value, *across: Value) -> tuple[Value, Value]:
            return self.force(time, angle + drift(moment) / self.ratio, *across)

        return push
