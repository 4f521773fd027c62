"""What makes two jobs the same: the function with all of the caller's code it reaches, the point, and the versions."""

from __future__ import annotations

import dataclasses
import functools
import hashlib
import inspect
import json
import pickle
import site
import sysconfig
import types
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from hdrive_mbs.analysis.result import versions

COUNTED = ("hdrive-mbs", "exudyn", "numpy", "scipy")
"""Packages whose version makes a job another one."""


def fingerprint(function: Any) -> str:
    """Hash of a function or callable object.

    It sees the source text of the function and of every function, class, constant and module of the caller's own that
    the text names, and the fields of an object.  It does not see data files, the environment, what is reached only by
    ``getattr`` or ``importlib``, and packages that are installed (of those that compute, the version counts).
    """
    return _digest(_Reader().identity(function))


def job_key(function: str, point: Mapping[str, Any]) -> str:
    """Name of a job's file: the hash of fingerprint, point and versions."""
    found = versions()
    return _digest([function, sorted(point.items()), [found[name] for name in COUNTED]])[:32]


def _digest(value: Any) -> str:
    return hashlib.sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()


class _Reader:
    """Walks from an object to all that it is made of, each thing once."""

    def __init__(self) -> None:
        self._met: dict[int, int] = {}
        self._kept: list[Any] = []  # so that no id is used twice

    def identity(self, value: Any) -> Any:
        """Plain data that differs where the object differs."""
        if value is None or isinstance(value, (str, bool, int)):
            return value
        if isinstance(value, float):
            return repr(value)
        if isinstance(value, np.ndarray) and value.dtype != object:
            return ["array", str(value.dtype), list(value.shape), hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest()]
        if id(value) in self._met:
            return ["met", self._met[id(value)]]
        self._met[id(value)] = len(self._met)
        self._kept.append(value)
        return self._compound(value)

    def _compound(self, value: Any) -> Any:
        if isinstance(value, Mapping):
            return ["map", [[self.identity(key), self.identity(item)] for key, item in value.items()]]
        if isinstance(value, (tuple, list)):
            return ["list", [self.identity(item) for item in value]]
        if isinstance(value, functools.partial):
            return ["partial", *map(self.identity, (value.func, value.args, value.keywords))]
        if isinstance(value, types.MethodType):
            return ["method", value.__func__.__name__, self.identity(value.__self__), self.identity(value.__func__)]
        if isinstance(value, types.ModuleType):
            return ["module", value.__name__, _text(value) if _is_own(value) else ""]
        if isinstance(value, (types.FunctionType, type)):
            return self._code(value)
        if dataclasses.is_dataclass(value):
            fields = [[item.name, self.identity(getattr(value, item.name))] for item in dataclasses.fields(value) if item.init]
            return ["object", self.identity(type(value)), fields]
        if isinstance(value, types.BuiltinFunctionType):
            return ["builtin", value.__module__, value.__qualname__]
        try:
            return ["pickle", self.identity(type(value)), hashlib.sha256(pickle.dumps(value, protocol=4)).hexdigest()]
        except Exception:
            return ["name", type(value).__module__, type(value).__qualname__]  # a lock, a logger: no part of what is computed

    def _code(self, value: types.FunctionType | type) -> Any:
        name = ["code", value.__qualname__]
        module = inspect.getmodule(value)
        if module is not None and not _is_own(module):
            return [*name, value.__module__]
        functions = (
            [value] if isinstance(value, types.FunctionType) else [f for f in vars(value).values() if isinstance(f, types.FunctionType)]
        )
        reached = []
        for function in functions:
            reached += [self.identity(item) for item in _named(function)]
            reached += [self.identity(cell.cell_contents) for cell in function.__closure__ or () if _is_filled(cell)]
        bases = [self.identity(base) for base in value.__bases__] if isinstance(value, type) else []
        return [*name, _text(value), bases, reached]


def _named(function: types.FunctionType) -> Iterator[Any]:
    """What a function's code names in its module."""
    waiting = [function.__code__]
    names: set[str] = set()
    while waiting:
        code = waiting.pop()
        names |= set(code.co_names)
        waiting += [item for item in code.co_consts if isinstance(item, types.CodeType)]
    for name in sorted(names & set(function.__globals__)):
        if not name.startswith("__"):
            yield function.__globals__[name]


def _is_filled(cell: types.CellType) -> bool:
    try:
        _ = cell.cell_contents
    except ValueError:
        return False
    return True


@functools.cache
def _installed() -> tuple[Path, ...]:
    paths = [sysconfig.get_path(name) for name in ("stdlib", "platstdlib", "purelib", "platlib")] + site.getsitepackages()
    return (*{Path(path).resolve() for path in paths if path}, Path(__file__).resolve().parents[1])


def _is_own(module: types.ModuleType) -> bool:
    """Whether a module is the caller's, not one of an installed package nor of this one."""
    if module.__name__.split(".")[0] == "hdrive_mbs":
        return False
    file = getattr(module, "__file__", None)
    if file is None:
        return module.__name__ in ("__main__", "__mp_main__")
    return not any(Path(file).resolve().is_relative_to(place) for place in _installed())


def _text(value: Any) -> str:
    try:
        return inspect.getsource(value)
    except (OSError, TypeError):  # typed at a prompt
        code = getattr(value, "__code__", None)
        return repr((code.co_code, [item for item in code.co_consts if not isinstance(item, types.CodeType)])) if code else ""
