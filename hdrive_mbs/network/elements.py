"""Elements of a network: what pulls at the coordinates and what drives the states.

Each element answers one question, ``contribution(moment)``: the generalized torque on each
coordinate it touches, or the rate of its state.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
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
class KinematicTerm:
    """A term e(q) that adds to a stretch: power-consistent, because torque and rate use e'(q)."""

    coordinate: str
    error: Callable[[Value], Value]

    def slope(self, angle: Value) -> Value:
        """de/dq by differentiation of the recorded law."""
        return gradient(self.error)(angle)


@dataclass(frozen=True)
class Connection:
    """A torsional element along a stretch  x = sum(f_i q_i) + sum(e_j(q_j)).

    ``torque(moment, x, dx/dt)`` is positive when it resists a positive stretch; by virtual work the
    torque on coordinate i is -torque * dx/dq_i, so power is conserved for every ratio f_i.
    """

    name: str
    factors: Mapping[str, float]
    torque: Callable[[Moment, Value, Value], Value]
    terms: tuple[KinematicTerm, ...] = ()
    dissipative: bool = False

    def stretch(self, moment: Moment) -> Value:
        """Elastic stretch x [rad]."""
        linear = sum(factor * moment.angle(name) for name, factor in self.factors.items())
        return linear + sum(term.error(moment.angle(term.coordinate)) for term in self.terms)

    def rate(self, moment: Moment) -> Value:
        """Rate of stretch dx/dt [rad/s]."""
        linear = sum(factor * moment.speed(name) for name, factor in self.factors.items())
        return linear + sum(term.slope(moment.angle(term.coordinate)) * moment.speed(term.coordinate) for term in self.terms)

    def value(self, moment: Moment) -> Value:
        """Torque of the element [N m]."""
        return self.torque(moment, self.stretch(moment), self.rate(moment))

    def contribution(self, moment: Moment) -> dict[str, Value]:
        torque = self.value(moment)
        result: dict[str, Value] = {name: -factor * torque for name, factor in self.factors.items()}
        for term in self.terms:
            slope = term.slope(moment.angle(term.coordinate))
            result[term.coordinate] = result.get(term.coordinate, 0.0) - slope * torque
        return result

    def power(self, moment: Moment) -> Value:
        """Power that the element takes from the coordinates [W]."""
        return self.value(moment) * self.rate(moment)


@dataclass(frozen=True)
class AppliedTorque:
    """A torque on one coordinate, positive in its forward sense."""

    name: str
    coordinate: str
    torque: Callable[[Moment], Value]
    dissipative: bool = False

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
