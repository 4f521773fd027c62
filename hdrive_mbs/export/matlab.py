"""MATLAB 5 files by scipy: one structure per column with ``values``, ``unit`` and ``name``."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from hdrive_mbs.export.table import Table
from hdrive_mbs.writing import write_whole

LONGEST = 60
"""Characters of a name; MATLAB reads 63."""


def write(path: Path, table: Table) -> Path:
    """Variables named like the columns with ``_`` for what MATLAB does not allow, and one ``hdrive_mbs`` with the head."""
    from scipy.io import savemat

    content: dict[str, Any] = {"hdrive_mbs": dict(table.head)}
    for name, column in zip(identifiers(column.name for column in table.columns), table.columns, strict=True):
        values = column.values.astype(object) if column.values.dtype.kind == "U" else column.values
        content[name] = {"values": values, "unit": column.unit or "1", "name": column.name}
    return write_whole(path, lambda file: savemat(file, content, long_field_names=True, do_compression=True, oned_as="column"))  # type: ignore[arg-type]  # it takes open files too


def identifiers(names: Iterable[str]) -> list[str]:
    """Names that MATLAB takes, each once."""
    found: list[str] = []
    for name in names:
        stem = re.sub(r"\W+", "_", name, flags=re.ASCII).strip("_")[:LONGEST] or "column"
        stem = stem if stem[0].isalpha() else f"x_{stem}"[:LONGEST]
        unique, number = stem, 2
        while unique in found or unique == "hdrive_mbs":
            unique, number = f"{stem[: LONGEST - 4]}_{number}", number + 1
        found.append(unique)
    return found
