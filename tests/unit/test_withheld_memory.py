"""The memory that a case takes, its worker processes included."""

from __future__ import annotations

import subprocess
import sys
import time

import numpy as np

from benchmarks.withheld.memory import EVERY, Memory

MIB = 1 << 20
HOLD = f"import time; held = b'x' * {200 * MIB}; time.sleep({6.0 * EVERY})"


def test_what_this_process_and_its_children_hold_counts() -> None:
    with Memory() as before:
        time.sleep(2.0 * EVERY)
    with Memory() as alone:
        held = np.ones(100 * MIB // 8)
        time.sleep(2.0 * EVERY)
        assert held.all()
    del held
    with Memory() as together:
        subprocess.run([sys.executable, "-c", HOLD], check=True)
    # pages of libraries come and go by some MiB
    assert 90 * MIB < alone.peak - before.peak < 130 * MIB
    assert 190 * MIB < together.peak - before.peak < 260 * MIB


def test_a_process_that_has_ended_is_no_error() -> None:
    with Memory() as memory:
        for _ in range(5):
            subprocess.run([sys.executable, "-c", "pass"], check=True)
    assert memory.peak > 0
