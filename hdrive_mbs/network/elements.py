"""Elements of a network: what pulls at the coordinates and what drives the states.

Each element answers one question, ``contribution(moment)``: the generalized torque on each
coordinate it touches, or the rate of its state.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol

from hdrive_mbs.expression import Value, gradient
from hdrive_mbs.network.moment import Moment


class Element(Protocol):
    """An element of a network."""

    @property
    def name(self) -> str:
        """Unique name, used in channels and messages."""

    def contribution(self, moment: Moment) -> dict[str, Value]:
        """Torque [N m] on each coordinate in its forward sense, or the rate of each state [unit/s]."""


@dataclass(frozen=True)
class Claim:
    """What a law promises that calls itself dissipative: power taken - d(stored)/dt >= 0 at every moment.

    power : power that it takes from the coordinates [W]
    stored : energy that it holds in states or angles [J] (None: nothing)
    """

    name: str
    power: Callable[[Moment], Value]
    stored: Callable[[Moment], Value] | None = None


@dataclass(frozen=True)
class KinematicTerm:
    """A term e(a), a = sum(f_i q_i), that adds to a stretch: power-consistent, because torque and rate use e'(a)."""

    factors: Mapping[str, float]
    error: Callable[[Value], Value]

    def value(self, moment: Moment) -> Value:
        """e(a) [rad]."""
        return self.error(self._angle(moment))

    def slope(self, moment: Moment) -> Value:
        """de/da by differentiation of the recorded law."""
        return self._derivative(self._angle(moment))

    def rate(self, moment: Moment) -> Value:
        """de/dt [rad/s]."""
        return self.slope(moment) * sum(factor * moment.speed(name) for name, factor in self.factors.items())

    @cached_property
    def _derivative(self) -> Callable[[Value], Value]:
        return gradient(self.error)

    def _angle(self, moment: Moment) -> Value:
        return sum(factor * moment.angle(name) for name, factor in self.factors.items())


@dataclass(frozen=True)
class Connection:
    """A torsional element along a stretch  x = sum(f_i q_i) + sum(e_j).

    ``torque(moment, x, dx/dt)`` is positive when it resists a positive stretch; by virtual work the
    torque on coordinate i is -torque * dx/dq_i, so power is conserved for every ratio f_i.
    ``parts`` are the claims of laws that act inside it (see ConnectionDraft.claim); ``flanges`` names
    the body at each flange of a shaft or gear (none for a torque that merely acts between bodies).
    """

    name: str
    factors: Mapping[str, float]
    torque: Callable[[Moment, Value, Value], Value]
    terms: tuple[KinematicTerm, ...] = ()
    dissipative: bool = False
    parts: tuple[Claim, ...] = ()
    flanges: Mapping[str, str] = field(default_factory=dict)

    def claims(self) -> tuple[Claim, ...]:
        """What the element and the laws inside it promise."""
        return (Claim(self.name, self.power), *self.parts) if self.dissipative else self.parts

    def stretch(self, moment: Moment) -> Value:
        """Elastic stretch x [rad]."""
        linear = sum(factor * moment.angle(name) for name, factor in self.factors.items())
        return linear + sum(term.value(moment) for term in self.terms)

    def rate(self, moment: Moment) -> Value:
        """Rate of stretch dx/dt [rad/s]."""
        linear = sum(factor * moment.speed(name) for name, factor in self.factors.items())
        return linear + sum(term.rate(moment) for term in self.terms)

    def value(self, moment: Moment) -> Value:
        """Torque of the element [N m]."""
        return self.torque(moment, self.stretch(moment), self.rate(moment))

    def contribution(self, moment: Moment) -> dict[str, Value]:
        torque = self.value(moment)
        result: dict[str, Value] = {name: -factor * torque for name, factor in self.factors.items()}
        for term in self.terms:
            slope = term.slope(moment)
            for name, factor in term.factors.items():
                result[name] = result.get(name, 0.0) - factor * slope * torque
        return result

    def power(self, moment: Moment) -> Value:
        """Power that the element takes from the coordinates [W]."""
        return self.value(moment) * self.rate(moment)


@dataclass(frozen=True)
class AppliedTorque:
    """A torque on one coordinate, positive in its forward sense.

    is_motor : of a motor, on its rotor;  is_load : of a working machine, on its body
    """

    name: str
    coordinate: str
    torque: Callable[[Moment], Value]
    dissipative: bool = False
    stored: Callable[[Moment], Value] | None = None
    is_motor: bool = False
    is_load: bool = False

    def claims(self) -> tuple[Claim, ...]:
        """What the torque promises."""
        return (Claim(self.name, self.power, self.stored),) if self.dissipative else ()

    def value(self, moment: Moment) -> Value:
        """Torque [N m]."""
        return self.torque(moment)

    def contribution(self, moment: Moment) -> dict[str, Value]:
        return {self.coordinate: self.torque(moment)}

    def power(self, moment: Moment) -> Value:
        """Power that the torque takes from the coordinate [W] (negative when it drives)."""
        return -self.torque(moment) * moment.speed(self.coordinate)


@dataclass(frozen=True)
class StateRate:
    """The equation of a first-order state: dz/dt = rate(moment)."""

    state: str
    rate: Callable[[Moment], Value]

    @property
    def name(self) -> str:
        return f"{self.state} (state equation)"

    def contribution(self, moment: Moment) -> dict[str, Value]:
        return {self.state: self.rate(moment)}
