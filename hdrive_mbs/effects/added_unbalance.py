"""A change of the mass distribution of a rotor."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.effects.lateral_effect import moving_station
from hdrive_mbs.errors import ParameterError, PlaceError
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.rigid_mass import RigidMass


def add_unbalance(effect: Effect, draft: Draft, place: str, *, static: complex, couple: complex) -> None:
    """Move the centre of mass of a rotor by static/m and add products of inertia, the tensor about that centre otherwise kept.

    static : x + i y [kg m] in the turning frame;  couple : of the masses at +z, about the plane of the place [kg m^2]

    Raises PlaceError where the place is no rotor, ParameterError where no body has such an inertia.
    """
    kind = type(effect).__name__
    station = moving_station(effect, draft, place)
    if not draft.body(place, kind).is_rotor:
        raise PlaceError(f"{kind} acts on a rotor, but {place!r} is none: its ring has no unbalance. Put it on a Rotor part.")
    body = draft.body(place, kind).mass
    before = np.array(body.centre)
    after = before + np.array([static.real, static.imag, 0.0]) / body.mass
    # shifting the whole body already makes a couple about the place where its centre lies beside that
    more = couple + static * (station.offset - before[2])
    zero = (0.0, 0.0, 0.0)
    product = RigidMass(0.0, zero, ((0.0, 0.0, -more.real), (0.0, 0.0, -more.imag), (-more.real, -more.imag, 0.0)))
    point = RigidMass(body.mass, _vector(after), _about_origin(body.mass, after))
    gone = RigidMass(-body.mass, _vector(before), _about_origin(-body.mass, before))
    whole = body + point + gone + product
    _check(effect, place, whole)
    draft.add_mass(replace(station, offset=0.0), point)
    draft.add_mass(replace(station, offset=0.0), gone)
    draft.add_mass(replace(station, offset=0.0), product)


def _vector(values: np.ndarray) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in values)
    return x, y, z


def _about_origin(mass: float, at: np.ndarray) -> tuple[tuple[float, float, float], ...]:
    """Inertia of a point mass [kg m^2]."""
    tensor = mass * (float(at @ at) * np.eye(3) - np.outer(at, at))
    return tuple(_vector(row) for row in tensor)


def _check(effect: Effect, place: str, body: RigidMass) -> None:
    centre = np.array(body.centre)
    own = np.array(body.inertia) - np.array(_about_origin(body.mass, centre))
    moments = np.linalg.eigvalsh(own)
    if not moments[0] > 0.0:
        raise ParameterError(
            f"{effect.describe()} at {place!r} gives the rotor a principal moment of inertia of {moments[0]:.3g} kg m^2, which no body "
            "has. Make it smaller."
        )
