"""A foot or housing that sticks to what carries it until it slides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.fast_sliding import followed_share
from hdrive_mbs.effects.lateral_effect import LateralEffect, Push, Stretches
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.stretch_rate import RateOver
from hdrive_mbs.quantities import option, parameter

_CREEP = 1e-9
"""Speed [m/s] that is added under the root, so that it has a slope at rest."""


@dataclass(frozen=True, kw_only=True)
class SupportPresliding(LateralEffect):
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
    signature: ClassVar[str] = "a support that is stiffer for small vibration than for large, with a loss in between"
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"presliding": (1e-6, 1e-5), "by_axis": (False, True)}

    def force(self, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> tuple[Value, Value]:
        """What is left of it without its states: nothing."""
        return 0.0 * x, 0.0 * y

    def pushing(self, draft: Draft, stretches: Stretches, name: str) -> Push:
        def going(v: Mapping[str, Value], key: str) -> tuple[Value, Value]:
            square = v[key] * v[key] if self.by_axis else v["x"] * v["x"] + v["y"] * v["y"]
            size = np.sqrt(square + _CREEP**2)
            return size, followed_share(size / self.presliding, self.fastest_rate)

        def rate(key: str) -> RateOver:
            def of(moment: Moment, s: Mapping[str, Value], v: Mapping[str, Value]) -> Value:
                size, share = going(v, key)
                return share * (v[key] - size * moment.state(states[key])) / self.presliding

            return of

        states = {key: f"{name}.bent_{key}" for key in "xy"}
        for key in "xy":
            states[key] = draft.add_stretch_state(states[key], name, stretches, rate(key), unit="1")

        def push(
            moment: Moment, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value
        ) -> tuple[Value, Value]:
            v = {"x": x_rate, "y": y_rate}

            def along(key: str) -> Value:
                size, share = going(v, key)
                return share * moment.state(states[key]) + (1.0 - share) * v[key] / size

            return -self.coulomb * along("x"), -self.coulomb * along("y")

        return push
