"""A foot or housing that rubs on what carries it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.lateral_effect import LateralEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import option, parameter


@dataclass(frozen=True, kw_only=True)
class SupportFriction(LateralEffect):
    """Dry friction between the housing of one bearing and the ground, in the plane across the axis.

    F = -T v/sqrt(|v|^2 + v_0^2),  or by axis  F_x = -T x'/sqrt(x'^2 + v_0^2), F_y likewise

    with the velocity v = (x', y') of the housing: against the motion, whatever its direction, or a guide for each direction.

    Source: Coulomb's law with a smooth root in place of the jump.  Leaves out sticking: below v_0 the housing creeps
    (SupportPresliding holds).
    """

    coulomb: float = parameter("N", "sliding force T", low=0.0, high=1e6, typical=(0.05, 1e3))
    smoothing_speed: float = parameter("m/s", "v_0 of the smooth root", default=1e-3, above=0.0, high=1.0, typical=(1e-5, 0.05))
    by_axis: bool = option("whether x and y rub on their own", default=False)

    acts_on: ClassVar[str] = "support"
    family: ClassVar[str] = "support_friction"
    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = "small vibration damped more than large, resonances that sharpen as they grow; loss the same at every speed"
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"smoothing_speed": (1e-4, 1e-3), "by_axis": (False, True)}

    def force(self, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> tuple[Value, Value]:
        if self.by_axis:
            x_size, y_size = (np.sqrt(rate * rate + self.smoothing_speed**2) for rate in (x_rate, y_rate))
            return -self.coulomb * x_rate / x_size, -self.coulomb * y_rate / y_size
        size = -self.coulomb / np.sqrt(x_rate * x_rate + y_rate * y_rate + self.smoothing_speed**2)
        return size * x_rate, size * y_rate
