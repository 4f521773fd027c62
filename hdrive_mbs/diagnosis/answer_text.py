"""Looks and fits as plain data (for JSON) and arrays, and back.

Classes are written as module and name, and read back only as classes of the question or of a fixed list: a file cannot
make this program import or run anything.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np

from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.locate.latent_force import LatentForce, TurnedForce
from hdrive_mbs.diagnosis.located import Located
from hdrive_mbs.diagnosis.result import Place
from hdrive_mbs.diagnosis.screening import Look
from hdrive_mbs.diagnosis.unknowns import Factor

ANSWERS: tuple[type, ...] = (Look, Fitted, Hypothesis, Added, Factor, Located, Place, LatentForce, TurnedForce)
"""Classes that an answer may hold besides those of its question: effects and their laws."""


def as_plain(value: Any, arrays: dict[str, Any]) -> Any:
    """Plain data for a value; arrays go into ``arrays`` by a name.  Raises TypeError for anything else."""
    if isinstance(value, np.generic):
        value = value.item()
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, np.ndarray) and value.dtype != object:
        name = f"a{len(arrays)}"
        arrays[name] = value
        return {"array": name}
    if isinstance(value, (tuple, list)):
        return {type(value).__name__: [as_plain(item, arrays) for item in value]}
    if isinstance(value, Mapping):
        return {"map": [[as_plain(key, arrays), as_plain(item, arrays)] for key, item in value.items()]}
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        fields = {item.name: as_plain(getattr(value, item.name), arrays) for item in dataclasses.fields(value) if item.init}
        return {"class": _name(type(value)), "fields": fields}
    raise TypeError(f"{type(value).__name__} cannot be kept as plain data.")


def from_plain(plain: Any, arrays: Mapping[str, Any], question: Any) -> Any:
    """The value again.  Raises KeyError for a class that belongs neither to answers nor to the question."""
    known = {_name(kind): kind for kind in ANSWERS}
    _classes(question, known, set())
    return _read(plain, arrays, known)


def _read(plain: Any, arrays: Mapping[str, Any], known: Mapping[str, type]) -> Any:
    if not isinstance(plain, dict):
        return plain
    if "array" in plain:
        return arrays[plain["array"]]
    if "tuple" in plain:
        return tuple(_read(item, arrays, known) for item in plain["tuple"])
    if "list" in plain:
        return [_read(item, arrays, known) for item in plain["list"]]
    if "map" in plain:
        return {_read(key, arrays, known): _read(item, arrays, known) for key, item in plain["map"]}
    return known[plain["class"]](**{name: _read(item, arrays, known) for name, item in plain["fields"].items()})


def _name(kind: type) -> str:
    return f"{kind.__module__}:{kind.__qualname__}"


def _classes(value: Any, known: dict[str, type], met: set[int]) -> None:
    """Data classes of a question and of all that it holds."""
    if id(value) in met or isinstance(value, (str, float, int, np.ndarray)) or value is None:
        return
    met.add(id(value))
    if isinstance(value, (tuple, list)):
        for item in value:
            _classes(item, known, met)
    elif isinstance(value, partial):
        _classes((value.args, value.keywords), known, met)
    elif isinstance(value, Mapping):
        for item in value.values():
            _classes(item, known, met)
    elif dataclasses.is_dataclass(value) and not isinstance(value, type):
        known[_name(type(value))] = type(value)
        for field in dataclasses.fields(value):
            _classes(getattr(value, field.name), known, met)
