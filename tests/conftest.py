"""One thread of linear algebra in each test process: ``pytest -n auto`` gives every core a process already, and one more.

With a thread per core in each of them small complex products wait for each other, on a busy machine for minutes.

The processes that tests start keep the bytecode of the package, also where the environment says that none is to be kept: each of
some hundreds would compile it anew, which takes half as long as all its imports.
"""

from __future__ import annotations

import os

import pytest

from hdrive_mbs.worker_process import ONE_THREAD

for name in ONE_THREAD:
    os.environ.setdefault(name, "1")  # read when numpy is loaded, by the first test module

os.environ.pop("PYTHONDONTWRITEBYTECODE", None)


def pytest_xdist_auto_num_workers(config: pytest.Config) -> int:
    """Of ``-n auto``: one more than there are cores, for many tests wait for processes of their own."""
    return len(os.sched_getaffinity(0)) + 1 if hasattr(os, "sched_getaffinity") else (os.cpu_count() or 1) + 1
