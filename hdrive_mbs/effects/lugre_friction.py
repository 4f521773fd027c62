"""Friction with bristles (LuGre): presliding, true sticking, Stribeck sliding."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import MemoryTorqueEffect
from hdrive_mbs.effects.fast_sliding import FASTEST_RATE, followed_share, mixed
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class LuGreFriction(MemoryTorqueEffect):
    """Dry friction with a bristle state that holds at standstill.

    tau = -(y + s_1 dz/dt + s_2 w),  dz/dt = w - |w| y/g(w),  dy/dt = s_0 dz/dt,
    g(w) = T_C + (T_S - T_C) exp(-(w / w_S)^2),  s_1 = s_1(0) / (1 + s_1(0) |w| / (4 g(w)))

    with the bristle torque y = s_0 z as the state.  T_S may be given as T_C (1 + drop).  Sliding steadily it gives g(w) sign(w) + s_2 w.

    Source: Canudas de Wit, Olsson, Astrom, Lischinsky, IEEE Trans. Automatic Control 40 (1995) 419.
    There s_1 is constant, and the model then can deliver power (Barabanov, Ortega, same journal 45
    (2000) 830).  With the stored energy y^2/(2 s_0) the heat is |w| y^2/g + s_1 w dz/dt + s_2 w^2,
    which is never negative if s_1 <= 4 g/|w|; the fading s_1 above keeps to that at every speed.
    Without breakaway and damping it is Dahl's model.

    Leaves out load and temperature.  Presliding loops drift a little under small vibration.  Where the
    state would decay (at s_0 |w|/g) faster than at the rate f, dz/dt is scaled down to it and the torque
    is mixed with that of steady sliding: fast_sliding.py.
    """

    coulomb: float = parameter("N m", "sliding torque T_C", low=0.0, high=1e3, typical=(5e-3, 50.0))
    breakaway: float | None = parameter("N m", "breakaway torque T_S (by the drop if not given)", default=None, low=0.0, high=1e3)
    drop: float = parameter("1", "share by which breakaway exceeds coulomb", default=0.0, low=0.0, high=100.0, typical=(0.02, 3.0))
    stribeck_speed: float = parameter("rad/s", "speed w_S at which the drop has faded", default=1.0, above=0.0, typical=(0.01, 20.0))
    stiffness: float = parameter("N m/rad", "bristle stiffness s_0", above=0.0, typical=(1.0, 1e5))
    damping: float = parameter("N m s/rad", "bristle damping s_1 at low speed", default=0.0, low=0.0, typical=(1e-4, 10.0))
    viscous: float = parameter("N m s/rad", "viscous drag s_2", default=0.0, low=0.0, high=1e3)
    fastest_rate: float = parameter("1/s", "f, rate up to which the state is followed", default=FASTEST_RATE, above=0.0)

    family: ClassVar[str] = "friction"
    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = "no motion below a breakaway torque, then a jump; hysteresis against angle after each reversal"
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"stiffness": (30.0, 1e4), "stribeck_speed": (0.1, 5.0)}

    def check(self) -> None:
        if self.breakaway is not None and self.drop > 0.0:
            raise ParameterError(
                f"LuGreFriction has breakaway = {self.breakaway:g} N m and drop = {self.drop:g}, which say the same; leave one of them out."
            )
        if self.breakaway is not None and self.breakaway < self.coulomb:
            raise ParameterError(
                f"LuGreFriction.breakaway = {self.breakaway:g} N m is below coulomb = {self.coulomb:g} N m; "
                "leave it out where friction does not drop."
            )
        if self.coulomb == 0.0 and self.breakaway:
            raise ParameterError(
                f"LuGreFriction.coulomb = 0 N m with breakaway = {self.breakaway:g} N m: the bristles need a sliding torque "
                "above 0 N m at every speed; give coulomb a small value."
            )

    def sliding_torque(self, speed: Value) -> Value:
        """g(w) [N m], the Stribeck curve without its viscous part."""
        drop = self.drop * self.coulomb if self.breakaway is None else self.breakaway - self.coulomb
        return self.coulomb + drop * np.exp(-((speed / self.stribeck_speed) ** 2))

    def states(self) -> Mapping[str, str]:
        return {"bristle_torque": "N m"} if self.coulomb > 0.0 else {}

    def _share(self, speed: Value) -> Value:
        return followed_share(self.stiffness * np.abs(speed) / self.sliding_torque(speed), self.fastest_rate)

    def _deflection_rate(self, speed: Value, bristle: Value) -> Value:
        return self._share(speed) * (speed - np.abs(speed) * bristle / self.sliding_torque(speed))

    def state_rate(self, name: str, time: Value, angle: Value, speed: Value, state: Mapping[str, Value]) -> Value:
        return self.stiffness * self._deflection_rate(speed, state[name])

    def torque(self, time: Value, angle: Value, speed: Value, state: Mapping[str, Value]) -> Value:
        drag = -self.viscous * speed
        for name in self.states():
            sliding = self.sliding_torque(speed)
            damping = self.damping / (1.0 + self.damping * np.abs(speed) / (4.0 * sliding))
            drag = drag - mixed(self._share(speed), state[name], sliding, speed) - damping * self._deflection_rate(speed, state[name])
        return drag

    def stored(self, state: Mapping[str, Value]) -> Value:
        return sum(state[name] * state[name] / (2.0 * self.stiffness) for name in self.states())
