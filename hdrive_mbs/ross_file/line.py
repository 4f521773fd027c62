"""The elements of a ROSS rotor put together as a scene."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Sequence
from typing import TypeVar

from hdrive_mbs.bearings.law import BearingLaw
from hdrive_mbs.bearings.linear import LinearBearing
from hdrive_mbs.bearings.speed_table import TableBearing
from hdrive_mbs.components.bearing import Bearing
from hdrive_mbs.components.component import Component
from hdrive_mbs.components.housing import Housing
from hdrive_mbs.components.rotor import Rotor
from hdrive_mbs.components.shaft_section import ShaftSection
from hdrive_mbs.errors import FileFormatError, HdriveError
from hdrive_mbs.ross_file.elements import Disc, LumpedMass, ShaftPiece, Support
from hdrive_mbs.ross_file.problems import Problems
from hdrive_mbs.scene import Scene

Kind = TypeVar("Kind")


def scene_of(name: str, elements: Sequence[object], problems: Problems, version: str) -> Scene | None:
    """The scene; None where something was found that does not map (``problems`` has it)."""
    pieces = sorted(_of(ShaftPiece, elements), key=lambda piece: piece.node)
    _check_shaft(pieces)
    last = pieces[-1].node + 1
    parts: dict[str, Component] = {}
    places: dict[int, list[str]] = {}

    def put(label: str, node: int, part: Component) -> None:
        word = _word(label, parts)
        parts[word] = part
        places.setdefault(node, []).append(word)

    masses = {mass.node: mass for mass in _of(LumpedMass, elements)}
    supports = _of(Support, elements)
    bases = {support.node: support for support in supports if support.node > last}
    for one in _of(Disc, elements):
        if one.node > last:
            raise FileFormatError(f"{one.name} is at node {one.node}, but the shaft ends at node {last}.")
        made = _made(one.name, lambda one=one: _rotor(one))
        put(one.name, one.node, made)
    used: set[int] = set()
    for support in supports:
        if support.node > last:
            continue
        housing = None
        if support.link is not None:
            used.add(support.link)
            housing = _housing(support, bases.get(support.link), masses.get(support.link), problems)
            if housing is None:
                continue
        own = masses.get(support.node)
        mass = 0.0
        if own is not None and support.node not in used:  # it goes to the first bearing there
            used.add(support.node)
            mass = own.mass
            if own.axial != mass:
                problems.add(f"{own.name}.mz", f"{own.axial:g} kg along the axis, but {mass:g} kg across; without it, the one across")
        bearing = _made(support.name, lambda s=support, h=housing, m=mass: Bearing(law=_law(s, problems), mass=m, housing=h))
        put(support.name, support.node, bearing)
    for node, mass_there in masses.items():
        if node not in used:
            problems.add(mass_there.name, f"a point mass at node {node}, where no bearing is")
    for node, base in bases.items():
        if node not in used:
            problems.add(base.name, f"a bearing at node {node}, which no bearing of the shaft is linked to")
    chain = _chain(pieces, places, parts)
    joined = [(first, other) for first, *rest in places.values() for other in rest]
    notes = [f"From a rotor saved by ROSS {version}.", *(f"Left out: {line}." for line in problems.told)]
    if problems.is_open:
        return None
    return Scene(name=name, parts=parts, connections=[tuple(chain), *joined], notes=" ".join(notes))


def _of(kind: type[Kind], elements: Iterable[object]) -> list[Kind]:
    return [element for element in elements if isinstance(element, kind)]


def _made(label: str, make: object) -> Component:
    try:
        made: Component = make()  # type: ignore[operator]
    except HdriveError as error:
        raise type(error)(f"{label}: {error}") from error
    return made


def _check_shaft(pieces: Sequence[ShaftPiece]) -> None:
    for before, after in itertools.pairwise(pieces):
        if after.node == before.node:
            raise FileFormatError(
                f"{before.name} and {after.name} lie over each other at node {after.node}; a shaft in layers does not map."
            )
        if after.node != before.node + 1:
            raise FileFormatError(
                f"The shaft has a gap: {before.name} ends at node {before.node + 1}, {after.name} begins at {after.node}."
            )
    if pieces[0].node != 0:
        raise FileFormatError(f"The shaft begins at node {pieces[0].node} ({pieces[0].name}), not at node 0.")


def _word(label: str, taken: Iterable[str]) -> str:
    """A plain word for a tag, each once: "Disk 0" -> disk_0."""
    stem = re.sub(r"\W+", "_", label.lower(), flags=re.ASCII).strip("_") or "part"
    stem = stem if stem[0].isalpha() and stem != "ground" and not re.fullmatch(r"section_\d+", stem) else f"ross_{stem}"
    word, number = stem, 2
    while word in taken:
        word, number = f"{stem}_{number}", number + 1
    return word


def _chain(pieces: Sequence[ShaftPiece], places: dict[int, list[str]], parts: dict[str, Component]) -> list[str]:
    """The line from node 0 on; like elements without anything between them become one section."""
    chain = places.get(0, [])[:1]
    count = 0
    start = 0
    for k, piece in enumerate(pieces):
        end = k + 1 == len(pieces)
        if not end and piece.node + 1 not in places and pieces[k + 1].like(piece):
            continue
        number = k + 1 - start
        count += 1
        section = f"section_{count}"
        parts[section] = _made(piece.name, lambda piece=piece, number=number: _section(piece, number))
        chain += [section, *places.get(piece.node + 1, [])[:1]]
        start = k + 1
    return chain


def _section(piece: ShaftPiece, number: int) -> ShaftSection:
    return ShaftSection(
        length=number * piece.length,
        diameter=piece.diameter,
        bore=piece.bore,
        youngs_modulus=piece.youngs_modulus,
        shear_modulus=piece.shear_modulus,
        density=piece.density,
        elements=float(number),
        shear=piece.shear,
        rotary_inertia=piece.rotary_inertia,
        damping=piece.damping,
    )


def _rotor(one: Disc) -> Rotor:
    return Rotor(mass=one.mass, polar_inertia=one.polar_inertia, transverse_inertia=one.transverse_inertia)


def _law(support: Support, problems: Problems) -> BearingLaw:
    """Constant coefficients, or a table over the speed."""
    stiffness, damping = support.stiffness, support.damping
    if len(support.frequency) == 1:
        values = {f"{kind}_{axis}": table[axis][0] for kind, table in (("stiffness", stiffness), ("damping", damping)) for axis in table}
        return LinearBearing(**values)  # type: ignore[arg-type]
    for field, table in (("kzz", stiffness["zz"]), ("czz", damping["zz"])):
        if len(set(table)) > 1:
            problems.add(f"{support.name}.{field}", "an axial coefficient that depends on frequency; without it, the first value holds")
    tables = {
        f"{kind}_{axis}": table[axis] for kind, table in (("stiffness", stiffness), ("damping", damping)) for axis in table if axis != "zz"
    }
    return TableBearing(speeds=support.frequency, axial_stiffness=stiffness["zz"][0], axial_damping=damping["zz"][0], **tables)  # type: ignore[arg-type]


def _housing(support: Support, base: Support | None, mass: LumpedMass | None, problems: Problems) -> Housing | None:
    """The mass behind a bearing and what holds it; None where it is more than a housing that moves in x and y."""
    node = support.link
    if base is None or mass is None or mass.mass == 0.0:
        missing = "no bearing from there to the ground" if base is None else "no point mass there"
        problems.add(support.name, f"it is linked to node {node}, and there is {missing}; a housing has a mass and a foundation")
        return None
    if base.link is not None:
        problems.add(support.name, f"its support {base.name} stands on a further node; here a housing stands on the ground")
        return None
    if len(base.frequency) > 1:
        problems.add(f"{base.name}.frequency", "a foundation that depends on frequency; without that, the first values hold")
    for kind, table in (("k", base.stiffness), ("c", base.damping)):
        if table["xy"][0] or table["yx"][0]:
            problems.add(f"{base.name}.{kind}xy", "a foundation that couples x and y")
        if table["zz"][0]:
            problems.add(f"{base.name}.{kind}zz", "an axial foundation; here a housing moves in x and y only")
    return Housing(
        mass=mass.mass,
        stiffness_x=base.stiffness["xx"][0],
        stiffness_y=base.stiffness["yy"][0],
        damping_x=base.damping["xx"][0],
        damping_y=base.damping["yy"][0],
    )
