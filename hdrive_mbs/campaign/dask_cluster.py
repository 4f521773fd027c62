"""Jobs on the workers of a dask.distributed scheduler, on this machine or others."""

from __future__ import annotations

import contextlib
import time
import uuid
from collections import Counter, deque
from collections.abc import Iterator, Mapping
from typing import Any

from hdrive_mbs.analysis.result import versions
from hdrive_mbs.campaign.fingerprint import COUNTED
from hdrive_mbs.campaign.outcome import Outcome, lost, run_pickled
from hdrive_mbs.campaign.points import Point
from hdrive_mbs.errors import DependencyError, ParameterError, SimulationError

CONNECT = 10.0
"""Seconds to reach the scheduler."""
PATIENCE = 60.0
"""Seconds without any worker after which a campaign stops."""
FETCH = 30.0
"""Seconds for one result to come over."""
PAUSE = 0.02
"""Seconds between two looks at the jobs, whose state the scheduler sends by itself."""
LOOK = 1.0
"""Seconds between two questions whether the cluster has workers."""


def packed(function: Any) -> bytes:
    """A function as bytes that a worker can read, also one of the caller's own script."""
    _distributed()
    import cloudpickle

    return bytes(cloudpickle.dumps(function))


def is_cluster(executor: Any) -> bool:
    """Whether an executor is the address of a scheduler, or a dask client."""
    if isinstance(executor, str):
        return ":" in executor
    kinds = {f"{kind.__module__}.{kind.__qualname__}" for kind in type(executor).__mro__}  # distributed itself may not be installed
    return "distributed.client.Client" in kinds


def run_on_cluster(cluster: Any, task: bytes, jobs: Mapping[str, Point], *, retries: int) -> Iterator[tuple[str, Outcome]]:
    """Key and outcome of each job, as they are finished; closing the iterator cancels what is still waiting.

    cluster : address of a scheduler, or a dask client of the caller's, which is left open

    The scheduler itself gives a lost worker's jobs to others, up to its setting ``allowed-failures`` (3).  Then it gives
    up all that the worker had, also what only stood beside the job at fault.  So these are handed in again when the
    others are done, one at a time: up to ``retries`` times each, and a loss counts against the job alone.
    Raises SimulationError when the scheduler cannot be reached or has had no worker for PATIENCE seconds, ParameterError for
    a client that is closed or asynchronous.
    """
    campaign = uuid.uuid4().hex  # a client may run a job that failed again, which is not the same to the scheduler
    with _client(cluster) as client:
        address = client.scheduler.address
        attempts: Counter[str] = Counter()

        def submit(key: str) -> Any:
            attempts[key] += 1
            return client.submit(run_pickled, task, dict(jobs[key]), key=f"hdrive-{key}-{campaign}-{attempts[key]}", pure=False)

        futures = {submit(key): key for key in jobs}
        suspects: deque[str] = deque()
        seen = next_look = time.monotonic()
        try:
            while futures or suspects:
                if not futures:
                    key = suspects.popleft()
                    futures[submit(key)] = key
                done = [future for future in futures if future.done()]
                if not done:
                    time.sleep(PAUSE)
                    if time.monotonic() > next_look:
                        seen = _look(client, address, seen)
                        next_look = time.monotonic() + LOOK
                    continue
                for future in done:
                    try:
                        outcome = _outcome(future, attempts[futures[future]])
                    except TimeoutError:  # the worker died with the result; dask runs the job again
                        seen = _look(client, address, seen)
                        continue
                    key = futures.pop(future)
                    if outcome is None and attempts[key] <= retries:
                        suspects.append(key)
                        continue
                    yield key, outcome or lost("dask gave the job up after its workers died; see the scheduler's log", attempts[key])
        finally:
            client.cancel(list(futures), force=True)


@contextlib.contextmanager
def _client(cluster: Any) -> Iterator[Any]:
    """The caller's client, left open, or one of our own for an address."""
    distributed = _distributed()
    if isinstance(cluster, distributed.Client):
        if cluster.status != "running" or cluster.asynchronous:
            state = "asynchronous" if cluster.asynchronous else cluster.status
            raise ParameterError(f"executor = {cluster!r}: this dask client is {state}; give one that is connected and not asynchronous.")
        yield cluster
        return
    try:
        client = distributed.Client(cluster, timeout=CONNECT, set_as_default=False)
    except (OSError, TimeoutError, ValueError) as error:
        raise SimulationError(
            f"No dask scheduler answers at {cluster!r} within {CONNECT:g} s ({error}). Start one with 'dask scheduler' and give "
            "the address it prints, like tcp://192.168.1.10:8786."
        ) from None
    with client:
        yield client


def _outcome(future: Any, attempts: int) -> Outcome | None:
    """None where the workers were lost.  Raises TimeoutError where the result does not come over."""
    from distributed.scheduler import KilledWorker

    if future.status == "finished":
        outcome: Outcome = future.result(timeout=FETCH)
        mine = versions()
        other = [f"{name} {outcome.versions.get(name)}" for name in COUNTED if outcome.versions.get(name) != mine[name]]
        if other and outcome.values is not None:
            return Outcome(
                values=None,
                error=f"The worker {outcome.worker} has {', '.join(other)}, this machine {', '.join(f'{n} {mine[n]}' for n in COUNTED)}. "
                "Install the same versions on all machines.",
                versions=outcome.versions,
                attempts=attempts,
            )
        return outcome.after(attempts)
    if future.status in ("cancelled", "lost"):
        return None
    problem = future.exception(timeout=FETCH)
    if isinstance(problem, KilledWorker):
        return None
    return Outcome(values=None, error=f"{type(problem).__name__}: {problem}", versions=versions(), attempts=attempts)


def _look(client: Any, address: str, seen: float) -> float:
    """When the cluster was last seen with a worker."""
    if client.status not in ("running", "connecting"):
        raise SimulationError(f"The connection to the dask scheduler at {address} is {client.status}.")
    now = time.monotonic()
    if client.status == "running" and client.nthreads():
        return now
    if now - seen > PATIENCE:
        raise SimulationError(
            f"The dask scheduler at {address} has had no worker for {PATIENCE:g} s. Start some with 'dask worker {address}'."
        )
    return seen


def _distributed() -> Any:
    try:
        import distributed
    except ImportError:
        raise DependencyError('A cluster needs dask.distributed: python -m pip install "hdrive-mbs[cluster]".') from None
    return distributed
