"""Parts in readable tables, one for each kind of part: a rotor line has many that are alike."""

from __future__ import annotations

import dataclasses
import textwrap
from collections.abc import Iterator, Mapping
from typing import Any

from hdrive_mbs.quantities import Described, readable
from hdrive_mbs.quantity import Quantity

WIDTH = 116
"""Longest line, where no single value is longer."""

HARD = "\u00a0"
"""A space at which no line is broken."""


def part_table(parts: Mapping[str, Described]) -> list[str]:
    """For each kind of part what all of them have in common, and a table of what differs.

    Fields at their default in all of them are left out; fields of a law in a part have paths (``law.stiffness_xx``).
    """
    kinds: dict[str, list[str]] = {}
    for name, part in parts.items():
        kinds.setdefault(type(part).__name__, []).append(name)
    lines: list[str] = []
    for kind, names in kinds.items():
        rows = [dict(_fields(parts[name])) for name in names]
        paths = [path for path in dict.fromkeys(path for row in rows for path in row) if not all(_plain(row, path) for row in rows)]
        differing = [path for path in paths if len({_text(row, path) for row in rows}) > 1]
        common = [f"{path} {_with_unit(rows[0][path])}".replace(" ", HARD) for path in paths if path not in differing]
        head = f"{kind}: {', '.join(names) if not differing else f'{len(names)} parts'}" + ("; " if common else "")
        wrapped = textwrap.wrap(head + ", ".join(common), WIDTH, subsequent_indent="    ", break_long_words=False, break_on_hyphens=False)
        lines += [line.replace(HARD, " ") for line in wrapped]
        lines += _tables(names, rows, differing)
    return lines


_Field = tuple[Any, Quantity | None, bool]
"""Value, quantity and whether it is the default."""


def _fields(item: Described, before: str = "") -> Iterator[tuple[str, _Field]]:
    for field in dataclasses.fields(item):
        value, path = getattr(item, field.name), f"{before}{field.name}"
        if isinstance(value, Described):
            yield path, (type(value).__name__, None, False)
            yield from _fields(value, f"{path}.")
        else:
            yield path, (value, field.metadata.get("quantity"), value is field.default or value == field.default)


def _plain(row: Mapping[str, _Field], path: str) -> bool:
    return path not in row or row[path][2]


def _text(row: Mapping[str, _Field], path: str) -> str:
    if path not in row:
        return ""
    value, quantity, _ = row[path]
    return value if isinstance(value, str) else readable(value, quantity).removesuffix(f" {quantity.unit}" if quantity else "")


def _with_unit(field: _Field) -> str:
    value, quantity, _ = field
    return value if isinstance(value, str) else readable(value, quantity)


def _tables(names: list[str], rows: list[dict[str, _Field]], paths: list[str]) -> Iterator[str]:
    """Columns of the paths side by side, in as many tables as their width takes."""
    first = ["", *names]
    columns = []
    for path in paths:
        quantity = next((row[path][1] for row in rows if path in row), None)
        unit = f" [{quantity.unit}]" if quantity is not None and quantity.unit != "1" else ""
        columns.append([f"{path}{unit}", *(_text(row, path) for row in rows)])
    while columns:
        shown = [first]
        while columns and (len(shown) == 1 or _width([*shown, columns[0]]) <= WIDTH):
            shown.append(columns.pop(0))
        for row in zip(*shown, strict=True):
            yield "  " + "  ".join(f"{cell:<{max(map(len, column))}}" for cell, column in zip(row, shown, strict=True)).rstrip()


def _width(columns: list[list[str]]) -> int:
    return sum(max(map(len, column)) + 2 for column in columns)
