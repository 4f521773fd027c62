"""Case folders: one Parquet table a record, the unit in each field's metadata."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from benchmarks.withheld.case import Array, Case, Column


def write_record(path: Path, columns: Sequence[Column]) -> Path:
    """Write one table; nothing in it but the channels and their units."""
    fields, arrays = [], []
    for column in columns:
        kind = pa.float32() if column.single else pa.float64()
        fields.append(pa.field(column.name, kind, metadata={"unit": column.unit}))
        arrays.append(pa.array(np.asarray(column.values), type=pa.float64()).cast(kind))
    table = pa.Table.from_arrays(arrays, schema=pa.schema(fields))
    pq.write_table(table, path, compression="zstd", use_dictionary=False, use_byte_stream_split=True)
    return path


def read_record(path: Path) -> tuple[dict[str, Array], dict[str, str]]:
    """Values and units by channel."""
    table = pq.read_table(path)
    values = {name: table[name].to_numpy().astype(float) for name in table.column_names}
    units = {field.name: (field.metadata or {}).get(b"unit", b"").decode() for field in table.schema}
    return values, units


def write_case(folder: Path, name: str, case: Case) -> Path:
    """Write FOLDER/NAME/RECORD.parquet; the truth is not written here."""
    home = folder / name
    home.mkdir(parents=True, exist_ok=False)
    for record, columns in case.records.items():
        write_record(home / f"{record}.parquet", columns)
    return home
