"""What a reader of one file format gives, and how formats are found."""

from __future__ import annotations

import functools
import importlib
import importlib.util
import os
import pkgutil
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import FileFormatError

LONGEST_NAME = 500
"""Characters of a heading in which a unit is looked for."""

MOST_COLUMNS = 10_000
"""More columns than any logger writes: a sign of a file that is something else."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Column:
    """Numbers of one name in a file, as they stand there.

    unit : as in the file; None if it says none
    values : real numbers, shape (n,), or a matrix whose rows or columns are channels
    group : folder, structure or channel group inside the file; columns of one group share a time
    clock : the format says that this is the time of its group
    """

    name: str
    unit: str | None
    values: npt.NDArray[Any]
    group: tuple[str, ...] = ()
    clock: bool = False


@dataclass(frozen=True, kw_only=True, eq=False)
class Contents:
    """All columns of numbers of a file, and in words what else it holds.

    skipped : names of what holds no real numbers, with the reason
    """

    columns: tuple[Column, ...]
    skipped: Mapping[str, str]
    notes: tuple[str, ...] = ()


TIMES = frozenset({"t", "time", "times", "zeit", "timestamp", "timestamps", "time_stamp", "elapsed_time", "time_s", "sec", "seconds"})
"""Names of columns that are taken for the time, in lower case."""


def is_time(name: str) -> bool:
    """Whether a name, or the last part of a path, is one of TIMES."""
    return re.split(r"[./]", name)[-1].strip().lower().replace(" ", "_") in TIMES


def fits(pattern: str, name: str) -> bool:
    """Whether a name is the pattern; ``*`` stands for any text."""
    if pattern == name:
        return True
    return "*" in pattern and re.fullmatch(".*?".join(re.escape(part) for part in pattern.split("*")), name, re.S) is not None


def base_name(name: str) -> str:
    """``angle[2]``, one channel of a matrix -> ``angle``."""
    return re.sub(r"\[\d+\]$", "", name)


@dataclass(frozen=True)
class Wanted:
    """Which columns are asked for; a reader may leave out the others.  All if there are no patterns."""

    patterns: tuple[str, ...] | None = None

    def __call__(self, name: str) -> bool:
        if self.patterns is None or is_time(name):
            return True
        return any(fits(pattern, name) or fits(base_name(pattern), name) for pattern in self.patterns)


@dataclass(frozen=True, kw_only=True)
class Format:
    """A file format: its name, how to know it by its first bytes or suffix, and its reader.

    needs : (packages to import, what they read): optional ones, which may not be installed
    apart : the reader runs in a process of its own, because its library can crash on a damaged file
    """

    name: str
    suffixes: tuple[str, ...]
    recognises: Callable[[bytes], bool]
    read: Callable[[Path, Wanted], Contents]
    needs: tuple[str, ...] = ()
    apart: bool = False

    def contents(self, path: Path, wanted: Wanted) -> Contents:
        """The columns of a file.  Raises FileFormatError for a missing package or a file that cannot be read."""
        from hdrive_mbs.records.formats.apart import read_apart

        for name in self.needs:
            require_package(name, self.name, path)
        found = read_apart(self, path, wanted) if self.apart else self.read(path, wanted)
        empty = {column.name: "a column without values" for column in found.columns if not column.values.size}
        if not empty:
            return found
        columns = tuple(column for column in found.columns if column.values.size)
        return Contents(columns=columns, skipped={**found.skipped, **empty}, notes=found.notes)


@functools.cache
def formats() -> tuple[Format, ...]:
    """All formats: each module of this folder that has a FORMAT."""
    from hdrive_mbs.records import formats as folder

    modules = sorted(item.name for item in pkgutil.iter_modules(folder.__path__, f"{folder.__name__}."))
    found = (getattr(importlib.import_module(name), "FORMAT", None) for name in modules)
    return tuple(item for item in found if isinstance(item, Format))


def format_of(path: Path) -> Format:
    """The format of a file, by its first bytes, then by its suffix.

    Raises FileFormatError for what is no regular file, is empty, or is of no known format.
    """
    try:
        if not path.exists():
            raise FileFormatError(f"{path}: no such file.")
        if path.is_dir():
            raise FileFormatError(f"{path} is a folder; read its files one by one or all with read_records.")
        if not path.is_file():
            raise FileFormatError(f"{path} is no regular file (a device or pipe); copy it to a file first.")
        with open(path, "rb") as file:
            head = file.read(4096)
    except OSError as error:
        raise FileFormatError(f"{path} cannot be read: {error.strerror or error}.") from error
    if not head:
        raise FileFormatError(f"{path} is empty.")
    for item in formats():
        if item.recognises(head):
            return item
    for item in formats():
        if path.suffix.lower() in item.suffixes:
            return item
    known = ", ".join(f"{item.name} ({', '.join(item.suffixes)})" for item in formats())
    raise FileFormatError(f"{path}: neither its first bytes nor its suffix {path.suffix!r} say what it is. Known formats: {known}.")


def require_package(name: str, what: str, path: Path) -> None:
    """Raise FileFormatError, with the command that installs it, when an optional package is missing."""
    if importlib.util.find_spec(name) is None:
        raise FileFormatError(
            f"{path}: reading {what} needs {name}, which is not installed: python -m pip install 'hdrive-mbs[records]' (or {name} alone)."
        )


def broken(path: os.PathLike[str], what: str, error: Exception) -> FileFormatError:
    """The error for a file that its library cannot read."""
    said = " ".join(str(error).split())[:200] or type(error).__name__
    return FileFormatError(f"{path} is no readable {what} file, or it is truncated ({said}).")


def real_numbers(values: Any) -> str:
    """Empty for an array of real numbers in one or two dimensions, else what it is instead."""
    array = np.asarray(values)
    if array.dtype.kind not in "biuf":
        kinds = {"c": "complex numbers", "O": "objects", "U": "text", "S": "text", "V": "structures", "M": "dates", "m": "durations"}
        return kinds.get(array.dtype.kind, f"values of type {array.dtype}")
    if array.ndim not in (1, 2) or 0 in array.shape:
        return f"an array of shape {array.shape}"
    return ""


_BRACKETED = re.compile(r"^(.*?)\s*\[\s*([^\[\]]*?)\s*\]\s*$")
_PARENTHESISED = re.compile(r"^(.*?)\s*\(\s*([^()]*(?:\([^()]*\)[^()]*)*)\)\s*$")


def named_unit(heading: str, is_unit: Callable[[str], bool]) -> tuple[str, str | None]:
    """``"speed [rpm]"`` or ``"speed (rpm)"`` -> ("speed", "rpm"); in parentheses only what is a unit counts."""
    text = heading.strip()
    if len(text) > LONGEST_NAME:
        return text, None
    match = _BRACKETED.match(text)
    if match and match.group(1):
        return match.group(1), match.group(2) or "1"
    match = _PARENTHESISED.match(text)
    if match and match.group(1) and is_unit(match.group(2)):
        return match.group(1), match.group(2).strip()
    return text, None


def check_width(path: Path, names: Iterable[object]) -> None:
    """Refuse a file with more columns than a record can have."""
    count = sum(1 for _ in names)
    if count > MOST_COLUMNS:
        raise FileFormatError(f"{path} has {count} columns; more than {MOST_COLUMNS} are no record.")
