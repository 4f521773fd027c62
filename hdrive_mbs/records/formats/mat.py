"""MATLAB files up to version 7.2 (scipy).

Structures are opened: field ``x`` of ``rec`` is ``rec.x``; a structure with ``values`` (or ``data``,
``signals.values``) and ``unit`` is one channel.  Objects, function handles, cells and text hold no
channels: they are told of and never made or run.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from hdrive_mbs.records.formats.file_format import Column, Contents, Format, Wanted, broken, check_width, real_numbers

DEEPEST = 12
"""Structures inside structures that are followed."""

VALUES, UNITS = ("values", "value", "data"), ("unit", "units")


def read(path: Path, wanted: Wanted) -> Contents:
    """All numeric arrays of a MATLAB file of version 4 to 7.2."""
    from scipy.io import loadmat
    from scipy.io.matlab import MatlabFunction, MatlabOpaque, mat_struct

    try:
        variables = loadmat(
            str(path), squeeze_me=True, struct_as_record=False, chars_as_strings=True, verify_compressed_data_integrity=True
        )
    except Exception as error:  # scipy raises many kinds for a damaged file
        raise broken(path, "MATLAB", error) from error
    skipped: dict[str, str] = {}
    columns: list[Column] = []

    def opened(name: str, value: Any, group: tuple[str, ...], depth: int) -> Iterator[Column]:
        if isinstance(value, mat_struct):
            fields = {field: getattr(value, field) for field in vars(value)["_fieldnames"]}
            unit = next((str(fields[key]) for key in UNITS if isinstance(fields.get(key), str)), None)
            if depth >= DEEPEST:
                skipped[name] = f"structures more than {DEEPEST} deep"
                return
            for field, inner in fields.items():
                if unit is not None and field in VALUES:
                    yield from numbers(name, unit, inner, group[:-1])
                elif not (unit is not None and field in UNITS):
                    yield from opened(f"{name}.{field}", inner, (*group, field) if isinstance(inner, mat_struct) else group, depth + 1)
        elif isinstance(value, (MatlabOpaque, MatlabFunction)):
            skipped[name] = "a MATLAB object or function, which is not opened; in MATLAB store its numbers as a structure of arrays"
        else:
            yield from numbers(name, None, value, group)

    def numbers(name: str, unit: str | None, value: Any, group: tuple[str, ...]) -> Iterator[Column]:
        problem = real_numbers(value)
        if problem:
            skipped[name] = problem if np.ndim(value) or not isinstance(value, (int, float)) else "a single number"
        elif wanted(name):
            yield Column(name=name, unit=unit, values=np.asarray(value), group=group)

    for key, value in variables.items():
        if key is None or not (key.startswith("__") and key.endswith("__")):
            name = "(unnamed)" if key is None else key
            columns.extend(opened(name, value, (name,) if isinstance(value, mat_struct) else (), 0))
    check_width(path, columns)
    return Contents(columns=tuple(columns), skipped=skipped)


FORMAT = Format(name="MATLAB", suffixes=(".mat",), recognises=lambda head: head.startswith(b"MATLAB 5.0 MAT-file"), read=read, apart=True)
