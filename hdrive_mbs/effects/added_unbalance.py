"""A change of the mass distribution of a rotor."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.effects.lateral_effect import moving_station
from hdrive_mbs.errors import ParameterError, PlaceError
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.rigid_mass import RigidMass

Pair = tuple[float, float]


def add_unbalance(effect: Effect, draft: Draft, place: str, *, static: Pair, couple: Pair) -> None:
    """Move the centre of mass of a rotor by static/m and add products of inertia, the tensor about that centre otherwise kept.

    static : x and y [kg m] in the turning frame;  couple : of the masses at +z, about the plane of the place [kg m^2]

    Raises PlaceError where the place is no rotor, ParameterError where no body has such an inertia.
    """
    kind = type(effect).__name__
    station = moving_station(effect, draft, place)
    if not draft.body(place, kind).is_rotor:
        raise PlaceError(f"{kind} acts on a rotor, but {place!r} is none: its ring has no unbalance. Put it on a Rotor part.")
    body = draft.body(place, kind).mass
    x, y, z = body.centre
    after = (x + static[0] / body.mass, y + static[1] / body.mass, z)
    # shifting the whole body already makes a couple about the place where its centre lies beside that
    more_x, more_y = (own + (station.offset - z) * moved for own, moved in zip(couple, static, strict=True))
    product = RigidMass(0.0, (0.0, 0.0, 0.0), ((0.0, 0.0, -more_x), (0.0, 0.0, -more_y), (-more_x, -more_y, 0.0)))
    point, gone = RigidMass.point(body.mass, after), RigidMass.point(-body.mass, body.centre)
    _check(effect, place, body + point + gone + product)
    for change in (point, gone, product):
        draft.add_mass(replace(station, offset=0.0), change)


def _check(effect: Effect, place: str, body: RigidMass) -> None:
    own = np.array(body.inertia, float) - np.array(RigidMass.point(body.mass, body.centre).inertia, float)
    moments = np.linalg.eigvalsh(own)
    if not moments[0] > 0.0:
        raise ParameterError(
            f"{effect.describe()} at {place!r} gives the rotor a principal moment of inertia of {moments[0]:.3g} kg m^2, which no body "
            "has. Make it smaller."
        )
