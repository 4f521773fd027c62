"""What every effect offers, and the shapes that most effects have.

An effect of a user's own is a frozen dataclass that subclasses one of these and writes one law:

* TorqueEffect: a torque on a body, ``torque(time, angle, speed)``
* TwistEffect: a torque beside a connection, ``torque(time, twist, rate)``
* LawEffect: a changed connection, ``changed(law)(twist, rate)``
* MemoryTorqueEffect, MemoryTwistEffect: the first two with states, ``torque(..., state)`` and ``state_rate(name, ..., state)``
* MotorEffect (motor_effect.py): a changed motor torque, ``delivered(time, speed, torque)``
* SensorEffect, MemorySensorEffect (sensor_effect.py): a changed reading, ``reading(time, value)``
* LateralEffect (lateral_effect.py): a force across the axis of a rotor line, ``force(time, angle, speed, x, y, x_rate, y_rate)``
* Effect: anything else, ``apply(draft, place, name)``
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from hdrive_mbs.effects.places import PLACES
from hdrive_mbs.errors import ParameterError, PlaceError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network
from hdrive_mbs.network.node import Node
from hdrive_mbs.quantities import Described, snake_case

KINDS = ("force", "kinematic", "parametric", "sensor", "hidden state")
"""Ways in which an effect enters: a torque or force; a kinematic error; a changed law; a changed reading; dynamics of its own."""


class _OwnName:
    """The family of a class that names none: its own name."""

    def __get__(self, instance: object, owner: type) -> str:
        return snake_case(owner.__name__)


@dataclass(frozen=True, kw_only=True)
class Effect(Described, ABC):
    """A physical effect that can be put at a place of a scene.

    A search for the cause of a gap varies the fields that have a typical range, and leaves the others at their defaults.
    """

    _kind: ClassVar[str] = "effect"
    _use: ClassVar[str] = 'scene.with_effect({name}(...), at="...") puts it at a place of a scene'
    acts_on: ClassVar[str] = "body"
    """The kind of place the effect needs, one of PLACES: 'body', 'connection', 'gear', 'coupling', 'motor', 'sensor', 'load'; on rotor
    lines 'rotor', 'station', 'bearing', 'support', 'shaft', 'drive end'; under sensors 'probe' and 'surface'."""
    kind: ClassVar[str] = "force"
    """One of KINDS."""
    family: ClassVar[str] = _OwnName()  # type: ignore[assignment]
    """Name under which it is reported; several laws of one phenomenon share it.  A class that gives none has its own."""
    dissipative: ClassVar[bool] = False
    """Whether the effect claims never to give back more than it stores (checked when a scene is assembled)."""
    signature: ClassVar[str] = ""
    """What an engineer would see in a record, in words."""
    tried: ClassVar[bool] = True
    """Whether a search tries it without being asked, and lists show it."""
    vectors: ClassVar[tuple[tuple[str, str], ...]] = ()
    """Pairs of fields (amplitude, phase [rad]) in which a search turns amplitude cos and amplitude sin: linear (in its
    first harmonic), and no phase where the amplitude is zero."""
    additive: ClassVar[tuple[str, ...]] = ()
    """Fields that add to what the first amplitude does whatever that is, as the zero of an error that a sine makes; where records begin at
    an angle that is called zero, the amplitude shows little without them."""
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {}
    """Field -> values from which a search begins, one after the other.  A field without a typical range stays there."""
    periodic: ClassVar[Mapping[str, str]] = {}
    """Fields that are periods per turn of the shaft ("turn") or angular frequencies ("time"): away from the right value the effect
    does not show, so a search begins at those that stand out in what is left."""
    reaches: ClassVar[Mapping[str, tuple[float, ...]]] = {}
    """Field -> shares of the largest distance from the axis that its place has in the fitted model, from which a search begins too: a
    contact shows only beyond its gap."""
    leads: ClassVar[bool] = False
    """Whether it stands for its family in a first look, in place of the law with the fewest numbers to search."""
    finer: ClassVar[bool] = False
    """Whether a search tries it only where the other laws of its family leave something at the place they were found at."""
    decisive: ClassVar[tuple[str, ...]] = ()
    """Those of them of which already a first look takes every value: away from the right one the effect does not show."""
    half_turn: ClassVar[frozenset[str]] = frozenset()
    """Angles [rad] that say the same once more after half a turn."""
    limits: ClassVar[tuple[type[Effect], ...]] = ()
    """Simpler effects of other families as which it acts at an end of its range: a search that ends with it fits these from its values, and
    where one of them comes out better it is no more than an imitation of that."""

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        for name, value, allowed in (("kind", cls.kind, KINDS), ("acts_on", cls.acts_on, tuple(PLACES))):
            if value not in allowed:
                raise ParameterError(f"{cls.__name__}.{name} = {value!r}: must be one of {', '.join(allowed)}.")

    def elsewhere(self) -> tuple[Effect, ...]:
        """The effect with values where a neighbouring hollow of the misfit may lie: a search that has ended with these looks there too.

        None by default.  Override where fits are known to end beside the right values.
        """
        return ()

    def telling(self, other: Effect) -> tuple[Effect, ...]:
        """The effect with what another law of its family was found with, where fields of the same name do not say it: a search that
        tells a cause by other laws begins there too.

        None by default.
        """
        return ()

    def twins(self, sense: int) -> tuple[Effect, ...]:
        """Effects of other classes that act exactly as it does with its values, so that no record can tell them apart: a search that
        ends with one of them names the others too.

        sense : in which the body at its place turns forward, 1 or -1

        None by default.
        """
        return ()

    @abstractmethod
    def apply(self, draft: Draft, place: str, name: str) -> None:
        """Add the effect to the network.  ``name`` is unique in the scene and prefixes channels.

        Raises PlaceError when the place does not exist or is of the wrong kind.
        """

    @classmethod
    def places(cls, network: Network) -> tuple[str, ...]:
        """Where in a network it may sit, each place once: all of the kind ``acts_on``.  Override where fewer make sense."""
        return PLACES[cls.acts_on](network)


def moving_body(effect: Effect, draft: Draft, place: str) -> Node:
    """The body of that place.  Raises PlaceError where there is none or where the ground holds it."""
    kind = type(effect).__name__
    node = draft.body(place, kind)
    if node.name == "ground":
        raise PlaceError(f"{kind} at {place!r} would do nothing: that place is held by the ground. Put it on a body that can turn.")
    return node


def add_body_torque(
    effect: Effect,
    draft: Draft,
    body: str,
    name: str,
    torque: Callable[[Moment], Value],
    stored: Callable[[Moment], Value] | None = None,
) -> None:
    """Put an effect's torque on a body, with its channel ``<name>.torque``."""
    draft.add_torque(name, body, torque, dissipative=effect.dissipative, stored=stored)
    draft.add_channel(f"{name}.torque", "N m", f"torque of {name}, positive when driving", torque)


@dataclass(frozen=True, kw_only=True)
class TorqueEffect(Effect):
    """A torque on a body."""

    @abstractmethod
    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        """Torque [N m] along the forward sense, at a forward angle [rad] and speed [rad/s]."""

    def apply(self, draft: Draft, place: str, name: str) -> None:
        body = moving_body(self, draft, place).name
        add_body_torque(self, draft, body, name, lambda m: self.torque(m.time, m.angle(body), m.speed(body)))


@dataclass(frozen=True, kw_only=True)
class TwistEffect(Effect):
    """A torque that acts beside the torque of a connection."""

    acts_on: ClassVar[str] = "connection"

    @abstractmethod
    def torque(self, time: Value, twist: Value, rate: Value) -> Value:
        """Torque [N m] that resists a positive twist [rad] or rate [rad/s]."""

    def apply(self, draft: Draft, place: str, name: str) -> None:
        connection = draft.connection(place, type(self).__name__)

        def torque(moment: Moment, twist: Value, rate: Value) -> Value:
            return self.torque(moment.time, twist, rate)

        connection.parallel.append((name, torque))
        if self.dissipative:
            connection.claim(name, torque)


@dataclass(frozen=True, kw_only=True)
class LawEffect(Effect):
    """A change of the law of a connection.  What it adds to the old law is what ``dissipative`` is about."""

    acts_on: ClassVar[str] = "connection"
    kind: ClassVar[str] = "parametric"

    @abstractmethod
    def changed(self, law: Callable[[Value, Value], Value]) -> Callable[[Value, Value], Value]:
        """The new torque(twist, rate) made from the old one."""

    def changed_beyond(self, law: Callable[[Value, Value], Value], gap: float) -> Callable[[Value, Value], Value]:
        """The same for a law that has no elastic torque in a gap of its own about zero, gap its full width [rad].

        Override it where that makes a difference.
        """
        return self.changed(law)

    def apply(self, draft: Draft, place: str, name: str) -> None:
        connection = draft.connection(place, type(self).__name__)
        old, gap = connection.law, connection.gap

        def new(moment: Moment, twist: Value, rate: Value) -> Value:
            return self.changed_beyond(lambda x, v: old(moment, x, v), gap)(twist, rate)

        def added(moment: Moment, twist: Value, rate: Value) -> Value:
            return new(moment, twist, rate) - old(moment, twist, rate)

        connection.law = new
        connection.gap = 0.0
        if self.dissipative:
            connection.claim(name, added)


class _Read(Mapping[str, Value]):
    """The states of one effect at a moment, by their own names, read when asked for."""

    def __init__(self, names: Mapping[str, str], moment: Moment) -> None:
        self._names, self._moment = names, moment

    def __getitem__(self, name: str) -> Value:
        return self._moment.state(self._names[name])

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)


@dataclass(frozen=True, kw_only=True)
class _Memory(Effect):
    """What effects with first-order states share.  All states start at zero."""

    @abstractmethod
    def states(self) -> Mapping[str, str]:
        """Name and unit of each state."""

    def stored(self, state: Mapping[str, Value]) -> Value:
        """Energy [J] held in the states: what a dissipative effect may still give back."""
        return 0.0

    def _add_states(
        self, draft: Draft, name: str, rate: Callable[[str, Moment, Mapping[str, Value]], Value]
    ) -> Callable[[Moment], Mapping[str, Value]]:
        """One state equation per state; returns the function that reads the states at a moment."""
        full: dict[str, str] = {}

        def read(moment: Moment) -> Mapping[str, Value]:
            return _Read(full, moment)

        def equation(own: str) -> Callable[[Moment], Value]:
            return lambda moment: rate(own, moment, read(moment))

        for own, unit in self.states().items():
            full[own] = draft.add_state(f"{name}.{own}", unit=unit, initial=0.0, rate=equation(own))
        return read


@dataclass(frozen=True, kw_only=True)
class MemoryTorqueEffect(_Memory):
    """A torque on a body that depends on the past through first-order states."""

    @abstractmethod
    def torque(self, time: Value, angle: Value, speed: Value, state: Mapping[str, Value]) -> Value:
        """Torque [N m] along the forward sense, at a forward angle [rad] and speed [rad/s]."""

    @abstractmethod
    def state_rate(self, name: str, time: Value, angle: Value, speed: Value, state: Mapping[str, Value]) -> Value:
        """Rate of the state of that name [its unit/s]."""

    def apply(self, draft: Draft, place: str, name: str) -> None:
        body = moving_body(self, draft, place).name
        read = self._add_states(draft, name, lambda own, m, state: self.state_rate(own, m.time, m.angle(body), m.speed(body), state))

        def torque(moment: Moment) -> Value:
            return self.torque(moment.time, moment.angle(body), moment.speed(body), read(moment))

        add_body_torque(self, draft, body, name, torque, lambda moment: self.stored(read(moment)))


@dataclass(frozen=True, kw_only=True)
class MemoryTwistEffect(_Memory):
    """A torque beside a connection that depends on the past through first-order states."""

    acts_on: ClassVar[str] = "connection"

    @abstractmethod
    def torque(self, time: Value, twist: Value, rate: Value, state: Mapping[str, Value]) -> Value:
        """Torque [N m] that resists a positive twist [rad] or rate [rad/s]."""

    @abstractmethod
    def state_rate(self, name: str, time: Value, twist: Value, rate: Value, state: Mapping[str, Value]) -> Value:
        """Rate of the state of that name [its unit/s]."""

    def apply(self, draft: Draft, place: str, name: str) -> None:
        connection = draft.connection(place, type(self).__name__)

        def rate_of(own: str, moment: Moment, state: Mapping[str, Value]) -> Value:
            return self.state_rate(own, moment.time, *connection.inside(moment), state)

        read = self._add_states(draft, name, rate_of)

        def torque(moment: Moment, twist: Value, rate: Value) -> Value:
            return self.torque(moment.time, twist, rate, read(moment))

        connection.parallel.append((name, torque))
        if self.dissipative:
            connection.claim(name, torque, lambda moment: self.stored(read(moment)))
