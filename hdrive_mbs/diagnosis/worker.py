"""A process that works for a diagnosis: started fresh, fed through a pipe, ended with its parent."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
import traceback
from collections.abc import Iterator
from dataclasses import dataclass
from multiprocessing import connection
from multiprocessing.context import SpawnProcess
from pathlib import Path
from typing import Any

from hdrive_mbs.diagnosis.packing import packed, unpacked
from hdrive_mbs.errors import AnalysisError

ONE_THREAD = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
"""Variables that hold numpy to one thread a process: many small matrices are slower with more."""
READY = "ready"


@dataclass(eq=False)
class Worker:
    """A process and the number of the item it is at; None while it has none."""

    process: SpawnProcess
    pipe: connection.Connection
    at: int | None = None
    ready: bool = False

    @classmethod
    def start(cls) -> Worker:
        """A new process; it says READY once it has read this package."""
        context = multiprocessing.get_context("spawn")
        ours, theirs = context.Pipe()
        process = context.Process(target=_work, args=(theirs,), name="diagnosis worker", daemon=True)
        with _one_thread():
            process.start()
        theirs.close()  # so that our end says when the process has died
        return cls(process=process, pipe=ours)

    def give(self, number: int, shared: Path, function: Any, item: Any) -> None:
        """An item to work on.  Raises ParameterError for one that cannot be sent."""
        data = packed((function, item))
        self.at = number
        with contextlib.suppress(OSError):  # it has just died: the pipe says so when it is read
            self.pipe.send((str(shared), data))

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
def _one_thread() -> Iterator[None]:
    """The environment that a process starts with; numpy reads it when it is loaded."""
    missing = [name for name in ONE_THREAD if name not in os.environ]
    os.environ.update(dict.fromkeys(missing, "1"))
    try:
        yield
    finally:
        for name in missing:
            os.environ.pop(name, None)


def _work(pipe: connection.Connection) -> None:
    """Answer items until the pipe is closed: (True, answer) or (False, error with the lines where it arose)."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C goes to all; the parent stops its workers
    threading.Thread(target=_leave_with_parent, daemon=True).start()
    known: dict[str, Any] = {}
    with contextlib.suppress(EOFError, OSError):
        pipe.send((True, READY))
        while True:
            path, data = pipe.recv()
            try:
                if path not in known:
                    known.clear()
                    known[path] = unpacked(Path(path).read_bytes())
                function, item = unpacked(data)
                pipe.send((True, function(known[path], item)))
            except Exception as error:
                pipe.send((False, _sendable(error)))


def _sendable(error: Exception) -> Exception:
    """The error with its lines as a note, as far as it can be sent."""
    error.add_note(f"In a worker process:\n{traceback.format_exc()}")
    try:
        read: Any = unpacked(packed(error))
    except Exception:
        read = None
    return error if type(read) is type(error) else AnalysisError(f"{type(error).__name__}: {error}")


def _leave_with_parent() -> None:
    """End with the parent, however it ends."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        connection.wait([parent.sentinel])
        os._exit(1)
