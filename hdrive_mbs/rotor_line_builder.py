"""A rotor line from positions: what sits where on which shaft, and the sections between come by themselves."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from hdrive_mbs.components.component import Component
from hdrive_mbs.components.rigid_section import RigidSection
from hdrive_mbs.components.shaft_section import ShaftSection
from hdrive_mbs.errors import ParameterError, SceneError, unknown_place
from hdrive_mbs.quantities import Described, option, parameter
from hdrive_mbs.quantity import Quantity
from hdrive_mbs.scene import Scene
from hdrive_mbs.usual_values import DENSITY, SHEAR_MODULUS, YOUNGS_MODULUS

SAME_PLACE = 1e-9
"""Positions closer than this share of the length of the shaft are one."""

SHORTEST = 5e-4
"""Length of a section over that of the shaft below which it is refused: its stiffness, with the cube of that, drowns the rest."""

_POSITION = Quantity(unit="m", doc="position along the axis")
_DIAMETER = Quantity(unit="m", doc="outer diameter", above=0.0)
_BORE = Quantity(unit="m", doc="inner diameter", low=0.0)


@dataclass(frozen=True, kw_only=True)
class ShaftMaterial(Described):
    """What all sections of a shaft share; the fields are those of ShaftSection."""

    _kind = "shaft material"

    youngs_modulus: float = parameter("Pa", "E", above=0.0, **YOUNGS_MODULUS)
    shear_modulus: float = parameter("Pa", "G", above=0.0, **SHEAR_MODULUS)
    density: float = parameter("kg/m^3", "density; 0: massless", default=0.0, low=0.0, **DENSITY)
    damping: float = parameter("s", "damping over stiffness, not rotating", default=0.0, low=0.0)
    rotating_damping: float = parameter("s", "damping over bending stiffness, rotating with the shaft", default=0.0, low=0.0)
    shear: bool = option("Timoshenko beams; False: Euler-Bernoulli", default=False)
    rotary_inertia: bool = option("whether the mass of a piece of shaft resists tilting too", default=True)


@dataclass(frozen=True)
class _Step:
    """A piece of one diameter."""

    start: float
    end: float
    diameter: float
    bore: float


def rotor_line(
    name: str,
    *,
    stations: Mapping[str, tuple[float, Component]],
    shaft: float | Sequence[Sequence[float]],
    material: ShaftMaterial,
    largest_element: float | None = None,
    rigid: Sequence[tuple[str, str]] = (),
    attached: Mapping[str, tuple[str, Component]] | None = None,
    parts: Mapping[str, Component] | None = None,
    connections: Sequence[Sequence[str]] = (),
    notes: str = "",
) -> Scene:
    """A scene with one shaft, described by absolute positions z [m].

    stations : name -> (z, part), in any order: rotors, bearings
    shaft : one diameter [m] from the first station to the last, or steps (z_from, z_to, diameter) or
        (z_from, z_to, diameter, bore) that follow each other without gap; they may reach beyond the stations
    material : of the whole shaft.  Without a density the shaft is massless: then every step must end at a station
    largest_element : longest beam element [m] of a shaft with density; None: one element from each station or step to the next
    rigid : pairs of neighbouring stations with a rigid piece without mass between them (a bearing close to a rotor)
    attached : name -> (station, part): what sits rigidly at a station too (a drive, a bearing on a disc)
    parts, connections : anything further (gravity, a motor with its coupling), as in Scene

    Sections are named section_1, section_2, ... from the lowest z, each from one station or step to the next.
    Positions in results count from the beginning of the shaft.

    Raises ParameterError for a bad number and SceneError where the stations do not fit the shaft.
    """
    placed = _placed(stations)
    steps = _steps(shaft, placed)
    start, end = steps[0].start, steps[-1].end
    near = SAME_PLACE * (end - start)
    _check_places(placed, start, end, near)
    cuts = _cuts(placed, steps, near)
    hard = _rigid_pairs(rigid, [label for _, label in placed])
    _check_lengths(cuts, hard, end - start)
    made: dict[str, Component] = {label: stations[label][1] for _, label in placed}
    chain: list[str] = []
    for number, ((low, left), (high, right)) in enumerate(itertools.pairwise(cuts), start=1):
        label = f"section_{number}"
        if label in made:
            raise SceneError(f"The station name {label!r} is taken by a section of the shaft; rename the station.")
        chain += [left, label] if left else [label]
        if (left, right) in hard:
            made[label] = RigidSection(length=high - low)
        else:
            step = next(item for item in steps if item.end > 0.5 * (low + high))
            made[label] = _section(step, high - low, material, largest_element)
    chain += [cuts[-1][1]] if cuts[-1][1] else []
    _check_massless(cuts, hard, material)
    joined = _attached(attached or {}, made)
    for label, part in [*((key, item) for key, (_, item) in (attached or {}).items()), *(parts or {}).items()]:
        if label in made:
            raise SceneError(f"The name {label!r} is given twice. In use: {', '.join(made)}.")
        made[label] = part
    chains = ([tuple(chain)] if len(chain) > 1 else []) + joined
    return Scene(name=name, parts=made, connections=[*chains, *map(tuple, connections)], notes=notes)


def _is_list(value: object) -> bool:
    """Whether it is a list or tuple, and not a text."""
    return isinstance(value, Sequence) and not isinstance(value, (str, bytes))


def _number(where: str, value: object, quantity: Quantity) -> float:
    if isinstance(value, (bool, str, bytes)):
        raise ParameterError(f"{where} = {value!r}: must be a number, in {quantity.unit}.")
    try:
        number = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        raise ParameterError(f"{where} = {value!r}: must be a number, in {quantity.unit}.") from None
    quantity.check(where, number)
    return number


def _placed(stations: Mapping[str, tuple[float, Component]]) -> list[tuple[float, str]]:
    """(z, name) of all stations, from the lowest."""
    if not isinstance(stations, Mapping) or len(stations) < 1:
        raise SceneError("rotor_line has no stations; give stations={'disc': (0.2, Rotor(...)), ...}, positions in m.")
    found = []
    for label, item in stations.items():
        if not _is_list(item) or len(item) != 2 or not isinstance(item[1], Component):
            given = type(item).__name__ if isinstance(item, Component) else repr(item)
            raise ParameterError(f"stations[{label!r}] = {given}: must be (z, part), a position in m and a part.")
        found.append((_number(f"z of station {label!r}", item[0], _POSITION), label))
    return sorted(found)


def _steps(shaft: float | Sequence[Sequence[float]], placed: list[tuple[float, str]]) -> list[_Step]:
    """The shaft as steps, checked to follow each other."""
    if isinstance(shaft, (int, float)) or not _is_list(shaft):
        diameter = _number("shaft (its diameter)", shaft, _DIAMETER)
        if len(placed) < 2:
            raise SceneError("A shaft given by its diameter runs from the first station to the last, but there is only one; give steps.")
        return [_Step(placed[0][0], placed[-1][0], diameter, 0.0)]
    found: list[_Step] = []
    for number, item in enumerate(shaft, start=1):
        where = f"step {number} of the shaft"
        if not _is_list(item) or len(item) not in (3, 4):
            raise ParameterError(f"{where} = {item!r}: must be (z_from, z_to, diameter) or (z_from, z_to, diameter, bore), in m.")
        start, end = _number(f"{where}, z_from", item[0], _POSITION), _number(f"{where}, z_to", item[1], _POSITION)
        diameter = _number(f"{where}, diameter", item[2], _DIAMETER)
        bore = _number(f"{where}, bore", item[3], _BORE) if len(item) == 4 else 0.0
        if bore >= diameter:
            raise ParameterError(f"{where}: bore = {bore:g} m must be less than the diameter of {diameter:g} m.")
        if end <= start:
            what = "has no length" if end == start else "runs backwards"
            raise SceneError(f"{where.capitalize()} {what}: from z = {start:g} m to {end:g} m. Give the lower z first.")
        if found and abs(start - found[-1].end) > SAME_PLACE * max(abs(start), end - found[0].start):
            what = "a gap" if start > found[-1].end else "an overlap"
            raise SceneError(
                f"There is {what} between step {number - 1} of the shaft, which ends at z = {found[-1].end:g} m, and step {number}, which "
                f"begins at {start:g} m. Steps follow each other from the lowest z."
            )
        found.append(_Step(found[-1].end if found else start, end, diameter, bore))
    if not found:
        raise SceneError("The shaft has no steps; give its diameter, or steps (z_from, z_to, diameter), in m.")
    return found


def _check_places(placed: list[tuple[float, str]], start: float, end: float, near: float) -> None:
    """Refuse stations at one place and stations beside the shaft."""
    for (low, left), (high, right) in itertools.pairwise(placed):
        if high - low <= near:
            raise SceneError(
                f"Stations {left!r} and {right!r} are both at z = {low:g} m, so the section between them has no length. "
                f"Move one, or attach it to the other: attached={{{right!r}: ({left!r}, part)}}."
            )
    for z, label in placed:
        if not start - near <= z <= end + near:
            raise SceneError(
                f"Station {label!r} at z = {z:g} m lies outside the shaft, which runs from {start:g} m to {end:g} m. "
                "Move it, or let the shaft reach that far."
            )


def _cuts(placed: list[tuple[float, str]], steps: list[_Step], near: float) -> list[tuple[float, str]]:
    """(z, station or nothing) of all ends of sections, from the lowest."""
    ends = [steps[0].start, *(step.end for step in steps)]
    bare = [(z, "") for z in ends if all(abs(z - other) > near for other, _ in placed)]
    return sorted([*placed, *bare])


def _check_lengths(cuts: list[tuple[float, str]], hard: set[tuple[str, str]], whole: float) -> None:
    """Refuse elastic sections that are so short that rounding errors of their stiffness are those of the line."""
    for (low, left), (high, right) in itertools.pairwise(cuts):
        if high - low < SHORTEST * whole and (left, right) not in hard:
            ends = " to ".join(repr(label) if label else f"a step at z = {z:.9g} m" for z, label in ((low, left), (high, right)))
            way = "Move the step to the station." if left or right else "Make one step of them."
            if left and right:
                way = f"Move them apart, name them in rigid=[({left!r}, {right!r})], or attach one to the other."
            raise SceneError(
                f"The section from {ends} is {high - low:.3g} m long, less than {SHORTEST:g} of the shaft of {whole:.3g} m; it would be so "
                f"stiff that rounding errors drown the rest of the line. {way}"
            )


def _rigid_pairs(rigid: Sequence[tuple[str, str]], labels: Sequence[str]) -> set[tuple[str, str]]:
    """Pairs in the order of the line."""
    found = set()
    for pair in rigid:
        if not _is_list(pair) or len(pair) != 2:
            raise SceneError(f"rigid = {rigid!r}: must be pairs of stations, like [('bearing', 'disc')].")
        for label in pair:
            if label not in labels:
                raise unknown_place("station", label, labels, "This line")
        low, high = sorted(labels.index(label) for label in pair)
        if high - low != 1:
            raise SceneError(f"rigid: {pair[0]!r} and {pair[1]!r} are not neighbours. From the lowest z: {', '.join(labels)}.")
        found.add((labels[low], labels[high]))
    return found


def _section(step: _Step, length: float, material: ShaftMaterial, largest: float | None) -> ShaftSection:
    fields = {field: value for field, value, _ in material.fields()}
    count = 1
    if largest is not None:
        longest = _number("largest_element", largest, Quantity(unit="m", doc="longest beam element", above=0.0))
        if material.density == 0.0:
            raise ParameterError(
                f"largest_element = {longest:g} m: a massless shaft has no places between its stations, one element is exact there. "
                "Give the material a density (steel: 7850), or leave largest_element out."
            )
        count = math.ceil(length / longest * (1.0 - SAME_PLACE))
    return ShaftSection(length=length, diameter=step.diameter, bore=step.bore, elements=float(max(1, count)), **fields)


def _check_massless(cuts: list[tuple[float, str]], hard: set[tuple[str, str]], material: ShaftMaterial) -> None:
    """A massless shaft has no places of its own; a rigid piece must not hide a step."""
    for z, label in cuts:
        if not label and material.density == 0.0:
            raise SceneError(
                f"The massless shaft has a step or an end at z = {z:g} m where no station is, so nothing there has mass. "
                "Put a station there, shorten the shaft, or give the material a density."
            )
    neighbours = {(left, right) for (_, left), (_, right) in itertools.pairwise(cuts)}
    for pair in hard - neighbours:
        raise SceneError(f"rigid: the shaft has a step between {pair[0]!r} and {pair[1]!r}; a rigid piece has no diameter, leave it out.")


def _attached(attached: Mapping[str, tuple[str, Component]], made: Mapping[str, Component]) -> list[tuple[str, ...]]:
    """Connections of parts to the stations where they sit."""
    chains: list[tuple[str, ...]] = []
    for label, item in attached.items():
        if not _is_list(item) or len(item) != 2 or not isinstance(item[1], Component):
            raise ParameterError(f"attached[{label!r}] = {item!r}: must be (station, part).")
        if item[0] not in made:
            raise unknown_place("station", item[0], made, "This line")
        chains.append((label, item[0]))
    return chains
