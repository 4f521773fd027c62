"""A small table of a result, units in its heads: what print() shows and what the command line draws."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

MOST = 21
"""Rows that a long table is printed with."""


@dataclass(frozen=True, kw_only=True)
class PrintedTable:
    """Rows under heads that name their units.

    title : what is in it; empty where the status of the result is enough
    notes : lines under it
    """

    heads: tuple[str, ...]
    rows: tuple[tuple[object, ...], ...]
    title: str = ""
    notes: tuple[str, ...] = ()

    def __str__(self) -> str:
        """Columns of equal width, numbers to the right; the title is the first line."""
        cells = [self.heads, *([cell(item) for item in row] for row in self.rows)]
        widths = [max(len(line[k]) for line in cells) for k in range(len(self.heads))]
        right = [k > 0 and all(is_number(row[k]) for row in self.rows) for k in range(len(self.heads))]
        lines = [
            "  ".join(item.rjust(widths[k]) if right[k] else item.ljust(widths[k]) for k, item in enumerate(line)).rstrip()
            for line in cells
        ]
        return "\n".join([*filter(None, [self.title]), *(lines if self.rows else []), *self.notes])


def thinned(columns: Mapping[str, np.ndarray], *, title: str = "", notes: tuple[str, ...] = ()) -> PrintedTable:
    """Columns as a table of at most MOST rows, evenly picked, the last one among them, with a note that says so."""
    count = min((len(values) for values in columns.values()), default=0)
    picked = range(count) if count <= MOST else sorted({round(k * (count - 1) / (MOST - 1)) for k in range(MOST)})
    rows = tuple(tuple(_plain(values[k]) for values in columns.values()) for k in picked)
    left_out = () if len(rows) == count else (f"{len(rows)} of {count} rows; columns() and to_csv() have them all",)
    return PrintedTable(title=title, heads=tuple(columns), rows=rows, notes=(*notes, *left_out))


def _plain(value: object) -> object:
    return value.item() if isinstance(value, np.generic) else value


def cell(item: object) -> str:
    """A number with six digits, a dash for none, anything else as it is."""
    if isinstance(item, float):
        return "-" if item != item else f"{item + 0.0:.6g}"
    return str(item)


def is_number(item: object) -> bool:
    """Whether it stands to the right in its column."""
    try:
        float(str(item) or "nan")
    except ValueError:
        return item in ("-", None)
    return True
