"""The simplified bearing of seed M section 5: nodal matrices on one beam element."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.components.bearing import has_forces
from hdrive_mbs.components.recovered_place import add_place, factors_of
from hdrive_mbs.components.section_torsion import add_spring
from hdrive_mbs.components.shaft_section import ShaftSection
from hdrive_mbs.components.supported_section import SupportedSection
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.network.circulation import Circulation
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.station import LATERAL

FloatArray = npt.NDArray[np.float64]

SPINS = (5, 11)


@dataclass(frozen=True, kw_only=True)
class SimplifiedSection(SupportedSection):
    """One beam element from a to b; ring and housing move as one and are spread to its ends by its shapes.

    With N the shapes of displacement and tilt at the bearing, q(xi_0) = N q_e, the ends feel  -Q_0,

        Q_0 = N^T diag(m, J) N q_e'' + N^T diag(b_h, b_psi) N q_e' + N^T diag(k_h, k_psi) N q_e

    in each plane, with m = m_h + m_b, the transverse inertia J of the ring, stiffness k_h and damping b_h of the
    foundation, tilt stiffness k_psi and tilt damping b_psi of the bearing.  Source: seed M (9)-(15), where (10) has
    to have -psi, the first term of (12) and (13) the acceleration, and the sign is that of (15).  The mass in (10)
    is that of the housing alone; the ring moves with it.  Beyond section 5, the ring is held axially by the bearing
    (k_zz, b_zz) and has its mass there, and its polar inertia is shared between the ends.  Without a housing the
    bearing itself takes the place of the foundation.

    Leaves out stiffness and damping of the bearing across the axis, its nonlinear forces, a power term of the
    foundation, the play of the ring against the housing, and that the shaft bends differently on both sides of a
    bearing: one cubic is too stiff.  ``with_bearings`` compares it with the full model and warns.
    """

    def check(self) -> None:
        super().check()
        for field, value, _ in self.left.fields():
            other = getattr(self.right, field)
            if field not in ("length", "elements") and value != other:
                raise ParameterError(
                    f"SimplifiedSection: left.{field} = {value} and right.{field} = {other} differ, but the simplified bearing sits on one "
                    "uniform section. Give both the same, or use ImprovedSection, which takes two."
                )
        if self.bearing.housing is None and has_forces(self.bearing.law):
            raise ParameterError(
                "SimplifiedSection: a bearing without a housing has nothing but its law to hold the shaft, and "
                f"{type(self.bearing.law).__name__} is more than constant matrices. Give law.linearised(load=..., speed=...), "
                "or use ImprovedSection."
            )

    @property
    def section(self) -> ShaftSection:
        """The shaft as one section with one element."""
        return self.left.replacing(length=self.length, elements=1.0)

    def shapes(self) -> FloatArray:
        """N: x, y, z, psi, theta, phi at the bearing over the 12-vector of the ends (seed M (9))."""
        return self.section.beam().shape(self.left.length / self.length)

    def at_bearing(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Mass, damping and stiffness over x, y, z, psi, theta, phi at the bearing (diagonal of seed M (10)); phi has none."""
        bearing, housing = self.bearing, self.bearing.housing
        whole = 0.0 if housing is None else housing.mass
        mass = np.diag([whole + bearing.mass, whole + bearing.mass, bearing.mass, *[bearing.transverse_inertia] * 2, 0.0])
        damping = np.array(bearing.law.damping_matrix(), float)
        stiffness = np.array(bearing.law.stiffness_matrix(), float)
        if housing is not None:
            for matrix, x, y in (
                (damping, housing.damping_x, housing.damping_y),
                (stiffness, housing.stiffness_x, housing.stiffness_y),
            ):
                matrix[:2, :], matrix[:, :2] = 0.0, 0.0
                matrix[0, 0], matrix[1, 1] = x, y
        return mass, damping, stiffness

    def build(self, name: str, draft: Draft) -> None:
        a, b = self.stations(name, draft)
        section, shapes = self.section, self.shapes()
        beam = section.beam()
        elastic, turning = beam.stiffness(), section.rotating_damping * beam.bending_stiffness()
        lateral = shapes.copy()
        lateral[5] = 0.0
        for matrix in (elastic, lateral):
            matrix[..., SPINS] = 0.0
        elastic[SPINS, :] = 0.0
        mass, damping, stiffness = (lateral.T @ matrix @ lateral for matrix in self.at_bearing())
        mass += beam.mass(rotary_inertia=section.rotary_inertia)
        draft.add_matrix(
            f"{name}.section",
            (a, b),
            mass=self.with_coupled_spins(mass),
            damping=damping + section.damping * elastic + turning,
            stiffness=stiffness + elastic,
        )
        if section.rotating_damping > 0.0:
            skew = section.rotating_damping * beam.circulatory()
            draft.add_element(Circulation.between(f"{name}.rotating_damping", a, b, skew, turning))
        add_spring(name, draft, a, b, self.torsion.stiffness, self.torsion.damping)
        self.add_spin(name, draft, self.ring_spin(a, b))
        rows = {key: factors_of(shapes[k], a, b, ()) for k, key in enumerate(LATERAL)}
        add_place(name, draft, self.ring_position(a, b), rows)
        if self.bearing.housing is not None:
            for key in "xy":
                draft.add_displacement(f"{name}.housing.{key}", rows[key], "m", f"housing of {name} in {key}")
