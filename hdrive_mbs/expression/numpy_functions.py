"""What numpy functions record when they are called with expressions (NEP 13 and NEP 18)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from hdrive_mbs.expression.node import (
    FUNCTIONS,
    UFUNCS,
    Expression,
    add,
    as_node,
    choose,
    constant,
    divide,
    make,
    modulo,
    multiply,
    negate,
    power,
)


def _interp(x: Any, xp: Sequence[float], fp: Sequence[float], left: Any = None, right: Any = None) -> Expression:
    """np.interp as a bisection tree of linear pieces, so the cost grows with log2 of the points."""
    xs, ys = np.asarray(xp, float), np.asarray(fp, float)
    u = as_node(x)
    low = constant(ys[0] if left is None else left)
    high = constant(ys[-1] if right is None else right)

    def piece(i: int) -> Expression:
        slope = (ys[i + 1] - ys[i]) / (xs[i + 1] - xs[i])
        return u * float(slope) + float(ys[i] - slope * xs[i])

    def tree(first: int, last: int) -> Expression:
        if last - first == 1:
            return piece(first)
        middle = (first + last) // 2
        return choose(u < xs[middle], tree(first, middle), tree(middle, last))

    inside = tree(0, len(xs) - 1) if len(xs) > 1 else constant(ys[0])
    return choose(u < xs[0], low, choose(u > xs[-1], high, inside))


def _polyval(p: Sequence[Any], x: Any) -> Expression:
    result: Any = constant(0.0)
    for coefficient in p:
        result = result * x + coefficient
    return as_node(result)


def _clip(a: Any, a_min: Any = None, a_max: Any = None, **_: Any) -> Expression:
    result = as_node(a)
    if a_min is not None:
        result = make("max", result, as_node(a_min))
    if a_max is not None:
        result = make("min", result, as_node(a_max))
    return result


def _select(condlist: Sequence[Any], choicelist: Sequence[Any], default: Any = 0.0) -> Expression:
    result = as_node(default)
    for condition, choice in reversed(list(zip(condlist, choicelist, strict=True))):
        result = choose(condition, choice, result)
    return result


_UNARY = {
    "sin": "sin", "cos": "cos", "tan": "tan", "arcsin": "asin", "arccos": "acos", "arctan": "atan",
    "sinh": "sinh", "cosh": "cosh", "tanh": "tanh", "arcsinh": "asinh", "arccosh": "acosh", "arctanh": "atanh",
    "exp": "exp", "log": "log", "sqrt": "sqrt", "absolute": "abs", "fabs": "abs", "sign": "sign",
    "floor": "floor", "ceil": "ceil", "negative": "neg", "logical_not": "not",
}  # fmt: skip

UFUNCS |= {
    **{name: (lambda a, _op=operation: negate(a) if _op == "neg" else make(_op, a)) for name, operation in _UNARY.items()},
    "add": add, "subtract": lambda a, b: add(a, negate(b)), "multiply": multiply, "divide": divide, "power": power,
    "float_power": power, "remainder": modulo, "positive": lambda a: a,
    "square": lambda a: make("mul", a, a), "reciprocal": lambda a: divide(constant(1.0), a),
    "hypot": lambda a, b: make("sqrt", a * a + b * b), "arctan2": lambda a, b: make("atan2", a, b),
    "minimum": lambda a, b: make("min", a, b), "maximum": lambda a, b: make("max", a, b),
    "fmin": lambda a, b: make("min", a, b), "fmax": lambda a, b: make("max", a, b),
    "expm1": lambda a: make("exp", a) - 1.0, "log1p": lambda a: make("log", 1.0 + a),
    "deg2rad": lambda a: a * (math.pi / 180), "rad2deg": lambda a: a * (180 / math.pi),
    "less": lambda a, b: a < b, "less_equal": lambda a, b: a <= b, "greater": lambda a, b: a > b,
    "greater_equal": lambda a, b: a >= b, "equal": lambda a, b: a == b, "not_equal": lambda a, b: a != b,
    "logical_and": lambda a, b: a & b, "logical_or": lambda a, b: a | b,
    "bitwise_and": lambda a, b: a & b, "bitwise_or": lambda a, b: a | b,
    "heaviside": lambda a, b: choose(a < 0.0, 0.0, choose(a > 0.0, 1.0, b)),
    "copysign": lambda a, b: choose(b < 0.0, -make("abs", a), make("abs", a)),
}  # fmt: skip

FUNCTIONS |= {
    "where": choose, "interp": _interp, "polyval": _polyval, "clip": _clip, "select": _select,
}  # fmt: skip
