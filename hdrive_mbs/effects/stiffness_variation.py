"""Stiffness of a gear that changes as the wave generator or the output turns."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.connection_draft import ConnectionDraft
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import option, parameter

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)


@dataclass(frozen=True, kw_only=True)
class StiffnessVariation(Effect):
    """Elastic torque of a gear that depends on the angle of one of its flanges.

    tau = T(x, v) + r(a) T(x, 0),  r(a) = A sin(n a + p),  and on the flange -dr/da U(x),  U = integral of T(x, 0) from 0 to x

    where a is the true angle of the flange that it follows, counted from the circular spline.  Torque
    and reaction come from the one potential (1 + r(a)) U(x), so no energy is made: the flange does the
    work by which the spring grows stiffer.  U is found by Gauss's rule with four points, exact for
    laws up to the seventh power; at corners of a law the small reaction is off by some per cent.

    Source: parametric excitation of gears, e.g. Kahraman, Singh, J. Sound and Vibration 146 (1991) 135;
    in harmonic drives the number of loaded teeth changes twice per turn of the wave generator.
    Leaves out a change of damping or lost motion with angle; other orders are further effects.
    """

    variation: float = parameter("1", "A, share by which the stiffness changes, 0-peak", low=0.0, high=0.9, typical=(5e-3, 0.4))
    order: float = parameter("1", "periods n per turn of the flange it follows", default=2.0, above=0.0, high=1e3)
    phase: float = parameter("rad", "phase p at angle 0", default=0.0, typical=(-np.pi, np.pi))
    follows: str = option("'wave_generator' or 'flexspline': the flange whose angle counts", default="wave_generator")

    acts_on: ClassVar[str] = "gear"
    kind: ClassVar[str] = "parametric"
    family: ClassVar[str] = "stiffness_variation"
    signature: ClassVar[str] = (
        "vibration at a fixed order of a shaft that grows with the torque, with sidebands and instability near twice a mode"
    )
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("variation", "phase"),)
    starts: ClassVar[Mapping[str, tuple[float | str, ...]]] = {
        "order": (1.0, 2.0, 4.0),
        "follows": ("wave_generator", "flexspline"),
    }

    def check(self) -> None:
        if self.follows not in ("wave_generator", "flexspline"):
            raise ParameterError(f"{type(self).__name__}.follows = {self.follows!r}: must be 'wave_generator' or 'flexspline'.")

    def share(self, angle: Value) -> Value:
        """r, share by which the stiffness is larger at a true angle [rad] of the flange."""
        return self.variation * np.sin(self.order * angle + self.phase)

    def vary(self, gear: ConnectionDraft, share: Callable[[Moment], Value]) -> Callable[[Moment], Value]:
        """Let a gear's law vary by a share; what varies of its energy, U [J], of which r is a factor.

        U is by the law as it ends up, which holds 1 + r as a factor.
        """
        old = gear.law

        def new(moment: Moment, twist: Value, rate: Value) -> Value:
            return old(moment, twist, rate) + share(moment) * old(moment, twist, 0.0)

        def energy(moment: Moment) -> Value:
            twist, _ = gear.inside(moment)
            points = 0.5 * (1.0 + _NODES)
            whole = sum(0.5 * weight * twist * gear.law(moment, point * twist, 0.0) for point, weight in zip(points, _WEIGHTS))
            return whole / (1.0 + share(moment))

        gear.law = new
        return energy

    def apply(self, draft: Draft, place: str, name: str) -> None:
        gear = draft.connection(place, type(self).__name__, flanges=(self.follows, "circular_spline"))
        flange, ring = draft.body(gear.bodies[self.follows]), draft.body(gear.bodies["circular_spline"])
        relative = {flange.name: float(flange.sense), ring.name: -float(ring.sense)}

        def angle(moment: Moment) -> Value:
            return sum(factor * moment.angle(body) for body, factor in relative.items())

        energy = self.vary(gear, lambda moment: self.share(angle(moment)))

        def reaction(moment: Moment, relative_angle: Value, relative_speed: Value) -> Value:
            slope = self.variation * self.order * np.cos(self.order * relative_angle + self.phase)
            return slope * energy(moment)

        draft.add_relative_torque(name, relative, reaction)
        draft.add_channel(f"{name}.share", "1", f"share by which {name} raises the stiffness", lambda m: self.share(angle(m)))
