"""Backlash with an oil film in the gap."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.dead_zone import beyond, contact_share, dead_zone
from hdrive_mbs.effects.gap_law_effect import GapLawEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class FilmBacklash(GapLawEffect):
    """Backlash whose flanks meet on a film: no corner, and damping in the gap.

    tau = T(d, 0) + s (T(d, v) - T(d, 0)) + (1 - s) c v,  s = dd/dx,
    d(x) = x + (sqrt((x - b/2)^2 + e^2) - sqrt((x + b/2)^2 + e^2))/2

    with the law T(twist, rate) as it is without the effect.  The share s of contact rises from 0 to 1
    over the film e at each edge of the gap; with it the damping of the law comes in and that of the
    film, c, goes out.  A law with a gap g of its own counts from its edges, and d has b + g for b.
    The elastic torque depends on x alone, so no energy is made.

    Source: dead-zone model as in CouplingBacklash; that lubricated flanks meet on a film in place of an
    impact is in Theodossiades, Natsiavas, J. Sound and Vibration 229 (2000) 287; the rounding by a
    hyperbola is our own.  Leaves out the rise of squeeze-film damping as the gap closes, and cavitation:
    flanks that come apart are held by the damping.
    """

    backlash: float = parameter("rad", "full width b of the gap", low=0.0, high=0.2, typical=(1e-5, 0.05))
    film: float = parameter("rad", "twist e over which contact comes in", above=0.0, high=0.1, typical=(1e-6, 1e-3))
    film_damping: float = parameter("N m s/rad", "c, damping inside the gap", default=0.0, low=0.0, high=1e3, typical=(1e-3, 20.0))

    family: ClassVar[str] = "backlash"
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"backlash": (1.5e-5, 1e-4, 7e-4, 4e-3)}
    signature: ClassVar[str] = (
        "little torque over a range of twist, soft at its edges; load reversals without knocking, a lower resonance at small amplitude"
    )

    def changed_beyond(self, law: Callable[[Value, Value], Value], gap: float) -> Callable[[Value, Value], Value]:
        if self.backlash == 0.0:
            return law

        def torque(twist: Value, rate: Value) -> Value:
            inside = beyond(dead_zone(twist, gap + self.backlash, self.film), gap)
            share = contact_share(twist, gap + self.backlash, self.film)
            elastic = law(inside, 0.0)
            return elastic + share * (law(inside, rate) - elastic) + (1.0 - share) * self.film_damping * rate

        return torque
