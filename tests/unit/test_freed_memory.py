"""Memory that is free again goes back to the system."""

from __future__ import annotations

import ctypes
import os
import platform
import subprocess
import sys

import pytest

from hdrive_mbs.freed_memory import give_back

KEPT = """
import numpy as np
from hdrive_mbs.freed_memory import GIVE

def used():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * 4096 / 1e6

first = np.ones(3_500_000)
del first                                         # from now on arrays of up to 28 MB come from the heap
arrays = [np.ones(500_000) for _ in range(60)]    # 240 MB
last = np.ones(500_000)                           # and stay there below this one
del arrays
before = used()
GIVE()
print(before, used())
"""


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="memory is given back by glibc alone")
@pytest.mark.parametrize("give", ["give_back", "trim"])
def test_what_the_c_library_keeps_of_freed_arrays_is_given_back(give: str) -> None:
    # dask's nanny leaves MALLOC_TRIM_THRESHOLD_ in the environment of a process that started one: glibc then keeps nothing
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("MALLOC_", "GLIBC_TUNABLES"))}
    run = subprocess.run([sys.executable, "-c", KEPT.replace("GIVE", give)], env=environment, capture_output=True, text=True, check=True)
    before, after = map(float, run.stdout.split())
    assert before - after > 200.0


def test_where_the_c_library_cannot_nothing_happens(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[object] = []

    def library(name: object) -> object:
        asked.append(name)
        return object()

    monkeypatch.setattr(ctypes, "CDLL", library)
    give_back()
    assert asked == [None]
