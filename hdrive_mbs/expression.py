"""Expressions recorded from laws.

A law is written once, with ordinary arithmetic and numpy functions.  Called with numbers or
arrays it computes; called with :class:`Expression` arguments it records itself.  The engine
turns the record into a symbolic user function, the analyses differentiate it, and a law that
cannot be recorded (``if`` on an argument, ``math.sin``, ``float(x)``) raises
:class:`TraceError` instead of being frozen silently at one value.

numpy dispatches to expressions by its ``__array_ufunc__`` and ``__array_function__`` protocols
(NEP 13, NEP 18), so ``np.sin``, ``np.where``, ``np.clip``, ``np.interp`` work unchanged.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

Value = Any
"""A float, an array of floats or an Expression: what laws take and return."""


class TraceError(TypeError):
    """A law did something with its argument that cannot be recorded."""


class Expression:
    """A node of a recorded law: an operation on other nodes, a constant or a variable."""

    __slots__ = ("arguments", "data", "operation")
    __hash__ = object.__hash__

    def __init__(self, operation: str, arguments: tuple[Expression, ...] = (), data: Any = None) -> None:
        self.operation = operation
        self.arguments = arguments
        self.data = data

    # -- what cannot be recorded --------------------------------------------------------------
    def __bool__(self) -> bool:
        raise TraceError(
            "the law decides with 'if', 'and', 'or', 'min' or 'max' on its argument; write np.where, &, |, np.minimum, np.maximum"
        )

    def __float__(self) -> float:
        raise TraceError("the law turns its argument into a plain float (math.sin, float()); use the numpy function")

    def __int__(self) -> int:
        raise TraceError("the law turns its argument into a plain int; use np.floor or np.trunc")

    def __array__(self, *_: Any, **__: Any) -> Any:
        raise TraceError("the law puts its argument into an array; use it directly in arithmetic and numpy functions")

    def __iter__(self) -> Any:
        raise TraceError("the law iterates over its argument")

    # -- arithmetic ---------------------------------------------------------------------------
    def __add__(self, other: Value) -> Expression:
        return _add(self, _wrap(other))

    def __radd__(self, other: Value) -> Expression:
        return _add(_wrap(other), self)

    def __sub__(self, other: Value) -> Expression:
        return _add(self, _neg(_wrap(other)))

    def __rsub__(self, other: Value) -> Expression:
        return _add(_wrap(other), _neg(self))

    def __mul__(self, other: Value) -> Expression:
        return _mul(self, _wrap(other))

    def __rmul__(self, other: Value) -> Expression:
        return _mul(_wrap(other), self)

    def __truediv__(self, other: Value) -> Expression:
        return _div(self, _wrap(other))

    def __rtruediv__(self, other: Value) -> Expression:
        return _div(_wrap(other), self)

    def __pow__(self, other: Value) -> Expression:
        return _pow(self, _wrap(other))

    def __rpow__(self, other: Value) -> Expression:
        return _pow(_wrap(other), self)

    def __mod__(self, other: Value) -> Expression:
        return _mod(self, _wrap(other))

    def __neg__(self) -> Expression:
        return _neg(self)

    def __pos__(self) -> Expression:
        return self

    def __abs__(self) -> Expression:
        return _node("abs", self)

    # -- comparisons and logic (values 0 or 1) --------------------------------------------------
    def __lt__(self, other: Value) -> Expression:
        return _node("lt", self, _wrap(other))

    def __le__(self, other: Value) -> Expression:
        return _node("le", self, _wrap(other))

    def __gt__(self, other: Value) -> Expression:
        return _node("lt", _wrap(other), self)

    def __ge__(self, other: Value) -> Expression:
        return _node("le", _wrap(other), self)

    def __eq__(self, other: object) -> Expression:  # type: ignore[override]
        return _node("eq", self, _wrap(other))

    def __ne__(self, other: object) -> Expression:  # type: ignore[override]
        return _node("not", _node("eq", self, _wrap(other)))

    def __and__(self, other: Value) -> Expression:
        return _node("and", self, _wrap(other))

    __rand__ = __and__

    def __or__(self, other: Value) -> Expression:
        return _node("or", self, _wrap(other))

    __ror__ = __or__

    def __invert__(self) -> Expression:
        return _node("not", self)

    # -- numpy protocols ------------------------------------------------------------------------
    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **kwargs: Any) -> Any:
        handler = _UFUNCS.get(ufunc.__name__)
        if method != "__call__" or handler is None or kwargs.get("out") is not None:
            raise TraceError(f"np.{ufunc.__name__} cannot be recorded")
        return handler(*(_wrap(item) for item in inputs))

    def __array_function__(self, function: Any, _types: Any, args: Any, kwargs: Any) -> Any:
        handler = _FUNCTIONS.get(function.__name__)
        if handler is None:
            raise TraceError(f"np.{function.__name__} cannot be recorded")
        return handler(*args, **kwargs)

    def __repr__(self) -> str:
        if self.operation == "constant":
            return repr(self.data)
        if self.operation == "variable":
            return str(self.data)
        return f"{self.operation}({', '.join(map(repr, self.arguments))})"


# -- construction, folding constants as it goes ---------------------------------------------------


def constant(number: float) -> Expression:
    """A constant node."""
    return Expression("constant", (), float(number))


def variable(name: str) -> Expression:
    """A free variable of the given name."""
    return Expression("variable", (), name)


def _wrap(value: Any) -> Expression:
    if isinstance(value, Expression):
        return value
    if isinstance(value, (bool, int, float, np.number, np.bool_)):
        return constant(float(value))
    if isinstance(value, np.ndarray) and value.ndim == 0:
        return constant(float(value))
    raise TraceError(f"the law mixes its argument with a {type(value).__name__}; only numbers can be recorded")


def is_constant(expression: Expression, value: float | None = None) -> bool:
    """Whether the node is a constant (of the given value)."""
    return expression.operation == "constant" and (value is None or expression.data == value)


def _node(operation: str, *arguments: Expression) -> Expression:
    if all(item.operation == "constant" for item in arguments):
        with np.errstate(all="ignore"):
            return constant(float(_NUMERIC[operation](*(np.float64(item.data) for item in arguments))))
    return Expression(operation, arguments)


def _add(a: Expression, b: Expression) -> Expression:
    if is_constant(a, 0.0):
        return b
    if is_constant(b, 0.0):
        return a
    if b.operation == "neg":
        return _node("sub", a, b.arguments[0])
    return _node("add", a, b)


def _neg(a: Expression) -> Expression:
    return a.arguments[0] if a.operation == "neg" else _node("neg", a)


def _mul(a: Expression, b: Expression) -> Expression:
    if is_constant(b):
        a, b = b, a
    if is_constant(a):
        if a.data == 0.0:
            return a
        if a.data == 1.0:
            return b
        if a.data == -1.0:
            return _neg(b)
        if b.operation == "mul" and is_constant(b.arguments[0]):
            return _mul(constant(a.data * b.arguments[0].data), b.arguments[1])
    return _node("mul", a, b)


def _div(a: Expression, b: Expression) -> Expression:
    if is_constant(b) and b.data != 0.0:
        return a if b.data == 1.0 else _node("div", a, b)
    return a if is_constant(a, 0.0) else _node("div", a, b)


def _pow(a: Expression, b: Expression) -> Expression:
    if is_constant(b, 1.0):
        return a
    if is_constant(b, 0.0):
        return constant(1.0)
    if is_constant(b, 2.0) and a.operation == "variable":
        return _node("mul", a, a)
    return _node("pow", a, b)


def _mod(a: Expression, b: Expression) -> Expression:
    return a - b * _node("floor", _div(a, b))


def _where(condition: Any, a: Any, b: Any) -> Expression:
    chosen, other = _wrap(a), _wrap(b)
    test = _wrap(condition)
    if is_constant(test):
        return chosen if test.data else other
    if is_constant(chosen) and is_constant(other) and chosen.data == other.data:
        return chosen
    return Expression("where", (test, chosen, other))


def _interp(x: Any, xp: Sequence[float], fp: Sequence[float], left: Any = None, right: Any = None) -> Expression:
    """np.interp as a bisection tree of linear pieces, so the cost grows with log2 of the points."""
    xs, ys = np.asarray(xp, float), np.asarray(fp, float)
    u = _wrap(x)
    low = constant(ys[0] if left is None else left)
    high = constant(ys[-1] if right is None else right)

    def piece(i: int) -> Expression:
        slope = (ys[i + 1] - ys[i]) / (xs[i + 1] - xs[i])
        return u * float(slope) + float(ys[i] - slope * xs[i])

    def tree(first: int, last: int) -> Expression:
        if last - first == 1:
            return piece(first)
        middle = (first + last) // 2
        return _where(u < xs[middle], tree(first, middle), tree(middle, last))

    inside = tree(0, len(xs) - 1) if len(xs) > 1 else constant(ys[0])
    return _where(u < xs[0], low, _where(u > xs[-1], high, inside))


def _polyval(p: Sequence[Any], x: Any) -> Expression:
    result: Any = constant(0.0)
    for coefficient in p:
        result = result * x + coefficient
    return _wrap(result)


def _clip(a: Any, a_min: Any = None, a_max: Any = None, **_: Any) -> Expression:
    result = _wrap(a)
    if a_min is not None:
        result = _node("max", result, _wrap(a_min))
    if a_max is not None:
        result = _node("min", result, _wrap(a_max))
    return result


def _select(condlist: Sequence[Any], choicelist: Sequence[Any], default: Any = 0.0) -> Expression:
    result = _wrap(default)
    for condition, choice in reversed(list(zip(condlist, choicelist, strict=True))):
        result = _where(condition, choice, result)
    return result


_UNARY = {
    "sin": "sin", "cos": "cos", "tan": "tan", "arcsin": "asin", "arccos": "acos", "arctan": "atan",
    "sinh": "sinh", "cosh": "cosh", "tanh": "tanh", "arcsinh": "asinh", "arccosh": "acosh", "arctanh": "atanh",
    "exp": "exp", "log": "log", "sqrt": "sqrt", "absolute": "abs", "fabs": "abs", "sign": "sign",
    "floor": "floor", "ceil": "ceil", "negative": "neg", "logical_not": "not",
}  # fmt: skip

_UFUNCS: dict[str, Callable[..., Expression]] = {
    **{name: (lambda a, _op=operation: _neg(a) if _op == "neg" else _node(_op, a)) for name, operation in _UNARY.items()},
    "add": _add, "subtract": lambda a, b: _add(a, _neg(b)), "multiply": _mul, "divide": _div, "power": _pow,
    "float_power": _pow, "remainder": _mod, "positive": lambda a: a,
    "square": lambda a: _node("mul", a, a), "reciprocal": lambda a: _div(constant(1.0), a),
    "hypot": lambda a, b: _node("sqrt", a * a + b * b), "arctan2": lambda a, b: _node("atan2", a, b),
    "minimum": lambda a, b: _node("min", a, b), "maximum": lambda a, b: _node("max", a, b),
    "fmin": lambda a, b: _node("min", a, b), "fmax": lambda a, b: _node("max", a, b),
    "expm1": lambda a: _node("exp", a) - 1.0, "log1p": lambda a: _node("log", 1.0 + a),
    "deg2rad": lambda a: a * (math.pi / 180), "rad2deg": lambda a: a * (180 / math.pi),
    "less": lambda a, b: a < b, "less_equal": lambda a, b: a <= b, "greater": lambda a, b: a > b,
    "greater_equal": lambda a, b: a >= b, "equal": lambda a, b: a == b, "not_equal": lambda a, b: a != b,
    "logical_and": lambda a, b: a & b, "logical_or": lambda a, b: a | b,
    "bitwise_and": lambda a, b: a & b, "bitwise_or": lambda a, b: a | b,
    "heaviside": lambda a, b: _where(a < 0.0, 0.0, _where(a > 0.0, 1.0, b)),
    "copysign": lambda a, b: _where(b < 0.0, -_node("abs", a), _node("abs", a)),
}  # fmt: skip

_FUNCTIONS: dict[str, Callable[..., Expression]] = {
    "where": _where, "interp": _interp, "polyval": _polyval, "clip": _clip, "select": _select,
}  # fmt: skip

_NUMERIC: dict[str, Callable[..., Any]] = {
    "add": np.add, "sub": np.subtract, "mul": np.multiply, "div": np.divide, "pow": np.power, "neg": np.negative,
    "sin": np.sin, "cos": np.cos, "tan": np.tan, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan,
    "atan2": np.arctan2, "sinh": np.sinh, "cosh": np.cosh, "tanh": np.tanh, "asinh": np.arcsinh,
    "acosh": np.arccosh, "atanh": np.arctanh, "exp": np.exp, "log": np.log, "sqrt": np.sqrt, "abs": np.absolute,
    "sign": np.sign, "floor": np.floor, "ceil": np.ceil, "min": np.minimum, "max": np.maximum,
    "lt": np.less, "le": np.less_equal, "eq": np.equal,
    "and": np.logical_and, "or": np.logical_or, "not": np.logical_not, "where": np.where,
}  # fmt: skip


# -- use of a record ------------------------------------------------------------------------------


def record(value: Value) -> Expression:
    """The value itself if it is an expression, a constant if it is a number.

    Raises TraceError for anything else (a law that returns None, an array, a string).
    """
    return _wrap(value)


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
        wrapped = [_wrap(item) for item in arguments]
        build = _BUILD.get(operation)
        return build(*wrapped) if build is not None else _node(operation, *wrapped)
    result = _NUMERIC[operation](*arguments)
    return result * 1.0 if result.dtype == np.bool_ else result


_BUILD: dict[str, Callable[..., Expression]] = {
    "add": _add, "mul": _mul, "div": _div, "pow": _pow, "neg": _neg, "where": _where,
    "sub": lambda a, b: _add(a, _neg(b)),
}  # fmt: skip


def derivative(expression: Expression, name: str) -> Expression:
    """Partial derivative with respect to the variable.

    At kinks (abs, sign, min, max, where) the derivative is the one-sided derivative of the branch
    that the condition selects; jumps contribute nothing.
    """
    known: dict[int, Expression] = {}

    def visit(node: Expression) -> Expression:
        key = id(node)
        if key not in known:
            known[key] = _differentiate(node, visit, name)
        return known[key]

    return visit(expression)


Rule = Callable[..., Any]
"""Derivative of one operation from (node, *arguments, *their derivatives)."""


def _differentiate(node: Expression, visit: Callable[[Expression], Expression], name: str) -> Expression:
    operation, args = node.operation, node.arguments
    if operation == "variable":
        return constant(1.0 if node.data == name else 0.0)
    if operation in _FLAT:
        return constant(0.0)
    if operation == "where":
        return _where(args[0], visit(args[1]), visit(args[2]))
    if operation in ("min", "max"):
        first, second = args if operation == "min" else (args[1], args[0])
        return _where(first < second, visit(args[0]), visit(args[1]))
    slopes = [visit(item) for item in args]
    if all(is_constant(item, 0.0) for item in slopes):
        return constant(0.0)
    return _wrap(_RULES[operation](node, *args, *slopes))


_FLAT = {"constant", "sign", "floor", "ceil", "lt", "le", "eq", "and", "or", "not"}


def _d_pow(node: Expression, a: Expression, b: Expression, da: Expression, db: Expression) -> Expression:
    result = b * _pow(a, b - 1.0) * da
    if not is_constant(db, 0.0):
        result = result + node * _node("log", a) * db
    return result


_RULES: dict[str, Rule] = {
    "add": lambda n, a, b, da, db: da + db,
    "sub": lambda n, a, b, da, db: da - db,
    "mul": lambda n, a, b, da, db: da * b + a * db,
    "div": lambda n, a, b, da, db: da / b - a * db / (b * b),
    "pow": _d_pow,
    "neg": lambda n, a, da: -da,
    "sin": lambda n, a, da: _node("cos", a) * da,
    "cos": lambda n, a, da: -(_node("sin", a) * da),
    "tan": lambda n, a, da: (1.0 + n * n) * da,
    "asin": lambda n, a, da: da / _node("sqrt", 1.0 - a * a),
    "acos": lambda n, a, da: -(da / _node("sqrt", 1.0 - a * a)),
    "atan": lambda n, a, da: da / (1.0 + a * a),
    "atan2": lambda n, a, b, da, db: (da * b - a * db) / (a * a + b * b),
    "sinh": lambda n, a, da: _node("cosh", a) * da,
    "cosh": lambda n, a, da: _node("sinh", a) * da,
    "tanh": lambda n, a, da: (1.0 - n * n) * da,
    "asinh": lambda n, a, da: da / _node("sqrt", a * a + 1.0),
    "acosh": lambda n, a, da: da / _node("sqrt", a * a - 1.0),
    "atanh": lambda n, a, da: da / (1.0 - a * a),
    "exp": lambda n, a, da: n * da,
    "log": lambda n, a, da: da / a,
    "sqrt": lambda n, a, da: da / (2.0 * n),
    "abs": lambda n, a, da: _node("sign", a) * da,
}


def gradient(function: Callable[[Value], Value]) -> Callable[[Value], Value]:
    """Derivative of a function of one argument, usable on numbers, arrays and expressions.

    Raises TraceError where the function cannot be recorded.
    """
    slope = derivative(record(function(variable("x"))), "x")
    return lambda x: evaluate(slope, {"x": x})
