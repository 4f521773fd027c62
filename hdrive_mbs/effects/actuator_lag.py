"""Lag between the torque that a motor is asked for and what it delivers."""

from __future__ import annotations

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
class ActuatorLag(MotorLag):
    """First-order lag of the torque of a motor.

    tau = y,  dy/dt = (M - y)/t

    with the torque M of the motor's characteristic; y starts at zero.  The channel ``<motor>.torque`` stays M (what
    a drive reports), ``<effect>.torque`` is y.  A time constant of zero delivers M at once.

    Source: current loop as a first-order lag, as in any text on electrical drives, e.g. Leonhard, Control of
    Electrical Drives.  Leaves out dead time and the limit of voltage.  A lag shorter than 1/f, too fast for fixed steps,
    is replaced by y with 1/f in place of t and tau = f t y + (1 - f t) M: slow commands come late by t all the same.
    """

    time_constant: float = parameter("s", "t", low=0.0, high=10.0, typical=(5e-5, 0.05))
    fastest_rate: float = parameter("1/s", "f, rate up to which the lag is followed", default=FASTEST_RATE, above=0.0)

    signature: ClassVar[str] = "speed follows fast torque commands late; a closed loop that is less damped, nothing at steady torque"

    @property
    def share(self) -> float:
        return min(1.0, self.time_constant * self.fastest_rate)

    def add_filter(self, draft: Draft, name: str, torque: Callable[[Moment], Value]) -> str:
        def rate(moment: Moment) -> Value:
            return (torque(moment) - moment.state(state)) * (self.share / self.time_constant)

        state = draft.add_state(f"{name}.lagged", unit="N m", initial=0.0, rate=rate)
        return state
