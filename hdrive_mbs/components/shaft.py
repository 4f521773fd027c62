"""A torsionally elastic shaft."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Self

from hdrive_mbs.components.component import Component, Flange
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class Shaft(Component):
    """Spring and damper in torsion, with its inertia shared between its two ends.

    T = K (phi_a - phi_b) + B (w_a - w_b);  end a carries share_a * J, end b carries share_b * J.

    Source: seed F (1)-(4), shares w1..w4 (0.5 each).  Leaves out the torsional waves inside the
    shaft (good below about a third of its own first free-free frequency).
    """

    stiffness: float = parameter("N m/rad", "torsional stiffness K", above=0.0)
    damping: float = parameter("N m s/rad", "damping B on the rate of twist", default=0.0, low=0.0)
    inertia: float = parameter("kg m^2", "inertia of the shaft itself", default=0.0, low=0.0)
    share_a: float = parameter("1", "share of the inertia at end a (w1, w3)", default=0.5, low=0.0, high=1.0)
    share_b: float = parameter("1", "share of the inertia at end b (w2, w4)", default=0.5, low=0.0, high=1.0)

    entry = "a"
    exit = "b"

    @classmethod
    def from_geometry(
        cls, *, diameter: float, length: float, shear_modulus: float, density: float = 0.0, bore: float = 0.0, damping: float = 0.0
    ) -> Self:
        """K = G pi (D^4 - d^4) / (32 L), J = rho L pi (D^4 - d^4) / 32.  Lengths in m, moduli in Pa."""
        polar = math.pi * (diameter**4 - bore**4) / 32.0
        return cls(stiffness=shear_modulus * polar / length, inertia=density * length * polar, damping=damping)

    def flanges(self) -> tuple[Flange, ...]:
        return (
            Flange(name="a", inertia=self.share_a * self.inertia),
            Flange(name="b", inertia=self.share_b * self.inertia),
        )

    def relations(self) -> tuple[dict[str, float], ...]:
        return ({"a": 1.0, "b": -1.0},)

    def build(self, name: str, draft: Draft) -> None:
        a, b = draft.body(f"{name}.a"), draft.body(f"{name}.b")
        sense = b.sense if b.name != "ground" else a.sense
        factors = {a.name: float(sense * a.sense)}
        factors[b.name] = factors.get(b.name, 0.0) - float(sense * b.sense)
        stiffness, damping = self.stiffness, self.damping

        def torque(moment: Moment, twist: Value, rate: Value) -> Value:
            return stiffness * twist + damping * rate

        draft.add_connection(name, factors, torque, bodies={"a": a.name, "b": b.name})
