"""What gives way in line with a connection: the shape of springs, dampers and clamps in series."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.errors import PlaceError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment


@dataclass(frozen=True, kw_only=True)
class SeriesEffect(Effect):
    """A massless element in line with everything that acts at a connection.

    tau = T(x - y, v - dy/dt),  dy/dt = f(y, A, d),  A = T(x - y, v),  d = T(x - y, v + 1) - A

    with the torque T(twist, rate) of the connection, a part of whose whole twist x is the element's deflection y.  A is the torque
    that would pass if the element stood still, and tau = A - d dy/dt what passes: exact where T is linear in the rate, with the damping d.
    No mass sits between the two, so y is a first-order state.  Elements at one connection sit one behind the other: those whose f is
    linear in A inside, in the order they come, and one with a corner (``yields``) outermost, so that T stays linear in the rate for all.
    Each asks what is inside it twice: every further one makes the equations several times as long.
    """

    acts_on: ClassVar[str] = "connection"
    kind: ClassVar[str] = "hidden state"
    yields: ClassVar[bool] = False
    """Whether the rate of its deflection is not linear in the torque: a corner, a threshold."""

    @abstractmethod
    def deflection_rate(self, deflection: Value, torque: Value, damping: Value) -> Value:
        """Rate f [rad/s] of the deflection y [rad] at the torque A [N m] with the damping d [N m s/rad] of the connection."""

    def at_rest(self) -> bool:
        """Whether these numbers leave the connection as it is."""
        return False

    def apply(self, draft: Draft, place: str, name: str) -> None:
        connection = draft.connection(place, type(self).__name__)
        if self.yields and connection.yielding is not None:
            raise PlaceError(
                f"{type(self).__name__} at {place!r}: something yields in line with that connection already, and two of them there would"
                " need a torque that no formula gives. Keep the one that yields first."
            )
        if self.at_rest():
            return
        inner = connection.inside_yielding if self.yields else connection.through(len(connection.series))

        def series(moment: Moment, twist: Value, rate: Value) -> tuple[Value, Value, Value]:
            deflection = moment.state(state)
            torque = inner(moment, twist - deflection, rate)
            damping = inner(moment, twist - deflection, rate + 1.0) - torque
            its_rate = self.deflection_rate(deflection, torque, damping)
            return deflection, its_rate, torque - damping * its_rate

        def rate_of_state(moment: Moment) -> Value:
            return series(moment, *connection.reaching(moment, series))[1]

        state = draft.add_state(f"{name}.deflection", unit="rad", initial=0.0, rate=rate_of_state)
        if self.yields:
            connection.yielding = series
        else:
            connection.series.append(series)
