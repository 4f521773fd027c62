"""Lag of second order between the torque that a motor is asked for and what it delivers."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.fast_sliding import FASTEST_RATE
from hdrive_mbs.effects.motor_lag import MotorLag
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class SecondOrderLag(MotorLag):
    """Current control of a motor as a filter of second order.

    tau = y,  dy/dt = r,  dr/dt = f^2 (M - y) - 2 z f r,  f = 2 z/t

    with the torque M of the motor's characteristic; y starts at zero.  A slow command comes t late.  The channels are
    as in ActuatorLag.  A filter whose poles are faster than f_r is replaced by one with poles at f_r that is mixed
    with M itself so that the delay stays t; t = 0 delivers M at once.

    Source: closed current loop with a PI controller, as in any text on electrical drives, e.g. Leonhard, Control of
    Electrical Drives.  Leaves out the dead time of the sampling and the limit of voltage.
    """

    delay: float = parameter("s", "t, delay of a slow command", low=0.0, high=1.0, typical=(5e-5, 0.02))
    damping_ratio: float = parameter("1", "z", default=0.7, above=0.0, high=10.0, typical=(0.3, 1.5))
    fastest_rate: float = parameter("rad/s", "f_r, rate up to which the filter is followed", default=FASTEST_RATE, above=0.0)

    signature: ClassVar[str] = "speed follows fast torque commands late and rounded; a closed loop that is less damped"

    @property
    def frequency(self) -> float:
        """f [rad/s], or what can be followed of it."""
        fastest = max(1.0, self.damping_ratio + math.sqrt(max(self.damping_ratio**2 - 1.0, 0.0)))  # faster pole over f
        return min(2.0 * self.damping_ratio / self.delay, self.fastest_rate / fastest)

    @property
    def share(self) -> float:
        return self.delay * self.frequency / (2.0 * self.damping_ratio) if self.delay > 0.0 else 0.0

    def add_filter(self, draft: Draft, name: str, torque: Callable[[Moment], Value]) -> str:
        frequency = self.frequency

        def second(moment: Moment) -> Value:
            behind = torque(moment) - moment.state(lagged)
            return frequency * (frequency * behind - 2.0 * self.damping_ratio * moment.state(slope))

        lagged = draft.add_state(f"{name}.lagged", unit="N m", initial=0.0, rate=lambda moment: moment.state(slope))
        slope = draft.add_state(f"{name}.slope", unit="N m/s", initial=0.0, rate=second)
        return lagged
