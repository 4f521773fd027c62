"""Coulomb and Stribeck friction on a body."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import TorqueEffect
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class CoulombStribeckFriction(TorqueEffect):
    """Dry friction with a Stribeck drop, smooth through zero speed.

    tau = -tanh(w / w_0) [T_C + (T_S - T_C) exp(-(w / w_S)^2)]

    Source: Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30 (1994) 1083, with sign(w)
    regularised by tanh; T_S may be given as a share, T_C (1 + drop).
    Leaves out true sticking: below w_0 the body creeps (LuGreFriction holds).
    """

    coulomb: float = parameter("N m", "sliding torque T_C", low=0.0, high=1e3, typical=(5e-3, 50.0))
    breakaway: float | None = parameter("N m", "breakaway torque T_S (by the drop if not given)", default=None, low=0.0, high=1e3)
    drop: float = parameter("1", "share by which breakaway exceeds coulomb", default=0.0, low=0.0, high=100.0, typical=(0.02, 3.0))
    stribeck_speed: float = parameter("rad/s", "speed w_S at which the drop has faded", default=1.0, above=0.0, typical=(0.01, 20.0))
    smoothing_speed: float = parameter("rad/s", "speed w_0 of the smooth step through zero", default=0.01, above=0.0, typical=(1e-3, 3.0))

    family: ClassVar[str] = "friction"
    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = "constant torque offset that changes sign with the direction of rotation"
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"smoothing_speed": (0.01, 0.3), "stribeck_speed": (0.1, 5.0)}

    def check(self) -> None:
        if self.breakaway is not None and self.drop > 0.0:
            raise ParameterError(
                f"CoulombStribeckFriction has breakaway = {self.breakaway:g} N m and drop = {self.drop:g}, "
                "which say the same; leave one of them out."
            )
        if self.breakaway is not None and self.breakaway < self.coulomb:
            raise ParameterError(
                f"CoulombStribeckFriction.breakaway = {self.breakaway:g} N m is below coulomb = {self.coulomb:g} N m; "
                "leave it out where friction does not drop."
            )

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        drop = self.drop * self.coulomb if self.breakaway is None else self.breakaway - self.coulomb
        size = self.coulomb + drop * np.exp(-((speed / self.stribeck_speed) ** 2))
        return -np.tanh(speed / self.smoothing_speed) * size
