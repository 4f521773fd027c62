"""The loop around a right-hand side, as LLVM text: classical Runge-Kutta of order 4 with a fixed step."""

from __future__ import annotations

RUN = """
define i64 @run(ptr noalias %y, double %start, double %h, i64 %inner, i64 %samples, ptr %c, ptr %tables, ptr noalias %out) {{
entry:
  %k1 = alloca [{n} x double], align 16
  %k2 = alloca [{n} x double], align 16
  %k3 = alloca [{n} x double], align 16
  %k4 = alloca [{n} x double], align 16
  %stage = alloca [{n} x double], align 16
  %half = fmul double %h, 0.5
  %sixth = fdiv double %h, 6.0
  br label %sample
sample:
  %s = phi i64 [ 0, %entry ], [ %s2, %stepped ]
  %row = mul i64 %s, {n}
  %to = getelementptr double, ptr %out, i64 %row
  call void @copy(ptr %to, ptr %y)
  %checked = call i1 @finite(ptr %y)
  br i1 %checked, label %more, label %broken
broken:
  ret i64 %s
more:
  %s2 = add i64 %s, 1
  %over = icmp eq i64 %s2, %samples
  br i1 %over, label %end, label %step
step:
  %i = phi i64 [ 0, %more ], [ %i2, %step ]
  %whole = mul i64 %s, %inner
  %number = add i64 %whole, %i
  %count = sitofp i64 %number to double
  %passed = fmul double %count, %h
  %t = fadd double %start, %passed
  %tm = fadd double %t, %half
  %te = fadd double %t, %h
  call void @rates(double %t, ptr %y, ptr %c, ptr %tables, ptr %k1)
  call void @move(ptr %stage, ptr %y, double %half, ptr %k1)
  call void @rates(double %tm, ptr %stage, ptr %c, ptr %tables, ptr %k2)
  call void @move(ptr %stage, ptr %y, double %half, ptr %k2)
  call void @rates(double %tm, ptr %stage, ptr %c, ptr %tables, ptr %k3)
  call void @move(ptr %stage, ptr %y, double %h, ptr %k3)
  call void @rates(double %te, ptr %stage, ptr %c, ptr %tables, ptr %k4)
  call void @move(ptr %y, ptr %y, double %sixth, ptr %k1)
  %third = fmul double %sixth, 2.0
  call void @move(ptr %y, ptr %y, double %third, ptr %k2)
  call void @move(ptr %y, ptr %y, double %third, ptr %k3)
  call void @move(ptr %y, ptr %y, double %sixth, ptr %k4)
  %i2 = add i64 %i, 1
  %last = icmp eq i64 %i2, %inner
  br i1 %last, label %stepped, label %step
stepped:
  br label %sample
end:
  ret i64 %samples
}}

define internal void @move(ptr %to, ptr %y, double %h, ptr %k) alwaysinline {{
entry:
  br label %loop
loop:
  %i = phi i64 [ 0, %entry ], [ %i2, %loop ]
  %ya = getelementptr double, ptr %y, i64 %i
  %ka = getelementptr double, ptr %k, i64 %i
  %ta = getelementptr double, ptr %to, i64 %i
  %yv = load double, ptr %ya
  %kv = load double, ptr %ka
  %d = fmul double %h, %kv
  %v = fadd double %yv, %d
  store double %v, ptr %ta
  %i2 = add i64 %i, 1
  %done = icmp eq i64 %i2, {n}
  br i1 %done, label %end, label %loop
end:
  ret void
}}

define internal void @copy(ptr %to, ptr %y) alwaysinline {{
entry:
  br label %loop
loop:
  %i = phi i64 [ 0, %entry ], [ %i2, %loop ]
  %ya = getelementptr double, ptr %y, i64 %i
  %ta = getelementptr double, ptr %to, i64 %i
  %yv = load double, ptr %ya
  store double %yv, ptr %ta
  %i2 = add i64 %i, 1
  %done = icmp eq i64 %i2, {n}
  br i1 %done, label %end, label %loop
end:
  ret void
}}

define internal i1 @finite(ptr %y) alwaysinline {{
entry:
  br label %loop
loop:
  %i = phi i64 [ 0, %entry ], [ %i2, %loop ]
  %sum = phi double [ 0.0, %entry ], [ %sum2, %loop ]
  %ya = getelementptr double, ptr %y, i64 %i
  %yv = load double, ptr %ya
  %zero = fmul double %yv, 0.0
  %sum2 = fadd double %sum, %zero
  %i2 = add i64 %i, 1
  %done = icmp eq i64 %i2, {n}
  br i1 %done, label %end, label %loop
end:
  %good = fcmp oeq double %sum2, 0.0
  ret i1 %good
}}
"""
"""Samples at start, start + inner h, ...: row s of ``out`` is the state there; returns the number of rows that are finite."""


OBSERVE = """
define void @observe(double %start, double %every, i64 %samples, ptr %states, ptr %c, ptr %tables, ptr noalias %out) {{
entry:
  br label %loop
loop:
  %s = phi i64 [ 0, %entry ], [ %s2, %loop ]
  %count = sitofp i64 %s to double
  %passed = fmul double %count, %every
  %t = fadd double %start, %passed
  %row = mul i64 %s, {n}
  %y = getelementptr double, ptr %states, i64 %row
  %line = mul i64 %s, {m}
  %to = getelementptr double, ptr %out, i64 %line
  call void @read(double %t, ptr %y, ptr %c, ptr %tables, ptr %to)
  %s2 = add i64 %s, 1
  %done = icmp eq i64 %s2, %samples
  br i1 %done, label %end, label %loop
end:
  ret void
}}
"""
"""Channels at every sample of a run."""
