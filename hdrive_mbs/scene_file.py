"""Scenes to and from TOML and JSON, every number with its unit.  No code is executed from a file."""

from __future__ import annotations

import dataclasses
import difflib
import importlib
import inspect
import json
import os
import pkgutil
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from hdrive_mbs import bearings, components, effects, flexsplines, loads, motors, teeth
from hdrive_mbs.components.component import Component
from hdrive_mbs.documents import read_document
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.errors import FileFormatError, HdriveError, PlaceError, UnitError
from hdrive_mbs.quantities import Described
from hdrive_mbs.quantity import Quantity
from hdrive_mbs.scene import PlacedEffect, Scene
from hdrive_mbs.units import factor, to_si
from hdrive_mbs.writing import write_text

FORMAT = "hdrive-mbs scene 1"
MOST = 30
"""Types that an error lists; of more only those that are spelt alike."""


# -- out ------------------------------------------------------------------------------------------


def scene_to_dict(scene: Scene) -> dict[str, Any]:
    """Plain data of a scene.  Raises FileFormatError when it holds Python functions."""
    document: dict[str, Any] = {"format": FORMAT, "name": scene.name}
    if scene.notes:
        document["notes"] = scene.notes
    document["connections"] = [list(chain) for chain in scene.connections]
    document["parts"] = {name: _plain(part, name) for name, part in scene.parts.items()}
    if scene.effects:
        document["effects"] = {e.name: {"at": e.at, **_plain(e.effect, e.name)} for e in scene.effects}
    return document


def _plain(item: Described, where: str) -> dict[str, Any]:
    result: dict[str, Any] = {"type": type(item).__name__}
    for field in dataclasses.fields(item):
        value = getattr(item, field.name)
        path = f"{where}.{field.name}"
        if value is None:
            continue
        quantity: Quantity | None = field.metadata.get("quantity")
        if quantity is not None and quantity.sequence:
            result[field.name] = {"unit": quantity.unit, "values": list(value)}
        elif quantity is not None:
            result[field.name] = value if quantity.unit == "1" else f"{value!r} {quantity.unit}"
        elif isinstance(value, Described):
            result[field.name] = _plain(value, path)
        elif isinstance(value, (str, bool, int, float)):
            result[field.name] = value
        elif isinstance(value, tuple) and all(isinstance(entry, Described) for entry in value):
            result[field.name] = [_plain(entry, f"{path}[{k}]") for k, entry in enumerate(value)]
        elif isinstance(value, tuple) and all(isinstance(entry, (str, bool, int, float)) for entry in value):
            result[field.name] = list(value)
        else:
            raise FileFormatError(
                f"{path} is a Python {type(value).__name__}, which a scene file cannot hold. "
                "Write the law as a class (one file, see StiffnessLaw, LoadLaw, Effect), or keep the scene in a .py file."
            )
    return result


def save_scene(scene: Scene, path: str | os.PathLike[str], *, head: Sequence[str] = ()) -> Path:
    """Write a scene as .toml or .json, whole or not at all.

    head : lines of a comment at the top of a .toml file; JSON has no comments
    """
    import tomli_w

    suffix = Path(path).suffix.lower()
    document = scene_to_dict(scene)
    if suffix == ".toml":
        return write_text(path, "".join(f"# {_one_line(line)}\n" for line in head) + tomli_w.dumps(document))
    if suffix == ".json":
        return write_text(path, json.dumps(document, indent=2) + "\n")
    raise FileFormatError(f"{path}: a scene file ends in .toml or .json.")


def _one_line(text: str) -> str:
    """Without line ends and other control characters, which a comment must not have."""
    return "".join(letter for letter in " ".join(text.split()) if letter.isprintable())


# -- in -------------------------------------------------------------------------------------------


def load_scene(path: str | os.PathLike[str], types: Iterable[type[Described]] = ()) -> Scene:
    """Read a scene from .toml or .json.

    types : classes of a user's own that the file names (those already imported are found anyway)

    Raises FileFormatError, UnitError or ParameterError with the path of the entry at fault.
    """
    document = read_document(Path(path))
    try:
        return scene_from_dict(document, types)
    except HdriveError as error:
        raise type(error)(f"{path}: {error}") from error
    except RecursionError as error:
        raise FileFormatError(f"{path} cannot be parsed: its tables are nested too deep.") from error


def scene_from_dict(document: Any, types: Iterable[type[Described]] = ()) -> Scene:
    """A scene from plain data (the inverse of scene_to_dict)."""
    if not isinstance(document, Mapping) or document.get("format") != FORMAT:
        found = document.get("format") if isinstance(document, Mapping) else type(document).__name__
        raise FileFormatError(f"not a scene: 'format' must be {FORMAT!r}, found {found!r}.")
    allowed = {"format", "name", "notes", "connections", "parts", "effects"}
    for key in document:
        if key not in allowed:
            raise FileFormatError(f"unknown entry {key!r}; a scene has {', '.join(sorted(allowed))}.")
    known = _known_types(types)
    parts = {name: _build(entry, f"parts.{name}", (Component,), known) for name, entry in _mapping(document, "parts").items()}
    placed = []
    for effect_name, entry in _mapping(document, "effects", optional=True).items():
        inner = dict(_as_mapping(entry, f"effects.{effect_name}"))
        at = inner.pop("at", None)
        if not isinstance(at, str):
            raise FileFormatError(f"effects.{effect_name}: 'at' must name a place.")
        placed.append((effect_name, _build(inner, f"effects.{effect_name}", (Effect,), known), at))
    chains = document.get("connections", [])
    if not isinstance(chains, list) or not all(isinstance(c, list) and all(isinstance(p, str) for p in c) for c in chains):
        raise FileFormatError("connections: must be a list of lists of places.")
    notes = document.get("notes", "")
    name = document.get("name")
    if not isinstance(name, str) or not isinstance(notes, str):
        raise FileFormatError("name and notes: must be texts.")
    scene = Scene(name=name, parts=parts, connections=chains, notes=notes)  # type: ignore[arg-type]
    for effect_name, effect, at in placed:
        scene = scene.with_effect(effect, at=at, name=effect_name)  # type: ignore[arg-type]
    return scene


def _as_mapping(entry: Any, where: str) -> Mapping[str, Any]:
    if not isinstance(entry, Mapping):
        raise FileFormatError(f"{where}: must be a table, found {type(entry).__name__}.")
    return entry


def _mapping(document: Mapping[str, Any], key: str, optional: bool = False) -> Mapping[str, Any]:
    if key not in document:
        if optional:
            return {}
        raise FileFormatError(f"{key!r} is missing.")
    return _as_mapping(document[key], key)


def all_types() -> dict[str, type[Described]]:
    """Every described class of the package and of what the caller has imported, by name."""
    return _known_types(())


def _known_types(extra: Iterable[type[Described]]) -> dict[str, type[Described]]:
    for package in (bearings, components, effects, flexsplines, loads, motors, teeth):
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            importlib.import_module(module.name)
    found: dict[str, type[Described]] = {}
    stack: list[type[Described]] = [Described]
    while stack:
        for child in stack.pop().__subclasses__():
            found[child.__name__] = child
            stack.append(child)
    return found | {kind.__name__: kind for kind in extra}


def _usable(kind: type[Described]) -> bool:
    """Whether a file can name the class: it is no base class and does not need a Python function."""
    functions = any(str(field.type).startswith("Callable[") for field in dataclasses.fields(kind))
    return not (inspect.isabstract(kind) or "_kind" in vars(kind) or functions)


def _expected(field: dataclasses.Field[Any], known: Mapping[str, type[Described]]) -> tuple[type[Described], ...]:
    """The described classes that the annotation of a field names."""
    return tuple(known[word] for word in re.findall(r"\w+", str(field.type)) if word in known)


def _choice(name: str, kinds: list[str]) -> str:
    """The types that there can be: all where they are few, else those that are spelt alike."""
    if len(kinds) <= MOST:
        return f"it can be {', '.join(kinds)}"
    near = difflib.get_close_matches(name, kinds, 5, 0.5)
    which = f"; like it are {', '.join(near)}" if near else ", none of them spelt like it"
    return f"it can be one of {len(kinds)} types{which} (hdrive-mbs effects lists the effects)"


def _build(entry: Any, where: str, bases: tuple[type[Described], ...], known: Mapping[str, type[Described]]) -> Described:
    kinds = {key: kind for key, kind in known.items() if issubclass(kind, bases) and _usable(kind)}
    if not isinstance(entry, Mapping):
        raise FileFormatError(f"{where} = {entry!r}: must be a table with a type, one of: {', '.join(sorted(kinds))}.")
    data = dict(entry)
    name = data.pop("type", None)
    kind = kinds.get(name) if isinstance(name, str) else None
    if kind is None:
        raise PlaceError(
            f"No type {str(name)!r}. {where}: {_choice(str(name), sorted(kinds))}. For a class of your own import its module "
            "first, or use load_scene(path, types=[...]); on the command line give its file with --effects FILE.py."
        )
    fields = {field.name: field for field in dataclasses.fields(kind)}
    values: dict[str, Any] = {}
    for key, value in data.items():
        path = f"{where}.{key}"
        if key not in fields:
            raise FileFormatError(f"{path}: unknown entry. {kind.__name__} has: {', '.join(fields)}.")
        values[key] = _value(value, path, fields[key], known)
    missing = [
        field.name
        for field in fields.values()
        if field.name not in values and field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING
    ]
    if missing:
        raise FileFormatError(f"{where}: {', '.join(missing)} of {kind.__name__} missing.")
    try:
        return kind(**values)
    except HdriveError as error:
        raise type(error)(f"{where}: {error}") from error
    except Exception as error:  # a class of a user's own, or a base class that is not meant to be built
        raise FileFormatError(f"{where}: no {kind.__name__} can be made of these values ({type(error).__name__}: {error}).") from error


def _value(value: Any, path: str, field: dataclasses.Field[Any], known: Mapping[str, type[Described]]) -> Any:
    quantity: Quantity | None = field.metadata.get("quantity")
    if quantity is None:
        bases = _expected(field, known)
        if isinstance(value, list):
            return tuple(_build(item, f"{path}[{k}]", bases, known) if bases else item for k, item in enumerate(value))
        if value is None or not bases:
            return value
        return _build(value, path, bases, known)
    if quantity.sequence:
        return _sequence(value, path, quantity)
    if isinstance(value, str):
        return to_si(value, quantity.unit, path)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise FileFormatError(f"{path} = {value!r}: must be a number with a unit, like '1.0 {quantity.unit}'.")
    if quantity.unit != "1":
        raise UnitError(f"{path} = {value!r} has no unit; write it as text, like '{value!r} {quantity.unit}'.")
    return value


def _sequence(value: Any, path: str, quantity: Quantity) -> tuple[Any, ...]:
    if not isinstance(value, Mapping) or set(value) != {"unit", "values"} or not isinstance(value["values"], list):
        raise FileFormatError(f"{path}: must be a table {{ unit = '{quantity.unit}', values = [...] }}.")
    for index, item in enumerate(value["values"]):
        if isinstance(item, bool) or not isinstance(item, (int, float)):
            raise FileFormatError(f"{path}.values[{index}] = {item!r}: must be a number.")
    if not isinstance(value["unit"], str):
        raise UnitError(f"{path}.unit = {value['unit']!r}: must be a text like '{quantity.unit}'.")
    if value["unit"] == quantity.unit:
        return tuple(value["values"])
    to_unit = factor(value["unit"], quantity.unit, path)
    try:
        return tuple(item * to_unit for item in value["values"])
    except OverflowError:
        raise FileFormatError(f"{path}: holds a whole number of over 300 digits.") from None


def parse_setting(scene: Scene, text: str) -> tuple[str, Any]:
    """``motor.inertia=2e-3`` or ``motor.inertia=20 g*m^2`` -> path and SI value.

    A bare number is SI.  Raises FileFormatError without '=' and PlaceError for an unknown path.
    """
    path, sign, value = text.partition("=")
    path = path.strip()
    if not sign or not path:
        raise FileFormatError(f"{text!r}: write PATH=VALUE, like motor.inertia=2e-3.")
    parameters = scene.parameters()
    if path not in parameters:
        return path, _plain_setting(value.strip())
    try:
        return path, float(value)
    except ValueError:
        return path, to_si(value, parameters[path].unit, path)


def _plain_setting(value: str) -> Any:
    words = {"true": True, "false": False}
    if value.lower() in words:
        return words[value.lower()]
    try:
        return float(value)
    except ValueError:
        return value


__all__ = ["FORMAT", "PlacedEffect", "all_types", "load_scene", "parse_setting", "save_scene", "scene_from_dict", "scene_to_dict"]
