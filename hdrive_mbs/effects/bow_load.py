"""The elastic forces of a shaft that is not straight when it is free, and how they turn."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.expression import Value
from hdrive_mbs.network.bearing_draft import ShaftPiece
from hdrive_mbs.network.coupling import Forces
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.excitation import Excitation
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.station import Station

FloatArray = npt.NDArray[np.float64]
Load = dict[str, float]
"""Coordinate -> force or moment per unit of bow."""


def load_of(piece: ShaftPiece, shape: FloatArray) -> Load:
    """K q_0 of one piece: what holds it in a shape [x, y, z, psi, theta, phi] of end a, then end b, at its coordinates."""
    forces = piece.bending @ shape
    result: Load = {}
    for row, force in enumerate(forces.tolist()):
        if force != 0.0:
            for name, factor in piece.stretch(np.eye(12)[row].tolist()).items():
                result[name] = result.get(name, 0.0) + factor * force
    return result


def added(loads: list[Load]) -> Load:
    """The sum of loads, without what cancels between neighbours."""
    names = dict.fromkeys(name for load in loads for name in load)
    total = {name: sum(load.get(name, 0.0) for load in loads) for name in names}
    size = {name: sum(abs(load.get(name, 0.0)) for load in loads) for name in names}
    return {name: value for name, value in total.items() if abs(value) > 1e-12 * size[name]}


def add_bow(effect: Effect, draft: Draft, name: str, spin: Station, along: tuple[Load, Load], phase: float) -> None:
    """The load turned with the spin of a station: that of a bow in x times cos(f + p) plus that of one in y times sin(f + p).

    With the energy -q.(...) of the way into the bow it makes a torque on the spin: what whirl gains, the spin loses.
    One element per station, with its share of the torque: short enough for a symbolic function.
    """
    places: dict[str, dict[str, tuple[float, float]]] = {}
    for coordinate in dict.fromkeys((*along[0], *along[1])):
        pair = along[0].get(coordinate, 0.0), along[1].get(coordinate, 0.0)
        places.setdefault(coordinate.rpartition(".")[0], {})[coordinate] = pair
    for place, load in places.items():
        stretches = {coordinate: {coordinate: 1.0} for coordinate in load} | {"phi": spin.stretch("phi")}
        draft.add_element(Excitation(f"{name} at {place}", stretches, _turning(load, phase), effect.dissipative))


def _turning(load: Mapping[str, tuple[float, float]], phase: float) -> Forces:
    def forces(moment: Moment, s: Mapping[str, Value], v: Mapping[str, Value]) -> Mapping[str, Value]:
        cosine, sine = np.cos(s["phi"] + phase), np.sin(s["phi"] + phase)
        torque: Value = 0.0 * s["phi"]
        found: dict[str, Value] = {}
        for coordinate, (x, y) in load.items():
            found[coordinate] = -_combined(x, cosine, y, sine)
            torque = torque - s[coordinate] * _combined(y, cosine, -x, sine)
        return found | {"phi": torque}

    return forces


def _combined(a: float, x: Value, b: float, y: Value) -> Value:
    """a x + b y; what is zero costs nothing."""
    terms = [factor * value for factor, value in ((a, x), (b, y)) if factor != 0.0]
    return sum(terms) if terms else 0.0 * x
