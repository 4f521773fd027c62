"""A process that works for a diagnosis: it keeps what items share, and answers one item after the other."""

from __future__ import annotations

import contextlib
import ctypes
import importlib
import traceback
from collections.abc import Sequence
from dataclasses import dataclass
from multiprocessing import connection
from multiprocessing.context import SpawnContext
from pathlib import Path
from typing import Any

from hdrive_mbs.compiled.threads import allowed
from hdrive_mbs.diagnosis.later import Later
from hdrive_mbs.diagnosis.packing import packed, unpacked
from hdrive_mbs.diagnosis.refusals import taken
from hdrive_mbs.errors import AnalysisError
from hdrive_mbs.freed_memory import give_back
from hdrive_mbs.worker_process import READY, WorkerProcess, work_for_parent


def threads_of_each() -> ctypes.c_int:
    """A number that processes see change: threads that each of them may take while others have nothing to do."""
    return SpawnContext().RawValue(ctypes.c_int, 1)


@dataclass(eq=False, kw_only=True)
class Worker(WorkerProcess):
    """A process and what it is at: the number of an item, or work that is asked for later; None while it has none."""

    at: int | None = None
    apart: Later | None = None
    ready: bool = False

    @classmethod
    def begun(cls, threads: ctypes.c_int, needed: Sequence[str] = ()) -> Worker:
        """A new process; it says READY once it can take work.

        needed : modules that it reads then, while it has none
        """
        return cls.start(_work, threads, tuple(needed), name="diagnosis worker")

    @property
    def is_busy(self) -> bool:
        return self.at is not None or self.apart is not None

    def give(self, number: int, shared: Path, function: Any, item: Any) -> None:
        """An item to work on.  Raises ParameterError for one that cannot be sent."""
        data = packed((function, item))
        self.at = number
        self.send((str(shared), data))

    def give_apart(self, later: Later) -> None:
        """Work that is asked for later; it may be given before the process is ready."""
        data = packed((later.function, later.item))
        self.apart = later
        self.send((str(later.file), data))


def _work(pipe: connection.Connection, threads: ctypes.c_int, needed: Sequence[str]) -> None:
    """Answer items until the pipe is closed: (True, answer, refused) or (False, error with the lines where it arose, refused)."""
    work_for_parent()
    known: dict[str, Any] = {}
    with contextlib.suppress(EOFError, OSError), allowed(lambda: threads.value):
        pipe.send((True, READY, {}))
        for name in needed:
            importlib.import_module(name)
        while True:
            path, data = pipe.recv()
            try:
                if path not in known:
                    known.clear()
                    give_back()
                    known[path] = unpacked(Path(path).read_bytes())
                function, item = unpacked(data)
                answer = function(known[path], item)
                pipe.send((True, answer, taken()))
            except Exception as error:
                pipe.send((False, _sendable(error), taken()))


def _sendable(error: Exception) -> Exception:
    """The error with its lines as a note, as far as it can be sent."""
    error.add_note(f"In a worker process:\n{traceback.format_exc()}")
    try:
        read: Any = unpacked(packed(error))
    except Exception:
        read = None
    return error if type(read) is type(error) else AnalysisError(f"{type(error).__name__}: {error}")
