"""A structure as LLVM text: functions of the state, the row of the known inputs, constants and tables."""

from __future__ import annotations

from collections.abc import Sequence

from hdrive_mbs.compiled.llvm_text import Text
from hdrive_mbs.compiled.structure import Step, Structure
from hdrive_mbs.compiled.table_code import table_code
from hdrive_mbs.compiled.vector_functions import BOTH, VECTORS, sine_and_cosine, vector_function

_PLAIN = {"add": "fadd contract", "sub": "fsub contract", "mul": "fmul contract", "div": "fdiv"}
"""A product that is added once is rounded once, where the processor can (``contract``)."""
_COMPARE = {"lt": "olt", "le": "ole", "eq": "oeq"}
_INTRINSIC = {"sqrt": "sqrt", "abs": "fabs", "floor": "floor", "ceil": "ceil"}
_LIBRARY = ("sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh", "exp", "log", "pow", "atan2")


def functions(structure: Structure, width: int, *, shared: bool, fused: bool) -> list[str]:
    """``stage`` and ``read``, what they call, and its declarations.

    ``void @read(state*, row, constants*, tables*, columns*, out*)`` on ``width`` lanes; the lanes of a number lie side by side.
    ``void @stage(state*, row, constants*, tables*, columns*, base*, a, next*, from*, b, to*)`` works out the rates k at a state and
    what a Runge-Kutta step makes of them, next = base + a k and to = from + b k; of what it reads only ``from`` may be written.

    shared : all lanes read the columns of the first one
    fused : the processor has fused multiply-add

    Raises ValueError for an operation without a translation.
    """
    declared: dict[str, str] = {}
    vectors = [name for name in VECTORS if fused and any(step.operation == name for step in structure.steps)]
    made = [vector_function(name, width, declared) for name in vectors]
    made += [sine_and_cosine(width, declared)] if {"sin", "cos"}.issubset(vectors) else []
    orders = sorted({step.data[1] for step in structure.steps if isinstance(step.data, tuple)})
    made += [table_code(order, declared) for order in orders]
    for kind, results in ((_Stage, structure.rates), (_Read, structure.readings)):
        made.append(kind(structure, width, shared, vectors, declared).text(results))
    return [*declared.values(), *made]


class _Function:
    """One function, written step by step.

    name, more : of the function and its parameters beside those of all
    """

    name: str
    more: str

    def __init__(self, structure: Structure, width: int, shared: bool, vectors: Sequence[str], declared: dict[str, str]) -> None:
        self.structure, self.shared, self.vectors = structure, shared, vectors
        self.write = Text(width, declared)
        self.values: dict[int, str] = {}
        self.truths: dict[int, str] = {}
        self.turned: dict[int, dict[str, str]] = {}
        """Of angles whose sine and cosine are both needed the function's results."""

    def text(self, results: Sequence[int]) -> str:
        """Both sides of a branch are computed; what is done with a result is done at once, while it is in a register."""
        needed, left = set(), list(results)
        while left:
            k = left.pop()
            if k not in needed:
                needed.add(k)
                left += self.structure.steps[k].arguments
        self.turned = self._angles_of_both(needed)
        places: dict[int, list[int]] = {}
        for place, result in enumerate(results):
            places.setdefault(result, []).append(place)
        self.begin()
        for k in sorted(needed):
            self._step(k, self.structure.steps[k])
            for place in places.get(k, []):
                self.finish(place, self._real(k))
        parameters = f"ptr noalias %y, i64 %row, ptr noalias %c, ptr noalias %tables, ptr noalias %columns, {self.more}"
        return "\n".join([f"define internal void @{self.name}({parameters}) {{", "entry:", *self.write.lines, "  ret void", "}"])

    def begin(self) -> None:
        """Write what comes before all else."""

    def finish(self, place: int, value: str) -> None:
        """Write what is done with a result."""
        raise NotImplementedError

    def _angles_of_both(self, needed: set[int]) -> dict[int, dict[str, str]]:
        """Angles of which both sine and cosine are needed, where there is a function of both."""
        if not {"sin", "cos"}.issubset(self.vectors):
            return {}
        steps = [self.structure.steps[k] for k in needed]
        sines, cosines = ({step.arguments[0] for step in steps if step.operation == name} for name in ("sin", "cos"))
        return {angle: {} for angle in sines & cosines}

    def _real(self, k: int) -> str:
        """A step as a number; comparisons become 1 or 0.

        A state is read from memory wherever it is used: there are more of them than registers, and those that are kept are written to
        memory and read again.
        """
        step = self.structure.steps[k]
        if step.operation == "variable":
            return self._value(step)
        if k not in self.values:
            self.values[k] = self.write.new(f"uitofp {self.write.truth} {self.truths[k]} to {self.write.real}")
        return self.values[k]

    def _truth(self, k: int) -> str:
        """A step as a truth value."""
        if k not in self.truths:
            self.truths[k] = self.write.compare("une", self._real(k), self.write.number(0.0))
        return self.truths[k]

    def _step(self, k: int, step: Step) -> None:
        operation, write = step.operation, self.write
        if operation in ("and", "or", "not"):
            a, *rest = (self._truth(item) for item in step.arguments)
            other = rest[0] if rest else write.true
            self.truths[k] = write.new(f"{'xor' if operation == 'not' else operation} {write.truth} {a}, {other}")
        elif operation in _COMPARE:
            self.truths[k] = write.compare(_COMPARE[operation], *(self._real(item) for item in step.arguments))
        elif operation == "where":
            test, yes, no = step.arguments
            self.values[k] = write.choose(self._truth(test), self._real(yes), self._real(no))
        elif operation != "variable":
            self.values[k] = self._value(step)

    def _value(self, step: Step) -> str:
        operation, data, write = step.operation, step.data, self.write
        if operation == "number":
            assert isinstance(data, float)
            return write.number(data)
        if operation in ("constant", "variable"):
            assert isinstance(data, int)
            return write.load(write.real, "%c" if operation == "constant" else "%y", data)
        if operation == "input":
            assert isinstance(data, int)
            return self._input(data)
        values = [self._real(item) for item in step.arguments]
        if operation == "pieces":
            assert isinstance(data, tuple)
            return write.gathered([self._looked_up(values[0], *data, lane) for lane in range(write.width)])
        if operation in ("min", "max"):
            return self._extreme("olt" if operation == "min" else "ogt", step, values)
        return self._arithmetic(step, values)

    def _looked_up(self, x: str, table: int, order: int, lane: int) -> str:
        """What a lane reads from its table."""
        first = 2 * table * self.write.width + lane
        where, count = self.write.load("ptr", "%tables", first), self.write.load("i64", "%tables", first + self.write.width)
        return self.write.new(f"call double @pieces_{order}(double {self.write.lane(x, lane)}, ptr {where}, i64 {count})")

    def _input(self, number: int) -> str:
        write = self.write
        lanes = [self._cell(number * write.width + lane) for lane in range(1 if self.shared else write.width)]
        if len(lanes) < write.width:
            return write.everywhere(lanes[0])
        return write.gathered(lanes)

    def _cell(self, column: int) -> str:
        base = self.write.load("ptr", "%columns", column)
        at = self.write.new(f"getelementptr double, ptr {base}, i64 %row")
        return self.write.new(f"load double, ptr {at}, align 8")

    def _extreme(self, better: str, step: Step, values: list[str]) -> str:
        """Like numpy, NaN from either argument comes out.  ``a better b ? a : b`` gives b where one is NaN."""
        write, (a, b) = self.write, values
        first, second = (self.structure.steps[item].operation in ("number", "constant") for item in step.arguments)
        if second and not first:
            a, b, first = b, a, True
        chosen = write.choose(write.compare(better, a, b), a, b)
        return chosen if first else write.choose(write.compare("uno", a, a), a, chosen)

    def _arithmetic(self, step: Step, values: list[str]) -> str:
        operation, write = step.operation, self.write
        if operation in _PLAIN:
            return write.new(f"{_PLAIN[operation]} {write.real} {values[0]}, {values[1]}")
        if operation == "neg":
            return write.negative(values[0])
        if operation == "sign":
            one = write.intrinsic("copysign", write.number(1.0), values[0])
            return write.choose(write.compare("one", values[0], write.number(0.0)), one, values[0])
        if operation in _INTRINSIC:
            return write.intrinsic(_INTRINSIC[operation], values[0])
        if operation == "pow" and self.structure.steps[step.arguments[1]].operation == "number":
            return self._power(values[0], self.structure.steps[step.arguments[1]].data)
        if operation in ("sin", "cos") and step.arguments[0] in self.turned:
            return self._sine_or_cosine(operation, step.arguments[0])
        if operation in self.vectors:
            return write.new(f"call {write.real} @vector_{operation}({', '.join(f'{write.real} {value}' for value in values)})")
        if operation in _LIBRARY:
            return write.library(operation, *values)
        raise ValueError(f"no machine code for the operation {operation!r}")

    def _sine_or_cosine(self, operation: str, angle: int) -> str:
        known, write = self.turned[angle], self.write
        if not known:
            pair = f"{{{write.real}, {write.real}}}"
            both = write.new(f"call {pair} @vector_{BOTH}({write.real} {self._real(angle)})")
            known |= {name: write.new(f"extractvalue {pair} {both}, {at}") for at, name in enumerate(("sin", "cos"))}
        return known[operation]

    def _power(self, base: str, exponent: object) -> str:
        """Whole and half powers by products and a root."""
        assert isinstance(exponent, float)
        write, (whole, rest) = self.write, divmod(abs(exponent), 1.0)
        factors = [write.intrinsic("sqrt", base)] if rest else []
        square, left = base, int(whole)
        while left:
            if left % 2:
                factors.append(square)
            left //= 2
            square = write.mul(square, square) if left else square
        product = factors[0] if factors else write.number(1.0)
        for factor in factors[1:]:
            product = write.mul(product, factor)
        return write.div(write.number(1.0), product) if exponent < 0.0 else product


class _Read(_Function):
    """Results go out as they are."""

    name, more = "read", "ptr noalias %out"

    def finish(self, place: int, value: str) -> None:
        self.write.store(value, "%out", place)


class _Stage(_Function):
    """Results are rates, by which two states are moved: the next one at which rates are asked for, and the one after the step."""

    name, more = "stage", "ptr noalias %base, double %a, ptr noalias %next, ptr %from, double %b, ptr %to"

    def begin(self) -> None:
        a, b = self.write.everywhere("%a"), self.write.everywhere("%b")
        self._moves = ("%base", a, "%next"), ("%from", b, "%to")

    def finish(self, place: int, value: str) -> None:
        write = self.write
        for base, size, target in self._moves:
            write.store(write.product_added(size, value, write.load(write.real, base, place)), target, place)
