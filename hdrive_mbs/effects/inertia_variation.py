"""An inertia that varies with the angle of its body: arms, cranks, linkages."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import Effect, add_body_torque, moving_body
from hdrive_mbs.effects.places import gear_flanges, motors, torsional_bodies
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.network import Network
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class InertiaVariation(Effect):
    """Inertia of a body that varies with its angle, as of an arm that bends or of a machine behind a crank or a linkage.

    tau = -J (r(a) dw/dt + r'(a) w^2/2),  r(a) = A sin(n a + p)

    with J the inertia of the place, a its true angle and w = da/dt: Lagrange's equation of the kinetic energy J (1 + r) w^2/2, which is
    d(J (1 + r) w)/dt = T + J r' w^2/2 with the torque T of everything else, so no energy is made.  A slider of mass m on a Scotch
    yoke of radius c, with m c^2/2 in J, has A = m c^2/(2 J) and n = 2.

    Source: equation of motion of a machine with one degree of freedom and reduced inertia J(a), e.g. Goldstein, Classical
    Mechanics, 1.4.  Leaves out the mass's weight (EccentricLoad), forces on the bearings, other harmonics (further effects; the sizes
    of all at one place stay below 1 together).
    """

    variation: float = parameter("1", "A, share by which the inertia changes, 0-peak", low=0.0, high=0.95, typical=(2e-3, 0.5))
    order: float = parameter("1", "periods n per turn of the body", default=2.0, above=0.0, high=1e3)
    phase: float = parameter("rad", "phase p at angle 0", default=0.0, typical=(-np.pi, np.pi))

    kind: ClassVar[str] = "parametric"
    signature: ClassVar[str] = (
        "torque at a fixed order of the body that grows with acceleration and the square of speed; resonances that wander with angle"
    )
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("variation", "phase"),)
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"order": (1.0, 2.0)}

    @classmethod
    def places(cls, network: Network) -> tuple[str, ...]:
        """Bodies that only turn, without rotors of motors and wave generators, which are round or nearly so."""
        round_ones = {network.places[place] for place in motors(network)} | set(gear_flanges(network, "wave_generator"))
        return tuple(place for place in torsional_bodies(network) if place not in round_ones)

    def share(self, angle: Value) -> Value:
        """r, share by which the inertia is larger at a true angle [rad] of the body."""
        return self.variation * np.sin(self.order * angle + self.phase)

    def apply(self, draft: Draft, place: str, name: str) -> None:
        body = moving_body(self, draft, place)
        torque, energy = draft.vary_inertia(place, self.share, abs(self.variation), type(self).__name__)
        add_body_torque(self, draft, body.name, name, torque, energy)
        draft.add_channel(
            f"{name}.share", "1", f"share by which {name} raises the inertia", lambda m: self.share(body.sense * m.angle(body.name))
        )
