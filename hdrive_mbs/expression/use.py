"""Use of a record: its variables, and its value with other things in their place."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from hdrive_mbs.errors import HdriveError
from hdrive_mbs.expression.node import NUMERIC, Expression, TraceError, Value, add, as_node, choose, divide, make, multiply, negate, power


def record(value: Value) -> Expression:
    """The value itself if it is an expression, a constant if it is a number.

    Raises TraceError for anything else (a law that returns None, an array, a string).
    """
    return as_node(value)


def trace(law: Callable[..., Value], *arguments: Value) -> Expression:
    """The law as an expression.

    Raises TraceError for whatever stops the recording: a law for plain numbers may ask an
    expression for anything (``x.copy()``, ``table[x]``, ``round(x)``).
    """
    try:
        return record(law(*arguments))
    except (TraceError, HdriveError):
        raise
    except Exception as error:
        text = str(error).strip().split("\n")[0]
        raise TraceError(f"the law cannot be recorded ({type(error).__name__}: {text})") from error


def in_order(*expressions: Expression) -> list[Expression]:
    """All nodes, each once, arguments before what uses them (no recursion: records may be deep)."""
    ordered: list[Expression] = []
    seen: set[int] = set()
    stack: list[Expression | None] = list(reversed(expressions))  # None: the arguments of the node below it are done
    while stack:
        node = stack.pop()
        if node is None:
            ordered.append(stack.pop())  # type: ignore[arg-type]
        elif id(node) not in seen:
            seen.add(id(node))
            if node.arguments:
                stack += (node, None, *reversed(node.arguments))
            else:
                ordered.append(node)
    return ordered


def variables(*expressions: Expression) -> set[str]:
    """Names of the free variables."""
    return {node.data for node in in_order(*expressions) if node.operation == "variable"}


def evaluate(expression: Expression, values: Mapping[str, Value]) -> Value:
    """The expression with its variables replaced: by numbers, arrays or other expressions."""
    known: dict[int, Value] = {}
    for node in in_order(expression):
        if node.operation == "constant":
            known[id(node)] = node.data
        elif node.operation == "variable":
            known[id(node)] = values[node.data]
        else:
            known[id(node)] = rebuilt(node, [known[id(item)] for item in node.arguments])
    return known[id(expression)]


def rebuilt(node: Expression, arguments: Sequence[Value]) -> Value:
    """The operation of a node on other arguments."""
    operation = node.operation
    if operation == "pieces":
        return node.data(arguments[0])
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
