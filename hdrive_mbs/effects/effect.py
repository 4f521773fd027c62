"""What every effect offers, and the four shapes that most effects have.

An effect of a user's own is a frozen dataclass that subclasses one of these and writes one law:

* TorqueEffect: a torque on a body, ``torque(time, angle, speed)``
* TwistEffect: a torque beside a connection, ``torque(time, twist, rate)``
* LawEffect: a changed connection, ``changed(law)(twist, rate)``
* Effect: anything else, ``apply(draft, place, name)``
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft, Torque
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import Described


@dataclass(frozen=True, kw_only=True)
class Effect(Described):
    """A physical effect that can be put at a place of a scene."""

    _kind: ClassVar[str] = "effect"
    acts_on: ClassVar[str] = "body"
    """'body' or 'connection': the kind of place the effect needs."""
    dissipative: ClassVar[bool] = False
    """Whether the effect claims never to deliver power (checked when a scene is assembled)."""
    signature: ClassVar[str] = ""
    """What an engineer would see in a record, in words."""

    def apply(self, draft: Draft, place: str, name: str) -> None:
        """Add the effect to the network.  ``name`` is unique in the scene and prefixes channels."""
        raise NotImplementedError


@dataclass(frozen=True, kw_only=True)
class TorqueEffect(Effect):
    """A torque on a body."""

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        """Torque [N m] along the forward sense, at a forward angle [rad] and speed [rad/s]."""
        raise NotImplementedError

    def apply(self, draft: Draft, place: str, name: str) -> None:
        body = draft.body(place, type(self).__name__).name

        def torque(moment: Moment) -> Value:
            return self.torque(moment.time, moment.angle(body), moment.speed(body))

        draft.add_torque(name, body, torque, dissipative=self.dissipative)
        draft.add_channel(f"{name}.torque", "N m", f"torque of {name}, positive when driving", torque)


@dataclass(frozen=True, kw_only=True)
class TwistEffect(Effect):
    """A torque that acts beside the torque of a connection."""

    acts_on: ClassVar[str] = "connection"

    def torque(self, time: Value, twist: Value, rate: Value) -> Value:
        """Torque [N m] that resists a positive twist [rad] or rate [rad/s]."""
        raise NotImplementedError

    def apply(self, draft: Draft, place: str, name: str) -> None:
        connection = draft.connection(place, type(self).__name__)
        connection.parallel.append((name, lambda moment, twist, rate: self.torque(moment.time, twist, rate)))


@dataclass(frozen=True, kw_only=True)
class LawEffect(Effect):
    """A change of the law of a connection."""

    acts_on: ClassVar[str] = "connection"

    def changed(self, law: Callable[[Value, Value], Value]) -> Callable[[Value, Value], Value]:
        """The new torque(twist, rate) made from the old one."""
        raise NotImplementedError

    def apply(self, draft: Draft, place: str, name: str) -> None:
        def change(old: Torque) -> Torque:
            def new(moment: Moment, twist: Value, rate: Value) -> Value:
                return self.changed(lambda x, v: old(moment, x, v))(twist, rate)

            return new

        draft.connection(place, type(self).__name__).wrap(change)
