"""A brake or driven machine that follows its command late."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.effects.fast_sliding import FASTEST_RATE
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class LoadLag(Effect):
    """First-order lag of the torque of a load.

    tau = y,  dy/dt = (M - y)/t

    with the torque M of the load's law; y starts at zero.  The channel ``<load>.torque`` stays M (what is asked of a brake),
    ``<effect>.torque`` is y, positive when resisting.  A time constant of zero delivers M at once.

    Source: magnetic-powder, eddy-current and hysteresis brakes whose current follows through a coil (L/R), as in any text on
    dynamometers.  Leaves out hysteresis and remanence.  A lag shorter than 1/f, too fast for fixed steps, is replaced by y with 1/f in
    place of t and tau = f t y + (1 - f t) M: slow commands come late by t all the same.
    """

    time_constant: float = parameter("s", "t", low=0.0, high=100.0, typical=(5e-5, 0.5))
    fastest_rate: float = parameter("1/s", "f, rate up to which the lag is followed", default=FASTEST_RATE, above=0.0)

    acts_on: ClassVar[str] = "load"
    kind: ClassVar[str] = "hidden state"
    family: ClassVar[str] = "load_lag"
    signature: ClassVar[str] = "twist and speed that answer late to changes of the load; nothing at steady load"

    def apply(self, draft: Draft, place: str, name: str) -> None:
        share = min(1.0, self.time_constant * self.fastest_rate)

        def change(torque: Callable[[Moment], Value]) -> Callable[[Moment], Value]:
            if share == 0.0:
                return torque

            def rate(moment: Moment) -> Value:
                return (torque(moment) - moment.state(state)) * (share / self.time_constant)

            state = draft.add_state(f"{name}.lagged", unit="N m", initial=0.0, rate=rate)
            return lambda moment: share * moment.state(state) + (1.0 - share) * torque(moment)

        delivered = draft.change_load(place, change, type(self).__name__)
        draft.add_channel(f"{name}.torque", "N m", f"torque that resists at {place}", lambda moment: -delivered(moment))
