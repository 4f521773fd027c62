"""A shaft that stays bent."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from hdrive_mbs.effects.bow_load import Load, add_bow, added, load_of
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.effects.lateral_effect import moving_station
from hdrive_mbs.errors import ParameterError, PlaceError
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.station import Station
from hdrive_mbs.quantities import option, parameter
from hdrive_mbs.tracked_arrays import congruent, largest, proportions

FloatArray = npt.NDArray[np.float64]

SHAPES = ("load", "sine")


@dataclass(frozen=True, kw_only=True)
class ShaftBow(Effect):
    """Residual or thermal bow: the free shaft is bent, and its elastic forces turn with it.

    F = K R(f + p) q_0,  q_0(place) = A

    with the bending stiffness K of all shaft sections, the rotation R about the axis by the twisted spin angle f of the
    place, and the shape q_0 of the free shaft, which is A at the place:

    * "load": the deflection under a force at the place, the bearings as pins
    * "sine": a half sine between the bearings on both sides of the place, straight beyond them

    The torque that it puts on the spin is there too, so no energy is made.

    Source: Nicholas, Gunter, Allaire, ASME J. Eng. Power 98 (1976) 171: a bow is a force K q_0 that turns and does not
    grow with speed, a/(1 - (w/w_c)^2) on a rotor in mid-shaft.  Leaves out bows of other shapes (ShaftKink), a bow that
    changes with heat, and the unbalance of the bent shaft's own mass.
    """

    amplitude: float = parameter("m", "A, bow at the place", low=0.0, high=0.1, typical=(1e-8, 5e-4))
    phase: float = parameter("rad", "p, side to which it bends, from x towards y at spin angle 0", default=0.0, typical=(-np.pi, np.pi))
    shape: str = option("shape of the free shaft: load or sine", default="load")

    acts_on: ClassVar[str] = "rotor"
    kind: ClassVar[str] = "kinematic"
    family: ClassVar[str] = "bow"
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("amplitude", "phase"),)
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"shape": SHAPES}
    signature: ClassVar[str] = "vibration once per turn that is there at the lowest speed already and fades above the critical one"

    def check(self) -> None:
        if self.shape not in SHAPES:
            raise ParameterError(f"ShaftBow.shape = {self.shape!r}: must be one of {', '.join(SHAPES)}.")

    def apply(self, draft: Draft, place: str, name: str) -> None:
        station = moving_station(self, draft, place)
        pins = {bearing.name: draft.station(bearing.name) for bearing in draft.bearings}
        coordinates = {c for piece in draft.shafts for end in piece.ends for c in end.names}
        pins = {bearing: pin for bearing, pin in pins.items() if pin.names[0] in coordinates}
        if station.names[0] not in coordinates or len(pins) < 2:
            raise PlaceError(
                f"ShaftBow at {place!r} bends a shaft of ShaftSection parts between two bearings, and there are "
                f"{len(pins)} on it: {', '.join(pins) or 'none'}."
            )
        make = _deflected if self.shape == "load" else _half_sine
        along = (make(draft, place, station, pins, "x"), make(draft, place, station, pins, "y"))
        scaled = [{c: self.amplitude * value for c, value in load.items()} for load in along]
        add_bow(self, draft, name, station, (scaled[0], scaled[1]), self.phase)


def _deflected(draft: Draft, place: str, station: Station, pins: dict[str, Station], direction: str) -> Load:
    """Load that makes the unit deflection at the place, with its reactions at the pins."""
    names = list(dict.fromkeys(c for piece in draft.shafts for end in piece.ends for c in end.names if c != "ground"))
    stiffness = np.zeros((len(names),) * 2)
    for piece in draft.shafts:
        to = np.array([_row(piece.stretch(row.tolist()), names) for row in np.eye(12)])
        stiffness = stiffness + congruent(piece.bending, to)
    held = np.array([_row(pin.stretch(direction), names) for pin in pins.values()])
    pushed = _row(station.stretch(direction), names)
    scale = largest(stiffness)  # K q/scale = pushed - reactions, q = 0 at the pins
    whole = np.block([[proportions(stiffness, scale), held.T], [held, np.zeros((len(held),) * 2)]])
    right = np.concatenate([pushed, np.zeros(len(held))])
    solution = np.linalg.lstsq(whole, right, rcond=1e-13)[0]
    size = float(pushed @ solution[: len(names)])
    if np.max(np.abs(whole @ solution - right)) > 1e-6 or not size > 1e-12:
        raise PlaceError(f"ShaftBow at {place!r}: a force there does not bend the shaft between its bearings. Put it beside them.")
    forces = (pushed - held.T @ solution[len(names) :]) / size
    return {name: scale * force for name, force in zip(names, forces.tolist(), strict=True) if force != 0.0}


def _half_sine(draft: Draft, place: str, station: Station, pins: dict[str, Station], direction: str) -> Load:
    """Load of a half sine of height 1 at the place, with its tangents beyond the bearings."""
    below = [pin.position for pin in pins.values() if pin.position < station.position]
    above = [pin.position for pin in pins.values() if pin.position > station.position]
    if not below or not above:
        raise PlaceError(f'ShaftBow at {place!r} with the shape "sine" needs a bearing on both sides of the place; use "load".')
    start, end = max(below), min(above)
    wave = np.pi / (end - start)
    height = float(np.sin(wave * (station.position - start)))

    def at(z: float) -> tuple[float, float]:
        if start <= z <= end:
            return float(np.sin(wave * (z - start))) / height, wave * float(np.cos(wave * (z - start))) / height
        sign, edge = (1.0, start) if z < start else (-1.0, end)
        return sign * wave * (z - edge) / height, sign * wave / height

    return added([load_of(piece, _shape(piece.ends, at, direction)) for piece in draft.shafts])


def _shape(ends: tuple[Station, Station], at: Callable[[float], tuple[float, float]], direction: str) -> FloatArray:
    vector = np.zeros(12)
    for k, end in enumerate(ends):
        value, slope = at(end.position)
        if direction == "x":
            vector[6 * k], vector[6 * k + 4] = value, slope
        else:
            vector[6 * k + 1], vector[6 * k + 3] = value, -slope
    return vector


def _row(factors: dict[str, float], names: list[str]) -> FloatArray:
    return np.array([factors.get(name, 0.0) for name in names])
