"""HDF5 by h5py: one dataset per column with the attribute ``unit``; the head is attributes of the file."""

from __future__ import annotations

import io
from pathlib import Path

from hdrive_mbs.export.table import Table
from hdrive_mbs.writing import write_whole

LONGEST = 60_000
"""Bytes of a text that HDF5 takes as an attribute (its limit is 64 KiB with all of one object); a longer one is a dataset."""


def write(path: Path, table: Table) -> Path:
    """Datasets in the root; a slash in a name, which would make a group, is written as ``|``."""
    import h5py

    memory = io.BytesIO()  # h5py reads back what it writes
    with h5py.File(memory, "w", track_order=True) as file:
        for name, text in table.head.items():
            if len(text.encode()) < LONGEST:
                file.attrs[f"hdrive_mbs.{name}"] = text
            else:
                file.create_dataset(f"hdrive_mbs.{name}", data=text, dtype=h5py.string_dtype())
        for column in table.columns:
            is_text = column.values.dtype.kind == "U"
            values = column.values.astype(object) if is_text else column.values
            options = {} if is_text or len(values) < 64 else {"compression": "gzip", "shuffle": True}
            data = file.create_dataset(
                column.name.replace("/", "|"), data=values, dtype=h5py.string_dtype() if is_text else None, **options
            )
            data.attrs["name"] = column.name
            if column.unit:
                data.attrs["unit"] = column.unit
    return write_whole(path, lambda file: file.write(memory.getvalue()))
