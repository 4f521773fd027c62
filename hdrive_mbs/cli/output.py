"""What commands print and write: tables for people, JSON for programs."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from hdrive_mbs.analysis.result import Result
from hdrive_mbs.printed_table import PrintedTable, cell, is_number
from hdrive_mbs.writing import write_text

NAME = 24
"""A first column up to this width is never broken."""


def write_json(target: str | None, document: Any) -> None:
    """Write to a file, or to stdout for ``-``; nothing for None.  NaN and infinity become null."""
    if target is None:
        return
    text = json.dumps(_clean(document), indent=2) + "\n"
    if target == "-":
        print(text, end="")
    else:
        write_text(Path(target), text)


def _clean(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(key): _clean(item) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        return _clean(value.tolist())
    if isinstance(value, (list, tuple)):
        return [_clean(item) for item in value]
    if isinstance(value, (float, np.floating)):
        return float(value) if math.isfinite(value) else None
    if isinstance(value, np.integer):
        return int(value)
    return value


def write_exports(result: Result, files: Iterable[Path] | None) -> None:
    """The table of a result into the files of --export."""
    for file in files or ():
        result.export(file)


def print_tables(name: str, status: str, tables: Sequence[PrintedTable]) -> None:
    """The tables of a result; the first one is headed by the name of the scene and the status."""
    for index, table in enumerate(tables):
        first = f"{name}: {table.title} ({status})" if table.title else f"{name}: {status}"
        print_table(table.title if index else first, table.heads, table.rows)
        for note in table.notes:
            print(note)


def print_table(title: str, headers: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    """A table on stdout."""
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    table = Table(title=escape(title), title_justify="left")
    rows = list(rows)
    for index, header in enumerate(headers):
        numbers = index > 0 and all(is_number(row[index]) for row in rows)
        name = index == 0 and all(len(str(row[0])) <= NAME for row in rows)
        table.add_column(escape(header), justify="right" if numbers else "left", overflow="fold", no_wrap=name)
    for row in rows:
        table.add_row(*[escape(cell(item)) for item in row])
    Console(width=None if sys.stdout.isatty() else 120).print(table)
