"""A user's .py file as a module that other processes find too, with errors that name file and line."""

from __future__ import annotations

import importlib
import inspect
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType

from hdrive_mbs.errors import FileFormatError, HdriveError
from hdrive_mbs.quantities import Described


def imported(path: Path, wanted: str) -> ModuleType:
    """The module in a file, under the file's own name: worker processes import it by that name to read what is sent to them.

    wanted : what the file is to hold, for the error

    Raises FileFormatError for a file that is not there, has a name that no module can have or that another one has
    already, or raises when it is run.
    """
    if not path.is_file():
        raise FileFormatError(f"{path}: no such file. Give {wanted}.")
    if path.suffix != ".py" or not path.stem.isidentifier():
        raise FileFormatError(f"{path}: cannot be imported; rename it to letters, digits and '_', ending in .py.")
    folder = str(path.resolve().parent)
    if folder not in sys.path:
        sys.path.insert(0, folder)
        importlib.invalidate_caches()
    with lines_named(path):
        module = importlib.import_module(path.stem)
    if module.__file__ is None or Path(module.__file__).resolve() != path.resolve():
        raise FileFormatError(f"{path}: there is another module named {path.stem!r} ({module.__file__}); rename the file.")
    return module


def own_types(path: Path) -> list[type[Described]]:
    """The effects, laws and parts that a file defines, which a scene may name.  Raises FileFormatError where it defines none."""
    module = imported(path, "a .py file with classes of your own")
    found = [kind for kind in vars(module).values() if isinstance(kind, type) and issubclass(kind, Described)]
    own = [kind for kind in found if kind.__module__ == module.__name__ and not inspect.isabstract(kind)]
    if not own:
        raise FileFormatError(
            f"{path}: defines no effect, law or part that a scene could name. Write a class that subclasses TorqueEffect, TwistEffect or"
            " another Effect, or that of a law or part."
        )
    return own


@contextmanager
def lines_named(path: Path) -> Iterator[None]:
    """Turn whatever the file's code raises into a FileFormatError with the line of that file."""
    try:
        yield
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        line = _line(path, error)
        if isinstance(error, HdriveError) and line is None:
            raise
        at = f", line {line}" if line is not None else ""
        raise FileFormatError(f"{path}{at}: {type(error).__name__}: {_text(error)}") from error


def _line(path: Path, error: BaseException) -> int | None:
    """Line of the file that was being run last; None where none of it was."""
    target = path.resolve()
    if isinstance(error, SyntaxError) and error.filename is not None and Path(error.filename).resolve() == target:
        return error.lineno
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if Path(frame.filename).resolve() == target]
    return lines[-1] if lines else None


def _text(error: BaseException) -> str:
    return error.msg if isinstance(error, SyntaxError) else str(error) or "no message"
