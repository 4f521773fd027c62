"""Writing LLVM text: instructions on doubles, or on vectors of doubles that hold one number for each lane."""

from __future__ import annotations

import struct
from collections.abc import Sequence


def written(value: float) -> str:
    """A float as LLVM reads it exactly."""
    return "0x" + struct.pack(">d", value).hex().upper()


class Text:
    """The instructions of one function, on ``width`` lanes.

    declared : what the module calls, name -> declaration; shared by the functions of a module
    """

    def __init__(self, width: int, declared: dict[str, str]) -> None:
        self.width, self.declared = width, declared
        self.lines: list[str] = []
        self.real, self.truth, self.whole = (typed(kind, width) for kind in ("double", "i1", "i64"))
        self.true = repeated("i1", "true", width)
        self._next = 0

    def name(self) -> str:
        """A name that is not used yet."""
        self._next += 1
        return f"v{self._next}"

    def new(self, instruction: str) -> str:
        """Add an instruction; the name of its result."""
        name = self.name()
        self.lines.append(f"  %{name} = {instruction}")
        return f"%{name}"

    def number(self, value: float) -> str:
        """The same number in every lane."""
        return repeated("double", written(value), self.width)

    def integer(self, value: int) -> str:
        """The same whole number in every lane."""
        return repeated("i64", str(value), self.width)

    def add(self, a: str, b: str) -> str:
        """a + b."""
        return self.new(f"fadd {self.real} {a}, {b}")

    def sub(self, a: str, b: str) -> str:
        """a - b."""
        return self.new(f"fsub {self.real} {a}, {b}")

    def mul(self, a: str, b: str) -> str:
        """a b."""
        return self.new(f"fmul {self.real} {a}, {b}")

    def div(self, a: str, b: str) -> str:
        """a / b."""
        return self.new(f"fdiv {self.real} {a}, {b}")

    def negative(self, a: str) -> str:
        """-a."""
        return self.new(f"fneg {self.real} {a}")

    def compare(self, how: str, a: str, b: str) -> str:
        """A truth value for each lane."""
        return self.new(f"fcmp {how} {self.real} {a}, {b}")

    def choose(self, test: str, a: str, b: str) -> str:
        """a where the test holds, else b."""
        return self.new(f"select {self.truth} {test}, {self.real} {a}, {self.real} {b}")

    def intrinsic(self, name: str, *arguments: str) -> str:
        """An operation of LLVM on each lane: sqrt, fabs, floor, ceil, fma, fmuladd, copysign."""
        whole = f"llvm.{name}.{'f64' if self.width == 1 else f'v{self.width}f64'}"
        self.declared[whole] = f"declare {self.real} @{whole}({', '.join([self.real] * len(arguments))})"
        return self.new(f"call {self.real} @{whole}({', '.join(f'{self.real} {item}' for item in arguments)})")

    def fma(self, a: str, b: str, c: str) -> str:
        """a b + c with one rounding."""
        return self.intrinsic("fma", a, b, c)

    def product_added(self, a: str, b: str, c: str) -> str:
        """a b + c, with one rounding where that is faster."""
        return self.intrinsic("fmuladd", a, b, c)

    def polynomial(self, x: str, coefficients: tuple[float, ...]) -> str:
        """sum_k c[k] x^k by Estrin's scheme: pairs c[k] + c[k+1] x, then pairs of these with x^2, and so on.

        As many products as by Horner's rule and a few squares, but a chain of as many steps as the logarithm of their number says: a
        run waits for the chains of its powers, not for the processor.
        """
        terms = [self.number(c) for c in coefficients]
        while len(terms) > 1:
            pairs = [self.fma(terms[k + 1], x, terms[k]) for k in range(0, len(terms) - 1, 2)]
            terms = [*pairs, *terms[2 * len(pairs) :]]
            x = self.mul(x, x) if len(terms) > 1 else x
        return terms[0]

    def bits(self, a: str) -> str:
        """The bits of a number as a whole one."""
        return self.new(f"bitcast {self.real} {a} to {self.whole}")

    def from_bits(self, a: str) -> str:
        """The number with these bits."""
        return self.new(f"bitcast {self.whole} {a} to {self.real}")

    def integers(self, operation: str, a: str, b: str) -> str:
        """An operation on whole numbers."""
        return self.new(f"{operation} {self.whole} {a}, {b}")

    def any(self, test: str) -> str:
        """Whether a truth value holds in any lane."""
        if self.width == 1:
            return test
        name = f"llvm.vector.reduce.or.v{self.width}i1"
        self.declared[name] = f"declare i1 @{name}({self.truth})"
        return self.new(f"call i1 @{name}({self.truth} {test})")

    def library(self, name: str, *arguments: str) -> str:
        """A function of the C library, called for one lane after the other."""
        self.declared[name] = f"declare double @{name}({', '.join(['double'] * len(arguments))})"
        return self.gathered([self.new(f"call double @{name}({', '.join(parts)})") for parts in self._parted(arguments)])

    def _parted(self, values: Sequence[str]) -> list[list[str]]:
        """For each lane its part of all values, with type."""
        return [[f"double {self.lane(value, lane)}" for value in values] for lane in range(self.width)]

    def lane(self, value: str, lane: int) -> str:
        """One lane's part of a value."""
        return value if self.width == 1 else self.new(f"extractelement {self.real} {value}, i64 {lane}")

    def load(self, kind: str, base: str, index: int) -> str:
        """Number ``index`` of the values of this type behind a pointer."""
        at = self.new(f"getelementptr {kind}, ptr {base}, i64 {index}")
        return self.new(f"load {kind}, ptr {at}, align 8")

    def store(self, value: str, base: str, index: int) -> None:
        """Set number ``index`` of the lanes of numbers behind a pointer."""
        at = self.new(f"getelementptr {self.real}, ptr {base}, i64 {index}")
        self.lines.append(f"  store {self.real} {value}, ptr {at}, align 8")

    def everywhere(self, one: str) -> str:
        """A plain double in every lane."""
        if self.width == 1:
            return one
        first = self.new(f"insertelement {self.real} undef, double {one}, i64 0")
        return self.new(f"shufflevector {self.real} {first}, {self.real} undef, <{self.width} x i32> zeroinitializer")

    def gathered(self, lanes: Sequence[str]) -> str:
        """Plain doubles side by side."""
        if self.width == 1:
            return lanes[0]
        value = "undef"
        for lane, one in enumerate(lanes):
            value = self.new(f"insertelement {self.real} {value}, double {one}, i64 {lane}")
        return value


def typed(kind: str, width: int) -> str:
    """The type of ``width`` lanes of a kind."""
    return kind if width == 1 else f"<{width} x {kind}>"


def repeated(kind: str, value: str, width: int) -> str:
    """A literal in every lane."""
    return value if width == 1 else "<" + ", ".join([f"{kind} {value}"] * width) + ">"
