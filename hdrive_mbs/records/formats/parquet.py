"""Parquet tables (pyarrow); the unit stands in the metadata of a field, or in its name."""

from __future__ import annotations

import math
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

from hdrive_mbs.memory_limit import check_claim
from hdrive_mbs.records.formats.file_format import Column, Contents, Format, Wanted, broken, check_width, named_unit
from hdrive_mbs.records.si_units import is_unit

_STEPS = {"s": "s", "ms": "ms", "us": "us", "ns": "ns"}


def read(path: Path, wanted: Wanted) -> Contents:
    """Columns of numbers, times and durations; others are told of."""
    from pyarrow import parquet, types

    columns: list[Column] = []
    skipped: dict[str, str] = {}
    try:
        with parquet.ParquetFile(path) as file:
            schema = file.schema_arrow
            check_width(path, schema.names)
            chosen: list[tuple[str, str, str | None]] = []
            repeated = sorted(name for name, count in Counter(schema.names).items() if count > 1)
            for name in repeated:
                skipped[name] = "a name that occurs more than once"
            for field in schema:
                heading, unit = named_unit(field.name, is_unit)
                if field.name in repeated or not wanted(heading):
                    continue
                metadata = {_text(key).lower(): _text(value) for key, value in (field.metadata or {}).items()}
                unit = metadata.get("unit", metadata.get("units", unit))
                if types.is_timestamp(field.type) or types.is_duration(field.type):
                    unit = _STEPS[field.type.unit]
                elif not (
                    types.is_integer(field.type)
                    or types.is_floating(field.type)
                    or types.is_decimal(field.type)
                    or types.is_boolean(field.type)
                ):
                    skipped[heading] = f"values of type {field.type}"
                    continue
                chosen.append((field.name, heading, unit))
            claimed = 8 * file.metadata.num_rows * len(chosen)
            check_claim(path, claimed, "Read fewer of its columns with channels=[...], or mend the file.")
            for name, heading, unit in chosen:
                columns.append(Column(name=heading, unit=unit, values=_numbers(file.read(columns=[name]), types)))
    except Exception as error:  # pyarrow raises kinds of its own
        if type(error).__module__.startswith("hdrive_mbs"):
            raise
        raise broken(path, "Parquet", error) from error
    return Contents(columns=tuple(columns), skipped=skipped)


def _text(data: bytes) -> str:
    """Metadata as text: of a type of its author's own they may be bytes of any kind."""
    return data.decode("utf-8", "replace")


def _numbers(table: Any, types: Any) -> np.ndarray:
    """The only column of a table; what is missing becomes NaN."""
    column = table.column(0)
    if types.is_timestamp(column.type) or types.is_duration(column.type):
        column = column.cast("int64")
    if not (types.is_integer(column.type) and column.null_count == 0):
        column = column.cast("float64")
    # not by to_numpy, which loads pandas where it is installed
    parts = [np.from_dlpack(chunk.fill_null(math.nan) if chunk.null_count else chunk) for chunk in column.chunks]
    return np.concatenate(parts) if parts else np.zeros(0)


FORMAT = Format(name="Parquet", suffixes=(".parquet", ".pq"), recognises=lambda head: head[:4] == b"PAR1", read=read, needs=("pyarrow",))
