"""A piece of shaft with the bearing that holds it, as one element between the next two stations."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from hdrive_mbs.components.bearing import Bearing
from hdrive_mbs.components.component import Component, Flange
from hdrive_mbs.components.section_torsion import Torsion, torsion_over, turning
from hdrive_mbs.components.shaft_section import ShaftSection
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.station import GROUND, Station
from hdrive_mbs.quantities import option

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class SupportedSection(Component):
    """Shaft from flange a over a bearing to flange b, the bearing not a station of its own.

    Made of the same parts as the full model, so that both come from the same data.  In torsion the two pieces are
    in series and the ring follows them, which is exact but for (frequency / torsional frequency of the ring)^4.
    """

    _kind = "supported shaft section"

    left: ShaftSection = option("shaft from flange a to the bearing")
    bearing: Bearing = option("the bearing, with its ring and housing")
    right: ShaftSection = option("shaft from the bearing to flange b")

    entry = "a"
    exit = "b"

    def check(self) -> None:
        for name, kind in (("left", ShaftSection), ("bearing", Bearing), ("right", ShaftSection)):
            if not isinstance(getattr(self, name), kind):
                raise ParameterError(f"{type(self).__name__}.{name} = {getattr(self, name)!r}: must be a {kind.__name__}(...).")

    @property
    def length(self) -> float:
        """Distance from a to b [m]."""
        return self.left.length + self.right.length

    @cached_property
    def torsion(self) -> Torsion:
        """The two pieces in series, with the ring and the mass of the shaft condensed to the ends."""
        return torsion_over(self.left, self.right, self.bearing.polar_inertia)

    def flanges(self) -> tuple[Flange, ...]:
        shares = self.torsion.shares
        ends = (("a", 0.0, self.left), ("b", self.length, self.right))
        return tuple(
            Flange(name=name, lateral=True, mass=turning(share), axial=axial, free=part.density > 0.0)
            for (name, axial, part), share in zip(ends, shares, strict=True)
        )

    def relations(self) -> tuple[Mapping[str, float], ...]:
        return ({"a": 1.0, "b": -1.0},)

    # -- what the models share when they are built ----------------------------------------------------
    def stations(self, name: str, draft: Draft) -> tuple[Station, Station]:
        """The two ends."""
        a, b = draft.station(f"{name}.a", asked_by=repr(name)), draft.station(f"{name}.b", asked_by=repr(name))
        if a.held and b.held:
            raise ParameterError(f"{name!r}: both ends are held by the ground, so the section does nothing; remove it.")
        return a, b

    def ring_position(self, a: Station, b: Station) -> float:
        """Where the bearing lies on the axis [m]."""
        return a.position + self.left.length if not a.held else b.position - self.right.length

    def ring_spin(self, a: Station, b: Station) -> dict[str, float]:
        """Spin of the ring in the true sense as factors of the spins of the ends."""
        ends = [(station.node, float(share * station.sense)) for share, station in zip(self.torsion.ring, (a, b), strict=True)]
        return {node: factor for node, factor in ends if node != GROUND}

    def add_spin(self, name: str, draft: Draft, factors: dict[str, float]) -> dict[str, float]:
        """Channels of the ring's spin, which these factors of coordinates make; returns them."""
        parts = factors.items()
        draft.add_channel(
            f"{name}.angle", "rad", f"angle of {name}, true sense", lambda m: sum(f * m.angle(c) for c, f in parts), slope=f"{name}.speed"
        )
        draft.add_channel(f"{name}.speed", "rad/s", f"speed of {name}, true sense", lambda m: sum(f * m.speed(c) for c, f in parts))
        return factors

    def with_coupled_spins(self, mass: FloatArray) -> FloatArray:
        """A matrix of mass over the ends (and more) with what couples their spins: J = diag(shares) + J_ab [[-1, 1], [1, -1]]."""
        coupling = float(self.torsion.inertia[0, 1])
        whole = mass.copy()
        whole[np.ix_((5, 11), (5, 11))] = coupling * np.array([[-1.0, 1.0], [1.0, -1.0]])
        return whole
