"""Run one function over many points."""

from __future__ import annotations

import os
import pickle
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from hdrive_mbs.campaign.any_executor import run_on_executor
from hdrive_mbs.campaign.campaign import Campaign
from hdrive_mbs.campaign.dask_cluster import is_cluster, packed, run_on_cluster
from hdrive_mbs.campaign.fingerprint import fingerprint, job_key
from hdrive_mbs.campaign.in_this_process import run_here
from hdrive_mbs.campaign.job_files import JobFiles
from hdrive_mbs.campaign.origin import made_of
from hdrive_mbs.campaign.outcome import Outcome
from hdrive_mbs.campaign.points import Point, checked, parameter_columns
from hdrive_mbs.errors import ParameterError, SimulationError
from hdrive_mbs.progress import progress_bar
from hdrive_mbs.scene import Scene


def sweep(
    function: Callable[[dict[str, Any]], Any],
    points: Iterable[Point],
    *,
    executor: Any = "processes",
    workers: int | None = None,
    folder: str | os.PathLike[str] | None = None,
    retries: int = 2,
    units: Mapping[str, str] | None = None,
    progress: bool | None = None,
    arrived: Callable[[Point, Mapping[str, Any]], object] | None = None,
) -> Campaign:
    """Call ``function(point)`` for every point and collect what it returns, in the order of the points.

    function : takes a mapping name -> value, returns a number or a mapping name -> number, text, array.  Other
        processes must be able to import it: a function at the top of a module, or an object such as SceneAnalysis
    points : mappings with the same names, for instance from ``grid``
    executor : "processes" of this machine, "here" (this process), the address of a dask scheduler
        ("tcp://host:8786") or a dask client, or an object with the ``submit`` of concurrent.futures
    workers : number of processes; as many as the machine has cores if not given
    folder : finished jobs are kept there, and found again by the next call with the same function, point and
        package versions; None keeps them in the result alone
    retries : how often a job is begun again whose worker was lost
    units : unit of each parameter, for the head of the table
    progress : show a bar with the time left; None for "when stderr is a terminal"
    arrived : called in this process with the point and values of each job that is finished, as it comes in; of those
        found in the folder too

    A job that raises is listed in ``failures`` with its point and traceback, and the others go on; the next call runs
    it again.  Ctrl-C, or a cluster that is lost, stops and returns what is finished, which the status says.  The result
    does not depend on the number of workers as long as the function depends on its point alone: draw random numbers
    from a seed in the point.

    An object may have methods beside: ``check(point)`` raises for a point that no job can take, ``units()`` gives the unit
    of a name, ``made_of()`` the scene (or None) and the settings that the campaign was made of; its name and fingerprint are
    among the settings of every campaign.
    """
    plain = checked(points)
    if retries < 0 or (workers is not None and workers < 1):
        raise ParameterError(f"workers = {workers}, retries = {retries}: at least one worker, and no negative number of retries.")
    name = _name(function)
    if hasattr(function, "check"):
        function.check(plain[0])
    found = fingerprint(function)
    keys = [job_key(found, point) for point in plain]
    scene, asked = made_of(function, name, found)
    files = JobFiles(folder=None if folder is None else Path(folder))
    outcomes: dict[str, Outcome] = {}
    jobs: dict[str, Point] = {}
    for key, point in zip(keys, plain, strict=True):
        if key not in outcomes and key not in jobs:
            kept = files.read(key)
            if kept is None:
                jobs[key] = point
            else:
                outcomes[key] = kept
                if arrived is not None and kept.values is not None:
                    arrived(point, kept.values)
    reused = set(outcomes)
    stopped, written = "", set(reused)
    if jobs:
        number = workers or _cores()
        arriving = _start(executor, function, jobs, workers=min(number, len(jobs)), retries=retries)
        with progress_bar(f"{name}: {len(keys)} jobs", len(jobs), progress) as report:
            try:
                for done, (key, outcome) in enumerate(arriving, start=1):
                    outcomes[key] = outcome
                    files.write(key, asked, jobs[key], outcome)
                    written.add(key)
                    if arrived is not None and outcome.values is not None:
                        arrived(jobs[key], outcome.values)
                    if report is not None:
                        report(done)
            except KeyboardInterrupt:
                stopped = "stopped"
                for key in outcomes.keys() - written:  # it came while the file of a finished job was being written
                    files.write(key, asked, jobs[key], outcomes[key])
            except SimulationError as error:
                if not outcomes:
                    raise
                stopped = str(error)
            finally:
                arriving.close()  # type: ignore[attr-defined]
    return _campaign(
        plain,
        keys,
        outcomes,
        reused,
        units=dict(units if units is not None else getattr(function, "units", dict)()),
        stopped=stopped,
        scene=scene,
        settings={
            **asked,
            "executor": executor if isinstance(executor, str) else type(executor).__name__,
            "workers": workers,
            "folder": None if folder is None else str(folder),
            "retries": retries,
        },
    )


def _cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _name(function: Any) -> str:
    if isinstance(function, type) or not callable(function):
        raise ParameterError(f"function = {function!r}: must be a function or an object that can be called with a point.")
    return getattr(function, "__qualname__", None) or type(function).__name__


def _start(executor: Any, function: Any, jobs: Mapping[str, Point], *, workers: int, retries: int) -> Iterator[tuple[str, Outcome]]:
    if executor == "here":
        return run_here(function, jobs)
    if executor == "processes" or executor is None:
        from hdrive_mbs.campaign.local_processes import run_on_processes

        return run_on_processes(_pickled(function), jobs, workers=workers, retries=retries)
    if is_cluster(executor):
        return run_on_cluster(executor, packed(function), jobs, retries=retries)
    if hasattr(executor, "submit"):
        return run_on_executor(executor, _pickled(function), jobs)
    raise ParameterError(
        f"executor = {executor!r}: must be 'processes', 'here', the address of a dask scheduler like 'tcp://host:8786', "
        "a dask client, or an object with the submit() of concurrent.futures."
    )


def _pickled(function: Any) -> bytes:
    try:
        return pickle.dumps(function)
    except Exception as error:  # pickle raises several kinds
        raise ParameterError(
            f"{_name(function)} cannot be sent to another process ({error}). Put it at the top level of a module, "
            "and what it needs into the point."
        ) from None


def _campaign(
    points: tuple[dict[str, Any], ...],
    keys: list[str],
    outcomes: Mapping[str, Outcome],
    reused: set[str],
    *,
    units: Mapping[str, str],
    stopped: str,
    scene: Scene | None,
    settings: Mapping[str, Any],
) -> Campaign:
    found = [outcomes.get(key) for key in keys]
    failures = tuple(
        {"index": index, "parameters": point, "error": outcome.error, "traceback": outcome.traceback, "attempts": outcome.attempts}
        for index, (point, outcome) in enumerate(zip(points, found, strict=True))
        if outcome is not None and outcome.values is None
    )
    done = np.array([outcome is not None and outcome.values is not None for outcome in found])
    words = []
    if stopped:
        words.append(f"{stopped} with {int(done.sum())} of {len(keys)} jobs done; the same call with the same folder goes on from there")
    if failures:
        words.append(f"{len(failures)} of {len(keys)} jobs failed, see failures")
    return Campaign(
        scene=scene,
        status="; ".join(words) or "complete",
        settings=settings,
        parameters=parameter_columns(points),
        units={name: units.get(name, "") for name in points[0]},
        values=tuple({} if outcome is None or outcome.values is None else outcome.values for outcome in found),
        done=done,
        failures=failures,
        seconds=np.array([np.nan if outcome is None or outcome.values is None else outcome.seconds for outcome in found]),
        attempts=np.array([0 if outcome is None else outcome.attempts for outcome in found]),
        reused=sum(key in reused for key in keys),
    )
