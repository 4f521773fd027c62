"""The elements of a ROSS file as plain data, with every number checked."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from hdrive_mbs.errors import FileFormatError
from hdrive_mbs.ross_file.problems import Problems

COEFFICIENTS = ("xx", "xy", "yx", "yy", "zz")


@dataclass(frozen=True, kw_only=True)
class ShaftPiece:
    """ShaftElement from node to node + 1: a cylinder [m, Pa, kg/m^3, s]."""

    name: str
    node: int
    length: float
    bore: float
    diameter: float
    youngs_modulus: float
    shear_modulus: float
    density: float
    damping: float
    shear: bool
    rotary_inertia: bool

    def like(self, other: ShaftPiece) -> bool:
        """Whether the other has the same section, length and material."""
        mine, theirs = (({**vars(piece), "name": "", "node": 0}) for piece in (self, other))
        return mine == theirs


@dataclass(frozen=True, kw_only=True)
class Disc:
    """DiskElement [kg, kg m^2]."""

    name: str
    node: int
    mass: float
    polar_inertia: float
    transverse_inertia: float


@dataclass(frozen=True, kw_only=True)
class Support:
    """BearingElement or one that is saved with the same coefficients [N/m, N s/m, rad/s].

    node, link : it acts between these nodes; link None: the ground
    frequency : where the coefficients are given; one value for constant ones
    """

    name: str
    node: int
    link: int | None
    frequency: tuple[float, ...]
    stiffness: Mapping[str, tuple[float, ...]]
    damping: Mapping[str, tuple[float, ...]]


@dataclass(frozen=True, kw_only=True)
class LumpedMass:
    """PointMass [kg], the same in x and y; axial: in z."""

    name: str
    node: int
    mass: float
    axial: float


class Entry:
    """One table of the file, read field by field."""

    def __init__(self, name: str, data: Mapping[str, Any]) -> None:
        self.name = name
        self.data = data

    def number(self, field: str, default: float | None = None) -> float:
        value = self.data.get(field)
        if value is None and default is not None:
            return default
        return self._finite(field, value)

    def node(self, field: str = "n") -> int:
        value = self.data.get(field)
        if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value < 100_000:
            raise FileFormatError(f"{self.name}: {field} = {value!r}: must be the number of a node.")
        return value

    def numbers(self, field: str) -> tuple[float, ...]:
        value = self.data.get(field)
        values = value if isinstance(value, list) else [value]
        return tuple(self._finite(f"{field}[{k}]", item) for k, item in enumerate(values))

    def switch(self, field: str, default: bool) -> bool:
        value = self.data.get(field, default)
        if not isinstance(value, bool):
            raise FileFormatError(f"{self.name}: {field} = {value!r}: must be true or false.")
        return value

    def _finite(self, field: str, value: Any) -> float:
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) < 1e300 or math.isnan(value):
            raise FileFormatError(f"{self.name}: {field} = {value!r}: must be a finite number.")
        return float(value)


def shaft_piece(entry: Entry, problems: Problems) -> ShaftPiece:
    """A shaft element; taper, axial force, torque and damping by mass do not map."""
    material = entry.data.get("material")
    if not isinstance(material, Mapping):
        raise FileFormatError(f"{entry.name}: material = {material!r}: must be a table with rho, E and G_s.")
    made = Entry(f"{entry.name}.material", material)
    bore, diameter = entry.number("idl"), entry.number("odl")
    bore_right, diameter_right = entry.number("idr", bore), entry.number("odr", diameter)
    if (bore, diameter) != (bore_right, diameter_right):
        problems.add(
            f"{entry.name}.taper", f"a cone from {diameter:g} to {diameter_right:g} m; without it, a cylinder of the mean diameters"
        )
    for field, words in (
        ("axial_force", "N: a force along the shaft that stiffens it"),
        ("torque", "N m: a torque along the shaft"),
        ("alpha", "1/s: damping in proportion to mass"),
    ):
        if entry.number(field, 0.0) != 0.0:
            problems.add(f"{entry.name}.{field}", f"{entry.number(field):g} {words}")
    if not entry.switch("gyroscopic", True):
        problems.add(f"{entry.name}.gyroscopic", "switched off; here gyroscopic moments come with the polar inertia")
    shear = entry.switch("shear_effects", True)
    if shear and entry.data.get("shear_method_calc", "cowper") != "cowper":
        problems.add(f"{entry.name}.shear_method_calc", f"{entry.data['shear_method_calc']!r}; here the coefficient is Cowper's")
    return ShaftPiece(
        name=entry.name,
        node=entry.node(),
        length=entry.number("L"),
        bore=0.5 * (bore + bore_right),
        diameter=0.5 * (diameter + diameter_right),
        youngs_modulus=made.number("E"),
        shear_modulus=made.number("G_s"),
        density=made.number("rho"),
        damping=entry.number("beta", 0.0),
        shear=shear,
        rotary_inertia=entry.switch("rotary_inertia", True),
    )


def disc(entry: Entry, problems: Problems) -> Disc:
    """A disc."""
    return Disc(
        name=entry.name,
        node=entry.node(),
        mass=entry.number("m"),
        polar_inertia=entry.number("Ip"),
        transverse_inertia=entry.number("Id"),
    )


def support(entry: Entry, problems: Problems) -> Support:
    """A bearing or seal by its saved coefficients; added mass does not map."""
    tables = {f"{kind}{axis}": entry.numbers(f"{kind}{axis}") for kind in "kc" for axis in COEFFICIENTS if f"{kind}{axis}" in entry.data}
    frequency = entry.numbers("frequency") if entry.data.get("frequency") is not None else (0.0,)
    for kind in ("k", "c"):
        if f"{kind}xx" not in tables:
            raise FileFormatError(f"{entry.name}: {kind}xx is missing; a bearing is saved with its coefficients.")
        tables.setdefault(f"{kind}yy", tables[f"{kind}xx"])
        for axis in ("xy", "yx", "zz"):
            tables.setdefault(f"{kind}{axis}", (0.0,) * len(frequency))
    for field, values in tables.items():
        if len(values) != len(frequency):
            raise FileFormatError(f"{entry.name}: {field} has {len(values)} values for {len(frequency)} frequencies.")
    for axis in COEFFICIENTS:
        if any(entry.numbers(f"m{axis}") if f"m{axis}" in entry.data else ()):
            problems.add(f"{entry.name}.m{axis}", f"added mass of {entry.numbers(f'm{axis}')[0]:g} kg")
    return Support(
        name=entry.name,
        node=entry.node(),
        link=None if entry.data.get("n_link") is None else entry.node("n_link"),
        frequency=frequency,
        stiffness={axis: tables[f"k{axis}"] for axis in COEFFICIENTS},
        damping={axis: tables[f"c{axis}"] for axis in COEFFICIENTS},
    )


def lumped_mass(entry: Entry, problems: Problems) -> LumpedMass:
    """A point mass; one that differs in x and y does not map."""
    total = entry.number("m", 0.0)
    mass, other, axial = (entry.number(field, total) for field in ("mx", "my", "mz"))
    if mass != other:
        problems.add(f"{entry.name}.my", f"{other:g} kg in y, but {mass:g} kg in x; without it, the mass in x is taken for both")
    return LumpedMass(name=entry.name, node=entry.node(), mass=mass, axial=axial)
