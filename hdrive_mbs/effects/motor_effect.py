"""The shape of effects that change what a motor delivers."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment


@dataclass(frozen=True, kw_only=True)
class MotorEffect(Effect):
    """A change of the torque on its way from a motor's characteristic to its rotor.

    The channel ``<motor>.torque`` stays what the characteristic gives (what a drive reports);
    ``<effect>.torque`` is what reaches the rotor.  Several such effects follow one another.
    """

    acts_on: ClassVar[str] = "motor"
    kind: ClassVar[str] = "parametric"

    @abstractmethod
    def delivered(self, time: Value, speed: Value, torque: Value) -> Value:
        """Torque [N m] that reaches the rotor, at a forward speed [rad/s] and the torque that is asked for [N m]."""

    def apply(self, draft: Draft, place: str, name: str) -> None:
        body = draft.body(place, type(self).__name__).name

        def change(torque: Callable[[Moment], Value]) -> Callable[[Moment], Value]:
            return lambda moment: self.delivered(moment.time, moment.speed(body), torque(moment))

        delivered = draft.change_motor(place, change, type(self).__name__)
        draft.add_channel(f"{name}.torque", "N m", f"torque that reaches the rotor of {place}", delivered)
