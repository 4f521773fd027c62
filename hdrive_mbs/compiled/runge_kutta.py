"""The loop around rates and readings, as LLVM text: classical Runge-Kutta of order 4 with a fixed step, on lanes.

    k1 = f(y), k2 = f(y + h/2 k1), k3 = f(y + h/2 k2), k4 = f(y + h k3),  y + h/6 k1 + h/3 k2 + h/3 k3 + h/6 k4

Rates do not go through memory: each stage adds its part to the state after the step (``%sum``, at last ``%y``) and makes the state of
the next stage (``%odd`` and ``%even`` in turns; what the fourth makes there is not used).
"""

from __future__ import annotations

from hdrive_mbs.compiled.llvm_text import Text, typed


def loop(states: int, readings: int, width: int) -> list[str]:
    """``run`` and what it calls, its declarations first.

    ``void @run(y*, h, inner, samples, last, constants*, tables*, columns*, good*, out*, rows)`` makes ``samples`` rows of
    readings; between two of them lie ``inner`` steps h, and after the last one too unless ``last`` is 1.

    y : states, the lanes of each side by side; at the end those after the last step
    columns : what is known at every half step
    good : for each lane the number of samples with finite states, counted on
    out : for each reading and lane ``rows`` values in a row, written from the first on
    """
    declared: dict[str, str] = {}
    parts = {"n": states, "m": readings * width, "real": typed("double", width), "columns_m": max(1, readings)}
    made = [_RUN.format(**parts), _finite(states, width, declared)]
    return [*declared.values(), *made]


def _finite(states: int, width: int, declared: dict[str, str]) -> str:
    """Count on in the lanes whose states are all finite; whether there is one."""
    text = Text(width, declared)
    total = text.number(0.0)
    for k in range(states):
        total = text.add(total, text.mul(text.load(text.real, "%y", k), text.number(0.0)))
    good = text.compare("oeq", total, text.number(0.0))
    count = text.load(text.whole, "%good", 0)
    more = text.integers("add", count, text.new(f"zext {text.truth} {good} to {text.whole}"))
    text.lines.append(f"  store {text.whole} {more}, ptr %good, align 8")
    some = text.any(good)
    return "\n".join(["define internal i1 @finite(ptr noalias %y, ptr noalias %good) {", "entry:", *text.lines, f"  ret i1 {some}", "}"])


_RUN = """
define void @run(
  ptr noalias %y, double %h, i64 %inner, i64 %samples, i64 %last,
  ptr noalias %c, ptr noalias %tables, ptr noalias %columns, ptr noalias %good, ptr noalias %out, i64 %rows
) {{
entry:
  %sum = alloca [{n} x {real}], align 64
  %odd = alloca [{n} x {real}], align 64
  %even = alloca [{n} x {real}], align 64
  %line = alloca [{columns_m} x {real}], align 64
  %half = fmul double %h, 0.5
  %sixth = fdiv double %h, 6.0
  %third = fmul double %sixth, 2.0
  br label %sample
sample:
  %s = phi i64 [ 0, %entry ], [ %s2, %stepped ]
  %whole = mul i64 %s, %inner
  %row = mul i64 %whole, 2
  %checked = call i1 @finite(ptr %y, ptr %good)
  br i1 %checked, label %reading, label %end
reading:
  call void @read(ptr %y, i64 %row, ptr %c, ptr %tables, ptr %columns, ptr %line)
  br label %scatter
scatter:
  %j = phi i64 [ 0, %reading ], [ %j2, %write ]
  %left = icmp slt i64 %j, {m}
  br i1 %left, label %write, label %more
write:
  %from = getelementptr double, ptr %line, i64 %j
  %value = load double, ptr %from
  %first = mul i64 %j, %rows
  %place = add i64 %first, %s
  %to = getelementptr double, ptr %out, i64 %place
  store double %value, ptr %to
  %j2 = add i64 %j, 1
  br label %scatter
more:
  %s2 = add i64 %s, 1
  %over = icmp eq i64 %s2, %samples
  %stop = icmp eq i64 %last, 1
  %finished = and i1 %over, %stop
  br i1 %finished, label %end, label %step
step:
  %i = phi i64 [ 0, %more ], [ %i2, %step ]
  %passed = mul i64 %i, 2
  %r0 = add i64 %row, %passed
  %r1 = add i64 %r0, 1
  %r2 = add i64 %r0, 2
  call void @stage(ptr %y, i64 %r0, ptr %c, ptr %tables, ptr %columns, ptr %y, double %half, ptr %odd, ptr %y, double %sixth, ptr %sum)
  call void @stage(ptr %odd, i64 %r1, ptr %c, ptr %tables, ptr %columns, ptr %y, double %half, ptr %even, ptr %sum, double %third, ptr %sum)
  call void @stage(ptr %even, i64 %r1, ptr %c, ptr %tables, ptr %columns, ptr %y, double %h, ptr %odd, ptr %sum, double %third, ptr %sum)
  call void @stage(ptr %odd, i64 %r2, ptr %c, ptr %tables, ptr %columns, ptr %sum, double %h, ptr %even, ptr %sum, double %sixth, ptr %y)
  %i2 = add i64 %i, 1
  %done = icmp eq i64 %i2, %inner
  br i1 %done, label %stepped, label %step
stepped:
  br i1 %over, label %end, label %sample
end:
  ret void
}}
"""
