"""Jobs on processes of this machine, each watched over its own pipe.

The pools of the standard library give up all their jobs when one process is killed, and do not say which job it had.
Here a process has one job at a time, so a lost one costs that job's time alone and is counted against that job alone.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
from collections import Counter, deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from multiprocessing import connection
from multiprocessing.process import BaseProcess
from typing import Any

from hdrive_mbs.campaign.outcome import Outcome, lost, run_pickled
from hdrive_mbs.campaign.points import Point
from hdrive_mbs.errors import SimulationError

READY = "ready"
ONE_THREAD = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
"""A process per core and a thread per core each would be slower; and sums would depend on the number of threads."""


@dataclass(kw_only=True)
class _Worker:
    """A process, this end of its pipe, and what it is at: a job's key, READY, or None while it starts."""

    process: BaseProcess
    pipe: connection.Connection
    at: str | None = None


def run_on_processes(task: bytes, jobs: Mapping[str, Point], *, workers: int, retries: int) -> Iterator[tuple[str, Outcome]]:
    """Key and outcome of each job, as they are finished; closing the iterator stops the processes.

    Raises SimulationError when no process can be started.
    """
    waiting = deque(jobs)
    attempts: Counter[str] = Counter()
    crew: list[_Worker] = []
    false_starts = 0
    try:
        while waiting or any(worker.at in jobs for worker in crew):
            for worker in crew:
                if worker.at == READY and waiting:
                    _give(worker, waiting.popleft(), jobs)
            while len(crew) < workers and sum(worker.at is None for worker in crew) < len(waiting):
                crew.append(_start(task))
            by_pipe: dict[Any, _Worker] = {worker.pipe: worker for worker in crew}
            for pipe in connection.wait(list(by_pipe)):
                worker = by_pipe[pipe]
                try:
                    message = worker.pipe.recv()
                except (EOFError, OSError):
                    crew.remove(worker)
                    reason = _end(worker, patience=5.0)
                    if worker.at in jobs:
                        key = str(worker.at)
                        attempts[key] += 1
                        if attempts[key] > retries:
                            yield key, lost(reason, attempts[key])
                        else:
                            waiting.appendleft(key)
                    elif worker.at is None:
                        false_starts += 1
                        if false_starts > retries or not reason.startswith("signal"):
                            raise _no_start(reason) from None
                    continue
                key, worker.at = str(worker.at), READY
                if isinstance(message, Outcome):
                    yield key, message.after(attempts[key] + 1)
                elif message != READY:
                    raise SimulationError(
                        f"The function cannot be read in another process: {message}. Put it at the top level of a module."
                    )
    finally:
        for worker in crew:
            _end(worker, patience=0.0)


def _give(worker: _Worker, key: str, jobs: Mapping[str, Point]) -> None:
    worker.at = key
    with contextlib.suppress(OSError):  # it has just died: the pipe will say so
        worker.pipe.send(jobs[key])


def _start(task: bytes) -> _Worker:
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    process = context.Process(target=_work, args=(theirs, task), name="campaign worker", daemon=True)
    with _one_thread_each():
        process.start()
    theirs.close()  # so that its end is closed when the process dies
    return _Worker(process=process, pipe=ours)


@contextlib.contextmanager
def _one_thread_each() -> Iterator[None]:
    """The environment that a process starts with; numpy reads it when it is loaded."""
    missing = [name for name in ONE_THREAD if name not in os.environ]
    os.environ.update(dict.fromkeys(missing, "1"))
    try:
        yield
    finally:
        for name in missing:
            os.environ.pop(name, None)


def _end(worker: _Worker, *, patience: float) -> str:
    """Wait some seconds for the process to end, then kill it; returns how it ended."""
    worker.pipe.close()
    worker.process.join(patience)
    if worker.process.is_alive():
        worker.process.kill()
        worker.process.join()
    code = worker.process.exitcode
    return f"signal {signal.Signals(-code).name}" if code is not None and code < 0 else f"exit code {code}"


def _no_start(reason: str) -> SimulationError:
    return SimulationError(
        f"A worker process could not start ({reason}; its own words are above). A script that calls sweep needs the line "
        "if __name__ == '__main__': before the call, since each process reads the script; or use executor='here'."
    )


def _work(pipe: connection.Connection, task: bytes) -> None:
    """A worker: says that it is ready, then answers each point with an outcome until the pipe is closed."""
    import pickle

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C goes to all; the parent stops the workers
    threading.Thread(target=_leave_with_parent, daemon=True).start()
    try:
        pickle.loads(task)
    except Exception as error:
        pipe.send(f"{type(error).__name__}: {error}")
        return
    with contextlib.suppress(EOFError, OSError):
        pipe.send(READY)
        while True:
            pipe.send(run_pickled(task, pipe.recv()))


def _leave_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        connection.wait([parent.sentinel])
        os._exit(1)
