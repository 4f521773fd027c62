"""MATLAB files of version 7.3, which are HDF5 (h5py).

Structures are groups; units, matrices and what is not opened as in mat.py.  MATLAB stores the columns of
a matrix first, so a matrix is turned.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from hdrive_mbs.errors import FileFormatError
from hdrive_mbs.memory_limit import check_claim
from hdrive_mbs.records.formats.file_format import Column, Contents, Format, Wanted, broken, check_width, real_numbers
from hdrive_mbs.records.formats.hdf5 import FEWER, attribute_text, claim, datasets
from hdrive_mbs.records.formats.mat import UNITS, VALUES


def read(path: Path, wanted: Wanted) -> Contents:
    """All numeric arrays of a MATLAB 7.3 file."""
    import h5py

    skipped: dict[str, str] = {}
    columns: list[Column] = []
    numeric = {"double", "single", "logical", *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64))}
    try:
        with h5py.File(path, "r") as file:
            texts = {}
            found = list(datasets(file, skipped))
            check_claim(path, sum(claim(data) for parts, data in found if wanted(".".join(parts)) or wanted(".".join(parts[:-1]))), FEWER)
            for parts, data in found:
                if attribute_text(data, "MATLAB_class") == "char" and parts[-1] in UNITS and data.dtype.kind in "iu" and data.size < 200:
                    texts[parts[:-1]] = "".join(chr(code) for code in np.asarray(data).ravel())
            for parts, data in found:
                if parts[0].startswith("#"):
                    continue
                kind = attribute_text(data, "MATLAB_class") or "unknown"
                whole = parts[:-1] in texts and parts[-1] in VALUES
                name = ".".join(parts[:-1] if whole else parts)
                if parts[:-1] in texts and parts[-1] in UNITS:
                    continue
                if kind not in numeric or data.dtype.kind not in "biuf" or _is_empty(data):
                    skipped[name] = (
                        f"a MATLAB {kind}, which is not opened"
                        if kind not in numeric
                        else real_numbers(np.empty(1, data.dtype)) or "an empty array"
                    )
                elif wanted(name):
                    values = np.squeeze(np.asarray(data)).T
                    problem = real_numbers(values) if values.ndim else "a single number"
                    if problem:
                        skipped[name] = problem
                    else:
                        group = parts[:-2] if whole else parts[:-1]
                        columns.append(Column(name=name, unit=texts.get(parts[:-1]) if whole else None, values=values, group=group))
    except FileFormatError:
        raise
    except Exception as error:  # h5py raises many kinds for a damaged file
        raise broken(path, "MATLAB 7.3", error) from error
    check_width(path, columns)
    return Contents(columns=tuple(columns), skipped=skipped)


def _is_empty(data: Any) -> bool:
    """Whether MATLAB wrote the size of an empty array in place of its values."""
    name = "MATLAB_empty"
    return name in data.attrs and data.attrs.get_id(name).dtype.kind in "iu" and bool(np.any(data.attrs[name]))


FORMAT = Format(
    name="MATLAB 7.3",
    suffixes=(".mat",),
    recognises=lambda head: head.startswith(b"MATLAB 7.3 MAT-file"),
    read=read,
    needs=("h5py",),
    apart=True,
)
