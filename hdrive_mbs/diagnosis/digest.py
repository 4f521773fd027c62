"""Hashes of what a diagnosis is made of: equal in every process for equal content."""

from __future__ import annotations

import dataclasses
import functools
import hashlib
import inspect
import struct
import sys
import types
from collections.abc import Mapping, Set
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

import hdrive_mbs

PACKAGES = ("numpy", "scipy", "llvmlite")
"""Packages whose version changes results."""


def digest(*values: Any) -> str:
    """Hash of plain data, arrays, dataclasses (fields that their constructor takes), classes and functions.

    Of a class or function of the caller's own its module's text counts.  Other objects count by their attributes.
    """
    writer = _Writer()
    for value in values:
        writer.add(value)
    return writer.hash.hexdigest()


@functools.cache
def program() -> str:
    """Hash of this package's text and of the versions of the packages it computes with."""
    found = hashlib.sha256(sys.version.encode())
    for name in PACKAGES:
        found.update(f"{name} {metadata.version(name)}\n".encode())
    root = Path(hdrive_mbs.__file__).parent
    for path in sorted(root.rglob("*.py")):
        found.update(str(path.relative_to(root)).encode())
        found.update(path.read_bytes())
    return found.hexdigest()


class _Writer:
    def __init__(self) -> None:
        self.hash = hashlib.sha256()
        self._within: list[int] = []

    def _put(self, *texts: str) -> None:
        for text in texts:
            data = text.encode()
            self.hash.update(struct.pack("<q", len(data)))
            self.hash.update(data)

    def add(self, value: Any) -> None:
        if value is None or isinstance(value, (bool, str, int, float, np.bool_, np.number)):
            plain = value.item() if isinstance(value, np.generic) else value
            self._put(type(plain).__name__, repr(plain))
        elif isinstance(value, np.ndarray) and value.dtype != object:
            self._put("array", str(value.dtype), repr(value.shape))
            self.hash.update(np.ascontiguousarray(value).tobytes())
        elif isinstance(value, (type, types.FunctionType)):
            self._put("code", value.__module__, value.__qualname__, _text(value))
            if isinstance(value, types.FunctionType):
                self.add((value.__defaults__, [cell.cell_contents for cell in value.__closure__ or ()]))
        elif id(value) in self._within:
            self._put("above", str(len(self._within) - self._within.index(id(value))))
        else:
            self._within.append(id(value))
            self._compound(value)
            self._within.pop()

    def _compound(self, value: Any) -> None:
        if isinstance(value, (tuple, list)):
            self._put("list", str(len(value)))
            for item in value:
                self.add(item)
        elif isinstance(value, Mapping):
            self._put("map", str(len(value)))
            for key, item in value.items():
                self.add(key)
                self.add(item)
        elif isinstance(value, Set):
            self._put("set", *sorted(digest(item) for item in value))
        elif isinstance(value, types.MethodType):
            self.add((value.__func__, value.__self__))
        elif isinstance(value, functools.partial):
            self.add((value.func, value.args, value.keywords))
        elif dataclasses.is_dataclass(value):
            self.add(type(value))
            for field in dataclasses.fields(value):
                if field.init:
                    self._put(field.name)
                    self.add(getattr(value, field.name))
        else:
            self.add(type(value))
            state = getattr(value, "__dict__", None)
            self.add(dict(sorted(state.items())) if state is not None else repr(value))


@functools.cache
def _text(value: Any) -> str:
    """Text of the module where a class or function of the caller's own is defined; of one typed at a prompt its code."""
    if value.__module__.partition(".")[0] == hdrive_mbs.__name__:
        return ""
    module = sys.modules.get(value.__module__)
    file = getattr(module, "__file__", None)
    if file is not None and Path(file).is_file():
        return hashlib.sha256(Path(file).read_bytes()).hexdigest()
    try:
        return inspect.getsource(value)
    except (OSError, TypeError):
        return ""
