"""A brake or driven machine that follows its command late."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.actuator_lag import ActuatorLag
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class LoadLag(ActuatorLag):
    """First-order lag of the torque of a load.

    tau = y,  dy/dt = (M - y)/t

    with the torque M of the load's law; y starts at zero.  The channel ``<load>.torque`` stays M (what is asked of a brake),
    ``<effect>.torque`` is y, positive when resisting.  A time constant of zero delivers M at once.

    Source: magnetic-powder, eddy-current and hysteresis brakes whose current follows through a coil (L/R), as in any text on
    dynamometers.  Leaves out hysteresis and remanence.  A lag too fast for fixed steps is replaced as that of ActuatorLag is.
    """

    time_constant: float = parameter("s", "t", low=0.0, high=100.0, typical=(5e-5, 0.5))

    acts_on: ClassVar[str] = "load"
    family: ClassVar[str] = "load_lag"
    signature: ClassVar[str] = "twist and speed that answer late to changes of the load; nothing at steady load"

    def apply(self, draft: Draft, place: str, name: str) -> None:
        delivered = draft.change_load(place, self.lagging(draft, name), type(self).__name__)
        draft.add_channel(f"{name}.torque", "N m", f"torque that resists at {place}", lambda moment: -delivered(moment))
