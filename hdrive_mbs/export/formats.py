"""Which writer a suffix means."""

from __future__ import annotations

import importlib
import os
from collections.abc import Callable
from pathlib import Path

from hdrive_mbs.errors import DependencyError, FileFormatError
from hdrive_mbs.export import hdf5, matlab, parquet
from hdrive_mbs.export.table import Table

Writer = Callable[[Path, Table], Path]

WRITERS: dict[str, tuple[Writer, str]] = {
    ".parquet": (parquet.write, "pyarrow"),
    ".pq": (parquet.write, "pyarrow"),
    ".h5": (hdf5.write, "h5py"),
    ".hdf5": (hdf5.write, "h5py"),
    ".mat": (matlab.write, "scipy"),
}
"""Suffix -> writer and the package it needs."""


def write_table(path: str | os.PathLike[str], table: Table) -> Path:
    """Write a table as the suffix says, whole or not at all.

    Raises FileFormatError for another suffix and DependencyError when the package for it is missing.
    """
    return writer_for(path)(Path(path), table)


def writer_for(path: str | os.PathLike[str]) -> Writer:
    """The writer of a file; nothing is written yet.  Raises like ``write_table``."""
    suffix = Path(path).suffix.lower()
    if suffix not in WRITERS:
        raise FileFormatError(f"{path}: a table is written as .csv, {', '.join(WRITERS)}.")
    write, needed = WRITERS[suffix]
    try:
        importlib.import_module(needed)
    except ImportError:
        raise DependencyError(f'{path}: writing this needs {needed}: python -m pip install "hdrive-mbs[records]".') from None
    return write
