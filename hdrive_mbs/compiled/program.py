"""Recorded expressions taken apart: what they compute (the structure) and with which numbers.

Two scenes that differ in numbers alone have the same structure, so that one piece of machine code serves both.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.structure import Plan, Structure, shaped
from hdrive_mbs.compiled.time_inputs import TIME, TimeInput, digest, time_input
from hdrive_mbs.expression import Expression, Pieces, in_order
from hdrive_mbs.tracked import Tracked, plain

FloatArray = npt.NDArray[np.float64]

WRITTEN = (0.0, 1.0, -1.0, 2.0, 0.5)
"""Numbers that belong to a structure: most of them come from the form of a law, not from its data."""

_tables: WeakKeyDictionary[Pieces, Table] = WeakKeyDictionary()


@dataclass(frozen=True, eq=False)
class Table:
    """A piecewise polynomial in a row: breaks, starts and coefficients of its pieces."""

    pieces: int
    values: FloatArray


@dataclass(frozen=True, eq=False)
class Numbers:
    """Where the constants of a program come from.

    found : constants of the recorded expressions, in order; tracked ones where the fields of a scene were
    """

    found: tuple[float, ...]
    plan: Plan

    def constants(self, found: FloatArray) -> FloatArray:
        """Those of the program, shape (..., program), from these of the expressions, shape (..., found)."""
        values = np.concatenate([np.zeros((*found.shape[:-1], 1)), found], axis=-1)[..., self.plan.constants]
        values[..., self.plan.inverses] = 1.0 / values[..., self.plan.inverses]
        return np.asarray(values)


@dataclass(frozen=True, eq=False)
class Program:
    """A structure with its numbers.

    constants : values that the steps "constant" refer to by position;  numbers : where they come from
    tables : what the steps "pieces" refer to
    inputs : what is known before a run; the first is the time
    """

    structure: Structure
    constants: FloatArray
    tables: tuple[Table, ...]
    inputs: tuple[TimeInput, ...]
    numbers: Numbers


def program(rates: Sequence[Expression], readings: Sequence[Expression], variables: Sequence[str]) -> Program:
    """Take expressions over these variables apart.  Equal steps become one; the variable "t" is the time."""
    ordered = in_order(*rates, *readings)
    exponents = {id(node.arguments[1]) for node in ordered if node.operation == "pow"}
    place: dict[int, int] = {}
    form: list[tuple[str, Any, tuple[int, ...]]] = []
    constants: list[float] = []
    tables: dict[bytes, tuple[int, Pieces]] = {}
    for k, node in enumerate(ordered):
        operation, data, arguments = node.operation, node.data, node.arguments
        place[id(node)] = k
        if len(arguments) == 2:
            form.append((operation, None, (place[id(arguments[0])], place[id(arguments[1])])))
        elif operation == "constant":
            if type(data) is not Tracked and (
                data in WRITTEN or (id(node) in exponents and abs(data) <= 9.0 and (2.0 * data).is_integer())
            ):
                form.append(("number", data, ()))
            else:
                form.append(("constant", len(constants), ()))
                constants.append(data)
        elif operation == "variable":
            form.append(("variable", data, ()))
        elif operation == "pieces":
            number, _ = tables.setdefault(digest(data), (len(tables), data))
            form.append(("pieces", (number, data.coefficients.shape[1]), (place[id(arguments[0])],)))
        else:
            form.append((operation, None, tuple([place[id(item)] for item in arguments])))
    results = tuple([place[id(item)] for item in rates]), tuple([place[id(item)] for item in readings])
    numbers = [plain(value) for value in constants]
    plan = shaped(tuple(form), *results, tuple(variables)).plan(numbers)
    taken = Numbers(tuple(constants), plan)
    pieces = [item for _, item in tables.values()]
    return Program(
        plan.structure,
        taken.constants(np.array(numbers)),
        tuple(_table(pieces[k]) for k in plan.tables),
        (TIME, *(time_input(ordered[k]) for k in plan.inputs)),
        taken,
    )


def _table(pieces: Pieces) -> Table:
    if pieces not in _tables:
        flat = np.concatenate([pieces.breaks, pieces.starts, pieces.coefficients.ravel()], dtype=float)
        _tables[pieces] = Table(len(pieces.starts), flat)
    return _tables[pieces]
