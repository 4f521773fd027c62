"""Lag between the torque that a motor is asked for and what it delivers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class ActuatorLag(Effect):
    """First-order lag of the torque of a motor.

    tau = y,  dy/dt = (M - y)/t

    with the torque M of the motor's characteristic; y starts at zero.  The channel ``<motor>.torque`` stays M (what
    a drive reports), ``<effect>.torque`` is y.  A time constant of zero delivers M at once.

    Source: current loop as a first-order lag, as in any text on electrical drives, e.g. Leonhard, Control of
    Electrical Drives.  Leaves out dead time and the limit of voltage; a lag much shorter than the step of a solver
    with fixed steps makes it unstable.
    """

    time_constant: float = parameter("s", "t", low=0.0, high=10.0, typical=(5e-4, 0.05))

    acts_on: ClassVar[str] = "motor"
    kind: ClassVar[str] = "hidden state"
    family: ClassVar[str] = "actuator_lag"
    signature: ClassVar[str] = "speed follows fast torque commands late; a closed loop that is less damped, nothing at steady torque"

    def apply(self, draft: Draft, place: str, name: str) -> None:
        kind = type(self).__name__

        def change(torque: Callable[[Moment], Value]) -> Callable[[Moment], Value]:
            if self.time_constant == 0.0:
                return torque

            def rate(moment: Moment) -> Value:
                return (torque(moment) - moment.state(state)) / self.time_constant

            state = draft.add_state(f"{name}.lagged", unit="N m", initial=0.0, rate=rate)
            return lambda moment: moment.state(state)

        delivered = draft.change_motor(place, change, kind)
        draft.add_channel(f"{name}.torque", "N m", f"torque that reaches the rotor of {place}", delivered)
