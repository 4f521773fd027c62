"""Derivatives of recorded laws."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from hdrive_mbs.expression.node import Expression, Value, as_node, choose, constant, is_constant, make, power, variable
from hdrive_mbs.expression.use import evaluate, in_order, trace


def derivative(expression: Expression, name: str) -> Expression:
    """Partial derivative with respect to the variable.

    At kinks (abs, sign, min, max, where) the derivative is the one-sided derivative of the branch
    that the condition selects; jumps contribute nothing.  At the tip of a root, where its argument is 0 and
    level and smooth as of a radius sqrt(x^2 + y^2) at the centre, it is 0, the mean of all directions.
    """
    known: dict[int, Expression] = {}
    for node in in_order(expression):
        known[id(node)] = _differentiate(node, [known[id(item)] for item in node.arguments], name)
    return known[id(expression)]


Rule = Callable[..., Any]
"""Derivative of one operation from (node, *arguments, *their derivatives)."""


def _differentiate(node: Expression, slopes: list[Expression], name: str) -> Expression:
    operation, args = node.operation, node.arguments
    if operation == "variable":
        return constant(1.0 if node.data == name else 0.0)
    if operation in _FLAT:
        return constant(0.0)
    if operation == "where":
        return choose(args[0], slopes[1], slopes[2])
    if operation in ("min", "max"):
        first, second = args if operation == "min" else (args[1], args[0])
        return choose(first < second, slopes[0], slopes[1])
    if all(is_constant(item, 0.0) for item in slopes):
        return constant(0.0)
    if operation == "pieces":
        return as_node(node.data.derivative()(args[0]) * slopes[0])
    return as_node(_RULES[operation](node, *args, *slopes))


_FLAT = {"constant", "sign", "floor", "ceil", "lt", "le", "eq", "and", "or", "not"}


def _d_pow(node: Expression, a: Expression, b: Expression, da: Expression, db: Expression) -> Expression:
    result = b * power(a, b - 1.0) * da
    if is_constant(b) and 0.5 <= b.data < 1.0:
        result = _level(result, a, da)
    if not is_constant(db, 0.0):
        result = result + node * make("log", a) * db
    return result


def _level(slope: Expression, a: Expression, da: Expression) -> Expression:
    """The slope of a root of a, but 0 where a smooth a is level: there the slope itself is 0/0, and a grows as a square at least."""
    return choose(da == 0.0, constant(0.0), slope) if not is_constant(da) and all(map(_is_smooth, in_order(a))) else slope


def _is_smooth(node: Expression) -> bool:
    if node.operation == "pow":
        exponent = node.arguments[1]
        return is_constant(exponent) and exponent.data >= 0.0 and exponent.data.is_integer()
    return node.operation in _SMOOTH


_SMOOTH = {"variable", "constant", "add", "sub", "mul", "div", "neg", "sin", "cos", "tan", "atan", "sinh", "cosh", "tanh", "asinh", "exp"}


_RULES: dict[str, Rule] = {
    "add": lambda n, a, b, da, db: da + db,
    "sub": lambda n, a, b, da, db: da - db,
    "mul": lambda n, a, b, da, db: da * b + a * db,
    "div": lambda n, a, b, da, db: da / b - a * db / (b * b),
    "pow": _d_pow,
    "neg": lambda n, a, da: -da,
    "sin": lambda n, a, da: make("cos", a) * da,
    "cos": lambda n, a, da: -(make("sin", a) * da),
    "tan": lambda n, a, da: (1.0 + n * n) * da,
    "asin": lambda n, a, da: da / make("sqrt", 1.0 - a * a),
    "acos": lambda n, a, da: -(da / make("sqrt", 1.0 - a * a)),
    "atan": lambda n, a, da: da / (1.0 + a * a),
    "atan2": lambda n, a, b, da, db: (da * b - a * db) / (a * a + b * b),
    "sinh": lambda n, a, da: make("cosh", a) * da,
    "cosh": lambda n, a, da: make("sinh", a) * da,
    "tanh": lambda n, a, da: (1.0 - n * n) * da,
    "asinh": lambda n, a, da: da / make("sqrt", a * a + 1.0),
    "acosh": lambda n, a, da: da / make("sqrt", a * a - 1.0),
    "atanh": lambda n, a, da: da / (1.0 - a * a),
    "exp": lambda n, a, da: n * da,
    "log": lambda n, a, da: da / a,
    "sqrt": lambda n, a, da: _level(da / (2.0 * n), a, da),
    "abs": lambda n, a, da: make("sign", a) * da,
}


def gradient(function: Callable[[Value], Value]) -> Callable[[Value], Value]:
    """Derivative of a function of one argument, usable on numbers, arrays and expressions.

    Raises TraceError where the function cannot be recorded.
    """
    slope = derivative(trace(function, variable("x")), "x")

    def of(x: Value) -> Value:
        value = evaluate(slope, {"x": x})
        return np.full(np.shape(x), value) if is_constant(slope) and isinstance(x, np.ndarray) else value

    return of
