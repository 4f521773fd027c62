"""Use of a record: its variables, and its value with other things in their place."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from hdrive_mbs.expression.node import NUMERIC, Expression, Value, add, as_node, choose, divide, make, multiply, negate, power


def record(value: Value) -> Expression:
    """The value itself if it is an expression, a constant if it is a number.

    Raises TraceError for anything else (a law that returns None, an array, a string).
    """
    return as_node(value)


def variables(*expressions: Expression) -> set[str]:
    """Names of the free variables."""
    found: set[str] = set()
    seen: set[int] = set()
    stack = list(expressions)
    while stack:
        node = stack.pop()
        if id(node) in seen:
            continue
        seen.add(id(node))
        if node.operation == "variable":
            found.add(node.data)
        stack.extend(node.arguments)
    return found


def evaluate(expression: Expression, values: Mapping[str, Value]) -> Value:
    """The expression with its variables replaced: by numbers, arrays or other expressions."""
    known: dict[int, Value] = {}

    def visit(node: Expression) -> Value:
        key = id(node)
        if key not in known:
            if node.operation == "constant":
                known[key] = node.data
            elif node.operation == "variable":
                known[key] = values[node.data]
            else:
                arguments = [visit(item) for item in node.arguments]
                known[key] = _rebuild(node.operation, arguments)
        return known[key]

    return visit(expression)


def _rebuild(operation: str, arguments: list[Value]) -> Value:
    if any(isinstance(item, Expression) for item in arguments):
        wrapped = [as_node(item) for item in arguments]
        build = _BUILD.get(operation)
        return build(*wrapped) if build is not None else make(operation, *wrapped)
    result = NUMERIC[operation](*arguments)
    return result * 1.0 if result.dtype == np.bool_ else result


_BUILD: dict[str, Callable[..., Expression]] = {
    "add": add, "mul": multiply, "div": divide, "pow": power, "neg": negate, "where": choose,
    "sub": lambda a, b: add(a, negate(b)),
}  # fmt: skip
