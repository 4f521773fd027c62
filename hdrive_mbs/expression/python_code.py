"""Compile recorded laws to plain Python scalar functions (math only, common parts shared)."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from hdrive_mbs.expression.node import Expression
from hdrive_mbs.expression.pieces import unfold
from hdrive_mbs.expression.use import evaluate, in_order

_INFIX = {"add": "+", "sub": "-", "mul": "*", "div": "/", "lt": "<", "le": "<=", "eq": "=="}
_PREFIX = {"and": "({} and {})", "or": "({} or {})", "not": "(not {})", "neg": "(-{})"}
_CALLS = {"abs": "abs", "min": "min", "max": "max", "sign": "sign_", "pow": "pow_"}

DEEPEST_BLOCK = 40
"""Branches nested deeper than this are both evaluated: Python limits the indentation to 100 levels."""
DEEPEST_TEXT = 20
"""Operations written into one line: Python limits the nesting of brackets to 200 levels."""


def _sign(x: float) -> float:
    return (x > 0) - (x < 0)


class _Block:
    """Statements that run together; a branch of a ``where`` is a block inside another."""

    def __init__(self, parent: _Block | None) -> None:
        self.parent = parent
        self.depth: int = 0 if parent is None else parent.depth + 1
        self.lines: list[str] = []


def _meeting(a: _Block, b: _Block) -> _Block:
    """The innermost block that both lie in."""
    while a is not b:
        if a.depth < b.depth:
            a, b = b, a
        assert a.parent is not None
        a = a.parent
    return a


def scalar_source(expressions: Sequence[Expression], arguments: Sequence[str], names: Sequence[str]) -> str:
    """Source of ``def function(names...)`` that returns a tuple of floats.

    ``arguments`` are the variables of the expressions, ``names`` the Python names of the parameters.
    Shared sub-expressions are computed once; what only one branch of a ``where`` needs, only when
    that branch is chosen.  ``otherwise_(names...)`` is called where Python's math raises.
    """
    rename = dict(zip(arguments, names, strict=True))
    expressions = unfold(*expressions)
    nodes = in_order(*expressions)
    body = _Block(None)
    place: dict[int, _Block] = {}
    branches: dict[int, tuple[_Block, _Block]] = {}
    uses: dict[int, int] = {}

    def use(node: Expression, block: _Block) -> None:
        key = id(node)
        uses[key] = uses.get(key, 0) + 1
        place[key] = block if key not in place else _meeting(place[key], block)

    for expression in expressions:
        use(expression, body)
    for node in reversed(nodes):
        block = place[id(node)]
        inner = (block, block)
        if node.operation == "where" and block.depth < DEEPEST_BLOCK:
            inner = (_Block(block), _Block(block))
            branches[id(node)] = inner
        for item, target in zip(node.arguments, (block, *inner) if node.operation == "where" else (block, block)):
            use(item, target)

    text: dict[int, str] = {}
    depth: dict[int, int] = {}
    for number, node in enumerate(nodes):
        key, block = id(node), place[id(node)]
        parts = [text[id(item)] for item in node.arguments]
        name = f"s{number}"
        deep = 1 + max((depth[id(item)] for item in node.arguments), default=-1)
        if node.operation == "constant":
            text[key] = f"({node.data!r})"
        elif node.operation == "variable":
            text[key] = rename[node.data]
        elif key in branches:
            for branch, value, head in zip(branches[key], parts[1:], (f"if {parts[0]}:", "else:")):
                block.lines += [head, *(f"    {line}" for line in branch.lines), f"    {name} = {value}"]
            text[key], deep = name, 0
        elif uses[key] > 1 or deep > DEEPEST_TEXT:
            block.lines.append(f"{name} = {_format(node, parts)}")
            text[key], deep = name, 0
        else:
            text[key] = _format(node, parts)
        depth[key] = deep
    results = ", ".join(text[id(expression)] for expression in expressions)
    lines = ["try:", *(f"    {line}" for line in body.lines), f"    return ({results},)"]
    lines += ["except (ValueError, OverflowError, ZeroDivisionError):", f"    return otherwise_({', '.join(names)})"]
    return "\n".join([f"def function({', '.join(names)}):", *(f"    {line}" for line in lines)])


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
    """The expressions as one Python function of floats.

    Where Python's math raises (1/0, log(-1), exp(1000)) it gives what numpy gives, inf or nan.
    """
    names = [f"a{i}" for i in range(len(arguments))]

    def otherwise(*values: float) -> tuple[float, ...]:
        numbers = {name: np.float64(value) for name, value in zip(arguments, values, strict=True)}
        with np.errstate(all="ignore"):
            return tuple(float(evaluate(expression, numbers)) for expression in expressions)

    scope = {**vars(math), "abs": abs, "min": min, "max": max, "sign_": _sign, "pow_": math.pow, "otherwise_": otherwise}
    exec(scalar_source(expressions, arguments, names), scope)  # our own generated source
    function: Callable[..., tuple[float, ...]] = scope["function"]
    return function
