"""Scenes for the command line: SCENE.py with build(), a scene file or a rotor saved by ROSS, with --set and --effect."""

from __future__ import annotations

import dataclasses
import importlib.util
import inspect
import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

from hdrive_mbs.cli.python_file import own_types
from hdrive_mbs.documents import read_document
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.errors import FileFormatError, ParameterError, SceneError, unknown_place
from hdrive_mbs.quantities import Described
from hdrive_mbs.quantity import Quantity
from hdrive_mbs.ross_file.reading import is_rotor, load_ross
from hdrive_mbs.scene import Scene
from hdrive_mbs.scene_file import all_types, load_scene, parse_setting
from hdrive_mbs.units import to_si


def open_scene(path: Path, settings: Sequence[str] = (), effects: Sequence[str] = (), own: Sequence[Path] = ()) -> Scene:
    """The scene of a .py file (its ``build()``) or of a .toml or .json file (``load_file``), with changes applied.

    settings : ``PATH=VALUE``; a name without a dot that is an argument of build() is passed to it; values of
        effects are set too, those of ``effects`` among them
    effects : ``TYPE@PLACE:field=value,field=value``
    own : .py files with classes that these or the scene file name
    """
    kinds = [kind for file in own for kind in own_types(file)]
    if path.suffix == ".py":
        scene, rest = _build(path, settings)
    else:
        scene, rest = load_file(path, kinds), list(settings)
    for text in effects:
        effect, place = parse_effect(text)
        scene = scene.with_effect(effect, at=place)
    for text in rest:
        name, value = parse_setting(scene, text)
        scene = scene.replacing({name: value})
    return scene


def load_file(path: Path, types: Iterable[type[Described]] = ()) -> Scene:
    """The scene of a .toml or .json file, which holds a scene of ours or a rotor saved by ROSS: its content says which.

    types : classes of a user's own that a scene names

    Raises FileFormatError for a rotor with anything that does not map, and lists all of it.
    """
    return load_ross(path) if is_rotor(read_document(path)) else load_scene(path, types)


def module_of(path: Path) -> ModuleType:
    """The module in a .py file, run once."""
    if not path.is_file():
        raise FileFormatError(f"{path}: no such file. Give a .py file with build() -> Scene, or a .toml or .json scene.")
    spec = importlib.util.spec_from_file_location(f"scene_file_{path.stem}", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    beside = str(path.resolve().parent)
    if beside not in sys.path:
        sys.path.insert(0, beside)  # as python itself does for a script: a scene may import what lies beside it
    sys.modules[spec.name] = module  # a dataclass in the file looks its module up there
    sys.modules[module.__name__] = module  # dataclasses of a scene's own look their module up there
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[module.__name__]
        raise
    return module


def call(function: Callable[..., Any], settings: Sequence[str]) -> tuple[Any, list[str]]:
    """The function with those NAME=VALUE settings that are arguments of it, and the other settings."""
    wanted = inspect.signature(function).parameters
    arguments: dict[str, Any] = {}
    rest = []
    for text in settings:
        name, sign, value = text.partition("=")
        if sign and name.strip() in wanted:
            arguments[name.strip()] = _plain(value.strip())
        else:
            rest.append(text)
    return function(**arguments), rest


def _build(path: Path, settings: Sequence[str]) -> tuple[Scene, list[str]]:
    build = getattr(module_of(path), "build", None)
    if build is None:
        raise SceneError(f"{path} has no function build() that returns a Scene.")
    scene, rest = call(build, settings)
    if not isinstance(scene, Scene):
        raise SceneError(f"{path}: build() returned a {type(scene).__name__}, not a Scene.")
    return scene, rest


def _plain(value: str) -> Any:
    try:
        return float(value)
    except ValueError:
        return {"true": True, "false": False}.get(value.lower(), value)


def effect_types() -> dict[str, type[Effect]]:
    """All effect classes that can be put into a scene, by name."""
    return {name: kind for name, kind in sorted(all_types().items()) if issubclass(kind, Effect) and not inspect.isabstract(kind)}


def parse_effect(text: str) -> tuple[Effect, str]:
    """``CoulombStribeckFriction@load:coulomb=2 N m,smoothing_speed=0.02`` -> effect and place."""
    head, _, fields = text.partition(":")
    name, sign, place = head.partition("@")
    kinds = effect_types()
    if not sign or not place:
        raise FileFormatError(f"{text!r}: write TYPE@PLACE:field=value,field=value.")
    if name not in kinds:
        raise unknown_place("effect", name, kinds, "The library (with what the scene's .py file imports, and --effects FILE.py)")
    known: dict[str, Quantity | None] = {field.name: field.metadata.get("quantity") for field in dataclasses.fields(kinds[name])}
    values: dict[str, Any] = {}
    for item in filter(None, fields.split(",")):
        key, equal, value = (part.strip() for part in item.partition("="))
        if not equal or key not in known:
            raise unknown_place("field", key, known, name)
        quantity = known[key]
        values[key] = _plain(value) if quantity is None else _number(value, quantity, f"{name}.{key}")
    try:
        return kinds[name](**values), place
    except ParameterError as error:
        raise ParameterError(f"{text!r}: {error}") from None


def _number(value: str, quantity: Quantity, where: str) -> float:
    try:
        return float(value)
    except ValueError:
        return to_si(value, quantity.unit, where)
