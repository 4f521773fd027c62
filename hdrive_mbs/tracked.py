"""Floats that remember how they were computed, so that what was computed once can be had for other numbers too.

A scene whose fields are tracked is built and its equations are recorded once; the numbers in them then follow from those of
other parameter sets without building anything.  Every comparison is kept with its outcome: where one comes out otherwise, the way
taken does not hold for those numbers.  What takes a number out of sight (``math.sqrt``, an array) leaves a plain one behind, which
stays what it was: who uses this holds one other set of numbers against what is built for it.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]
Argument = tuple[bool, float]
"""(True, a place on the tape) or (False, a number)."""


class Tape:
    """What was done with tracked numbers, in order.

    simplified : whether a zero that is added and a one that multiplies are left out where the numbers are such: what is made then holds
        for such numbers alone
    lost : what made a number a whole one, after which nothing is known; None as long as nothing did
    """

    def __init__(self, *, simplified: bool = True) -> None:
        self.simplified = simplified
        self.lost: str | None = None
        self._inputs: dict[str, int] = {}
        self._steps: list[tuple[np.ufunc | None, tuple[Argument, ...]]] = []
        self._places: dict[tuple[np.ufunc, tuple[Argument, ...]], int] = {}
        self._outcomes: dict[tuple[np.ufunc, tuple[Argument, ...]], bool] = {}

    def start(self, name: str, value: float) -> Tracked:
        """A number to begin with, which has other values later."""
        self._inputs[name] = len(self._steps)
        self._steps.append((None, ()))
        return Tracked(value, self, self._inputs[name])

    def computed(self, value: float, ufunc: np.ufunc, arguments: Sequence[float]) -> Tracked:
        """A number computed from others, some of them tracked."""
        key = ufunc, tuple([_argument(item) for item in arguments])
        place = self._places.get(key)
        if place is None:
            place = self._places[key] = len(self._steps)
            self._steps.append(key)
        return Tracked(value, self, place)

    def compared(self, outcome: bool, ufunc: np.ufunc, arguments: Sequence[float]) -> bool:
        """A comparison with its outcome, which it passes on."""
        self._outcomes[ufunc, tuple([_argument(item) for item in arguments])] = outcome
        return outcome

    def replay(self, wanted: Sequence[float]) -> Replay:
        """What it takes to have wanted numbers again, and the comparisons as they came out until now."""
        needed = self._needed([_argument(item) for item in wanted])
        slots: dict[Argument, int] = {(True, place): place for place in range(len(self._steps))}
        plain_ones: list[float] = []

        def slot(argument: Argument) -> int:
            if argument not in slots:
                slots[argument] = len(slots)
                plain_ones.append(argument[1])
            return slots[argument]

        steps = [
            (place, ufunc, tuple([slot(item) for item in arguments]))
            for place, (ufunc, arguments) in enumerate(self._steps)
            if ufunc is not None and place in needed
        ]
        outcomes = [(ufunc, tuple([slot(item) for item in arguments]), outcome) for (ufunc, arguments), outcome in self._outcomes.items()]
        asked = [slot(_argument(item)) for item in wanted]
        return Replay(dict(self._inputs), len(self._steps), tuple(plain_ones), steps, outcomes, asked)

    def _needed(self, wanted: Sequence[Argument]) -> set[int]:
        """Steps that wanted numbers and comparisons rest on."""
        open_ = [int(number) for tracked, number in wanted if tracked]
        open_ += [int(number) for _, arguments in self._outcomes for tracked, number in arguments if tracked]
        found: set[int] = set()
        while open_:
            place = open_.pop()
            if place not in found:
                found.add(place)
                open_ += [int(number) for tracked, number in self._steps[place][1] if tracked]
        return found


@dataclass(frozen=True, eq=False)
class Replay:
    """Steps of a tape as far as wanted numbers and comparisons rest on them.  Every number has a slot: first those of the tape, then plain
    ones.

    inputs : name -> slot;  tracked : slots of the tape;  plain_ones : numbers in the slots behind these
    steps : (slot, what is computed, slots of its arguments);  outcomes : (what is compared, slots, how it came out);  asked : slots
    """

    inputs: Mapping[str, int]
    tracked: int
    plain_ones: tuple[float, ...]
    steps: Sequence[tuple[int, np.ufunc, tuple[int, ...]]]
    outcomes: Sequence[tuple[np.ufunc, tuple[int, ...], bool]]
    asked: Sequence[int]

    def again(self, inputs: Mapping[str, FloatArray]) -> tuple[FloatArray, Mask]:
        """Wanted numbers for other inputs, each of shape (n,): shape (n, wanted), and where all comparisons come out as before, (n,)."""
        count = len(next(iter(inputs.values())))
        known: list[Any] = [None] * self.tracked + list(self.plain_ones)
        for name, slot in self.inputs.items():
            known[slot] = inputs[name]
        with np.errstate(all="ignore"):
            for slot, ufunc, arguments in self.steps:
                known[slot] = ufunc(*[known[k] for k in arguments])
            holds = np.ones(count, bool)
            for ufunc, arguments, outcome in self.outcomes:
                holds &= ufunc(*[known[k] for k in arguments]) == outcome
        found = np.empty((count, len(self.asked)))
        for k, slot in enumerate(self.asked):
            found[:, k] = known[slot]
        return found, holds


def _argument(value: float) -> Argument:
    return (True, value.place) if type(value) is Tracked else (False, float(value))


def is_kept(value: Any) -> bool:
    """Whether it stays where it is even if it is zero or one: a tracked number whose tape is not simplified."""
    return type(value) is Tracked and not value.tape.simplified


def plain(value: Any) -> Any:
    """The number itself; anything else as it is."""
    return value.value if type(value) is Tracked else value


class Tracked(float):
    """A float on a tape.  It is a plain number to all that do not know better."""

    __slots__ = ("place", "tape", "value")
    value: float
    tape: Tape
    place: int

    def __new__(cls, value: float, tape: Tape, place: int) -> Tracked:
        made = super().__new__(cls, value)
        made.value, made.tape, made.place = value, tape, place
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        return float, (self.value,)

    def __hash__(self) -> int:
        return float.__hash__(self)

    def __float__(self) -> float:
        return self.value

    # -- arithmetic with numbers; expressions and arrays have their own way --------------------------------
    def __add__(self, other: Any) -> Any:
        return _binary(operator.add, np.add, self, other)

    def __radd__(self, other: Any) -> Any:
        return _binary(operator.add, np.add, other, self)

    def __sub__(self, other: Any) -> Any:
        return _binary(operator.sub, np.subtract, self, other)

    def __rsub__(self, other: Any) -> Any:
        return _binary(operator.sub, np.subtract, other, self)

    def __mul__(self, other: Any) -> Any:
        return _binary(operator.mul, np.multiply, self, other)

    def __rmul__(self, other: Any) -> Any:
        return _binary(operator.mul, np.multiply, other, self)

    def __truediv__(self, other: Any) -> Any:
        return _binary(operator.truediv, np.true_divide, self, other)

    def __rtruediv__(self, other: Any) -> Any:
        return _binary(operator.truediv, np.true_divide, other, self)

    def __pow__(self, other: Any, modulus: None = None) -> Any:
        return _binary(operator.pow, np.power, self, other)

    def __rpow__(self, other: Any, modulus: None = None) -> Any:
        return _binary(operator.pow, np.power, other, self)

    def __mod__(self, other: Any) -> Any:
        return _binary(operator.mod, np.mod, self, other)

    def __rmod__(self, other: Any) -> Any:
        return _binary(operator.mod, np.mod, other, self)

    def __neg__(self) -> Tracked:
        return self.tape.computed(-self.value, np.negative, (self,))

    def __pos__(self) -> Tracked:
        return self

    def __abs__(self) -> Tracked:
        return self.tape.computed(abs(self.value), np.absolute, (self,))

    # -- comparisons --------------------------------------------------------------------------------------
    def __lt__(self, other: Any) -> Any:
        return _compared(operator.lt, np.less, self, other)

    def __le__(self, other: Any) -> Any:
        return _compared(operator.le, np.less_equal, self, other)

    def __gt__(self, other: Any) -> Any:
        return _compared(operator.gt, np.greater, self, other)

    def __ge__(self, other: Any) -> Any:
        return _compared(operator.ge, np.greater_equal, self, other)

    def __eq__(self, other: object) -> Any:
        return _compared(operator.eq, np.equal, self, other)

    def __ne__(self, other: object) -> Any:
        return _compared(operator.ne, np.not_equal, self, other)

    def __bool__(self) -> bool:
        return self.tape.compared(bool(self.value), np.not_equal, (self, 0.0))

    # -- whole numbers: what they choose is not kept ---------------------------------------------------------
    def __int__(self) -> int:
        return int(self._lost("int"))

    def __trunc__(self) -> int:
        return int(self._lost("trunc"))

    def __floor__(self) -> int:
        return self._lost("floor").__floor__()

    def __ceil__(self) -> int:
        return self._lost("ceil").__ceil__()

    def __round__(self, digits: Any = None) -> Any:
        return round(self._lost("round"), digits)

    def __floordiv__(self, other: Any) -> Any:
        return self._lost("//") // other

    def __rfloordiv__(self, other: Any) -> Any:
        return other // self._lost("//")

    def __divmod__(self, other: Any) -> Any:
        return divmod(self._lost("divmod"), other)

    def __rdivmod__(self, other: Any) -> Any:
        return divmod(other, self._lost("divmod"))

    def is_integer(self) -> bool:
        """Whether it is a whole number, of which nothing is kept."""
        return self._lost("is_integer").is_integer()

    def _lost(self, how: str) -> float:
        self.tape.lost = self.tape.lost or how
        return self.value

    # -- numpy --------------------------------------------------------------------------------------------
    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **kwargs: Any) -> Any:
        if any(not _is_known(item) for item in inputs):
            return NotImplemented
        values = [plain(item) for item in inputs]
        scalars = method == "__call__" and not kwargs and ufunc.nout == 1 and all(_is_number(item) for item in inputs)
        found = getattr(ufunc, method)(*values, **kwargs)
        if not scalars:
            return found
        if isinstance(found, (bool, np.bool_)):
            return self.tape.compared(bool(found), ufunc, inputs)
        return self.tape.computed(float(found), ufunc, inputs)


def _is_number(value: Any) -> bool:
    return isinstance(value, (float, int, np.number))


def _is_known(value: Any) -> bool:
    """Whether numpy itself can take it: no expression, which has a way of its own."""
    return _is_number(value) or isinstance(value, (np.ndarray, np.bool_, list, tuple))


def sine(value: float) -> float:
    """Of a number that may be tracked, where ``math.sin`` would take it out of sight."""
    return np.sin(value) if type(value) is Tracked else math.sin(value)


def cosine(value: float) -> float:
    """Likewise."""
    return np.cos(value) if type(value) is Tracked else math.cos(value)


def _binary(plain_one: Callable[[Any, Any], Any], ufunc: np.ufunc, a: Any, b: Any) -> Any:
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return plain_one(plain(a) if type(a) is Tracked else a, plain(b) if type(b) is Tracked else b)
    if not (_is_number(a) and _is_number(b)):
        return NotImplemented
    known = _whatever_comes(plain_one, a, b)
    if known is not None:
        return known
    tape = a.tape if type(a) is Tracked else b.tape
    return tape.computed(float(plain_one(plain(a), plain(b))), ufunc, (a, b))


def _whatever_comes(plain_one: Callable[[Any, Any], Any], a: Any, b: Any) -> float | None:
    """What comes of a tracked and a plain number whatever the tracked one is, as long as it is finite; None where it depends on it.

    As plain numbers do: a zero times anything is a zero, and neither a zero that is added nor a one that multiplies changes anything.
    """
    tracked, other = (a, b) if type(a) is Tracked else (b, a)
    if type(other) is Tracked:
        return None
    if plain_one is operator.mul:
        return 0.0 if other == 0.0 else tracked if other == 1.0 else None
    if plain_one is operator.add:
        return tracked if other == 0.0 else None
    if tracked is a and plain_one is operator.sub:
        return tracked if other == 0.0 else None
    if tracked is a and plain_one is operator.truediv:
        return tracked if other == 1.0 else None
    return None


def _compared(plain_one: Callable[[Any, Any], bool], ufunc: np.ufunc, a: Tracked, b: Any) -> Any:
    if isinstance(b, np.ndarray):
        return plain_one(a.value, b)
    if not _is_number(b):
        return NotImplemented
    return a.tape.compared(bool(plain_one(a.value, plain(b))), ufunc, (a, b))
