"""A small table of a result, units in its heads: what print() shows and what the command line draws."""

from __future__ import annotations

from dataclasses import dataclass


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


def cell(item: object) -> str:
    """A number with six digits, anything else as it is."""
    return f"{item:.6g}" if isinstance(item, float) else str(item)


def is_number(item: object) -> bool:
    """Whether it stands to the right in its column."""
    try:
        float(str(item) or "nan")
    except ValueError:
        return item in ("-", None)
    return True
