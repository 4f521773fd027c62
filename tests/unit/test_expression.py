"""Recorded laws: a record computes what numpy computes, and what cannot be recorded says so."""

from __future__ import annotations

import bisect
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from hdrive_mbs.errors import LawError
from hdrive_mbs.expression import (
    Expression,
    TraceError,
    constant,
    derivative,
    evaluate,
    gradient,
    in_order,
    is_constant,
    record,
    scalar_function,
    scalar_source,
    trace,
    variable,
    variables,
)
from hdrive_mbs.expression.node import FUNCTIONS, NUMERIC, UFUNCS

x, y = variable("x"), variable("y")

# -- random laws ----------------------------------------------------------------------------------
# A random law is a nested tuple (function, *arguments).  Its constants are powers of two, so that
# gathering constants rounds nothing and the record must give numpy's result to the last bit.

UNARY: tuple[Callable[[Any], Any], ...] = (
    np.sin, np.cos, np.tanh, np.arctan, np.abs, np.sign, np.floor, np.ceil, np.negative, np.trunc, np.arcsinh,
    lambda a: np.sqrt(np.abs(a)),
    lambda a: np.exp(np.sin(a)),
    lambda a: np.log(2.0 + np.abs(a)),
    lambda a: abs(a) ** 1.5,
    lambda a: a**2,
    lambda a: np.clip(a, -1.0, 2.0),
    lambda a: np.interp(a, [-2.0, -0.5, 1.0, 4.0], [1.0, -1.0, 0.0, 3.0]),
)  # fmt: skip
BINARY: tuple[Callable[[Any, Any], Any], ...] = (
    lambda a, b: a + b,
    lambda a, b: a - b,
    lambda a, b: a * b,
    lambda a, b: a / (4.0 + np.sin(b)),
    np.minimum,
    np.maximum,
    lambda a, b: np.where(a < b, a, -b),
    lambda a, b: np.where((a <= b) & np.logical_not(b > 0.0) | (a == 0.5), np.sin(a), b),
    lambda a, b: np.select([a > 1.0, b > 1.0], [b, a], default=0.5),
)
SMOOTH_UNARY: tuple[Callable[[Any], Any], ...] = (
    np.sin, np.cos, np.tanh, np.arctan, np.arcsinh, lambda a: np.exp(np.sin(a)), lambda a: np.log(2.0 + a * a),
)  # fmt: skip
SMOOTH_BINARY: tuple[Callable[[Any, Any], Any], ...] = (
    lambda a, b: a + b,
    lambda a, b: a - b,
    lambda a, b: a * np.tanh(b),
    lambda a, b: a / (4.0 + np.sin(b)),
    np.hypot,
)
LEAVES = st.sampled_from(["x", "y", -2.0, -1.0, -0.5, 0.25, 0.5, 1.0, 2.0])


def laws(unary: tuple[Any, ...], binary: tuple[Any, ...]) -> st.SearchStrategy[Any]:
    return st.recursive(
        LEAVES,
        lambda inner: st.tuples(st.sampled_from(unary), inner) | st.tuples(st.sampled_from(binary), inner, inner),
        max_leaves=12,
    )


def apply(law: Any, values: dict[str, Any]) -> Any:
    if isinstance(law, tuple):
        return law[0](*(apply(item, values) for item in law[1:]))
    return values[law] if isinstance(law, str) else law


numbers = st.floats(-4.0, 4.0, allow_nan=False).map(lambda value: round(value, 3))


@settings(max_examples=150, deadline=None, derandomize=True)
@given(laws(UNARY, BINARY), st.lists(st.tuples(numbers, numbers), min_size=1, max_size=5))
def test_a_random_law_and_its_record_give_the_same_bits(law: Any, points: list[tuple[float, float]]) -> None:
    values = {"x": np.array([p[0] for p in points]), "y": np.array([p[1] for p in points])}
    plain = np.broadcast_to(apply(law, values), len(points))
    recorded = np.broadcast_to(evaluate(record(apply(law, {"x": x, "y": y})), values), len(points))
    np.testing.assert_array_equal(recorded, plain)


@settings(max_examples=150, deadline=None, derandomize=True)
@given(laws(UNARY, BINARY), numbers, numbers)
def test_the_compiled_scalar_function_of_a_random_law_computes_the_law(law: Any, at_x: float, at_y: float) -> None:
    recorded = record(apply(law, {"x": x, "y": y}))
    (got,) = scalar_function([recorded], ["x", "y"])(at_x, at_y)
    want = float(evaluate(recorded, {"x": np.float64(at_x), "y": np.float64(at_y)}))
    # math and numpy round elementary functions differently in the last bit; a law may then sit on
    # the other side of a jump, so the law is looked at within a neighbourhood of rounding too
    near = [
        float(evaluate(recorded, {"x": np.float64(at_x + dx), "y": np.float64(at_y + dy)}))
        for dx in (-1e-13, 1e-13)
        for dy in (-1e-13, 1e-13)
    ]
    assert any(math.isclose(got, value, rel_tol=1e-9, abs_tol=1e-9) for value in [want, *near])


@settings(max_examples=100, deadline=None, derandomize=True)
@given(laws(SMOOTH_UNARY, SMOOTH_BINARY), numbers, numbers)
def test_the_derivative_of_a_random_smooth_law_is_its_slope(law: Any, at_x: float, at_y: float) -> None:
    recorded = record(apply(law, {"x": x, "y": y}))
    h = 1e-3

    def along(value: float) -> float:
        return float(evaluate(recorded, {"x": np.float64(value), "y": np.float64(at_y)}))

    # five points: truncation h^4/30 * fifth derivative; three different h tell a slope from a pole of np.hypot at 0
    slopes = [
        (8.0 * (along(at_x + d) - along(at_x - d)) - (along(at_x + 2 * d) - along(at_x - 2 * d))) / (12.0 * d) for d in (h, h / 2, h / 4)
    ]
    assume(max(slopes) - min(slopes) < 1e-6 * (1.0 + abs(slopes[0])))  # smooth on this scale (not the tip of hypot's cone)
    with np.errstate(all="ignore"):
        got = float(evaluate(derivative(recorded, "x"), {"x": np.float64(at_x), "y": np.float64(at_y)}))
    assume(math.isfinite(got))
    assert got == pytest.approx(slopes[-1], rel=1e-5, abs=1e-5)


# -- every operation ------------------------------------------------------------------------------

ALL, POSITIVE, UNIT, ABOVE_ONE = (-2.3, -0.6, 0.4, 1.7), (0.3, 0.9, 2.6), (-0.8, -0.2, 0.5), (1.2, 2.5)
DOMAIN = dict.fromkeys(NUMERIC, ALL) | {
    "log": POSITIVE, "sqrt": POSITIVE, "pow": POSITIVE, "asin": UNIT, "acos": UNIT, "atanh": UNIT, "acosh": ABOVE_ONE,
}  # fmt: skip


def operands(operation: str) -> tuple[Expression, ...]:
    function = NUMERIC[operation]
    count = function.nin if isinstance(function, np.ufunc) else 3
    if operation == "where":
        return (x < y, x * x, x * y)
    if operation in ("and", "or"):
        return (x < y, y < 1.0)
    return (x, y)[:count]


@pytest.mark.parametrize("operation", NUMERIC)
def test_every_operation_computes_what_numpy_computes(operation: str) -> None:
    arguments = operands(operation)
    node = Expression(operation, arguments)
    for at_x in DOMAIN[operation]:
        for at_y in DOMAIN[operation]:
            values = {"x": np.float64(at_x), "y": np.float64(at_y)}
            plain = [evaluate(item, values) for item in arguments]
            assert evaluate(node, values) == NUMERIC[operation](*plain)


@pytest.mark.parametrize("operation", NUMERIC)
@pytest.mark.parametrize("name", ["x", "y"])
def test_the_derivative_of_every_operation_is_its_slope(operation: str, name: str) -> None:
    node = Expression(operation, operands(operation))
    slope = derivative(node, name)
    h = 1e-4
    for at_x in DOMAIN[operation]:
        for at_y in (value + 0.05 for value in DOMAIN[operation]):  # off the kinks at x = y
            if operation in ("asin", "acos", "atanh") and abs(at_y) >= 1.0:
                continue
            values = {"x": np.float64(at_x), "y": np.float64(at_y)}

            def along(step: float, values: dict[str, Any] = values) -> float:
                return float(evaluate(node, values | {name: values[name] + step}))

            # rounding 1e-16/h = 1e-12, truncation h^4 f'''''/30 < 1e-14 for these functions and points
            expected = (8.0 * (along(h) - along(-h)) - (along(2 * h) - along(-2 * h))) / (12.0 * h)
            got = float(evaluate(slope, values))
            assert got == pytest.approx(expected, rel=1e-9, abs=1e-9), (operation, at_x, at_y)


def test_no_operation_is_left_out_of_the_derivatives() -> None:
    for operation in NUMERIC:
        derivative(Expression(operation, operands(operation)), "x")


def test_at_a_kink_the_derivative_is_that_of_one_side() -> None:
    assert evaluate(derivative(record(np.maximum(x, 0.0)), "x"), {"x": 0.0}) in (0.0, 1.0)
    assert evaluate(derivative(record(np.where(x > 0.0, 5.0 * x, 2.0 * x)), "x"), {"x": 0.0}) == 2.0
    assert evaluate(derivative(record(abs(x)), "x"), {"x": 0.0}) == 0.0


@pytest.mark.parametrize("radius", [lambda a, b: np.sqrt(a * a + b * b), np.hypot, lambda a, b: (a * a + b * b) ** 0.5])
def test_a_radius_is_level_at_the_centre_and_has_its_slope_elsewhere(radius: Callable[[Any, Any], Any]) -> None:
    """So that a stop beyond a radial gap can be linearised about the centre."""
    slope = scalar_function([derivative(record(radius(x, y)), "x")], ("x", "y"))
    assert slope(0.0, 0.0) == (0.0,)
    assert slope(3.0, 4.0) == (pytest.approx(0.6, rel=1e-15),)
    stop = derivative(record(x * np.maximum(0.0, radius(x, y) - 1.0) / (radius(x, y) + 1e-9)), "x")
    assert scalar_function([stop], ("x", "y"))(0.0, 0.0) == (0.0,)


STEEP: dict[str, Callable[[Any], Any]] = {
    "x": np.sqrt,
    "|x|": lambda a: np.sqrt(abs(a)),
    "fourth root": lambda a: (a * a) ** 0.25,
    "odd": lambda a: np.sign(a) * np.sqrt(abs(a)),
    "of a radius": lambda a: np.sqrt(np.hypot(a, a)),
}


@pytest.mark.parametrize("root", STEEP.values(), ids=STEEP)
def test_a_root_that_begins_steeply_has_no_finite_slope_there(root: Callable[[Any], Any]) -> None:
    [slope] = scalar_function([derivative(record(root(x)), "x")], ("x",))(0.0)
    assert not math.isfinite(slope)


# -- numpy functions ------------------------------------------------------------------------------

MIXED = np.array([-3.7, -1.0, -0.3, 0.0, 0.2, 0.5, 1.0, 2.5])
INSIDE = np.array([-0.9, -0.2, 0.0, 1e-9, 0.4, 0.99])


def _with(name: str, use: Callable[[Any, Any], Any]) -> Callable[[Any], Any]:
    return lambda a: use(getattr(np, name), a)


LAWS: dict[str, tuple[Callable[[Any], Any], np.ndarray]] = {
    **{name: (getattr(np, name), MIXED) for name in (
        "sin", "cos", "tan", "arctan", "sinh", "cosh", "tanh", "arcsinh", "exp", "absolute", "fabs", "sign", "floor", "ceil",
        "negative", "logical_not", "positive", "trunc", "square", "expm1", "exp2", "cbrt", "deg2rad", "radians", "rad2deg",
        "degrees")},
    **{name: (getattr(np, name), INSIDE) for name in ("arcsin", "arccos", "arctanh")},
    **{name: (getattr(np, name), np.array([1e-3, 0.5, 1.0, 40.0])) for name in ("log", "log2", "log10", "sqrt", "reciprocal")},
    "log1p": (np.log1p, np.array([-0.9, -1e-9, 0.0, 1e-12, 0.4, 0.6, 1e9])),
    "arccosh": (np.arccosh, np.array([1.0, 1.5, 20.0])),
    **{name: (_with(name, lambda f, a: f(a, 0.75)), MIXED) for name in (
        "add", "subtract", "multiply", "divide", "hypot", "arctan2", "minimum", "maximum", "fmin", "fmax", "less", "less_equal",
        "greater", "greater_equal", "equal", "not_equal", "logical_and", "logical_or", "logical_xor", "remainder", "fmod",
        "floor_divide", "copysign")},
    **{name: (_with(name, lambda f, a: f(np.abs(a), 1.7)), MIXED) for name in ("power", "float_power")},
    **{name: (_with(name, lambda f, a: f(a > 0.1, a < 1.0)), MIXED) for name in ("bitwise_and", "bitwise_or", "bitwise_xor")},
    "invert": (lambda a: ~(a > 0.1), MIXED),
    "heaviside": (lambda a: np.heaviside(a, 0.25), MIXED),
    "where": (lambda a: np.where(a > 0.1, a, -2.0), MIXED),
    "interp": (lambda a: np.interp(a, [-1.0, 0.0, 2.0], [3.0, 1.0, 4.0], left=7.0, right=-7.0), MIXED),
    "polyval": (lambda a: np.polyval([2.0, -1.0, 0.5], a), MIXED),
    "clip": (lambda a: np.clip(a, -0.5, None), MIXED),
    "select": (lambda a: np.select([a < -1.0, a > 1.0], [a, a * a], default=9.0), MIXED),
    "zeros_like": (lambda a: np.zeros_like(a) + a, MIXED),
    "ones_like": (lambda a: np.ones_like(a) * a, MIXED),
    "full_like": (lambda a: np.full_like(a, 3.0) + a, MIXED),
}  # fmt: skip


def test_every_numpy_function_that_is_recorded_is_tested() -> None:
    assert set(LAWS) == set(UFUNCS) | set(FUNCTIONS)


@pytest.mark.parametrize("name", LAWS)
def test_every_recorded_numpy_function_computes_what_numpy_computes(name: str) -> None:
    law, points = LAWS[name]
    recorded = record(law(x))
    assert variables(recorded) == {"x"}
    np.testing.assert_allclose(
        np.asarray(evaluate(recorded, {"x": points}), float), np.asarray(law(points), float), rtol=4e-15, atol=1e-300
    )
    compiled = scalar_function([recorded], ["x"])
    for point in points:
        assert compiled(float(point))[0] == pytest.approx(float(law(point)), rel=1e-14, abs=1e-300)


@pytest.mark.parametrize(
    "law",
    [
        pytest.param(
            lambda a: np.clip(a, min=-1.0, max=0.5), marks=pytest.mark.skipif(np.__version__ < "2.1", reason="numpy 2.1 names them")
        ),
        lambda a: np.clip(a, a_min=-1.0, a_max=0.5),
        lambda a: np.clip(a, None, 0.5),
        lambda a: a.clip(-1.0, 0.5) if isinstance(a, np.ndarray) else np.clip(a, -1.0, 0.5),
        lambda a: 2.0**a,
        lambda a: a // 0.4,
        lambda a: 3.0 // (a + 10.0),
        lambda a: a % 0.4,
        lambda a: 3.0 % (a + 10.0),
        lambda a: np.float64(2.0) * a - np.array(3.0),
        lambda a: np.int64(2) * a,
        lambda a: +a,
        lambda a: np.where((a > 0.0) ^ (a > 1.0), 1.0, 0.0),
        lambda a: np.where(np.logical_and(a, a - 1.0), 1.0, 0.0),
        lambda a: np.where(np.logical_or(a, 0.0), 1.0, 0.0),
        lambda a: sum([a, 2.0 * a, 3.0]),
        lambda a: (a > 0.0) * 5.0,
    ],
)
def test_other_ways_to_write_a_law_are_recorded_as_numpy_has_them(law: Callable[[Any], Any]) -> None:
    np.testing.assert_allclose(evaluate(record(law(x)), {"x": MIXED}), law(MIXED), rtol=1e-15, atol=4e-15)


points = st.lists(st.floats(-3.0, 3.0).map(lambda value: round(value, 2)), min_size=1, max_size=12).map(sorted)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(points, st.data())
def test_a_table_is_interpolated_as_numpy_does_it_also_with_steps(xs: list[float], data: st.DataObject) -> None:
    ys = data.draw(st.lists(st.floats(-5.0, 5.0).map(lambda value: round(value, 2)), min_size=len(xs), max_size=len(xs)))
    at = np.unique(np.concatenate((np.linspace(-4.0, 4.0, 41), xs, np.array(xs) + 1e-3)))
    recorded = record(np.interp(x, xs, ys))
    np.testing.assert_allclose(evaluate(recorded, {"x": at}), np.interp(at, xs, ys), rtol=1e-12, atol=1e-12)
    compiled = scalar_function([recorded], ["x"])
    np.testing.assert_allclose([compiled(float(a))[0] for a in at], np.interp(at, xs, ys), rtol=1e-12, atol=1e-12)


def test_a_table_far_from_zero_keeps_its_digits() -> None:
    # lines written as slope*u + offset would lose 1e6 * 1e6 * 1e-16 = 1e-4
    xs, ys = 1e6 + np.array([0.0, 1e-3, 2e-3]), np.array([0.0, 1e3, -1e3])
    at = xs[0] + 1.5e-3
    assert evaluate(record(np.interp(x, xs, ys)), {"x": at}) == pytest.approx(np.interp(at, xs, ys), abs=1e-6)


def test_the_slope_of_a_table_is_the_slope_of_its_pieces() -> None:
    slope = gradient(lambda a: np.interp(a, [0.0, 1.0, 3.0], [0.0, 5.0, 1.0]))
    np.testing.assert_allclose(slope(np.array([-1.0, 0.5, 2.0, 4.0])), [0.0, 5.0, -2.0, 0.0], rtol=1e-14)


def test_small_arguments_of_expm1_and_log1p_keep_their_digits() -> None:
    # exp(1e-12) - 1 has four digits
    assert evaluate(record(np.expm1(x)), {"x": 1e-12}) == pytest.approx(1e-12, rel=1e-11)
    assert evaluate(record(np.log1p(x)), {"x": 1e-12}) == pytest.approx(1e-12, rel=1e-11)


# -- what cannot be recorded ----------------------------------------------------------------------

LOOKUP = {0.0: 1.0}
UNRECORDABLE: dict[str, tuple[Callable[[Any], Any], str]] = {
    "if": (lambda a: 1.0 if a > 0.0 else 2.0, "np.where"),
    "and": (lambda a: a > 0.0 and a < 1.0, "&"),
    "or": (lambda a: a > 0.0 or a < -1.0, r"\|"),
    "not": (lambda a: not a, "np.where"),
    "max()": (lambda a: max(a, 0.0), "np.maximum"),
    "min()": (lambda a: min(a, 0.0), "np.minimum"),
    "chained comparison": (lambda a: 0.0 < a < 1.0, "np.where"),
    "bisect": (lambda a: bisect.bisect([0.0, 1.0], a), "np.where"),
    "math.sin": (math.sin, "numpy function"),
    "math.floor": (math.floor, "numpy function"),
    "float()": (float, "numpy function"),
    "int()": (int, "np.floor"),
    "complex": (lambda a: a * 1j, "complex"),
    "np.array": (lambda a: np.array([a]), "array"),
    "np.array of two": (lambda a: np.array([a, 1.0]), "array"),
    "np.asarray": (np.asarray, "array"),
    "array times": (lambda a: np.array([1.0, 2.0]) * a, "ndarray"),
    "times array": (lambda a: a * np.array([1.0, 2.0]), "ndarray"),
    "list": (lambda a: a + [1.0], "list"),  # noqa: RUF005
    "None": (lambda a: a + None, "NoneType"),
    "text": (lambda a: a + "1", "str"),
    "& of numbers": (lambda a: a & 2, "comparisons"),
    "& of a comparison and a number": (lambda a: (a > 0.0) & -2, "comparisons"),
    "~ of a number": (lambda a: ~a, "comparisons"),
    "iteration": (lambda a: [item for item in a], "iterates"),  # noqa: C416
    "np.sum": (np.sum, r"np\.sum"),
    "np.sum of a list": (lambda a: np.sum([a, 1.0]), "array"),
    "np.max": (np.max, r"np\.max"),
    "reduce": (lambda a: np.maximum.reduce([a, 1.0]), "array"),
    "outer": (lambda a: np.multiply.outer(a, a), r"np\.multiply\.outer"),
    "np.round": (np.round, r"np\.round"),
    "np.isnan": (np.isnan, r"np\.isnan"),
    "np.rint": (np.rint, r"np\.rint"),
    "out=": (lambda a: np.sin(a, out=np.zeros(1)), "out="),
    "where=": (lambda a: np.sin(a, where=True), "where="),
    "period": (lambda a: np.interp(a, [0.0, 1.0], [0.0, 1.0], period=2.0), "np.mod"),
    "falling table": (lambda a: np.interp(a, [1.0, 0.0], [0.0, 1.0]), "rising"),
    "table of two lengths": (lambda a: np.interp(a, [0.0, 1.0], [0.0]), "as many"),
    "where without values": (lambda a: np.where(a > 0.0), r"np\.where"),
    "select of two lengths": (lambda a: np.select([a > 0.0], [a, 1.0]), r"np\.select"),
    "np.vectorize": (lambda a: np.vectorize(math.sin)(a), "array"),
    "round()": (round, "__round__"),
    "method": (lambda a: a.copy(), "copy"),
    "index": (lambda a: a[0], "subscriptable"),
    "len": (len, "len"),
    "dictionary": (lambda a: LOOKUP[a], "KeyError"),
    "format": (lambda a: float(f"{a:.3f}"), "format"),
    "range": (range, "integer"),
    "matrix product": (lambda a: a @ a, "@"),
    "returns None": (lambda a: None, "NoneType"),
    "returns a text": (lambda a: "5", "str"),
    "returns an array": (lambda a: np.zeros(2), "ndarray"),
}


@pytest.mark.parametrize("way", UNRECORDABLE)
def test_what_cannot_be_recorded_raises_and_says_why(way: str) -> None:
    law, reason = UNRECORDABLE[way]
    with pytest.raises(TraceError, match=reason):
        trace(law, x)


def test_an_error_of_the_library_inside_a_law_is_not_mistaken_for_an_unrecordable_law() -> None:
    def law(_: Any) -> Any:
        raise LawError("this law has no closed form")

    with pytest.raises(LawError, match="closed form"):
        trace(law, x)


def test_the_gradient_of_an_unrecordable_law_raises() -> None:
    with pytest.raises(TraceError, match="numpy function"):
        gradient(math.sin)


def test_the_gradient_of_a_straight_line_has_the_shape_of_its_argument() -> None:
    np.testing.assert_array_equal(gradient(lambda a: 3.0 * a)(np.zeros((2, 3))), np.full((2, 3), 3.0))
    assert gradient(lambda a: 3.0 * a)(0.5) == 3.0


def test_constants_are_folded() -> None:
    assert is_constant(record(np.sin(constant(0.5)) * 2.0 + 1.0), math.sin(0.5) * 2.0 + 1.0)
    assert is_constant(record(0.0 * x), 0.0)
    assert record(1.0 * x + 0.0) is x
    assert record(np.negative(-x)) is x


# -- compiled scalar functions --------------------------------------------------------------------


def run_source(expressions: list[Expression], *values: float) -> tuple[float, ...]:
    """The generated function with a way out that fails: only what is needed may be computed."""

    def unexpected(*_: float) -> tuple[float, ...]:
        raise AssertionError("something was computed that the chosen branch does not need")

    scope: dict[str, Any] = {
        **vars(math), "abs": abs, "min": min, "max": max, "pow_": math.pow, "sign_": np.sign, "otherwise_": unexpected
    }  # fmt: skip
    exec(scalar_source(expressions, ["x", "y"], ["a", "b"]), scope)
    return scope["function"](*values)  # type: ignore[no-any-return]


def test_only_the_chosen_branch_is_computed() -> None:
    root = np.sqrt(x)
    law = record(np.where(x > 0.0, root + 1.0 / root, np.where(y > 0.0, 1.0 / y, np.log(1.0 - y))))
    assert run_source([law], 4.0, 0.0) == (2.5,)
    assert run_source([law], -4.0, 2.0) == (0.5,)
    assert run_source([law], -4.0, 0.0) == (0.0,)


def test_a_part_that_two_branches_share_is_computed_once_and_before_them() -> None:
    shared = np.sin(x) * np.cos(x)
    law = record(np.where(y > 0.0, shared + 1.0, shared - 1.0))
    assert scalar_source([law], ["x", "y"], ["a", "b"]).count("sin(") == 1
    assert run_source([law], 0.3, 1.0) == pytest.approx([math.sin(0.3) * math.cos(0.3) + 1.0])


@pytest.mark.parametrize(
    ("law", "value", "expected"),
    [
        (lambda a: 1.0 / a, 0.0, math.inf),
        (np.log, 0.0, -math.inf),
        (np.log, -1.0, math.nan),
        (np.sqrt, -1.0, math.nan),
        (np.exp, 1000.0, math.inf),
        (np.sinh, -1000.0, -math.inf),
        (lambda a: a**0.5, -1.0, math.nan),
        (lambda a: a**-1.0, 0.0, math.inf),
        (lambda a: a**300.0, 1e10, math.inf),
        (np.arcsin, 2.0, math.nan),
        (np.floor, math.inf, math.inf),
    ],
)
def test_where_math_raises_the_compiled_function_gives_what_numpy_gives(law: Callable[[Any], Any], value: float, expected: float) -> None:
    (got,) = scalar_function([record(law(x))], ["x"])(value)
    assert got == expected or (math.isnan(got) and math.isnan(expected))


def test_a_law_that_uses_its_own_result_many_times_stays_small() -> None:
    # written out it would have 2^60 operations
    law: Any = x
    for k in range(60):
        law = np.where(law > 0.1 * k, np.sin(law) + law, np.cos(law) - law)
    source = scalar_source([law], ["x"], ["a"])
    assert len(source) < 20_000
    assert scalar_function([law], ["x"])(0.3)[0] == pytest.approx(float(evaluate(law, {"x": 0.3})), rel=1e-9)


def test_a_law_of_thousands_of_terms_is_evaluated_differentiated_and_compiled() -> None:
    law: Any = 0.0
    for k in range(1, 2500):
        law = law + np.sin(k * x) / k
    slope = derivative(law, "x")
    at = 0.7
    k = np.arange(1, 2500)
    assert evaluate(law, {"x": at}) == pytest.approx(np.sum(np.sin(k * at) / k), rel=1e-10)
    assert evaluate(slope, {"x": at}) == pytest.approx(np.sum(np.cos(k * at)), rel=1e-10)
    assert scalar_function([law, slope], ["x"])(at) == pytest.approx([np.sum(np.sin(k * at) / k), np.sum(np.cos(k * at))], rel=1e-10)


def test_many_choices_in_a_row_compile() -> None:
    law: Any = x
    for k in range(300):
        law = np.where(x > k, np.sqrt(x - k), law)
    compiled = scalar_function([law], ["x"])
    for at in (-0.5, 0.5, 38.25, 150.5, 299.25, 310.0):
        assert compiled(at)[0] == pytest.approx(at if at <= 0.0 else math.sqrt(at - min(math.ceil(at) - 1, 299)), rel=1e-14)


def test_nodes_come_in_an_order_that_can_be_computed() -> None:
    law = record(np.where(x > y, np.sin(x) * y, np.sin(x) + y))
    ordered = in_order(law)
    assert len({id(node) for node in ordered}) == len(ordered)
    seen: set[int] = set()
    for node in ordered:
        assert all(id(item) in seen for item in node.arguments)
        seen.add(id(node))
    assert ordered[-1] is law


def test_an_expression_in_place_of_a_variable_gives_the_composed_law() -> None:
    outer, inner = record(np.sin(x) + x * x), record(2.0 * y + 1.0)
    composed = evaluate(outer, {"x": inner})
    assert variables(composed) == {"y"}
    assert evaluate(composed, {"y": 0.3}) == pytest.approx(math.sin(1.6) + 1.6**2, rel=1e-15)
