"""What numpy functions record when they are called with expressions (NEP 13 and NEP 18)."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from hdrive_mbs.expression.by_identity import ByIdentity
from hdrive_mbs.expression.node import (
    FUNCTIONS,
    UFUNCS,
    Expression,
    TraceError,
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
    truth,
)
from hdrive_mbs.expression.pieces import Pieces, lines_between

_tables: ByIdentity[Pieces] = ByIdentity(64)
"""Tables of the laws recorded last: a long table is read once, however often its law is recorded."""


def _interp(x: Any, xp: Sequence[float], fp: Sequence[float], left: Any = None, right: Any = None, period: Any = None) -> Expression:
    """np.interp as one node, however long the table is."""
    if period is not None:
        raise TraceError("np.interp with period= cannot be recorded; write np.interp(np.mod(x, period), ...)")
    if left is None and right is None:
        return as_node(_tables.of(xp, fp, lambda: _lines(xp, fp, None, None))(as_node(x)))
    return as_node(_lines(xp, fp, left, right)(as_node(x)))


def _lines(xp: Sequence[float], fp: Sequence[float], left: Any, right: Any) -> Pieces:
    xs, ys = np.asarray(xp, float), np.asarray(fp, float)
    if xs.ndim != 1 or xs.shape != ys.shape or not len(xs) or np.any(np.diff(xs) < 0.0):
        raise TraceError(f"np.interp needs as many values ({ys.shape}) as rising points ({xs.shape})")
    return lines_between(xs, ys, ys[0] if left is None else left, ys[-1] if right is None else right)


def _polyval(p: Sequence[Any], x: Any) -> Expression:
    result: Any = constant(0.0)
    for coefficient in p:
        result = result * x + coefficient
    return as_node(result)


def _clip(a: Any, a_min: Any = None, a_max: Any = None, *, min: Any = None, max: Any = None) -> Expression:
    a_min, a_max = (a_min if min is None else min), (a_max if max is None else max)
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


def _truncate(a: Expression) -> Expression:
    return choose(a < 0.0, make("ceil", a), make("floor", a))


def _log1p(a: Expression) -> Expression:
    small = 2.0 * make("atanh", divide(a, 2.0 + a))  # exact to rounding near zero
    return choose(make("abs", a) < 0.5, small, make("log", 1.0 + a))


def _filled(value: float) -> Callable[..., Expression]:
    def like(_shape_of: Any) -> Expression:
        return constant(value)

    return like


_UNARY = {
    "sin": "sin", "cos": "cos", "tan": "tan", "arcsin": "asin", "arccos": "acos", "arctan": "atan",
    "sinh": "sinh", "cosh": "cosh", "tanh": "tanh", "arcsinh": "asinh", "arccosh": "acosh", "arctanh": "atanh",
    "exp": "exp", "log": "log", "sqrt": "sqrt", "absolute": "abs", "fabs": "abs", "sign": "sign",
    "floor": "floor", "ceil": "ceil", "negative": "neg", "logical_not": "not",
}  # fmt: skip

UFUNCS |= {
    **{name: (lambda a, _op=operation: negate(a) if _op == "neg" else make(_op, a)) for name, operation in _UNARY.items()},
    "add": add, "subtract": lambda a, b: add(a, negate(b)), "multiply": multiply, "divide": divide, "power": power,
    "float_power": power, "positive": lambda a: a, "trunc": _truncate,
    "remainder": modulo, "fmod": lambda a, b: a - b * _truncate(divide(a, b)), "floor_divide": lambda a, b: a // b,
    "square": lambda a: make("mul", a, a), "reciprocal": lambda a: divide(constant(1.0), a),
    "hypot": lambda a, b: make("sqrt", a * a + b * b), "arctan2": lambda a, b: make("atan2", a, b),
    "minimum": lambda a, b: make("min", a, b), "maximum": lambda a, b: make("max", a, b),
    "fmin": lambda a, b: make("min", a, b), "fmax": lambda a, b: make("max", a, b),
    "expm1": lambda a: 2.0 * make("sinh", 0.5 * a) * make("exp", 0.5 * a), "log1p": _log1p,
    "exp2": lambda a: power(constant(2.0), a), "cbrt": lambda a: make("sign", a) * power(make("abs", a), constant(1.0 / 3.0)),
    "log2": lambda a: make("log", a) / math.log(2.0), "log10": lambda a: make("log", a) / math.log(10.0),
    **dict.fromkeys(("deg2rad", "radians"), lambda a: a * (math.pi / 180)),
    **dict.fromkeys(("rad2deg", "degrees"), lambda a: a * (180 / math.pi)),
    "less": lambda a, b: a < b, "less_equal": lambda a, b: a <= b, "greater": lambda a, b: a > b,
    "greater_equal": lambda a, b: a >= b, "equal": lambda a, b: a == b, "not_equal": lambda a, b: a != b,
    "logical_and": lambda a, b: truth(a) & truth(b), "logical_or": lambda a, b: truth(a) | truth(b),
    "bitwise_and": lambda a, b: a & b, "bitwise_or": lambda a, b: a | b, "invert": lambda a: ~a,
    "logical_xor": lambda a, b: truth(a) ^ truth(b), "bitwise_xor": lambda a, b: a ^ b,
    "heaviside": lambda a, b: choose(a < 0.0, 0.0, choose(a > 0.0, 1.0, b)),
    "copysign": lambda a, b: choose(b < 0.0, -make("abs", a), make("abs", a)),
}  # fmt: skip

FUNCTIONS |= {
    "where": choose, "interp": _interp, "polyval": _polyval, "clip": _clip, "select": _select,
    "zeros_like": _filled(0.0), "ones_like": _filled(1.0), "full_like": lambda _shape_of, value: as_node(value),
}  # fmt: skip
