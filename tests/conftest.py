"""One thread of linear algebra in each test process: ``pytest -n auto`` gives every core a process already.

With a thread per core in each of them small complex products wait for each other, on a busy machine for minutes.
"""

from __future__ import annotations

import os

from hdrive_mbs.worker_process import ONE_THREAD

for name in ONE_THREAD:
    os.environ.setdefault(name, "1")  # read when numpy is loaded, by the first test module
