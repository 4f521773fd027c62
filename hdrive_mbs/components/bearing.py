"""The full bearing: inner ring as a body, bearing law, housing on an elastic foundation."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.bearings.law import DIRECTIONS, BearingLaw, RelativeMotion
from hdrive_mbs.components.component import Component, Flange
from hdrive_mbs.components.housing import Housing, raised
from hdrive_mbs.components.housing_channels import add_across, add_foundation_force
from hdrive_mbs.errors import LawError, ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.bearing_draft import BearingDraft, SupportDraft
from hdrive_mbs.network.connection_draft import Torque
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.rigid_mass import RigidMass
from hdrive_mbs.network.station import Station
from hdrive_mbs.quantities import option, parameter
from hdrive_mbs.tracked_arrays import array_of, as_array, congruent, scaled

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Bearing(Component):
    """Seed M section 4: F_B = K (q_b - q_h) + K_n (q_b - q_h)^n + D (q_b' - q_h') acts on the housing, -F_B on the ring.

    The ring is a body with six coordinates; a rotor or a rigid section connected to the bearing makes one body
    of both (Fig. 2(b)).  Without a housing the outer ring is held by the ground.  The housing moves in x and y
    only, so tilt moments, axial force and friction torque go into the ground.
    """

    law: BearingLaw = option("force law between ring and housing")
    mass: float = parameter("kg", "inner ring with the shaft in it", default=0.0, low=0.0)
    polar_inertia: float = parameter("kg m^2", "ring about the axis, Jp", default=0.0, low=0.0)
    transverse_inertia: float = parameter("kg m^2", "ring about a diameter, Jt", default=0.0, low=0.0)
    housing: Housing | None = option("housing on its foundation; None: the outer ring is fixed", default=None)

    def check(self) -> None:
        if not isinstance(self.law, BearingLaw):
            raise ParameterError(f"Bearing.law = {self.law!r}: must be a bearing law, for instance a LinearBearing(...).")
        if self.housing is not None and not isinstance(self.housing, Housing):
            raise ParameterError(f"Bearing.housing = {self.housing!r}: must be a Housing(...) or None.")
        if self.polar_inertia > 2.0 * self.transverse_inertia * (1.0 + 1e-9):
            raise ParameterError(
                f"Bearing.polar_inertia = {self.polar_inertia:g} kg m^2 is more than twice transverse_inertia = "
                f"{self.transverse_inertia:g} kg m^2, which no body has (Jx + Jy >= Jz). Were the two exchanged, or one left out?"
            )

    def flanges(self) -> tuple[Flange, ...]:
        ring = RigidMass.rotor(self.mass, self.polar_inertia, self.transverse_inertia)
        return (Flange(name="", lateral=True, mass=ring),)

    def build(self, name: str, draft: Draft) -> None:
        station = draft.station(name)
        if self.housing is not None and has_forces(self.law):
            stretches = add_housing_across(name, draft, station, self.housing)
        else:
            housing = add_housing(name, draft, self.housing)
            stretches = {direction: station.stretch(direction) for direction in DIRECTIONS}
            for direction, coordinate in zip("xy", housing):
                stretches[direction] = {**stretches[direction], coordinate: -1.0}
        bearing = add_bearing(name, draft, station, self.law, stretches)
        support = None
        if self.housing is not None:
            support = _support(name, station, self.housing, stretches)
            add_across(name, draft, stretches)
            add_foundation_force(name, draft, self.housing, support.displacement)
        draft.add_bearing(bearing, support)


def _support(name: str, station: Station, housing: Housing, stretches: Mapping[str, Mapping[str, float]]) -> SupportDraft:
    """The housing as effects see it; its displacement is that of the ring less that across the bearing."""
    displacement: dict[str, dict[str, float]] = {}
    for key in "xy":
        ring, across = station.stretch(key), stretches[key]
        factors = {c: ring.get(c, 0.0) - across.get(c, 0.0) for c in (*ring, *across)}
        displacement[key] = {c: factor for c, factor in factors.items() if factor != 0.0}

    return SupportDraft(name, displacement, housing.mass, {"x": housing.damping_x, "y": housing.damping_y}, housing.spring)


def has_forces(law: BearingLaw) -> bool:
    """Whether a law has more than constant matrices."""
    still = dict.fromkeys(DIRECTIONS, 0.0)
    return bool(law.forces(_relative(still, still)))


def add_housing(name: str, draft: Draft, housing: Housing | None) -> tuple[str, ...]:
    """The two coordinates of a housing with its foundation; none without a housing."""
    if housing is None:
        return ()
    names = []
    for key, stiffness, damping, power in (
        ("x", housing.stiffness_x, housing.damping_x, housing.power_stiffness_x),
        ("y", housing.stiffness_y, housing.damping_y, housing.power_stiffness_y),
    ):
        coordinate = draft.add_coordinate(f"{name}.housing.{key}", inertia=housing.mass, unit="m", doc=f"housing of {name} in {key}")
        names.append(coordinate)
        draft.add_matrix(f"{name}.foundation_{key}", (), (coordinate,), stiffness=array_of([[stiffness]]), damping=array_of([[damping]]))
        if power != 0.0:
            draft.add_relative_torque(f"{name}.foundation_{key}_power", {coordinate: 1.0}, power_law(power, int(housing.power)))
    return tuple(names)


def add_housing_across(name: str, draft: Draft, station: Station, housing: Housing) -> dict[str, dict[str, float]]:
    """A housing counted by the displacement across the bearing u = x - x_h: the stretches of the law.

    A law over u and the spin is evaluated once (not for the ring and again for the housing), and under a rotor it
    is short enough for a compiled function.  Mass and foundation act on x_h = x - u.
    """
    stretches = {direction: station.stretch(direction) for direction in DIRECTIONS}
    for key, stiffness, damping, power in (
        ("x", housing.stiffness_x, housing.damping_x, housing.power_stiffness_x),
        ("y", housing.stiffness_y, housing.damping_y, housing.power_stiffness_y),
    ):
        housed = f"{name}.housing.{key}"
        across = draft.add_coordinate(
            f"{name}.across_{key}", inertia=0.0, unit="m", doc=f"displacement across {name} in {key}", shown_as=housed
        )
        row = np.zeros((1, 7))
        row[0, DIRECTIONS.index(key)], row[0, 6] = 1.0, -1.0
        square = row.T @ row
        draft.add_matrix(
            f"{name}.foundation_{key}",
            (station,),
            (across,),
            mass=scaled(housing.mass, square),
            stiffness=scaled(stiffness, square),
            damping=scaled(damping, square),
        )
        factors = {**stretches[key], across: -1.0}
        if power != 0.0:
            draft.add_relative_torque(f"{name}.foundation_{key}_power", factors, power_law(power, int(housing.power)))
        draft.add_displacement(housed, factors, "m", f"housing of {name} in {key}")
        stretches[key] = {across: 1.0}
    return stretches


def power_law(factor: float, exponent: int) -> Torque:
    """factor * x^exponent."""
    return lambda moment, x, v: factor * raised(x, exponent)


def add_bearing(name: str, draft: Draft, station: Station, law: BearingLaw, stretches: Mapping[str, Mapping[str, float]]) -> BearingDraft:
    """Matrices and forces of a law along its six stretches, and the channels of its force on the housing."""
    stiffness, damping = as_array(law.stiffness_matrix()), as_array(law.damping_matrix())
    extra = tuple(dict.fromkeys(c for factors in stretches.values() for c in factors if c not in station.names))
    names = (*station.names[:5], *extra)
    rows = np.array([[0.0 if c == "ground" else stretches[d].get(c, 0.0) for c in names] for d in DIRECTIONS])
    rows[5] = 0.0
    if any(matrix[5].any() or matrix[:, 5].any() for matrix in (stiffness, damping)):
        raise LawError(f"{name!r}: the matrices of {type(law).__name__} have entries for phi; torque about the axis belongs into forces().")
    if stiffness.any() or damping.any():
        draft.add_coordinate_matrix(f"{name}.coefficients", names, stiffness=congruent(stiffness, rows), damping=congruent(damping, rows))
    return add_law(name, draft, law, stretches)


def add_law(
    name: str, draft: Draft, law: BearingLaw, stretches: Mapping[str, Mapping[str, float]], offset: Callable[[int], float] = lambda row: 0.0
) -> BearingDraft:
    """Forces of a law on top of its matrices, along its six stretches, and the channels of its whole force on the housing.

    offset : what the channels add to the stretch of each direction [m, rad]
    """
    stiffness, damping = as_array(law.stiffness_matrix()), as_array(law.damping_matrix())

    def forces(s: Mapping[str, Value], v: Mapping[str, Value]) -> Mapping[str, Value]:
        return law.forces(_relative(s, v))

    bearing = BearingDraft(name, {key: stretches[key] for key in DIRECTIONS}, stiffness, damping, forces)
    if has_forces(law):
        draft.add_coupling(f"{name}.force", {key: dict(factors) for key, factors in stretches.items()}, lambda m, s, v: forces(s, v))
    for direction in "xy":

        def read(moment: Moment, direction: str = direction) -> Value:
            along = enumerate(stretches.items())
            s = {key: sum((f * moment.angle(c) for c, f in factors.items()), offset(k)) for k, (key, factors) in along}
            v = {key: sum(f * moment.speed(c) for c, f in factors.items()) for key, factors in stretches.items()}
            return bearing.whole(direction, s, v)

        draft.add_channel(f"{name}.force_{direction}", "N", f"force of {name} on its housing in {direction}", read)
    return bearing


def _relative(s: Mapping[str, Value], v: Mapping[str, Value]) -> RelativeMotion:
    return RelativeMotion(
        x=s["x"],
        y=s["y"],
        z=s["z"],
        psi=s["psi"],
        theta=s["theta"],
        angle=s["phi"],
        vx=v["x"],
        vy=v["y"],
        vz=v["z"],
        psi_rate=v["psi"],
        theta_rate=v["theta"],
        speed=v["phi"],
    )
