"""A connection while the network is being built."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from hdrive_mbs.expression import Value
from hdrive_mbs.network.elements import Claim, Connection, KinematicTerm
from hdrive_mbs.network.moment import Moment

Torque = Callable[[Moment, Value, Value], Value]

Series = Callable[[Moment, Value, Value], tuple[Value, Value, Value]]
"""From the stretch and its rate over one element in line and all that is inside it: the element's own deflection, its rate, and the torque
through both."""


@dataclass
class ConnectionDraft:
    """A connection that effects may still change.

    ``law(moment, stretch, rate)`` is the constitutive law; ``parallel`` holds torques that act
    beside it; ``series`` holds elements in line with both, from the inside out, and ``yielding`` one
    more outside them, which may have a corner; ``terms`` are kinematic errors that add to the stretch;
    ``bodies`` names the body at each flange.  ``gap`` is the full width about zero in which the law has
    no elastic torque, 0 where it has none or nobody knows.  ``own`` and ``own_gap`` are those of the part itself: a change of
    ``own`` lies inside whatever changes ``law``, before it or after.
    """

    name: str
    factors: dict[str, float]
    law: Torque
    parallel: list[tuple[str, Torque]] = field(default_factory=list)
    terms: list[KinematicTerm] = field(default_factory=list)
    bodies: dict[str, str] = field(default_factory=dict)
    claims: list[Claim] = field(default_factory=list)
    series: list[Series] = field(default_factory=list)
    yielding: Series | None = None
    gap: float = 0.0
    own: Torque = field(init=False)
    own_gap: float = field(init=False)

    def __post_init__(self) -> None:
        self.own, self.own_gap = self.law, self.gap
        self.law = lambda moment, stretch, rate: self.own(moment, stretch, rate)

    def wrap(self, change: Callable[[Torque], Torque]) -> None:
        """Replace the law by ``change(law)``."""
        self.law = change(self.law)

    def claim(self, name: str, torque: Torque, stored: Callable[[Moment], Value] | None = None) -> None:
        """Promise that a torque inside this connection is dissipative (checked when the scene is assembled)."""

        def power(moment: Moment) -> Value:
            stretch, rate = self.inside(moment)
            return torque(moment, stretch, rate) * rate

        self.claims.append(Claim(name, power, stored))

    def inner(self, moment: Moment, stretch: Value, rate: Value) -> Value:
        """Torque of the law and of what acts beside it."""
        torque = self.law(moment, stretch, rate)
        for _, extra in self.parallel:
            torque = torque + extra(moment, stretch, rate)
        return torque

    @property
    def in_line(self) -> list[Series]:
        """All elements in line, from the inside out."""
        return self.series if self.yielding is None else [*self.series, self.yielding]

    def through(self, count: int) -> Torque:
        """Torque through the law, what acts beside it, and the innermost ``count`` elements in line with it."""
        if count == 0:
            return self.inner
        return lambda moment, stretch, rate: self.series[count - 1](moment, stretch, rate)[2]

    def inside_yielding(self, moment: Moment, stretch: Value, rate: Value) -> Value:
        """Torque through everything inside the element that yields, whatever comes to sit there."""
        return self.through(len(self.series))(moment, stretch, rate)

    def reaching(self, moment: Moment, element: Series | None = None) -> tuple[Value, Value]:
        """Stretch and rate over an element in line and all inside it, or over the law alone: the whole less what sits further out."""
        whole = self.build()
        stretch, rate = whole.stretch(moment), whole.rate(moment)
        for outer in reversed(self.in_line):
            if outer is element:
                break
            deflection, its_rate, _ = outer(moment, stretch, rate)
            stretch, rate = stretch - deflection, rate - its_rate
        return stretch, rate

    def inside(self, moment: Moment) -> tuple[Value, Value]:
        """Stretch and rate that the law sees."""
        return self.reaching(moment)

    def build(self) -> Connection:
        torque = self.law if not self.parallel else self.inner
        if self.in_line:
            torque = self._torque
        return Connection(self.name, dict(self.factors), torque, tuple(self.terms), parts=tuple(self.claims), flanges=dict(self.bodies))

    def _torque(self, moment: Moment, stretch: Value, rate: Value) -> Value:
        return self.in_line[-1](moment, stretch, rate)[2]
