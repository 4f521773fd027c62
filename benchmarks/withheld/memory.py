"""Memory of this process and of all that it begins, sampled while something runs."""

from __future__ import annotations

import threading
from types import TracebackType
from typing import Self

import psutil

EVERY = 0.3
"""Seconds from one look to the next; what is held for a shorter time may be missed."""


class Memory:
    """The most that was held at once within a ``with`` block: ``peak`` [bytes].

    On Linux a page that several processes share counts once (proportional set sizes); elsewhere resident sizes are added up.
    """

    def __init__(self) -> None:
        self.peak = 0
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
        while True:
            processes = [this, *this.children(recursive=True)]
            if sum(map(_resident, processes)) > self.peak:  # shares are never more, and take far longer to count
                self.peak = max(self.peak, sum(map(_held, processes)))
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
