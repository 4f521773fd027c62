"""A piece of elastic shaft between two stations: bending, tension and torsion, without or with mass."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from hdrive_mbs.components.component import Component, Flange
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.bearing_draft import ShaftPiece
from hdrive_mbs.network.circulation import Circulation
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.rigid_mass import RigidMass
from hdrive_mbs.network.station import Station
from hdrive_mbs.quantities import option, parameter
from hdrive_mbs.shafts.beam import Beam
from hdrive_mbs.shafts.section_geometry import CircularSection
from hdrive_mbs.tracked_arrays import has_tracked, scaled
from hdrive_mbs.usual_values import DENSITY, DIAMETER, LENGTH, SHEAR_MODULUS, YOUNGS_MODULUS

FloatArray = npt.NDArray[np.float64]

SPINS = (5, 11)
KEPT = 256
"""Sections whose ends and matrices are kept: a search builds most of them again and again."""


@dataclass(frozen=True, kw_only=True)
class ShaftSection(Component):
    """Round shaft from station a to station b (a at the lower z), as one or more beam elements.

    Without a density it is massless: exact for what its ends do, one element is enough.  With a density each
    element has the consistent mass matrix (translation, diametral rotary inertia, axial) and its polar inertia
    at its ends; more elements converge.  Damping is proportional to stiffness; ``damping`` acts on rates in the
    fixed frame, ``rotating_damping`` on rates in the turning frame, where it destabilises forward whirl above
    the first critical speed (and is a Python callback in time integration).
    """

    length: float = parameter("m", "distance between the stations", above=0.0, **LENGTH)
    diameter: float = parameter("m", "outer diameter", above=0.0, **DIAMETER)
    bore: float = parameter("m", "inner diameter", default=0.0, low=0.0)
    youngs_modulus: float = parameter("Pa", "E", above=0.0, **YOUNGS_MODULUS)
    shear_modulus: float = parameter("Pa", "G", above=0.0, **SHEAR_MODULUS)
    density: float = parameter("kg/m^3", "density; 0: massless", default=0.0, low=0.0, **DENSITY)
    elements: float = parameter("1", "number of beam elements, a whole number", default=1.0, low=1.0, high=500.0)
    shear: bool = option("Timoshenko beam (shear coefficient of Cowper); False: Euler-Bernoulli", default=False)
    rotary_inertia: bool = option("whether the mass of a piece of shaft resists tilting too (Rayleigh)", default=True)
    damping: float = parameter("s", "damping over stiffness, not rotating", default=0.0, low=0.0)
    rotating_damping: float = parameter("s", "damping over bending stiffness, rotating with the shaft", default=0.0, low=0.0)

    entry = "a"
    exit = "b"

    def check(self) -> None:
        if self.bore >= self.diameter:
            raise ParameterError(f"ShaftSection.bore = {self.bore:g} m: must be less than the diameter of {self.diameter:g} m.")
        if self.elements % 1.0:
            raise ParameterError(f"ShaftSection.elements = {self.elements:g}: must be a whole number.")
        if self.density == 0.0 and self.elements > 1.0:
            raise ParameterError(
                f"ShaftSection.elements = {self.elements:g} of a massless section: the stations between have no mass. "
                "One element is exact there; give a density to have more."
            )

    def beam(self, length: float | None = None) -> Beam:
        """One element of that length (the whole section if not given) [m]."""
        section = CircularSection(diameter=self.diameter, bore=self.bore)
        return Beam(
            length=self.length if length is None else length,
            area=section.area,
            second_moment=section.second_moment,
            polar_moment=section.polar_moment,
            youngs_modulus=self.youngs_modulus,
            shear_modulus=self.shear_modulus,
            density=self.density,
            shear_area=section.shear_area(self.youngs_modulus, self.shear_modulus) if self.shear else None,
        )

    def flanges(self) -> tuple[Flange, ...]:
        return _ends(self)

    def relations(self) -> tuple[dict[str, float], ...]:
        return ({"a": 1.0, "b": -1.0},)

    def build(self, name: str, draft: Draft) -> None:
        first, last, count = draft.station(f"{name}.a"), draft.station(f"{name}.b"), int(self.elements)
        if first.held and last.held:
            raise ParameterError(f"{name!r}: both ends are held by the ground, so the section does nothing; remove it.")
        inner, start = first if not first.held else last, first.position if not first.held else last.position - self.length
        end = _end_mass(self)
        stations = [first]
        for k in range(1, count):
            position = start + self.length * k / count
            stations.append(draft.add_station(f"{name}.{k}", end + end, like=inner, position=position))
        stations.append(last)
        for k, (a, b) in enumerate(itertools.pairwise(stations), start=1):
            self._add_element(name if count == 1 else f"{name}.element_{k}", draft, a, b)

    def _add_element(self, name: str, draft: Draft, a: Station, b: Station) -> None:
        beam = self.beam(self.length / self.elements)
        stiffness, bending, mass = _matrices(beam, self.rotary_inertia)
        damping = scaled(self.damping, stiffness)
        if self.rotating_damping > 0.0:
            damping = damping + scaled(self.rotating_damping, bending)
        draft.add_matrix(f"{name}.beam", (a, b), stiffness=stiffness, damping=damping, mass=mass)
        draft.add_shaft(ShaftPiece(name, (a, b), beam.length, bending))
        if self.rotating_damping > 0.0:
            factor = self.rotating_damping
            circulatory, dissipative = scaled(factor, beam.circulatory()), scaled(factor, bending)
            draft.add_element(Circulation.between(f"{name}.rotating_damping", a, b, circulatory, dissipative))
        torsion = beam.shear_modulus * beam.polar_moment / beam.length
        sense = b.sense if not b.held else a.sense
        factors: dict[str, float] = {a.node: float(sense * a.sense)}
        factors[b.node] = factors.get(b.node, 0.0) - float(sense * b.sense)
        damper = (self.damping + self.rotating_damping) * torsion

        def torque(moment: Moment, twist: Value, rate: Value) -> Value:
            return torsion * twist + damper * rate

        draft.add_connection(name, factors, torque, bodies={"a": a.node, "b": b.node})


def _end_mass(section: ShaftSection) -> RigidMass:
    polar = section.beam(section.length / section.elements).end_polar_inertia()
    return RigidMass(0.0, (0.0, 0.0, 0.0), ((0.0,) * 3, (0.0,) * 3, (0.0, 0.0, polar)))


def _ends(section: ShaftSection) -> tuple[Flange, ...]:
    return _made_ends(section) if has_tracked(section) else _kept_ends(section)


def _made_ends(section: ShaftSection) -> tuple[Flange, ...]:
    end = Flange(name="a", lateral=True, mass=_end_mass(section), free=section.density > 0.0)
    return (end, replace(end, name="b", axial=section.length))


def _matrices(beam: Beam, rotary_inertia: bool) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Stiffness without torsion, that of bending alone, and mass of a beam; not to be changed."""
    return _made_matrices(beam, rotary_inertia) if has_tracked(beam) else _kept_matrices(beam, rotary_inertia)


def _made_matrices(beam: Beam, rotary_inertia: bool) -> tuple[FloatArray, FloatArray, FloatArray]:
    stiffness, bending, mass = beam.stiffness(), beam.bending_stiffness(), beam.mass(rotary_inertia=rotary_inertia)
    stiffness[SPINS, :] = 0.0
    stiffness[:, SPINS] = 0.0
    for matrix in (stiffness, bending, mass):
        matrix.setflags(write=False)
    return stiffness, bending, mass


_kept_ends, _kept_matrices = lru_cache(maxsize=KEPT)(_made_ends), lru_cache(maxsize=KEPT)(_made_matrices)
"""Of sections of plain numbers: to ask whether a tracked number equals another one is a comparison that is kept."""
