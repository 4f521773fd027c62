"""Columns with units, and a head that says what they are: what every file format gets."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

_HEADING = re.compile(r"^(.*\S)\s*\[([^\[\]]*)\]$")


@dataclass(frozen=True, kw_only=True)
class Column:
    """One column.

    name : without unit
    unit : "" where there is none
    values : numbers, switches or texts
    """

    name: str
    unit: str
    values: np.ndarray


@dataclass(frozen=True, kw_only=True)
class Table:
    """Equally long columns.

    head : what, of what, how and with which versions: name -> text
    """

    columns: tuple[Column, ...]
    head: Mapping[str, str]


def table_of(columns: Mapping[str, np.ndarray], head: Mapping[str, str]) -> Table:
    """A table of columns headed ``name [unit]``; complex ones become a real and an imaginary one."""
    found: list[Column] = []
    for heading, values in columns.items():
        match = _HEADING.match(heading)
        name, unit = (match.group(1), match.group(2)) if match else (heading, "")
        values = np.asarray(values)
        if np.iscomplexobj(values):
            found += [
                Column(name=f"{name} {part}", unit=unit, values=half) for part, half in (("real", values.real), ("imaginary", values.imag))
            ]
        else:
            found.append(Column(name=name, unit=unit, values=values))
    names = [column.name for column in found]
    unique = [
        column if names.count(column.name) == 1 else Column(name=f"{column.name} [{column.unit}]", unit=column.unit, values=column.values)
        for column in found
    ]
    return Table(columns=tuple(unique), head=dict(head))
