"""A structure as LLVM text: one function of time, state, constants and tables."""

from __future__ import annotations

import struct

from hdrive_mbs.compiled.program import Step, Structure

_PLAIN = {"add": "fadd", "sub": "fsub", "mul": "fmul", "div": "fdiv"}
_COMPARE = {"lt": "olt", "le": "ole", "eq": "oeq"}
_INTRINSIC = {"sqrt": "llvm.sqrt.f64", "abs": "llvm.fabs.f64", "floor": "llvm.floor.f64", "ceil": "llvm.ceil.f64"}
_LIBRARY = ("sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh", "exp", "log", "pow", "atan2")

HEAD = "\n".join(
    [f"declare double @{name}(double)" for name in _INTRINSIC.values()]
    + [f"declare double @{name}(double)" for name in _LIBRARY if name not in ("pow", "atan2")]
    + ["declare double @pow(double, double)", "declare double @atan2(double, double)"]
)
"""What the generated code calls: intrinsics and the C library's mathematics."""

PIECES = """
define internal double @pieces(double %x, ptr %base, i64 %count, i64 %width) alwaysinline {
entry:
  %breaks = sub i64 %count, 1
  br label %search
search:
  %low = phi i64 [ 0, %entry ], [ %low2, %next ]
  %high = phi i64 [ %breaks, %entry ], [ %high2, %next ]
  %more = icmp slt i64 %low, %high
  br i1 %more, label %next, label %found
next:
  %sum = add i64 %low, %high
  %middle = lshr i64 %sum, 1
  %at = getelementptr double, ptr %base, i64 %middle
  %break = load double, ptr %at
  %right = fcmp ole double %break, %x
  %above = add i64 %middle, 1
  %low2 = select i1 %right, i64 %above, i64 %low
  %high2 = select i1 %right, i64 %high, i64 %middle
  br label %search
found:
  %starts = getelementptr double, ptr %base, i64 %breaks
  %startat = getelementptr double, ptr %starts, i64 %low
  %start = load double, ptr %startat
  %passed = fsub double %x, %start
  %rows = getelementptr double, ptr %starts, i64 %count
  %offset = mul i64 %low, %width
  %row = getelementptr double, ptr %rows, i64 %offset
  %lastk = sub i64 %width, 1
  br label %horner
horner:
  %k = phi i64 [ %lastk, %found ], [ %k2, %horner ]
  %value = phi double [ 0.0, %found ], [ %value2, %horner ]
  %cat = getelementptr double, ptr %row, i64 %k
  %c = load double, ptr %cat
  %scaled = fmul double %value, %passed
  %value2 = fadd double %scaled, %c
  %k2 = sub i64 %k, 1
  %done = icmp eq i64 %k, 0
  br i1 %done, label %end, label %horner
end:
  ret double %value2
}
"""
"""Piecewise polynomial by bisection: the first piece whose end lies beyond x."""


def written(value: float) -> str:
    """A float as LLVM reads it exactly."""
    return "0x" + struct.pack(">d", value).hex().upper()


def function(name: str, structure: Structure) -> str:
    """``define void @name(time, state*, constants*, tables*, out*)``; variable 0 is the time, the others are the state in order.

    Both sides of a branch are computed.  Raises ValueError for an operation without a translation.
    """
    lines = [f"define void @{name}(double %t, ptr %y, ptr %c, ptr %tables, ptr noalias %out) {{", "entry:"]
    boolean: set[int] = set()
    for k, step in enumerate(structure.steps):
        lines += _lines(k, step, boolean)
    for k, result in enumerate(structure.results):
        value = _real(result, boolean, lines, f"r{k}")
        lines += [f"  %o{k} = getelementptr double, ptr %out, i64 {k}", f"  store double {value}, ptr %o{k}"]
    return "\n".join([*lines, "  ret void", "}"])


def _real(number: int, boolean: set[int], lines: list[str], name: str) -> str:
    """A step as a double; comparisons become 1 or 0."""
    if number not in boolean:
        return f"%v{number}"
    lines.append(f"  %{name} = uitofp i1 %v{number} to double")
    return f"%{name}"


def _truth(number: int, boolean: set[int], lines: list[str], name: str) -> str:
    """A step as a truth value."""
    if number in boolean:
        return f"%v{number}"
    lines.append(f"  %{name} = fcmp une double %v{number}, 0.0")
    return f"%{name}"


def _lines(k: int, step: Step, boolean: set[int]) -> list[str]:
    operation, data = step.operation, step.data
    lines: list[str] = []
    if operation == "number":
        assert isinstance(data, float)
        return [f"  %v{k} = fadd double {written(data)}, {written(-0.0)}"]
    if operation == "constant":
        return [f"  %p{k} = getelementptr double, ptr %c, i64 {data}", f"  %v{k} = load double, ptr %p{k}"]
    if operation == "variable":
        assert isinstance(data, int)
        if data == 0:
            return [f"  %v{k} = fadd double %t, {written(-0.0)}"]
        return [f"  %p{k} = getelementptr double, ptr %y, i64 {data - 1}", f"  %v{k} = load double, ptr %p{k}"]
    if operation in ("and", "or", "not"):
        truths = [_truth(item, boolean, lines, f"b{k}_{i}") for i, item in enumerate(step.arguments)]
        boolean.add(k)
        other = truths[1] if len(truths) > 1 else "true"
        return [*lines, f"  %v{k} = {'xor' if operation == 'not' else operation} i1 {truths[0]}, {other}"]
    if operation == "where":
        test = _truth(step.arguments[0], boolean, lines, f"b{k}")
        a, b = (_real(item, boolean, lines, f"w{k}_{i}") for i, item in enumerate(step.arguments[1:]))
        return [*lines, f"  %v{k} = select i1 {test}, double {a}, double {b}"]
    values = [_real(item, boolean, lines, f"a{k}_{i}") for i, item in enumerate(step.arguments)]
    if operation in _COMPARE:
        boolean.add(k)
        return [*lines, f"  %v{k} = fcmp {_COMPARE[operation]} double {values[0]}, {values[1]}"]
    if operation == "pieces":
        assert isinstance(data, tuple)
        first, count, width = data
        lines.append(f"  %p{k} = getelementptr double, ptr %tables, i64 {first}")
        return [*lines, f"  %v{k} = call double @pieces(double {values[0]}, ptr %p{k}, i64 {count}, i64 {width})"]
    return [*lines, *_arithmetic(k, operation, values)]


def _arithmetic(k: int, operation: str, values: list[str]) -> list[str]:
    if operation in _PLAIN:
        return [f"  %v{k} = {_PLAIN[operation]} double {values[0]}, {values[1]}"]
    if operation == "neg":
        return [f"  %v{k} = fneg double {values[0]}"]
    if operation in ("min", "max"):
        # like numpy, a NaN comes out
        return [
            f"  %n{k} = fcmp uno double {values[0]}, {values[0]}",
            f"  %m{k} = fcmp {'olt' if operation == 'min' else 'ogt'} double {values[0]}, {values[1]}",
            f"  %f{k} = or i1 %n{k}, %m{k}",
            f"  %v{k} = select i1 %f{k}, double {values[0]}, double {values[1]}",
        ]
    if operation == "sign":
        return [
            f"  %g{k} = fcmp ogt double {values[0]}, 0.0",
            f"  %l{k} = fcmp olt double {values[0]}, 0.0",
            f"  %h{k} = select i1 %l{k}, double -1.0, double 0.0",
            f"  %v{k} = select i1 %g{k}, double 1.0, double %h{k}",
        ]
    if operation in _INTRINSIC:
        return [f"  %v{k} = call double @{_INTRINSIC[operation]}(double {values[0]})"]
    if operation in _LIBRARY:
        return [f"  %v{k} = call double @{operation}({', '.join(f'double {value}' for value in values)})"]
    raise ValueError(f"no machine code for the operation {operation!r}")
