"""Compile recorded laws to plain Python scalar functions (math only, common parts shared)."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from hdrive_mbs.expression.node import Expression

_INFIX = {"add": "+", "sub": "-", "mul": "*", "div": "/", "lt": "<", "le": "<=", "eq": "=="}
_PREFIX = {"and": "({} and {})", "or": "({} or {})", "not": "(not {})", "neg": "(-{})", "pow": "pow_({}, {})"}
_CALLS = {"abs": "abs", "min": "min", "max": "max", "sign": "sign_"}


def _sign(x: float) -> float:
    return (x > 0) - (x < 0)


def _power(a: float, b: float) -> float:
    try:
        return math.pow(a, b)
    except (ValueError, OverflowError, ZeroDivisionError):
        return math.nan


def scalar_source(expressions: Sequence[Expression], arguments: Sequence[str], names: Sequence[str]) -> str:
    """Source of ``def function(names...)`` that returns a tuple of floats.

    ``arguments`` are the variables of the expressions, ``names`` the Python names of the parameters.
    Shared sub-expressions are computed once; the two branches of ``where`` only when chosen.
    """
    rename = dict(zip(arguments, names, strict=True))
    counts: dict[int, int] = {}

    def count(node: Expression) -> None:
        counts[id(node)] = counts.get(id(node), 0) + 1
        if counts[id(node)] == 1:
            for item in node.arguments:
                count(item)

    for expression in expressions:
        count(expression)
    lines: list[str] = []
    temporaries: dict[int, str] = {}

    def write(node: Expression, lazy: bool) -> str:
        if node.operation == "constant":
            return f"({node.data!r})"
        if node.operation == "variable":
            return rename[node.data]
        if id(node) in temporaries:
            return temporaries[id(node)]
        inner_lazy = lazy or node.operation == "where"
        text = _format(node, [write(item, inner_lazy and i > 0) for i, item in enumerate(node.arguments)])
        if counts[id(node)] > 1 and not lazy:
            name = f"s{len(temporaries)}"
            temporaries[id(node)] = name
            lines.append(f"    {name} = {text}")
            return name
        return text

    results = [write(expression, False) for expression in expressions]
    return "\n".join([f"def function({', '.join(names)}):", *lines, f"    return ({', '.join(results)},)"])


def _format(node: Expression, parts: list[str]) -> str:
    operation = node.operation
    if operation in _INFIX:
        return f"({parts[0]} {_INFIX[operation]} {parts[1]})"
    if operation in _PREFIX:
        return _PREFIX[operation].format(*parts)
    if operation == "where":
        return f"({parts[1]} if {parts[0]} else {parts[2]})"
    return f"{_CALLS.get(operation, operation)}({', '.join(parts)})"


def scalar_function(expressions: Sequence[Expression], arguments: Sequence[str]) -> Callable[..., tuple[float, ...]]:
    """The expressions as one Python function of floats."""
    names = [f"a{i}" for i in range(len(arguments))]
    scope = {**vars(math), "abs": abs, "min": min, "max": max, "sign_": _sign, "pow_": _power}
    exec(scalar_source(expressions, arguments, names), scope)  # our own generated source
    function: Callable[..., tuple[float, ...]] = scope["function"]
    return function
