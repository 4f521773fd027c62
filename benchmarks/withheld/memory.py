"""Memory of this process and of all that it begins, sampled while something runs."""

from __future__ import annotations

import itertools
import threading
from types import TracebackType
from typing import Self

import psutil

EVERY = 0.3
"""Seconds from one look to the next; what is held for a shorter time may be missed."""
COUNTED = 30
"""Looks after which shares are counted in any case, since processes come to share less (or more) of their pages."""
LISTED = 4
"""Looks after which the processes are listed again, for which all processes of the computer are read; one that lives for a shorter time may
be missed."""


class Memory:
    """The most that was held at once within a ``with`` block: ``peak`` [bytes], and how often shares were counted for it: ``counts``.

    On Linux a page that several processes share counts once (proportional set sizes); elsewhere resident sizes are added up.  Shares take
    long to count, and hold up the processes whose pages are counted: they are where resident sizes, less what was shared at the last
    count, promise more than the peak, where processes have come or gone, and now and then (COUNTED).
    """

    def __init__(self) -> None:
        self.peak = 0
        self.counts = 0
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._watch, name="memory", daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, lines: TracebackType | None) -> None:
        self._ended.set()
        self._thread.join()

    def _watch(self) -> None:
        this = psutil.Process()
        shared, since, number = 0, 0, 0
        processes: list[psutil.Process] = []
        for look in itertools.count():
            if look % LISTED == 0:
                processes = [this, *this.children(recursive=True)]
            resident = sum(map(_resident, processes))
            since += 1
            if resident - shared > self.peak or since > COUNTED or len(processes) != number:
                held = sum(map(_held, processes))
                self.peak, shared, since, number = max(self.peak, held), max(0, resident - held), 0, len(processes)
                self.counts += 1
            if self._ended.wait(EVERY):
                return


def _resident(process: psutil.Process) -> int:
    try:
        return int(process.memory_info().rss)
    except psutil.Error:
        return 0


def _held(process: psutil.Process) -> int:
    try:
        found = process.memory_full_info()
    except psutil.Error:  # it has ended meanwhile, or is not ours
        return 0
    return int(getattr(found, "pss", found.rss))
