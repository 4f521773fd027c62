"""A process that works for this one: started fresh, fed through a pipe of its own, ended with its parent."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from multiprocessing import connection
from multiprocessing.context import SpawnProcess
from typing import Any, Self

ONE_THREAD = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
"""Variables that hold numpy to one thread a process: a process per core and a thread per core each would be slower, and
sums would depend on the number of threads."""
READY = "ready"
"""What a process says when it has read what it needs."""


@dataclass(eq=False, kw_only=True)
class WorkerProcess:
    """A process and this end of its pipe."""

    process: SpawnProcess
    pipe: connection.Connection

    @classmethod
    def start(cls, work: Callable[..., object], *arguments: Any, name: str) -> Self:
        """A new process that runs ``work(pipe, *arguments)``, which begins with ``work_for_parent()``."""
        context = multiprocessing.get_context("spawn")
        ours, theirs = context.Pipe()
        process = context.Process(target=work, args=(theirs, *arguments), name=name, daemon=True)
        with one_thread_each():
            process.start()
        theirs.close()  # so that our end says when the process has died
        return cls(process=process, pipe=ours)

    def send(self, message: Any) -> None:
        """Send what can be pickled; a process that has just died says so when its pipe is read."""
        with contextlib.suppress(OSError):
            self.pipe.send(message)

    def end(self, patience: float = 0.0) -> str:
        """Stop the process, at once or after some seconds; returns how it ended, in words."""
        self.pipe.close()
        self.process.join(patience)
        if self.process.is_alive():
            self.process.kill()
            self.process.join()
        code = self.process.exitcode
        return f"signal {signal.Signals(-code).name}" if code is not None and code < 0 else f"exit code {code}"


@contextlib.contextmanager
def one_thread_each() -> Iterator[None]:
    """The environment that a process starts with; numpy reads it when it is loaded."""
    missing = [name for name in ONE_THREAD if name not in os.environ]
    os.environ.update(dict.fromkeys(missing, "1"))
    try:
        yield
    finally:
        for name in missing:
            os.environ.pop(name, None)


def work_for_parent() -> None:
    """In the process: leave Ctrl-C, which goes to all, to the parent, and end with it, however it ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_leave_with_parent, daemon=True).start()


def _leave_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        connection.wait([parent.sentinel])
        os._exit(1)
