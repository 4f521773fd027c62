"""Recorded expressions taken apart: what they compute (the structure) and with which numbers.

Two scenes that differ in numbers alone have the same structure, so that one piece of machine code serves both.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.expression import Expression, in_order
from hdrive_mbs.expression.pieces import Pieces

FloatArray = npt.NDArray[np.float64]

WRITTEN = (0.0, 1.0, -1.0, 2.0, 0.5)
"""Numbers that belong to a structure: most of them come from the form of a law, not from its data."""


@dataclass(frozen=True)
class Step:
    """One operation: its arguments are numbers of earlier steps."""

    operation: str
    arguments: tuple[int, ...]
    data: str | float | int | tuple[int, ...] | None = None


@dataclass(frozen=True)
class Structure:
    """Steps that compute ``results`` from variables, constants and tables."""

    variables: tuple[str, ...]
    steps: tuple[Step, ...]
    results: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Program:
    """A structure with its numbers.

    constants : values that the steps "constant" refer to by position
    tables : breaks, starts and coefficients of all piecewise polynomials, one after the other
    """

    structure: Structure
    constants: FloatArray
    tables: FloatArray


def program(expressions: Sequence[Expression], variables: Sequence[str]) -> Program:
    """Take expressions over these variables apart.  Equal steps become one."""
    index = {name: k for k, name in enumerate(variables)}
    steps: list[Step] = []
    known: dict[Step, int] = {}
    number: dict[int, int] = {}
    constants: list[float] = []
    tables: list[FloatArray] = []
    size = 0

    def add(step: Step) -> int:
        if step not in known:
            known[step] = len(steps)
            steps.append(step)
        return known[step]

    exponents = {id(node.arguments[1]) for node in in_order(*expressions) if node.operation == "pow"}
    for node in in_order(*expressions):
        arguments = tuple(number[id(item)] for item in node.arguments)
        if node.operation == "variable":
            made = Step("variable", (), index[node.data])
        elif node.operation == "constant":
            value = float(node.data)
            if value in WRITTEN or (id(node) in exponents and value == int(value) and abs(value) <= 9.0):
                made = Step("number", (), value)
            else:
                made = Step("constant", (), len(constants))
                constants.append(value)
        elif node.operation == "pieces":
            pieces: Pieces = node.data
            count, width = pieces.coefficients.shape
            made = Step("pieces", arguments, (size, count, width))
            flat = np.concatenate([pieces.breaks, pieces.starts, pieces.coefficients.ravel()])
            tables.append(flat)
            size += len(flat)
        else:
            made = Step(node.operation, arguments)
        number[id(node)] = add(made)
    results = tuple(number[id(expression)] for expression in expressions)
    whole = np.concatenate(tables) if tables else np.zeros(1)
    return Program(Structure(tuple(variables), tuple(steps), results), np.array(constants or [0.0]), whole)
