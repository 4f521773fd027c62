"""MATLAB files: up to version 7.2 by scipy, 7.3 (which is HDF5) by h5py.

Structures are opened: field ``x`` of ``rec`` is ``rec.x``; a structure with ``values`` (or ``data``,
``signals.values``) and ``unit`` is one channel.  Objects, function handles, cells and text hold no
channels: they are told of and never made or run.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from hdrive_mbs.records.formats.file_format import Column, Contents, Format, Wanted, broken, check_width, package, real_numbers
from hdrive_mbs.records.formats.hdf5 import attribute_text, datasets

DEEPEST = 12
"""Structures inside structures that are followed."""

_VALUES, _UNITS = ("values", "value", "data"), ("unit", "units")


def read(path: Path, wanted: Wanted) -> Contents:
    """All numeric arrays of a MATLAB file."""
    with open(path, "rb") as file:
        newer = file.read(19).startswith(b"MATLAB 7.3 MAT-file")
    return _read_7_3(path, wanted) if newer else _read_older(path, wanted)


def _read_older(path: Path, wanted: Wanted) -> Contents:
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
            fields = {field: getattr(value, field) for field in value._fieldnames}
            unit = next((str(fields[key]) for key in _UNITS if isinstance(fields.get(key), str)), None)
            if depth >= DEEPEST:
                skipped[name] = f"structures more than {DEEPEST} deep"
                return
            for field, inner in fields.items():
                if unit is not None and field in _VALUES:
                    yield from numbers(name, unit, inner, group)
                elif not (unit is not None and field in _UNITS):
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


def _read_7_3(path: Path, wanted: Wanted) -> Contents:
    h5py = package("h5py", "MATLAB 7.3 files", path)
    skipped: dict[str, str] = {}
    columns: list[Column] = []
    numeric = {"double", "single", "logical", *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64))}
    try:
        with h5py.File(path, "r") as file:
            texts = {}
            found = list(datasets(file, skipped))
            for parts, data in found:
                if attribute_text(data, "MATLAB_class") == "char" and parts[-1] in _UNITS and data.size < 200:
                    texts[parts[:-1]] = "".join(chr(code) for code in np.asarray(data).ravel())
            for parts, data in found:
                if parts[0].startswith("#"):
                    continue
                kind = attribute_text(data, "MATLAB_class") or "unknown"
                whole = parts[:-1] in texts and parts[-1] in _VALUES
                name = ".".join(parts[:-1] if whole else parts)
                if parts[:-1] in texts and parts[-1] in _UNITS:
                    continue
                if kind not in numeric or data.attrs.get("MATLAB_empty", 0):
                    skipped[name] = "an empty array" if kind in numeric else f"a MATLAB {kind}, which is not opened"
                elif wanted(name):
                    values = np.squeeze(np.asarray(data)).T
                    problem = real_numbers(values) if values.ndim else "a single number"
                    if problem:
                        skipped[name] = problem
                    else:
                        group = parts[:-2] if whole else parts[:-1]
                        columns.append(Column(name=name, unit=texts.get(parts[:-1]) if whole else None, values=values, group=group))
    except Exception as error:  # h5py raises many kinds for a damaged file
        raise broken(path, "MATLAB 7.3", error) from error
    check_width(path, columns)
    return Contents(columns=tuple(columns), skipped=skipped)


def _recognises(head: bytes) -> bool:
    return head.startswith((b"MATLAB 5.0 MAT-file", b"MATLAB 7.3 MAT-file"))


FORMAT = Format(name="MATLAB", suffixes=(".mat",), recognises=_recognises, read=read)
