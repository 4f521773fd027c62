"""A stiffness beside a gear's law that changes as the wave generator or the output turns."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.effects.dead_zone import dead_zone
from hdrive_mbs.effects.stiffness_variation import StiffnessVariation
from hdrive_mbs.expression import Value
from hdrive_mbs.network.connection_draft import ConnectionDraft
from hdrive_mbs.network.moment import Moment

NEAR_ZERO = 1e-6
"""Twist beyond the edge of the gap [rad] up to which the stiffness k is taken: a thousandth of where catalogue curves bend first."""
TINY = 1e-300
"""In place of k [N m/rad] where a law has no stiffness there, of which nothing varies."""


@dataclass(frozen=True, kw_only=True)
class ParallelStiffnessVariation(StiffnessVariation):
    """Stiffness of a gear that varies by the same amount at each torque, however much its law hardens.

    tau = T(x, v) + r(a) k d(x),  r(a) = A sin(n a + p),  and on the flange -dr/da k d(x)^2/2

    with k the stiffness of the gear's own law at zero twist, just beyond the edge of its gap where it has one, and d the twist beyond that
    edge, less what lost motion and the like take off before it comes to the law, whether these effects come first or later.  Where
    T is a straight line it is ``StiffnessVariation``; where it hardens, that varies in proportion to the torque and this one to the twist.
    Torque and reaction come from the one potential.

    Source: time-varying mesh stiffness k(t) f(x) with backlash, Kahraman, Singh, J. Sound and Vibration 146 (1991) 135.
    Leaves out a change of damping with angle, and in the small reaction that a film rounds the corners of a gap.
    """

    def vary(self, gear: ConnectionDraft, share: Callable[[Moment], Value]) -> Callable[[Moment], Value]:
        own, gap = gear.own, gear.own_gap
        told: list[float] = []  # a share that counts instead

        def stiffness(moment: Moment) -> Value:
            return (own(moment, 0.5 * gap + NEAR_ZERO, 0.0) - own(moment, 0.5 * gap, 0.0)) / NEAR_ZERO

        def new(moment: Moment, twist: Value, rate: Value) -> Value:
            r = told[-1] if told else share(moment)
            return own(moment, twist, rate) + r * stiffness(moment) * dead_zone(twist, gap, 0.0)

        def with_share(moment: Moment, r: float) -> Value:
            """The whole law at a share, without damping."""
            twist, _ = gear.inside(moment)
            told.append(r)
            try:
                return gear.law(moment, twist, 0.0)
            finally:
                told.pop()

        def energy(moment: Moment) -> Value:
            """k d^2/2, with k d from how the law as it ends up changes with r."""
            return (with_share(moment, 1.0) - with_share(moment, 0.0)) ** 2 / np.maximum(2.0 * stiffness(moment), TINY)

        gear.own = new
        return energy
