"""The improved simplified bearing: component-mode synthesis of two sections, ring, bearing and housing."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from hdrive_mbs.bearings.looked_at import directions_looked_at
from hdrive_mbs.components.bearing import add_law, power_law
from hdrive_mbs.components.component import Flange
from hdrive_mbs.components.condensed_line import CondensedLine, condensed_line
from hdrive_mbs.components.housing_channels import add_across, add_foundation_force
from hdrive_mbs.components.recovered_place import add_place, factors_of
from hdrive_mbs.components.section_torsion import add_spring, turning
from hdrive_mbs.components.shaft_section import ShaftSection
from hdrive_mbs.components.supported_line import supported_line
from hdrive_mbs.components.supported_section import SupportedSection
from hdrive_mbs.network.circulation import Circulation
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.node import Node
from hdrive_mbs.network.station import LATERAL, UNITS, WORDS, Station
from hdrive_mbs.quantities import parameter

FloatArray = npt.NDArray[np.float64]

CLEAR = 5.0
"""The lowest mode left out lies at least this many times above the highest speed; what it would add is below 1/25 of a static share."""

AT_RING = 0.1
"""Share of its polar inertia that a ring carries which turns by itself; see ``_carried``."""

LAGGING = 0.01
"""Share (speed times lag)^2 of the damping at the ring up to which the ring follows its neighbours statically."""


@dataclass(frozen=True, kw_only=True)
class ImprovedSection(SupportedSection):
    """The full model between a and b with the ring eliminated statically and the housing kept:  q = T (q_a, q_b, q_h, eta).

        M_r = T^T M T,   D_r = T^T D T,   K_r = T^T K T

    Bearing and foundation act in series, the damping of both is kept, and the shaft bends differently on both sides
    of the bearing.  Source: R. R. Craig, M. C. C. Bampton, AIAA J. 6 (1968) 1313; see shafts/condensation.py.

    Kept besides the housing, each where it is needed:

    * of the ring, the directions that the law of the bearing looks at beyond symmetric constant matrices, counted
      across the bearing: a nonlinear force acts at the true displacement;
    * the spin of the ring, when the law looks at it or brakes it; else it follows the ends;
    * of the ring x and y, when its damping would lag: (highest_speed d/k)^2 above 0.01, d/k of the ring held at the ends;
    * fixed-interface modes below 5 times ``highest_speed``; without that speed none.

    Static motion is exact.  Leaves out the motion of the ring by itself: of a ring that is not kept the inertia,
    m w^2 x, is missing in the channels of the bearing's force, which acts on the shaft all the same; and its
    gyroscopic moment is that of its polar inertia shared between the ends.
    """

    highest_speed: float | None = parameter(
        "rad/s", "fastest rotation or vibration that must come out right; none: slow against all that is left out", default=None, above=0.0
    )

    @cached_property
    def looked_at(self) -> tuple[str, ...]:
        """Directions of the ring that the bearing's law needs as coordinates."""
        return directions_looked_at(self.bearing.law)

    @property
    def keeps_spin(self) -> bool:
        """Whether the ring turns by itself."""
        return "phi" in self.looked_at

    @cached_property
    def kept(self) -> tuple[str, ...]:
        """Lateral directions of the ring that stay coordinates."""
        found = tuple(key for key in LATERAL if key in self.looked_at)
        if self.highest_speed is not None and not {"x", "y"} <= set(found):
            line = supported_line(self.left, self.bearing, self.right)
            lag = condensed_line(line, self._names(found)).lag
            if (self.highest_speed * lag) ** 2 > LAGGING:
                found = tuple(key for key in LATERAL if key in (*found, "x", "y"))
        return found

    def _names(self, ring: tuple[str, ...]) -> tuple[str, ...]:
        housing = ("housing.x", "housing.y") if self.bearing.housing is not None else ()
        return (*housing, *(f"ring.{key}" for key in ring))

    @cached_property
    def condensed(self) -> CondensedLine:
        """The matrices and how the ring follows."""
        line = supported_line(self.left, self.bearing, self.right).across([key for key in self.kept if key in "xy"])
        above = 0.0 if self.highest_speed is None else CLEAR * self.highest_speed
        return condensed_line(line, self._names(self.kept), above=above)

    def flanges(self) -> tuple[Flange, ...]:
        if not self.keeps_spin:
            return super().flanges()
        carried = self._carried
        a, b = (replace(end, mass=turning(share)) for end, share in zip(super().flanges(), (carried[0], carried[2]), strict=True))
        return a, b, Flange(name="ring", inertia=carried[1], free=True)

    @property
    def _carried(self) -> tuple[float, float, float]:
        """Polar inertia that a, ring and b carry as bodies where the ring turns by itself [kg m^2].

        Most is at the ends, where it resists their tilting; the matrix of mass puts it back to the ring, where it turns.
        """
        a, b = self.torsion.shares
        return (1.0 - AT_RING) * a, AT_RING * (a + b), (1.0 - AT_RING) * b

    def _spin_mass(self) -> tuple[float, float, float]:
        """What the matrix of mass has for the spins of a, ring and b: half of each shaft at its ends, less what they carry."""
        left, right = (section.beam().end_polar_inertia() for section in (self.left, self.right))
        a, ring, b = self._carried
        return left - a, self.bearing.polar_inertia + left + right - ring, right - b

    def relations(self) -> tuple[Mapping[str, float], ...]:
        return ({"a": 1.0, "ring": -1.0}, {"ring": 1.0, "b": -1.0}) if self.keeps_spin else super().relations()

    def build(self, name: str, draft: Draft) -> None:
        a, b = self.stations(name, draft)
        line = self.condensed
        own = tuple(self._add_coordinate(name, draft, kept) for kept in line.kept)
        self._add_matrices(name, draft, (a, b), own)
        if line.rotating.any():
            draft.add_element(Circulation.over(f"{name}.rotating_damping", (a, b), own, line.circulatory, line.rotating))
        spin = self._add_torsion(name, draft, a, b)
        rows = {key: factors_of(line.ring[k], a, b, own) for k, key in enumerate(LATERAL)}
        add_place(name, draft, self.ring_position(a, b), rows, line.ring_sag)
        self._add_housing(name, draft)
        self._add_law(name, draft, rows | {"phi": spin})

    def _add_matrices(self, name: str, draft: Draft, ends: tuple[Station, Station], own: tuple[str, ...]) -> None:
        line = self.condensed
        mass, damping, stiffness, falling = self.with_coupled_spins(line.mass), line.damping, line.stiffness, line.falling
        if self.keeps_spin:
            own = (*own, draft.body(f"{name}.ring").name)
            mass, damping, stiffness = (np.pad(matrix, (0, 1)) for matrix in (line.mass, damping, stiffness))
            falling = np.pad(falling, ((0, 1), (0, 0)))
            mass[[5, -1, 11], [5, -1, 11]] = self._spin_mass()
        draft.add_matrix(f"{name}.section", ends, own, mass=mass, damping=damping, stiffness=stiffness, falling=falling)

    def _add_torsion(self, name: str, draft: Draft, a: Station, b: Station) -> dict[str, float]:
        """Torsion springs, and the spin of the ring as factors of coordinates."""
        if not self.keeps_spin:
            add_spring(name, draft, a, b, self.torsion.stiffness, self.torsion.damping)
            return self.add_spin(name, draft, self.ring_spin(a, b))
        ring = draft.body(f"{name}.ring")
        pieces: tuple[tuple[str, ShaftSection, Station | Node, Station | Node], ...]
        pieces = (("left", self.left, a, ring), ("right", self.right, ring, b))
        for key, part, first, last in pieces:
            stiffness = part.shear_modulus * part.beam().polar_moment / part.length
            add_spring(f"{name}.{key}", draft, first, last, stiffness, (part.damping + part.rotating_damping) * stiffness)
        return self.add_spin(name, draft, {ring.name: float(ring.sense)})

    def _add_coordinate(self, name: str, draft: Draft, kept: str) -> str:
        """The coordinate of the network for a coordinate of the condensed line."""
        place, _, key = kept.partition(".")
        if place == "housing":
            coordinate, unit, doc = f"{name}.{kept}", "m", f"housing of {name} in {key}"
        elif place == "ring" and self._is_across(key):
            coordinate, unit, doc = f"{name}.across_{key}", "m", f"displacement across {name} in {key}"
        elif place == "ring":
            coordinate, unit, doc = f"{name}.{key}", UNITS[key], f"{WORDS[key]} of {name}"
        else:
            coordinate, unit, doc = f"{name}.{kept}", "m", f"amplitude of fixed-interface {kept} of {name}"
        # a coupled law is the faster the fewer coordinates its nodes have, so those of a law are a group by themselves
        group = f"{name}.law" if place == "ring" and self.looked_at else name
        return draft.add_coordinate(coordinate, inertia=0.0, unit=unit, doc=doc, group=group)

    def _is_across(self, key: str) -> bool:
        """Whether the ring's displacement is counted from the housing."""
        return self.bearing.housing is not None and key in ("x", "y")

    def _add_housing(self, name: str, draft: Draft) -> None:
        """The power term of the foundation; all else is in the matrices."""
        housing = self.bearing.housing
        if housing is None:
            return
        for key, factor in (("x", housing.power_stiffness_x), ("y", housing.power_stiffness_y)):
            if factor != 0.0:
                coordinate = f"{name}.housing.{key}"
                draft.add_relative_torque(f"{name}.foundation_{key}_power", {coordinate: 1.0}, power_law(factor, int(housing.power)))

    def _add_law(self, name: str, draft: Draft, rows: Mapping[str, Mapping[str, float]]) -> None:
        """The forces of the law along the coordinates kept for them, and its whole force as channels."""
        stretches = {key: dict(factors) for key, factors in rows.items()}
        if self.bearing.housing is not None:
            for key in "xy":
                coordinate = f"{name}.housing.{key}"
                stretches[key][coordinate] = stretches[key].get(coordinate, 0.0) - 1.0
            add_foundation_force(name, draft, self.bearing.housing, {key: {f"{name}.housing.{key}": 1.0} for key in "xy"})
        for key in self.kept:
            stretches[key] = {f"{name}.across_{key}" if self._is_across(key) else f"{name}.{key}": 1.0}
        sag = self.condensed.ring_sag

        def offset(row: int) -> float:
            return float(sag[row] @ np.array(draft.gravity)) if row < len(sag) else 0.0

        if self.bearing.housing is not None:
            add_across(name, draft, stretches, offset)
        add_law(name, draft, self.bearing.law, stretches, offset)
