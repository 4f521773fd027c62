"""One job: the function at one point, and what came of it."""

from __future__ import annotations

import os
import pickle
import platform
import time
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hdrive_mbs.analysis.result import versions
from hdrive_mbs.errors import ParameterError


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """What a job gave, or why it did not.

    values : what the function returned, None where it failed
    error, traceback : the exception in one line, and the text that Python prints
    seconds : of wall time in the worker
    worker : machine and process
    versions : of the packages in the worker
    attempts : 1 more than the number of workers that were lost with it
    """

    values: Mapping[str, Any] | None
    error: str = ""
    traceback: str = ""
    seconds: float = 0.0
    worker: str = ""
    versions: Mapping[str, str]
    attempts: int = 1

    def after(self, attempts: int) -> Outcome:
        """The same with the number of attempts."""
        return replace(self, attempts=attempts)


def lost(reason: str, attempts: int) -> Outcome:
    """The outcome of a job whose workers were lost each time."""
    times = "once" if attempts == 1 else f"{attempts} times"
    return Outcome(
        values=None, error=f"The worker was lost {times} ({reason}); the job was given up.", versions=versions(), attempts=attempts
    )


def run_pickled(task: bytes, point: Mapping[str, Any]) -> Outcome:
    """``run_job`` in another process, which gets the function as bytes."""
    return run_job(lambda found: pickle.loads(task)(found), point)


def run_job(function: Callable[[dict[str, Any]], Any], point: Mapping[str, Any]) -> Outcome:
    """Call the function with the point; an exception becomes part of the outcome."""
    started = time.perf_counter()
    values, error, text = None, "", ""
    try:
        values = figures(function(dict(point)))
    except (Exception, SystemExit) as problem:
        error = f"{type(problem).__name__}: {problem}"
        text = traceback.format_exc()
    return Outcome(
        values=values,
        error=error,
        traceback=text,
        seconds=time.perf_counter() - started,
        worker=f"{platform.node()}:{os.getpid()}",
        versions=versions(),
    )


def figures(returned: Any) -> dict[str, Any]:
    """What a function may return: a number (which is called "value"), or name -> number, text, switch, array, or these nested.

    Raises ParameterError for anything else.
    """
    if not isinstance(returned, Mapping):
        if isinstance(returned, (bool, int, float, np.number, np.bool_, np.ndarray)):
            returned = {"value": returned}
        else:
            raise ParameterError(
                f"The function returned {type(returned).__name__}: a job gives a number or a mapping like {{'peak [m]': 1e-4}}. "
                "Take the figures that you need from a result."
            )
    return {str(name): _plain(f"{name!r}", value) for name, value in returned.items()}


def _plain(where: str, value: Any) -> Any:
    if isinstance(value, np.ndarray):
        if value.dtype == object:
            raise ParameterError(f"The function returned in {where} an array of Python objects; give an array of numbers.")
        return value
    if isinstance(value, np.generic):
        return value.item()
    if value is None or isinstance(value, (str, bool, int, float)):
        return value
    if isinstance(value, Mapping):
        return {str(name): _plain(f"{where}[{name!r}]", item) for name, item in value.items()}
    if isinstance(value, (tuple, list)):
        return tuple(_plain(f"{where}[{number}]", item) for number, item in enumerate(value))
    raise ParameterError(
        f"The function returned in {where} a {type(value).__name__}; a job gives numbers, texts, arrays, and mappings of these."
    )
