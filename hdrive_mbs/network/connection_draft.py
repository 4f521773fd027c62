"""A connection while the network is being built."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from hdrive_mbs.expression import Value
from hdrive_mbs.network.elements import Claim, Connection, KinematicTerm
from hdrive_mbs.network.moment import Moment

Torque = Callable[[Moment, Value, Value], Value]


@dataclass
class ConnectionDraft:
    """A connection that effects may still change.

    ``law(moment, stretch, rate)`` is the constitutive law; ``parallel`` holds torques that act
    beside it; ``terms`` are kinematic errors that add to the stretch; ``bodies`` names the body at
    each flange.
    """

    name: str
    factors: dict[str, float]
    law: Torque
    parallel: list[tuple[str, Torque]] = field(default_factory=list)
    terms: list[KinematicTerm] = field(default_factory=list)
    bodies: dict[str, str] = field(default_factory=dict)
    claims: list[Claim] = field(default_factory=list)

    def wrap(self, change: Callable[[Torque], Torque]) -> None:
        """Replace the law by ``change(law)``."""
        self.law = change(self.law)

    def claim(self, name: str, torque: Torque, stored: Callable[[Moment], Value] | None = None) -> None:
        """Promise that a torque inside this connection is dissipative (checked when the scene is assembled)."""

        def power(moment: Moment) -> Value:
            whole = self.build()
            rate = whole.rate(moment)
            return torque(moment, whole.stretch(moment), rate) * rate

        self.claims.append(Claim(name, power, stored))

    def build(self) -> Connection:
        law, parallel = self.law, tuple(torque for _, torque in self.parallel)

        def total(moment: Moment, stretch: Value, rate: Value) -> Value:
            torque = law(moment, stretch, rate)
            for extra in parallel:
                torque = torque + extra(moment, stretch, rate)
            return torque

        return Connection(self.name, dict(self.factors), total if parallel else law, tuple(self.terms), parts=tuple(self.claims))
