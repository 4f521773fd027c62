"""The memory that a case takes, its worker processes included."""

from __future__ import annotations

import json
import subprocess
import sys

from benchmarks.withheld.memory import Memory

MIB = 1 << 20

MEASURED = f"""
import json, subprocess, sys, time
import numpy as np
from benchmarks.withheld.memory import EVERY, Memory

hold = f"import time; held = b'x' * {200 * MIB}; time.sleep({{6.0 * EVERY}})"
with Memory() as before:
    time.sleep(2.0 * EVERY)
with Memory() as alone:
    held = np.ones({100 * MIB // 8})
    time.sleep(2.0 * EVERY)
    assert held.all()
del held
with Memory() as together:
    subprocess.run([sys.executable, "-c", hold], check=True)
with Memory() as quiet:
    time.sleep(10.0 * EVERY)
print(json.dumps([item.peak for item in (before, alone, together)] + [quiet.counts]))
"""
"""In a process of its own: one that has run other tests gives memory back and takes it whenever it likes."""


def test_what_this_process_and_its_children_hold_counts() -> None:
    ran = subprocess.run([sys.executable, "-c", MEASURED], check=True, capture_output=True, text=True)
    before, alone, together, quiet = json.loads(ran.stdout)
    # pages of libraries come and go by some MiB
    assert 90 * MIB < alone - before < 130 * MIB
    assert 190 * MIB < together - before < 260 * MIB
    assert 1 <= quiet < 10  # where nothing changes shares are not counted at every look


def test_a_process_that_has_ended_is_no_error() -> None:
    with Memory() as memory:
        for _ in range(5):
            subprocess.run([sys.executable, "-c", "pass"], check=True)
    assert memory.peak > 0
