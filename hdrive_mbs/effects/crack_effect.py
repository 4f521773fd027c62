"""The shape of effects that put a transverse crack into a shaft."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.effects.shaft_bending import moment_at
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class CrackEffect(Effect):
    """A crack as a hinge that turns with the shaft: extra angles a_1 = g c M_1 about its front and a_2 = g e c M_2 across.

    M_1, M_2 are the bending moments at the crack, M_1 in the plane through the axis and the crack, and g says how far it is
    open.  The piece of shaft is exact between its ends: with the moments M_0 that the same ends would give without the crack and
    the moment h that a unit kink meets there,  M = M_0 - h a,  so  a = g c M_0/(1 + h g c), and the forces at the ends change by
    -a dM_0/dq.  The moments are whole ones, with what the weight does: that, turning, is where 1x and 2x come from.
    The spin angle is that of the nearer end.  The torque on the spin is such that what an always open crack stores comes back.
    """

    compliance: float = parameter("rad/(N m)", "c, extra angle per bending moment when open", low=0.0, high=1.0, typical=(1e-9, 3e-4))
    cross_share: float = parameter("1", "e, compliance across over that about the front", default=0.0, low=0.0, high=1.0)
    position: float = parameter("1", "where it lies, as a share of the length from end a", low=0.0, high=1.0, typical=(0.05, 0.95))
    angle: float = parameter(
        "rad",
        "where on the circumference, from x towards y at spin angle 0",
        default=0.0,
        low=-math.tau,
        high=math.tau,
        typical=(-math.pi, math.pi),
    )

    acts_on: ClassVar[str] = "shaft"
    kind: ClassVar[str] = "parametric"
    family: ClassVar[str] = "crack"
    signature: ClassVar[str] = (
        "1x, 2x and 3x that grow where the order meets a critical speed (2x at half of it), "
        "slightly lower resonances, no change by balancing"
    )
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {
        "compliance": (1e-8, 1e-7),
        "position": (0.2, 0.8),
        "angle": (0.0, 1.57, 3.14, -1.57),
    }
    decisive: ClassVar[tuple[str, ...]] = ("angle",)

    @abstractmethod
    def opening(self, moment: Value, cosine: Value, sine: Value, gravity: tuple[float, float]) -> tuple[Value, Value]:
        """How far it is open, 0 to 1, and the derivative of that by the spin angle with the moment held [1/rad].

        moment : M_0 at the crack, positive when it presses the crack shut [N m]
        cosine, sine : of the angle from x to the crack
        gravity : direction of the weight across the axis, a unit vector; (0, 0) without
        """

    def check_gravity(self, gravity: tuple[float, float], place: str) -> None:
        """Raise PlaceError where the law needs a weight and has none."""

    def apply(self, draft: Draft, place: str, name: str) -> None:
        piece = draft.shaft(place, type(self).__name__)
        shape, held = moment_at(piece, self.position)
        pull = math.hypot(*draft.gravity[:2])
        down = (draft.gravity[0] / pull, draft.gravity[1] / pull) if pull > 0.0 else (0.0, 0.0)
        self.check_gravity(down, place)
        c, e, size = self.compliance, self.cross_share, shape.size
        stretches = {**shape.stretches, "phi": piece.spin(self.position)}

        def seen(s: Mapping[str, Value]) -> tuple[Value, ...]:
            """Cosine and sine of the crack's direction, M_0 along and across it, opening and its slope."""
            beta = s["phi"] + self.angle
            cosine, sine = np.cos(beta), np.sin(beta)
            along, across = size * (cosine * s["x"] + sine * s["y"]), size * (cosine * s["y"] - sine * s["x"])
            return cosine, sine, along, across, *self.opening(along, cosine, sine, down)

        def forces(moment: Moment, s: Mapping[str, Value], v: Mapping[str, Value]) -> Mapping[str, Value]:
            cosine, sine, along, across, opened, slope = seen(s)
            first, second = along / (1.0 + held * c * opened), across / (1.0 + held * e * c * opened)  # M_1 and M_2
            one, two = c * opened * first, e * c * opened * second  # a_1 and a_2
            breathing = 0.5 * slope * c * (first * first + e * second * second)
            return {
                "x": -size * (one * cosine - two * sine),
                "y": -size * (one * sine + two * cosine),
                "phi": two * along - one * across - breathing,
            }

        draft.add_coupling(name, stretches, forces)

        def opened(moment: Moment) -> Value:
            s = {key: sum(f * moment.angle(q) for q, f in factors.items()) for key, factors in stretches.items()}
            return seen(s)[4] + 0.0 * moment.time

        draft.add_channel(f"{name}.opening", "1", f"how far the crack {name} is open, 0 to 1", opened)
