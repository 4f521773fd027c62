"""The shape of effects by which a motor delivers its torque late."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.draft_torsion import Change
from hdrive_mbs.network.moment import Moment


@dataclass(frozen=True, kw_only=True)
class MotorLag(Effect):
    """A filter y of the torque M of a motor's characteristic, y = 0 at the start:  tau = p y + (1 - p) M.

    p = 1 unless the filter is too fast for fixed steps: then one that can be followed stands in for it, with as large a
    share p as leaves the delay of slow commands as it was.  The channel ``<motor>.torque`` stays M (what a drive
    reports), ``<effect>.torque`` is tau.
    """

    acts_on: ClassVar[str] = "motor"
    kind: ClassVar[str] = "hidden state"
    family: ClassVar[str] = "actuator_lag"

    @property
    @abstractmethod
    def share(self) -> float:
        """p; 0 where there is no delay, and M is delivered at once."""

    @abstractmethod
    def add_filter(self, draft: Draft, name: str, torque: Callable[[Moment], Value]) -> str:
        """Add the states of the filter; returns the name of y [N m]."""

    def lagging(self, draft: Draft, name: str) -> Change:
        """What the filter makes of a torque."""

        def change(torque: Callable[[Moment], Value]) -> Callable[[Moment], Value]:
            share = self.share
            if share == 0.0:
                return torque
            lagged = self.add_filter(draft, name, torque)
            if share == 1.0:
                return lambda moment: moment.state(lagged)
            return lambda moment: share * moment.state(lagged) + (1.0 - share) * torque(moment)

        return change

    def apply(self, draft: Draft, place: str, name: str) -> None:
        delivered = draft.change_motor(place, self.lagging(draft, name), type(self).__name__)
        draft.add_channel(f"{name}.torque", "N m", f"torque that reaches the rotor of {place}", delivered)
