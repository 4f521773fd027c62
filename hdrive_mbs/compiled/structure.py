"""The structure of recorded expressions: what they compute, without the numbers; made once for each form."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, NamedTuple


class Step(NamedTuple):
    """One operation: its arguments are numbers of earlier steps.  (Made and hashed by the ten thousand: a tuple.)"""

    operation: str
    arguments: tuple[int, ...]
    data: float | int | tuple[int, int] | None = None


@dataclass(frozen=True)
class Structure:
    """Steps that compute ``rates`` and ``readings``.

    width of a table : coefficients of a piece
    inputs, constants, tables : how many numbers it takes; input 0 is the time
    states : variables apart from the time
    """

    steps: tuple[Step, ...]
    rates: tuple[int, ...]
    readings: tuple[int, ...]
    states: int
    inputs: int
    constants: int
    tables: int

    def __hash__(self) -> int:
        return self._hash

    @cached_property
    def _hash(self) -> int:
        return hash((self.steps, self.rates, self.readings))


@dataclass(frozen=True, eq=False)
class Plan:
    """How the numbers of a form become those of its structure.

    constants : for each of the structure, which of the form (counted from 1)
    inverses : those of which 1/value is taken, because a product is faster than a quotient
    inputs : nodes of the form that are known before a run
    tables : which of the form
    """

    structure: Structure
    constants: list[int]
    inverses: list[int]
    inputs: tuple[int, ...]
    tables: tuple[int, ...]


Form = tuple[tuple[str, Any, tuple[int, ...]], ...]
"""Nodes in order: operation, data, and the places of the arguments.

data : of a variable its name, of a number its value, of a constant which one it is, of a table which one and its width
"""


CHEAP = frozenset(
    {
        *("constant", "number", "variable", "add", "sub", "mul", "neg", "abs", "min", "max", "sign", "floor", "ceil"),
        *("where", "lt", "le", "eq", "and", "or", "not"),
    }
)
"""Operations that are computed as often as they are written: what is more than one of these is computed once."""
KEPT = 8
"""Plans of a form that are kept."""


@lru_cache(maxsize=64)  # for the points of a few groups: a form is larger than its structure, and soon planned anew
def shaped(form: Form, rates: tuple[int, ...], readings: tuple[int, ...], variables: tuple[str, ...]) -> Shaped:
    """A form with its results, ready to be planned for constants."""
    return Shaped(form, rates, readings, variables)


class Shaped:
    """A form with its results, planned once for each way in which constants of parts that are alike are equal."""

    def __init__(self, form: Form, rates: tuple[int, ...], readings: tuple[int, ...], variables: tuple[str, ...]) -> None:
        self._form, self._rates, self._readings, self._variables = form, rates, readings, variables
        self._asked = _constants_of_parts_alike(form)
        self._plans: dict[tuple[int, ...], Plan] = {}

    def plan(self, constants: Sequence[float]) -> Plan:
        """The structure for constants with these values.  What depends on time alone and reads tables becomes an input."""
        first: dict[float, int] = {}
        equal = tuple([first.setdefault(constants[k], k) for k in self._asked])
        if equal not in self._plans:
            if len(self._plans) >= KEPT:
                self._plans.clear()
            self._plans[equal] = self._planned(dict(zip(self._asked, equal, strict=True)))
        return self._plans[equal]

    def _planned(self, equal: Mapping[int, int]) -> Plan:
        stands = _once(self._form, equal)
        form = tuple([(operation, data, tuple([stands[k] for k in arguments])) for operation, data, arguments in self._form])
        rates, readings = [stands[k] for k in self._rates], [stands[k] for k in self._readings]
        maker = _Maker(form, (*rates, *readings), self._variables)
        number = maker.number
        structure = Structure(
            tuple(maker.steps),
            tuple(number[k] for k in rates),
            tuple(number[k] for k in readings),
            len(self._variables) - 1,
            1 + len(maker.inputs),
            len(maker.constants),
            len(maker.tables),
        )
        return Plan(structure, [k for k, _ in maker.constants], maker.inverses(), tuple(maker.inputs.values()), tuple(maker.tables))


class _Maker:
    """Steps of a form, made node by node."""

    def __init__(self, form: Form, results: Sequence[int], variables: Sequence[str]) -> None:
        self.form = form
        self.index = {name: k for k, name in enumerate(variables)}
        self.steps: list[Step] = []
        self.known: dict[Step, int] = {}
        self.number: dict[int, int] = {}
        self.constants: dict[tuple[int, bool], int] = {}
        self.tables: dict[int, int] = {}
        self.inputs: dict[object, int] = {}
        before = _known_before(form)
        needed = _needed(form, results, before)
        for k in range(len(form)):
            if k in needed:
                self.number[k] = self._input(k) if k in before else self._node(k)

    def inverses(self) -> list[int]:
        """Positions of the constants that are inverted."""
        return [at for (_, inverse), at in self.constants.items() if inverse]

    def _add(self, step: Step) -> int:
        if step not in self.known:
            self.known[step] = len(self.steps)
            self.steps.append(step)
        return self.known[step]

    def _constant(self, place: int, inverse: bool = False) -> int:
        return self._add(Step("constant", (), self.constants.setdefault((place + 1, inverse), len(self.constants))))

    def _input(self, k: int) -> int:
        key = self._content(k)
        if key not in self.inputs:
            self.inputs[key] = k
        return self._add(Step("input", (), 1 + list(self.inputs).index(key)))

    def _content(self, k: int) -> object:
        operation, data, arguments = self.form[k]
        return (operation, data, *(self._content(item) for item in arguments))

    def _node(self, k: int) -> int:
        operation, data, places = self.form[k]
        if operation == "variable":
            return self._add(Step("variable", (), self.index[data] - 1) if self.index[data] else Step("input", (), 0))
        if operation == "number":
            return self._add(Step("number", (), data))
        if operation == "constant":
            return self._constant(data)
        arguments = [self.number[place] for place in places]
        if operation == "pieces":
            table, width = data
            return self._add(Step("pieces", tuple(arguments), (self.tables.setdefault(table, len(self.tables)), width)))
        if operation == "div" and self.form[places[1]][0] == "constant":
            return self._add(Step("mul", (arguments[0], self._constant(self.form[places[1]][1], inverse=True))))
        return self._add(Step(operation, tuple(arguments)))


def _once(form: Form, equal: Mapping[int, int]) -> list[int]:
    """For each node the one that is computed in its place: for one that is not cheap the first with the same arguments.

    A law whose force and whose rate of a state both ask for the same power has it twice in its form, with constants of its own each time.
    Sums and products stay apart, for their constants may be equal by chance at one point and not at the next, which would be two
    structures; that a power has the same base of the same state and the same exponent is no chance.

    equal : for constants the first one with the same value, themselves if not given
    """
    same: list[int] = []
    known: dict[object, int] = {}
    for k, (operation, data, arguments) in enumerate(form):
        value = equal.get(data, data) if operation == "constant" else data
        same.append(known.setdefault((operation, value, tuple([same[at] for at in arguments])), k))
    return [k if _is_cheap(form, *form[k]) else same[k] for k in range(len(form))]


def _constants_of_parts_alike(form: Form) -> tuple[int, ...]:
    """Constants of costly parts of which there are several that differ in their constants at most."""
    stands = _once(form, dict.fromkeys((data for operation, data, _ in form if operation == "constant"), -1))
    asked: set[int] = set()
    left = [k for first, k in enumerate(stands) if k != first for k in (first, k)]
    seen: set[int] = set()
    while left:
        k = left.pop()
        if k not in seen:
            seen.add(k)
            operation, data, arguments = form[k]
            left += arguments
            if operation == "constant":
                asked.add(data)
    return tuple(sorted(asked))


def _is_cheap(form: Form, operation: str, _data: object, arguments: tuple[int, ...]) -> bool:
    """Whether computing it again takes next to nothing: quotients by a constant become products, and whole powers too."""
    if operation in ("div", "pow"):
        return form[arguments[1]][0] in ("constant", "number") if operation == "div" else form[arguments[1]][0] == "number"
    return operation in CHEAP


def _known_before(form: Form) -> set[int]:
    """Nodes that read a table of time and that no parameter changes, apart from where the table is read.

    Their values are the same for many sets of parameters.  What follows from them by other numbers, or from the time
    without a table, is computed in the run.
    """
    timed: set[int] = set()
    free: set[int] = set()
    tabled: set[int] = set()
    for k, (operation, data, arguments) in enumerate(form):
        if (operation == "variable" and data != "t") or not timed.issuperset(arguments):
            continue
        timed.add(k)
        if operation == "pieces" or not tabled.isdisjoint(arguments):
            tabled.add(k)
        if operation == "pieces" or (operation != "constant" and free.issuperset(arguments)):
            free.add(k)
    return free & tabled


def _needed(form: Form, results: Sequence[int], before: set[int]) -> set[int]:
    """Nodes that are used in a run: what is known before needs nothing else."""
    needed: set[int] = set()
    left = list(results)
    while left:
        k = left.pop()
        if k not in needed:
            needed.add(k)
            left += () if k in before else form[k][2]
    return needed
