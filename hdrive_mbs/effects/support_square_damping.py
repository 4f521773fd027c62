"""A support that is damped by a turbulent film."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.lateral_effect import LateralEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import option, parameter

_CREEP = 1e-9
"""Speed [m/s] that is added under the root, so that it has a slope at rest."""


@dataclass(frozen=True, kw_only=True)
class SupportSquareDamping(LateralEffect):
    """Damping between the housing of one bearing and the ground that grows with the square of the velocity.

    F = -c |v| v,  alike all around, or by axis  F_x = -c |x'| x', F_y = -c |y'| y'

    with the velocity v = (x', y') of the housing: a film around it, or a damper for each direction.

    Source: orifice and turbulent squeeze-film dampers; drag of a blunt body.  Leaves out the inertia of the fluid and its stiffness.
    """

    coefficient: float = parameter("N s^2/m^2", "c", low=0.0, high=1e12, typical=(10.0, 1e7))
    by_axis: bool = option("whether x and y are damped on their own", default=False)

    acts_on: ClassVar[str] = "support"
    family: ClassVar[str] = "support_square_damping"
    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = "resonances that are damped the more the larger they are; small vibration as in the model"
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"coefficient": (1e3,), "by_axis": (False, True)}

    def force(self, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> tuple[Value, Value]:
        if self.by_axis:
            return -self.coefficient * np.abs(x_rate) * x_rate, -self.coefficient * np.abs(y_rate) * y_rate
        size = -self.coefficient * np.sqrt(x_rate * x_rate + y_rate * y_rate + _CREEP**2)
        return size * x_rate, size * y_rate
