"""Files of ``Rotor.save`` of ROSS, TOML or JSON, as scenes."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from hdrive_mbs.documents import read_document
from hdrive_mbs.errors import FileFormatError, HdriveError
from hdrive_mbs.ross_file import elements
from hdrive_mbs.ross_file.elements import Disc, Entry, LumpedMass, ShaftPiece, Support
from hdrive_mbs.ross_file.line import scene_of
from hdrive_mbs.ross_file.problems import Problems
from hdrive_mbs.scene import Scene

Element = ShaftPiece | Disc | Support | LumpedMass

READERS: dict[str, Callable[[Entry, Problems], Element]] = {
    "ShaftElement": elements.shaft_piece,
    "DiskElement": elements.disc,
    "PointMass": elements.lumped_mass,
    **dict.fromkeys(
        (
            "BearingElement",
            "SealElement",
            "BallBearingElement",
            "RollerBearingElement",
            "CylindricalBearing",
            "BearingFluidFlow",
            "PlainJournal",
            "TiltingPad",
            "SqueezeFilmDamper",
            "HolePatternSeal",
            "HybridSeal",
            "LabyrinthSeal",
        ),
        elements.support,
    ),
}
"""Class in ROSS -> its reader; bearings and seals are all taken by the coefficients that ROSS has saved."""


def load_ross(path: str | os.PathLike[str], *, leave_out: Sequence[str] = (), name: str | None = None) -> Scene:
    """A scene from a rotor that ROSS has saved (``Rotor.save``, .toml or .json; written for ROSS 2.3).

    leave_out : names of what does not map and may be left out, like "Seal 2" or "*.alpha"; the error lists them
    name : of the scene; that of the file if not given

    Shaft elements become ShaftSections with as many elements, discs become balanced Rotors, bearings Bearings, and a
    point mass at the far node of a bearing with what holds it becomes the bearing's Housing.  Coefficients over
    frequency become a table over the speed, as ROSS takes them for a Campbell diagram, with straight lines between the
    points where ROSS puts a curve.  Does not map: couplings, gears, magnetic bearings, cones, damping in proportion to
    mass, axial force, added mass.

    Raises FileFormatError for a file that is damaged or no rotor of ROSS, and one that lists all that does not map.
    """
    return read_rotor(path, leave_out=leave_out, name=name)[0]


def read_rotor(path: str | os.PathLike[str], *, leave_out: Sequence[str] = (), name: str | None = None) -> tuple[Scene, tuple[str, ...]]:
    """``load_ross``, and what was left out of the scene, with the reason of each."""
    source = Path(path)
    document = _document(source)
    problems = Problems(leave_out)
    found: list[Element] = []
    for key, data in document.items():
        kind, sign, tag = key.partition("_")
        if key in ("parameters", "ross_version") or key.startswith("_"):
            continue
        if not isinstance(data, Mapping) or not sign:
            raise FileFormatError(f"{path}: {key!r} is no element of a ROSS rotor, which are named like 'DiskElement_Disk 0'.")
        given = data.get("tag")
        label = given if isinstance(given, str) and given else tag or key
        if kind not in READERS:
            problems.add(label, f"a {kind}")
            continue
        try:
            found.append(READERS[kind](Entry(label, data), problems))
        except HdriveError as error:
            raise type(error)(f"{path}: {error}") from error
    try:
        scene = scene_of(name or source.stem, found, problems, str(document.get("ross_version", "unknown")))
    except HdriveError as error:
        raise FileFormatError(f"{path}: {error}") from error
    problems.check(source)
    assert scene is not None
    return scene, tuple(problems.told)


def is_rotor(document: Any) -> bool:
    """Whether what a file holds is a rotor saved by ROSS, by its table of parameters and its shaft elements."""
    return isinstance(document, dict) and "parameters" in document and any(key.startswith("ShaftElement_") for key in document)


def _document(path: Path) -> dict[str, Any]:
    document = read_document(path)
    if not is_rotor(document):
        raise FileFormatError(f"{path} is no rotor saved by ROSS: it has no table 'parameters' or no 'ShaftElement_...'.")
    found: dict[str, Any] = document
    return found
