"""Jobs on processes of this machine, each watched over its own pipe.

The pools of the standard library give up all their jobs when one process is killed, and do not say which job it had.
Here a process has one job at a time, so a lost one costs that job's time alone and is counted against that job alone.
"""

from __future__ import annotations

import contextlib
import pickle
from collections import Counter, deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from multiprocessing import connection
from typing import Any

from hdrive_mbs.campaign.outcome import Outcome, lost, run_pickled
from hdrive_mbs.campaign.points import Point
from hdrive_mbs.errors import SimulationError
from hdrive_mbs.worker_process import READY, WorkerProcess, work_for_parent


@dataclass(eq=False, kw_only=True)
class _Worker(WorkerProcess):
    """A process and what it is at: a job's key, READY, or None while it starts."""

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
                    worker.at = waiting.popleft()
                    worker.send(jobs[worker.at])
            while len(crew) < workers and sum(worker.at is None for worker in crew) < len(waiting):
                crew.append(_Worker.start(_work, task, name="campaign worker"))
            by_pipe: dict[Any, _Worker] = {worker.pipe: worker for worker in crew}
            for pipe in connection.wait(list(by_pipe)):
                worker = by_pipe[pipe]
                try:
                    message = worker.pipe.recv()
                except (EOFError, OSError):
                    crew.remove(worker)
                    reason = worker.end(5.0)
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
            worker.end()


def _no_start(reason: str) -> SimulationError:
    return SimulationError(
        f"A worker process could not start ({reason}; its own words are above). A script that calls sweep needs the line "
        "if __name__ == '__main__': before the call, since each process reads the script; or use executor='here'."
    )


def _work(pipe: connection.Connection, task: bytes) -> None:
    """A worker: says that it is ready, then answers each point with an outcome until the pipe is closed."""
    work_for_parent()
    try:
        pickle.loads(task)
    except Exception as error:
        pipe.send(f"{type(error).__name__}: {error}")
        return
    with contextlib.suppress(EOFError, OSError):
        pipe.send(READY)
        while True:
            pipe.send(run_pickled(task, pipe.recv()))
