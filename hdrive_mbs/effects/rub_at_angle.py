"""A rub at one angle of a turn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.angle_friction import AngleFriction
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter

_ANGLES = tuple(float(angle) for angle in np.linspace(-np.pi, np.pi, 4, endpoint=False))


@dataclass(frozen=True, kw_only=True)
class RubAtAngle(AngleFriction):
    """Dry friction of a body about one angle of its turn.

    tau = -T tanh(w/w_0) exp(k (cos(a - a_0) - 1))

    with the true angle a of the body: near a_0 a bell of the width 1/sqrt(k).

    Source: none needed, a seal, brake disc or bearing that touches at a high spot; the bell is von Mises' (1918), a Gauss curve that closes
    after a turn.  Leaves out presliding and wear.
    """

    friction: float = parameter("N m", "T at the angle", low=0.0, high=1e3, typical=(1e-4, 20.0))
    angle: float = parameter("rad", "a_0", default=0.0, typical=(-np.pi, np.pi))
    sharpness: float = parameter("1", "k", default=10.0, above=0.0, high=1e4, typical=(1.0, 300.0))

    dissipative: ClassVar[bool] = True
    leads: ClassVar[bool] = True
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"angle": _ANGLES, "sharpness": (3.0,)}
    decisive: ClassVar[tuple[str, ...]] = ("angle",)
    signature: ClassVar[str] = "torque against the motion for a part of each turn, always at the same angle"

    def size(self, angle: Value) -> Value:
        return self.friction * np.exp(self.sharpness * (np.cos(angle - self.angle) - 1.0))
