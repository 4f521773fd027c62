"""A stiffness beside a gear's law that changes as the wave generator or the output turns."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from hdrive_mbs.effects.dead_zone import dead_zone
from hdrive_mbs.effects.stiffness_variation import StiffnessVariation
from hdrive_mbs.expression import Value
from hdrive_mbs.network.connection_draft import ConnectionDraft, Torque
from hdrive_mbs.network.moment import Moment

NEAR_ZERO = 1e-6
"""Twist beyond the edge of the gap [rad] up to which the stiffness k is taken: a thousandth of where catalogue curves bend first."""


@dataclass(frozen=True, kw_only=True)
class ParallelStiffnessVariation(StiffnessVariation):
    """Stiffness of a gear that varies by the same amount at each torque, however much its law hardens.

    tau = T(x, v) + r(a) k d(x),  r(a) = A sin(n a + p),  and on the flange -dr/da k d(x)^2/2

    with k the stiffness of T at zero twist, just beyond the edge of its gap where it has one, and d the twist beyond that edge.  Where
    T is a straight line it is ``StiffnessVariation``; where it hardens, that varies in proportion to the torque and this one to the twist.
    Torque and reaction come from the one potential.

    Source: time-varying mesh stiffness k(t) f(x) with backlash, Kahraman, Singh, J. Sound and Vibration 146 (1991) 135.
    Leaves out, in the small reaction, lost motion that a later effect puts into the law.
    """

    def varying(self, gear: ConnectionDraft, law: Torque) -> tuple[Callable[[Moment, Value], Value], Callable[[Moment, Value], Value]]:
        edge, gap = 0.5 * gear.gap, gear.gap

        def stiffness(moment: Moment) -> Value:
            return (law(moment, edge + NEAR_ZERO, 0.0) - law(moment, edge, 0.0)) / NEAR_ZERO

        def torque(moment: Moment, twist: Value) -> Value:
            return stiffness(moment) * dead_zone(twist, gap, 0.0)

        def energy(moment: Moment, angle: Value) -> Value:
            twist, _ = gear.inside(moment)
            return 0.5 * stiffness(moment) * dead_zone(twist, gap, 0.0) ** 2

        return torque, energy
