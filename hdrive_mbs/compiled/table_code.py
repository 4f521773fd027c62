"""Piecewise polynomials as LLVM text."""

from __future__ import annotations

from hdrive_mbs.compiled.llvm_text import Text

_SEARCH = """
  br label %search
search:
  %low = phi i64 [ 0, %entry ], [ %low2, %next ]
  %high = phi i64 [ %breaks, %entry ], [ %high2, %next ]
  %more = icmp slt i64 %low, %high
  br i1 %more, label %next, label %found
next:
  %sum = add i64 %low, %high
  %middle = lshr i64 %sum, 1
  %at = getelementptr double, ptr %table, i64 %middle
  %break = load double, ptr %at
  %right = fcmp ole double %break, %x
  %above = add i64 %middle, 1
  %low2 = select i1 %right, i64 %above, i64 %low
  %high2 = select i1 %right, i64 %high, i64 %middle
  br label %search
found:
  %starts = getelementptr double, ptr %table, i64 %breaks
  %startat = getelementptr double, ptr %starts, i64 %low
  %start = load double, ptr %startat
  %passed = fsub double %x, %start
  %rows = getelementptr double, ptr %starts, i64 %count
"""


def table_code(order: int, declared: dict[str, str]) -> str:
    """``define double @pieces_<order>(double %x, ptr %table, i64 %count)`` of a table with ``count`` pieces.

    order : coefficients of a piece

    The piece is found by bisection: the first whose end lies beyond x.  Lanes are searched one after the other, which is
    faster than gathering from all tables at once.
    """
    text = Text(1, declared)
    row = text.new(f"getelementptr double, ptr %rows, i64 {text.new(f'mul i64 %low, {order}')}")
    value = text.load("double", row, order - 1)
    for k in reversed(range(order - 1)):
        value = text.add(text.mul(value, "%passed"), text.load("double", row, k))
    head = f"define internal double @pieces_{order}(double %x, ptr %table, i64 %count) {{\nentry:\n  %breaks = sub i64 %count, 1"
    return "\n".join([head + _SEARCH, *text.lines, f"  ret double {value}", "}"])
