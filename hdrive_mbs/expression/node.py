"""Nodes of a recorded law and the arithmetic that makes them, folding constants as it goes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from hdrive_mbs.tracked import Tracked, is_kept

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
        raise TraceError("the law turns its argument into a plain int; use np.floor, np.ceil or np.trunc")

    def __array__(self, *_: Any, **__: Any) -> Any:
        raise TraceError("the law puts its argument into an array; use it directly in arithmetic and numpy functions")

    def __iter__(self) -> Any:
        raise TraceError("the law iterates over its argument")

    # -- arithmetic ---------------------------------------------------------------------------
    def __add__(self, other: Value) -> Expression:
        return add(self, as_node(other))

    def __radd__(self, other: Value) -> Expression:
        return add(as_node(other), self)

    def __sub__(self, other: Value) -> Expression:
        return subtract(self, as_node(other))

    def __rsub__(self, other: Value) -> Expression:
        return subtract(as_node(other), self)

    def __mul__(self, other: Value) -> Expression:
        return multiply(self, as_node(other))

    def __rmul__(self, other: Value) -> Expression:
        return multiply(as_node(other), self)

    def __truediv__(self, other: Value) -> Expression:
        return divide(self, as_node(other))

    def __rtruediv__(self, other: Value) -> Expression:
        return divide(as_node(other), self)

    def __pow__(self, other: Value) -> Expression:
        return power(self, as_node(other))

    def __rpow__(self, other: Value) -> Expression:
        return power(as_node(other), self)

    def __mod__(self, other: Value) -> Expression:
        return modulo(self, as_node(other))

    def __rmod__(self, other: Value) -> Expression:
        return modulo(as_node(other), self)

    def __floordiv__(self, other: Value) -> Expression:
        return make("floor", divide(self, as_node(other)))

    def __rfloordiv__(self, other: Value) -> Expression:
        return make("floor", divide(as_node(other), self))

    def __neg__(self) -> Expression:
        return negate(self)

    def __pos__(self) -> Expression:
        return self

    def __abs__(self) -> Expression:
        return make("abs", self)

    # -- comparisons and logic (values 0 or 1) --------------------------------------------------
    def __lt__(self, other: Value) -> Expression:
        return make("lt", self, as_node(other))

    def __le__(self, other: Value) -> Expression:
        return make("le", self, as_node(other))

    def __gt__(self, other: Value) -> Expression:
        return make("lt", as_node(other), self)

    def __ge__(self, other: Value) -> Expression:
        return make("le", as_node(other), self)

    def __eq__(self, other: object) -> Expression:  # type: ignore[override]
        return make("eq", self, as_node(other))

    def __ne__(self, other: object) -> Expression:  # type: ignore[override]
        return make("not", make("eq", self, as_node(other)))

    def __and__(self, other: Value) -> Expression:
        return make("and", logical(self), logical(as_node(other)))

    __rand__ = __and__

    def __or__(self, other: Value) -> Expression:
        return make("or", logical(self), logical(as_node(other)))

    __ror__ = __or__

    def __xor__(self, other: Value) -> Expression:
        return make("not", make("eq", logical(self), logical(as_node(other))))

    __rxor__ = __xor__

    def __invert__(self) -> Expression:
        return make("not", logical(self))

    # -- numpy protocols ------------------------------------------------------------------------
    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **kwargs: Any) -> Any:
        handler = UFUNCS.get(ufunc.__name__)
        if method != "__call__" or handler is None:
            raise TraceError(f"np.{ufunc.__name__}{'' if method == '__call__' else '.' + method} cannot be recorded")
        if kwargs:
            raise TraceError(f"np.{ufunc.__name__} with {', '.join(kwargs)}= cannot be recorded")
        return handler(*(as_node(item) for item in inputs))

    def __array_function__(self, function: Any, _types: Any, args: Any, kwargs: Any) -> Any:
        handler = FUNCTIONS.get(function.__name__)
        if handler is None:
            raise TraceError(f"np.{function.__name__} cannot be recorded")
        try:
            return handler(*args, **kwargs)
        except TraceError:
            raise
        except (TypeError, ValueError) as error:
            raise TraceError(f"np.{function.__name__} in this form cannot be recorded ({error})") from error

    def __repr__(self) -> str:
        if self.operation == "constant":
            return repr(self.data)
        if self.operation == "variable":
            return str(self.data)
        return f"{self.operation}({', '.join(map(repr, self.arguments))})"


UFUNCS: dict[str, Callable[..., Expression]] = {}
"""numpy ufunc name -> what it records (filled by numpy_functions.py)."""

FUNCTIONS: dict[str, Callable[..., Expression]] = {}
"""numpy function name -> what it records (filled by numpy_functions.py)."""

NUMERIC: dict[str, Callable[..., Any]] = {
    "add": np.add, "sub": np.subtract, "mul": np.multiply, "div": np.divide, "pow": np.power, "neg": np.negative,
    "sin": np.sin, "cos": np.cos, "tan": np.tan, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan,
    "atan2": np.arctan2, "sinh": np.sinh, "cosh": np.cosh, "tanh": np.tanh, "asinh": np.arcsinh,
    "acosh": np.arccosh, "atanh": np.arctanh, "exp": np.exp, "log": np.log, "sqrt": np.sqrt, "abs": np.absolute,
    "sign": np.sign, "floor": np.floor, "ceil": np.ceil, "min": np.minimum, "max": np.maximum,
    "lt": np.less, "le": np.less_equal, "eq": np.equal,
    "and": np.logical_and, "or": np.logical_or, "not": np.logical_not, "where": np.where,
}  # fmt: skip
"""Operation -> numpy function that computes it."""


def constant(number: float) -> Expression:
    """A constant node."""
    return Expression("constant", (), number if type(number) is Tracked else float(number))


def variable(name: str) -> Expression:
    """A free variable of the given name."""
    return Expression("variable", (), name)


def as_node(value: Any) -> Expression:
    """The value as a node.  Raises TraceError for anything but a number or an expression."""
    if isinstance(value, Expression):
        return value
    if type(value) is float or type(value) is Tracked:
        return Expression("constant", (), value)
    if isinstance(value, (bool, int, float, np.number, np.bool_)):
        return constant(float(value))
    if isinstance(value, np.ndarray) and value.ndim == 0:
        return constant(float(value))
    raise TraceError(f"the law mixes its argument with a {type(value).__name__}; only numbers can be recorded")


def is_constant(expression: Expression, value: float | None = None) -> bool:
    """Whether the node is a constant (of the given value)."""
    return expression.operation == "constant" and (value is None or expression.data == value)


def make(operation: str, *arguments: Expression) -> Expression:
    """A node of an operation; a constant when all arguments are."""
    for item in arguments:
        if item.operation != "constant":
            return Expression(operation, arguments)
    with np.errstate(all="ignore"):
        return constant(NUMERIC[operation](*(item.data if type(item.data) is Tracked else np.float64(item.data) for item in arguments)))


LOGICAL = frozenset(("lt", "le", "eq", "and", "or", "not"))
"""Operations whose value is 0 or 1."""


def _is_logical(a: Expression) -> bool:
    if a.operation == "where":
        return _is_logical(a.arguments[1]) and _is_logical(a.arguments[2])
    return a.operation in LOGICAL or is_constant(a, 0.0) or is_constant(a, 1.0)


def logical(a: Expression) -> Expression:
    """The node, which must be a comparison or a combination of some (numpy's & works on the bits of anything else)."""
    if not _is_logical(a):
        raise TraceError("the law uses &, |, ^ or ~ on a number; they combine comparisons (np.logical_and and its like take numbers)")
    return a


def truth(a: Expression) -> Expression:
    """1 where the node is not 0, else 0."""
    return a if _is_logical(a) else make("not", make("not", a))


def add(a: Expression, b: Expression) -> Expression:
    """a + b without useless zeros."""
    # sums, differences and products are made by the ten thousand for each point of a search: no call that can be spared
    first, second = a.operation, b.operation
    if first == "constant" and not is_kept(a.data) and a.data == 0.0:
        return b
    if second == "constant":
        if not is_kept(b.data) and b.data == 0.0:
            return a
        if first == "constant":
            return make("add", a, b)
    if second == "neg":
        return Expression("sub", (a, b.arguments[0]))
    return Expression("add", (a, b))


def subtract(a: Expression, b: Expression) -> Expression:
    """a - b without useless zeros: a + (-b)."""
    if a.operation == "constant" or b.operation in ("constant", "neg"):
        return add(a, negate(b))
    return Expression("sub", (a, b))


def negate(a: Expression) -> Expression:
    """-a."""
    return a.arguments[0] if a.operation == "neg" else make("neg", a)


def multiply(a: Expression, b: Expression) -> Expression:
    """a * b with constants gathered in front."""
    if b.operation == "constant":
        a, b = b, a
    if a.operation == "constant":
        factor = a.data
        if not is_kept(factor):
            if factor == 0.0:
                return a
            if factor == 1.0:
                return b
            if factor == -1.0:
                return negate(b)
        if b.operation == "mul" and b.arguments[0].operation == "constant":
            return multiply(constant(factor * b.arguments[0].data), b.arguments[1])
        if b.operation == "constant":
            return make("mul", a, b)
    return Expression("mul", (a, b))


def divide(a: Expression, b: Expression) -> Expression:
    """a / b."""
    if is_constant(b) and b.data != 0.0:
        return a if not is_kept(b.data) and b.data == 1.0 else make("div", a, b)
    return a if is_constant(a, 0.0) else make("div", a, b)


def power(a: Expression, b: Expression) -> Expression:
    """a ** b; small whole powers stay products."""
    if is_constant(b, 1.0):
        return a
    if is_constant(b, 0.0):
        return constant(1.0)
    if is_constant(b, 2.0) and a.operation == "variable":
        return make("mul", a, a)
    return make("pow", a, b)


def modulo(a: Expression, b: Expression) -> Expression:
    """a - b * floor(a / b), the sign of b as in Python."""
    return a - b * make("floor", divide(a, b))


def choose(condition: Any, a: Any, b: Any) -> Expression:
    """np.where of scalars: only the chosen branch is evaluated in the engine."""
    chosen, other = as_node(a), as_node(b)
    test = as_node(condition)
    if is_constant(test):
        return chosen if test.data else other
    if is_constant(chosen) and is_constant(other) and chosen.data == other.data:
        return chosen
    return Expression("where", (test, chosen, other))
