"""A connection while the network is being built."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from hdrive_mbs.expression import Value
from hdrive_mbs.network.elements import Claim, Connection, KinematicTerm
from hdrive_mbs.network.moment import Moment

Torque = Callable[[Moment, Value, Value], Value]

Series = Callable[[Moment, Value, Value], tuple[Value, Value, Value]]
"""From the whole stretch and its rate: deflection of what sits in series, its rate, and the torque through both."""


@dataclass
class ConnectionDraft:
    """A connection that effects may still change.

    ``law(moment, stretch, rate)`` is the constitutive law; ``parallel`` holds torques that act
    beside it; ``series`` is a spring in line with both; ``terms`` are kinematic errors that add to
    the stretch; ``bodies`` names the body at each flange.  ``gap`` is the full width about zero in
    which the law has no elastic torque, 0 where it has none or nobody knows.
    """

    name: str
    factors: dict[str, float]
    law: Torque
    parallel: list[tuple[str, Torque]] = field(default_factory=list)
    terms: list[KinematicTerm] = field(default_factory=list)
    bodies: dict[str, str] = field(default_factory=dict)
    claims: list[Claim] = field(default_factory=list)
    series: Series | None = None
    gap: float = 0.0

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

    def inside(self, moment: Moment) -> tuple[Value, Value]:
        """Stretch and rate that the law sees: the whole less what sits in series."""
        whole = self.build()
        stretch, rate = whole.stretch(moment), whole.rate(moment)
        if self.series is None:
            return stretch, rate
        deflection, its_rate, _ = self.series(moment, stretch, rate)
        return stretch - deflection, rate - its_rate

    def build(self) -> Connection:
        torque = self.law if not self.parallel else self.inner
        if self.series is not None:
            torque = self._through
        return Connection(self.name, dict(self.factors), torque, tuple(self.terms), parts=tuple(self.claims), flanges=dict(self.bodies))

    def _through(self, moment: Moment, stretch: Value, rate: Value) -> Value:
        assert self.series is not None
        return self.series(moment, stretch, rate)[2]
