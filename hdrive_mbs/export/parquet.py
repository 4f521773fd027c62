"""Parquet by pyarrow: the unit is metadata ``unit`` of a field, the head is metadata of the schema."""

from __future__ import annotations

from pathlib import Path

from hdrive_mbs.export.table import Table
from hdrive_mbs.writing import write_whole


def write(path: Path, table: Table) -> Path:
    """One row group, compressed."""
    import pyarrow
    from pyarrow import parquet

    arrays = [pyarrow.array(column.values.tolist() if column.values.dtype.kind == "U" else column.values) for column in table.columns]
    fields = [
        pyarrow.field(column.name, array.type, metadata={"unit": column.unit} if column.unit else None)
        for column, array in zip(table.columns, arrays, strict=True)
    ]
    schema = pyarrow.schema(fields, metadata={f"hdrive_mbs.{name}": text for name, text in table.head.items()})
    content = pyarrow.Table.from_arrays(arrays, schema=schema)
    return write_whole(path, lambda file: parquet.write_table(content, file, compression="zstd"))
