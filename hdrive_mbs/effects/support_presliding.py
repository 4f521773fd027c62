"""A foot or housing that sticks to what carries it until it slides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.effects.fast_sliding import followed_share
from hdrive_mbs.effects.lateral_effect import add_force_channels, stretches_of
from hdrive_mbs.expression import Value
from hdrive_mbs.network.coupling import Coupling
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.stretch_rate import RateOver
from hdrive_mbs.quantities import option, parameter

_CREEP = 1e-9
"""Speed [m/s] that is added under the root, so that it has a slope at rest."""


@dataclass(frozen=True, kw_only=True)
class SupportPresliding(Effect):
    """Dry friction between the housing of one bearing and the ground that builds up over a way: Dahl's law in the plane.

    F = -T z,  dz/dt = (v - |v| z)/d,  or by axis with |x'| and |y'| for |v|

    with the velocity v = (x', y') of the housing; z runs to the direction of v over a way of about d.  Small motion sees a spring
    T/d, large motion the sliding force T.  With the stored energy T d |z|^2/2 the heat is T |v| |z|^2, never negative.  Sliding by d
    faster than at the rate f is as in fast_sliding.py, with v/|v| for the sign.

    Source: Dahl, AIAA Journal 14 (1976) 1675, in two directions as the LuGre model of Velenis,
    Tsiotras, Canudas de Wit, Mediterranean Conf. Control and Automation (2002).  Leaves out a drop
    of the force once it slides.  Both states start at zero, so the weight that the foundation carries is not on them.
    """

    coulomb: float = parameter("N", "sliding force T", low=0.0, high=1e6, typical=(0.05, 1e3))
    presliding: float = parameter("m", "d, way over which it builds up", above=0.0, high=0.1, typical=(1e-8, 1e-3))
    by_axis: bool = option("whether x and y rub on their own", default=False)
    fastest_rate: float = parameter("1/s", "f, rate up to which the states are followed", default=2e4, above=0.0)

    acts_on: ClassVar[str] = "support"
    kind: ClassVar[str] = "hidden state"
    family: ClassVar[str] = "support_friction"
    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = "a support that is stiffer for small vibration than for large, with a loss in between"
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"presliding": (1e-6, 1e-5), "by_axis": (False, True)}

    def _going(self, v: Mapping[str, Value], key: str) -> tuple[Value, Value]:
        """Speed that bends the state of a direction [m/s], and the share of it that is followed."""
        square = v[key] * v[key] if self.by_axis else v["x"] * v["x"] + v["y"] * v["y"]
        size = np.sqrt(square + _CREEP**2)
        return size, followed_share(size / self.presliding, self.fastest_rate)

    def apply(self, draft: Draft, place: str, name: str) -> None:
        found = stretches_of(self, draft, place)
        stretches = {key: found[key] for key in "xy"}
        states: dict[str, str] = {}

        def rate(key: str) -> RateOver:
            def of(moment: Moment, s: Mapping[str, Value], v: Mapping[str, Value]) -> Value:
                size, share = self._going(v, key)
                return share * (v[key] - size * moment.state(states[key])) / self.presliding

            return of

        def forces(moment: Moment, s: Mapping[str, Value], v: Mapping[str, Value]) -> Mapping[str, Value]:
            resisting = {}
            for key in "xy":
                size, share = self._going(v, key)
                resisting[key] = self.coulomb * (share * moment.state(states[key]) + (1.0 - share) * v[key] / size)
            return resisting

        def stored(moment: Moment) -> Value:
            return 0.5 * self.coulomb * self.presliding * sum(moment.state(state) ** 2 for state in states.values())

        for key in "xy":
            states[key] = draft.add_stretch_state(f"{name}.bent_{key}", name, stretches, rate(key), unit="1")
        element = Coupling(name, stretches, forces, self.dissipative, stored)
        draft.add_element(element)
        add_force_channels(draft, name, element)
