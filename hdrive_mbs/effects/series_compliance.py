"""An extra compliance in series with a connection: a soft clamp, a key, a flange."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.series_effect import SeriesEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class SeriesCompliance(SeriesEffect):
    """A spring with a damper beside it, in line with everything that acts at a connection.

    tau = T(x - y, v - dy/dt) = (y + t dy/dt)/C,  so  dy/dt = (C T(x - y, v) - y)/(t + C d),  d = T(x - y, v + 1) - T(x - y, v)

    with the torque T(twist, rate) of the connection, a part of whose whole twist x is the deflection y of the extra
    spring of compliance C and relaxation time t.  No mass sits between the two, so y is a first-order state.  It is
    exact where T has linear damping d, and the extra spring makes no energy in any case.  C = 0 leaves the law as it is.

    Source: springs in series (statics) with the spring as a Kelvin-Voigt element.  Leaves out the inertia between the
    two springs; t gives the spring the loss factor w t at the frequency w.  In line with a linear shaft it cannot be told from a
    softer shaft.  The state settles within t + C d or less: a solver with fixed steps needs shorter ones.
    """

    compliance: float = parameter("rad/(N m)", "C of the extra spring", low=0.0, high=10.0, typical=(1e-7, 1e-2))
    relaxation_time: float = parameter("s", "t, damping over stiffness of the extra spring", default=2e-4, above=0.0, high=1.0)

    family: ClassVar[str] = "extra_compliance"
    signature: ClassVar[str] = (
        "more twist at every torque than the parts have, and a lower resonance, also where the connection itself is stiff"
    )

    def at_rest(self) -> bool:
        return self.compliance == 0.0

    def deflection_rate(self, deflection: Value, torque: Value, damping: Value) -> Value:
        return (self.compliance * torque - deflection) / (self.relaxation_time + self.compliance * damping)
