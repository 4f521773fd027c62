"""Recorded expressions -> exudyn.symbolic expressions and user functions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import exudyn as exu

from hdrive_mbs.expression import Expression, Pieces, constant, in_order, variable

esym = exu.symbolic

SYMBOLIC_VECTOR_LIMIT = 6
"""Symbolic vectors of 8 or more entries corrupt memory in exudyn 1.13; 6 are safe."""

_BINARY = {
    "add": lambda a, b: a + b, "sub": lambda a, b: a - b, "mul": lambda a, b: a * b, "div": lambda a, b: a / b,
    "pow": esym.pow, "min": esym.min, "max": esym.max, "atan2": esym.atan2,
    "lt": lambda a, b: a < b, "le": lambda a, b: a <= b, "eq": lambda a, b: a == b,
    "and": lambda a, b: esym.IfThenElse(a, b, esym.Real(0.0)),
    "or": lambda a, b: esym.IfThenElse(a, esym.Real(1.0), b),
}  # fmt: skip
_UNARY = {
    **{name: getattr(esym, name) for name in (
        "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh",
        "exp", "log", "sqrt", "abs", "sign", "floor", "ceil")},
    "neg": lambda a: -a,
    "not": lambda a: esym.IfThenElse(a, esym.Real(0.0), esym.Real(1.0)),
}  # fmt: skip


LARGEST_LAW = 20_000
"""Operations up to which a law is lowered; above it a compiled Python callback with shared parts is faster."""


def written_out(expression: Expression) -> int:
    """Number of operations with every shared part written out, which is how exudyn evaluates."""
    sizes: dict[int, int] = {}
    for node in in_order(expression):
        sizes[id(node)] = 1 + sum(sizes[id(item)] for item in node.arguments)
    return sizes[id(expression)]


def emit(expression: Expression, values: dict[str, Any]) -> Any:
    """The expression over exudyn.symbolic reals (recording must be on)."""
    known: dict[int, Any] = {}
    for node in in_order(expression):
        arguments = [known[id(item)] for item in node.arguments]
        if node.operation == "constant":
            made = esym.Real(node.data)
        elif node.operation == "variable":
            made = values[node.data]
        elif node.operation == "where":
            made = esym.IfThenElse(*arguments)
        elif node.operation == "pieces":
            made = _bisection(node.data, arguments[0])
        elif len(arguments) == 1:
            made = _UNARY[node.operation](arguments[0])
        else:
            made = _BINARY[node.operation](*arguments)
        known[id(node)] = made
    return known[id(expression)]


def _bisection(pieces: Pieces, x: Any) -> Any:
    """A table as nested branches: log2 of its length is evaluated, whatever its length."""
    breaks, starts = pieces.breaks.tolist(), pieces.starts.tolist()
    rows = pieces.coefficients.tolist()

    def piece(i: int) -> Any:
        value = esym.Real(rows[i][-1])
        for coefficient in rows[i][-2::-1]:
            value = value * (x - starts[i]) + coefficient
        return value

    def between(first: int, last: int) -> Any:
        if first == last:
            return piece(first)
        middle = (first + last) // 2
        return esym.IfThenElse(x < breaks[middle], between(first, middle), between(middle + 1, last))

    return between(0, len(starts) - 1)


def _operation(expression: Expression, name: str) -> Expression:
    """A bare constant or variable as an operation, which is what a user function must return."""
    if expression.operation not in ("constant", "variable"):
        return expression
    return Expression("add", (expression, Expression("mul", (constant(0.0), variable(name)))))


_SCALAR = {
    "ObjectConnectorCoordinateSpringDamper": 3,
    "ObjectConnectorCoordinateSpringDamperExt": 9,
}
"""Number of object parameters that follow displacement and velocity in a connector's user function."""


def _user_function(mbs: Any, item: str, function: str, arguments: list[Any], types: list[str], value: Any, kind: str) -> Any:
    record = esym.UserFunction()
    record.SetUserFunctionFromDict(
        mbs,
        {
            "functionName": "law",
            "argList": [mbs, *arguments],
            "argTypeList": ["MainSystem", *types],
            "returnValue": value,
            "returnType": kind,
        },
        function,
        None,
        item,
    )
    return record


def connector_function(mbs: Any, item: str, torque: Expression) -> Any:
    """Symbolic spring user function of a coordinate connector; variables ``t``, ``x`` and ``v``."""
    extra = _SCALAR[item]
    was_on = esym.GetRecording()
    esym.SetRecording(True)
    try:
        names = ["t", "i", "x", "v", *(f"p{k}" for k in range(extra))]
        reals = [esym.Real(name, 0.0) for name in names]
        value = emit(_operation(torque, "x"), {"t": reals[0], "x": reals[2], "v": reals[3]})
    finally:
        esym.SetRecording(was_on)
    types = ["Real", "Index", *["Real"] * (extra + 2)]
    return _user_function(mbs, item, "springForceUserFunction", reals, types, value, "Real")


def generic_function(mbs: Any, outputs: Sequence[Expression], positions: Sequence[str], velocities: Sequence[str]) -> Any:
    """Symbolic force user function of ObjectGenericODE2.

    positions, velocities : variable names that the entries of q and q_t stand for ("" if unused)
    """
    n = len(outputs)
    if n > SYMBOLIC_VECTOR_LIMIT:
        raise ValueError(f"{n} coordinates exceed the symbolic limit of {SYMBOLIC_VECTOR_LIMIT}")
    was_on = esym.GetRecording()
    esym.SetRecording(True)
    try:
        time, index = esym.Real("t", 0.0), esym.Real("i", 0.0)
        q, q_t = esym.Vector("q", [0.0] * n), esym.Vector("q_t", [0.0] * n)
        values: dict[str, Any] = {"t": time}
        values |= {name: q[k] for k, name in enumerate(positions) if name}
        values |= {name: q_t[k] for k, name in enumerate(velocities) if name}
        value = esym.Vector([emit(_operation(item, "t"), values) for item in outputs])
    finally:
        esym.SetRecording(was_on)
    types = ["Real", "Index", "StdVector", "StdVector"]
    return _user_function(mbs, "ObjectGenericODE2", "forceUserFunction", [time, index, q, q_t], types, value, "StdVector")
