"""HDF5 files (h5py): every dataset of numbers, with its ``unit`` or ``units`` attribute.

Links to other files, references and objects are not followed.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from hdrive_mbs.errors import FileFormatError
from hdrive_mbs.memory_limit import check_claim
from hdrive_mbs.records.formats.file_format import Column, Contents, Format, Wanted, broken, check_width, named_unit, real_numbers
from hdrive_mbs.records.si_units import is_unit

DEEPEST = 12
"""Groups inside groups that are followed."""

LARGEST = 2**31
"""Bytes of one dataset; a few bytes of file can claim any size."""

FEWER = "Read fewer of its columns with channels=[...], or mend the file."
"""What to do with a file that is too large for the memory."""

SIGNATURE = b"\x89HDF\r\n\x1a\n"


def read(path: Path, wanted: Wanted) -> Contents:
    """All datasets of real numbers, named by their path without the leading slash."""
    import h5py

    skipped: dict[str, str] = {}
    columns: list[Column] = []
    try:
        with h5py.File(path, "r") as file:
            chosen = []
            for parts, data in datasets(file, skipped):
                last, unit = named_unit(parts[-1], is_unit)
                name = "/".join((*parts[:-1], last))
                if wanted(name):
                    chosen.append((parts, name, unit, data))
            check_claim(path, sum(claim(data) for *_, data in chosen), FEWER)
            for parts, name, unit, data in chosen:
                if data.dtype.kind not in "biuf" or not data.shape:
                    skipped[name] = "a single value" if not data.shape else real_numbers(np.empty(1, data.dtype))
                    continue
                values = np.squeeze(np.asarray(data))
                problem = real_numbers(values) if values.ndim else "a single number"
                if problem:
                    skipped[name] = problem
                    continue
                unit = attribute_text(data, "unit") or attribute_text(data, "units") or unit
                columns.append(Column(name=name, unit=unit, values=values, group=parts[:-1]))
    except FileFormatError:
        raise
    except Exception as error:  # h5py raises many kinds for a damaged file
        raise broken(path, "HDF5", error) from error
    check_width(path, columns)
    return Contents(columns=tuple(columns), skipped=skipped)


def datasets(group: Any, skipped: dict[str, str], parts: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Path and dataset of all that lies in the file itself, each once."""
    import h5py

    waiting = [(parts, group)]
    seen = {hash(group.id)}
    while waiting:
        above, inside = waiting.pop(0)
        for key in inside:
            path = (*above, str(key))
            name = "/".join(path)
            if not isinstance(inside.get(key, getlink=True), h5py.HardLink):
                skipped[name] = "a link, which is not followed"
                continue
            item = inside[key]
            if isinstance(item, h5py.Dataset):
                if item.external is not None or item.is_virtual:
                    skipped[name] = "a dataset that lies in another file, which is not opened"
                elif item.dtype.kind != "O" and item.dtype.itemsize * max(item.size or 0, 1) > LARGEST:
                    skipped[name] = f"an array of shape {item.shape}, over {LARGEST / 2**30:g} GiB"
                else:
                    yield path, item
            elif isinstance(item, h5py.Group):
                if len(path) >= DEEPEST or hash(item.id) in seen:
                    skipped[name] = "a group inside itself" if hash(item.id) in seen else f"groups more than {DEEPEST} deep"
                else:
                    seen.add(hash(item.id))
                    waiting.append((path, item))


def claim(data: Any) -> int:
    """Bytes that a dataset takes when it is read."""
    return int(data.dtype.itemsize) * int(data.size or 0)


def attribute_text(item: Any, name: str) -> str | None:
    """A text attribute; None where it is missing or no text.

    Nothing else is read: an opaque type whose tag says "NUMPY:|O" makes h5py take bytes of the file for addresses of Python objects.
    """
    import h5py

    if name not in item.attrs or h5py.check_string_dtype(item.attrs.get_id(name).dtype) is None:
        return None
    value = item.attrs[name]
    value = value.item() if isinstance(value, np.ndarray) and value.size == 1 else value
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    return value if isinstance(value, str) else None


FORMAT = Format(
    name="HDF5",
    suffixes=(".h5", ".hdf5", ".hdf"),
    recognises=lambda head: head.startswith(SIGNATURE),
    read=read,
    needs=("h5py",),
    apart=True,
)
