"""Numbers that remember how they were computed give what the same computation gives for other numbers."""

from __future__ import annotations

import copy
import math
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.expression import Expression, record, variable
from hdrive_mbs.tracked import Tape, Tracked, plain

COMPUTATIONS: dict[str, Callable[[Any, Any], Any]] = {
    "sums": lambda a, b: 1.0 + a - b + 2 - (3.0 - a) + (4 + b),
    "products": lambda a, b: 2.0 * a * b / (a + 3.0) / 4.0 + 5.0 / b - (-a) + abs(b - 9.0) + (+a),
    "powers": lambda a, b: a**2 + b**0.5 + 2.0**a + (a * b) ** -1.5,
    "remainders": lambda a, b: (7.0 * a) % b + 3.3 % a,
    "numpy functions": lambda a, b: np.sqrt(a) + np.sin(b) * np.exp(-a) + np.maximum(a, 0.1) + np.hypot(a, b) + np.log(b) - np.tanh(a),
    "numpy numbers": lambda a, b: np.float64(2.0) * a + b / np.float64(3.0) - np.float64(4.0) * (a - np.float64(1.0)),
    "signs": lambda a, b: np.sign(a - 100.0) * b + np.abs(a),
    "sum": lambda a, b: sum([a, b, 1.0]) + max(a, 0.0) + min(b, 100.0),
    "choices": lambda a, b: (a if a > 0.2 else b) + (b if not b < 0.1 else a) + (a if a != b else 1.0),
}


@pytest.mark.parametrize("name", COMPUTATIONS)
def test_a_computation_is_had_for_other_numbers(name: str) -> None:
    compute = COMPUTATIONS[name]
    tape = Tape()
    found = compute(tape.start("a", 0.7), tape.start("b", 2.2))
    assert type(found) is Tracked
    assert float(found) == pytest.approx(float(compute(0.7, 2.2)), rel=1e-15)
    others = {"a": np.array([0.7, 0.31, 1.9, 5.0]), "b": np.array([2.2, 3.3, 0.4, 7.7])}
    made, holds = tape.replay([found]).again(others)
    [values] = made.T
    assert holds.all()
    np.testing.assert_allclose(values, [float(compute(a, b)) for a, b in zip(others["a"], others["b"], strict=True)], rtol=1e-14)
    assert tape.lost is None


def test_where_a_comparison_comes_out_otherwise_it_says_so() -> None:
    tape = Tape()
    a = tape.start("a", 1.0)
    found = a * 2.0 if a > 0.5 else a * 3.0
    for bound in (a < 4.0, a >= 0.1, a != 3.0, bool(a)):
        assert bound is True
    values, holds = tape.replay([found, 7.0]).again({"a": np.array([1.0, 0.2, 0.6, 5.0, 3.0, 0.0])})
    assert holds.tolist() == [True, False, True, False, False, False]
    np.testing.assert_array_equal(values[holds], [[2.0, 7.0], [1.2, 7.0]])


@pytest.mark.parametrize(
    "lose", [int, round, math.floor, math.ceil, math.trunc, lambda a: a // 2.0, lambda a: a.is_integer(), lambda a: divmod(a, 2)]
)
def test_what_makes_a_whole_number_of_it_loses_it(lose: Callable[[Any], Any]) -> None:
    tape = Tape()
    a = tape.start("a", 1.5)
    assert lose(a) == lose(1.5)
    assert tape.lost


def test_what_takes_it_out_of_sight_leaves_a_plain_number() -> None:
    """Which other numbers then show: who uses a tape checks one other set."""
    tape = Tape()
    a = tape.start("a", 4.0)
    for hidden in (math.sqrt(a), float(a), np.array([a])[0], f"{a:g}", np.asarray([1.0, 2.0]) * a):
        assert not isinstance(hidden, Tracked)
    assert plain(a) == 4.0
    assert type(plain(a)) is float
    assert plain("text") == "text"
    assert type(copy.deepcopy(a)) is float
    assert type(pickle.loads(pickle.dumps(a))) is float
    assert {4.0: "four"}[a] == "four"


def test_in_expressions_it_stays_what_it_is() -> None:
    tape = Tape()
    a, x = tape.start("a", 0.5), variable("x")
    for made in (a * x, x * a, a + x, x - a, a / x, x**a, np.maximum(a, x), np.maximum(x, a), 3.0 * (a * x)):
        assert isinstance(made, Expression)
        numbers = [node.data for node in _nodes(made) if node.operation == "constant"]
        assert any(type(number) is Tracked for number in numbers)
    assert type(record(np.sin(a) * 3.0).data) is Tracked


def _nodes(made: Expression) -> list[Expression]:
    return [made, *(node for item in made.arguments for node in _nodes(item))]


def test_fields_keep_it_within_their_ranges() -> None:
    tape = Tape()
    part = hm.ViscousDrag(coefficient=tape.start("c", 0.2))
    assert type(part.coefficient) is Tracked
    assert type(part.replacing(coefficient=part.coefficient * 2.0).coefficient) is Tracked
    _, holds = tape.replay([part.coefficient]).again({"c": np.array([0.3, -0.1])})
    assert holds.tolist() == [True, False]
    with pytest.raises(hm.ParameterError, match="must be at least 0"):
        hm.ViscousDrag(coefficient=tape.start("d", -0.2))
