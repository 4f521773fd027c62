"""Arrays with tracked numbers: what numpy makes of plain ones, for other numbers too."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from hdrive_mbs.compiled.constant_mass import ConstantMass
from hdrive_mbs.tracked import Tape, Tracked
from hdrive_mbs.tracked_arrays import (
    added_at,
    array_of,
    as_array,
    congruent,
    diagonal,
    has_tracked,
    is_tracked,
    largest,
    pattern,
    proportions,
    scaled,
    zeros,
)

ARM = np.array([[1.0, 0.0, 0.3], [0.0, -1.0, 0.0], [0.0, 2.0, 1.0]])
SPRING = np.array([[2.0, -1.0, 0.0], [-1.0, 3.0, 0.5], [0.0, 0.5, 1.0]])
AT = np.array([0, 2])

MADE: dict[str, Callable[[float, float], np.ndarray]] = {
    "array_of": lambda a, b: array_of([[a, 0.0], [2.0 * b, a + b]]),
    "diagonal": lambda a, b: diagonal([a, 3.0, b]),
    "scaled": lambda a, b: scaled(a * b, SPRING),
    "scaled twice": lambda a, b: scaled(b, scaled(a, SPRING)),
    "congruent": lambda a, b: congruent(scaled(a, SPRING) + scaled(b, np.eye(3)), ARM),
    "added_at": lambda a, b: added_at(np.ones((3, 3)), AT, array_of([[a, 0.0], [0.0, b]])),
    "added plain": lambda a, b: added_at(diagonal([a, b, a]), AT, np.ones((2, 2))),
    "largest": lambda a, b: array_of([[largest(scaled(-a, SPRING)) * b]]),
}


@pytest.mark.parametrize("name", MADE)
def test_an_array_is_had_for_other_numbers(name: str) -> None:
    """Whatever is zero in it is a plain zero."""
    tape = Tape()
    found = MADE[name](tape.start("a", 0.7), tape.start("b", 2.2))
    plain = MADE[name](0.7, 2.2)
    assert is_tracked(found)
    assert not is_tracked(plain)
    np.testing.assert_allclose(np.asarray(found, float), plain, rtol=1e-15)
    np.testing.assert_array_equal(pattern(found), plain != 0.0)
    assert all(type(item) is float for item in found.ravel().tolist() if item.__class__ is not Tracked)
    assert all(type(item) is Tracked for item, value in zip(found.ravel().tolist(), MADE[name](1.3, 0.4).ravel()) if value not in plain)
    made, holds = tape.replay(found.ravel().tolist()).again({"a": np.array([1.3, -0.5]), "b": np.array([0.4, 5.0])})
    assert holds.all()
    for row, (a, b) in zip(made, ((1.3, 0.4), (-0.5, 5.0)), strict=True):
        np.testing.assert_allclose(row, MADE[name](a, b).ravel(), rtol=1e-14, atol=1e-300)


def test_shares_of_a_size_are_plain_and_hold_as_long_as_entries_stay_in_proportion() -> None:
    tape = Tape()
    a, b = tape.start("a", 2.0), tape.start("b", 2.0)
    shares = proportions(array_of([[4.0 * a, b], [0.0, a]]), a)
    assert not is_tracked(shares)
    np.testing.assert_array_equal(shares, [[4.0, 1.0], [0.0, 1.0]])
    _, holds = tape.replay([a]).again({"a": np.array([3.0, 3.0]), "b": np.array([3.0, 3.1])})
    assert holds.tolist() == [True, False]
    np.testing.assert_array_equal(proportions(np.array([2.0, 3.0]), 4.0), [0.5, 0.75])


def test_a_mass_matrix_is_factorised_for_other_numbers_as_long_as_it_is_positive() -> None:
    tape = Tape()
    a, b = tape.start("a", 2.0), tape.start("b", 0.5)

    def matrix(a: float, b: float) -> np.ndarray:
        return array_of([[a, b, 0.0], [b, 1.0, 0.3], [0.0, 0.3, 2.0 * a]])

    def columns(a: float, b: float) -> list[float]:
        mass = ConstantMass(["x", "y", "z"], matrix(a, b))
        return [value for name in ("x", "y") for value in mass.column({name: a}).values()]

    found = columns(a, b)
    assert len(found) == 6
    made, holds = tape.replay(found).again({"a": np.array([2.0, 3.0, 0.2]), "b": np.array([0.5, -0.9, 0.5])})
    assert holds.tolist() == [True, True, False]  # of a smaller mass than the coupling allows
    for row, (a, b) in zip(made[:2], ((2.0, 0.5), (3.0, -0.9)), strict=True):
        np.testing.assert_allclose(row, columns(a, b), rtol=1e-14)
        whole = np.linalg.inv(matrix(a, b)) * a
        names = list(ConstantMass(["x", "y", "z"], matrix(a, b)).column({"x": a}))
        np.testing.assert_allclose(row[:3], [whole["xyz".index(name), 0] for name in names], rtol=1e-13)


def test_what_is_known_of_an_array() -> None:
    tape = Tape()
    a = tape.start("a", 2.0)
    assert as_array([1, 2]).dtype == float
    assert as_array(np.array([1, 2.5], object)).dtype == float
    assert is_tracked(as_array(array_of([a])))
    assert is_tracked(as_array([[a, 0.0], [0.0, 1.0]]))
    known = np.ones(2)
    assert as_array(known) is known
    with pytest.raises(ValueError, match="could not convert"):
        as_array(np.array(["stiff"], object))
    assert zeros((2, 2), like=array_of([a])).dtype == object
    assert zeros((2,), like=np.ones(2)).dtype == float
    assert largest(np.array([1.0, -3.0])) == 3.0

    class Part:
        def __init__(self, value: float) -> None:
            self.value = value

    assert has_tracked(Part(a))
    assert not has_tracked(Part(2.0))
    assert type(a * 1.0) is Tracked
    assert type(a * 0.0) is float
    assert 0.0 + a is a
    assert a - 0.0 is a
    assert a / 1.0 is a
