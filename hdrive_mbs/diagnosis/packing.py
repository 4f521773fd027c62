"""Pickles for worker processes that take along where a user's own classes are defined.

A fresh process finds a class by the name of its module.  A module that was loaded from a file by its path, or from a
folder that was put on ``sys.path`` later, is not found by its name there; so the files of all modules that a pickle
refers to go with it, and are loaded under the same names first.
"""

from __future__ import annotations

import importlib.util
import io
import pickle
import sys
from collections.abc import Mapping
from pathlib import Path
from types import FunctionType
from typing import Any

from hdrive_mbs.errors import ParameterError

_OWN = __name__.partition(".")[0]


class _Pickler(pickle.Pickler):
    """Notes the modules of classes and functions on the way."""

    def __init__(self, file: io.BytesIO) -> None:
        super().__init__(file, protocol=pickle.HIGHEST_PROTOCOL)
        self.met: dict[str, str] = {}

    def reducer_override(self, value: Any) -> Any:
        if isinstance(value, (type, FunctionType)) and value.__module__ != "builtins":
            self.met[value.__module__] = value.__qualname__
        return NotImplemented


def packed(value: Any) -> bytes:
    """A value as bytes for a worker process.

    Raises ParameterError for what no other process can read: a class or function that is defined inside a function or
    at a prompt.
    """
    file = io.BytesIO()
    pickler = _Pickler(file)
    try:
        pickler.dump(value)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        raise ParameterError(
            f"Worker processes cannot be sent what is defined inside a function ({error}); define it at the top of a file, or use"
            " workers=1."
        ) from error
    if "__main__" in pickler.met and not hasattr(sys.modules["__main__"], "__file__"):
        raise ParameterError(
            f"{pickler.met['__main__']} is defined at a prompt or in a notebook, where worker processes cannot read it; put it into a"
            " file and import it from there, or use workers=1."
        )
    return pickle.dumps((_files(pickler.met), file.getvalue()), protocol=pickle.HIGHEST_PROTOCOL)


def unpacked(data: bytes) -> Any:
    """The value that was packed, in any process."""
    files, content = pickle.loads(data)
    for name, file in files.items():
        _find(name, file)
    return pickle.loads(content)


def _files(names: Mapping[str, str]) -> dict[str, str]:
    """File of each module that is not of this package and not the script itself."""
    found = {}
    for name in names:
        file = getattr(sys.modules.get(name), "__file__", None)
        if file is not None and name not in ("__main__", "__mp_main__") and name.partition(".")[0] not in (_OWN, "numpy"):
            found[name] = str(Path(file).resolve())
    return found


def _find(name: str, file: str) -> None:
    """Load a module from its file where its name alone does not lead there."""
    if name in sys.modules:
        return
    try:
        spec = importlib.util.find_spec(name)
    except (ImportError, ValueError):
        spec = None
    if spec is not None and spec.origin is not None and Path(spec.origin).resolve() == Path(file):
        return
    spec = importlib.util.spec_from_file_location(name, file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[name]
        raise
