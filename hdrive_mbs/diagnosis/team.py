"""Candidates side by side in processes: what they share is sent once, results come back in order.

Processes are kept between the stages of a diagnosis, so that the machine code that each has made stays.
"""

from __future__ import annotations

import multiprocessing
import os
import pickle
import tempfile
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from types import TracebackType
from typing import Any, Self, TypeVar

from hdrive_mbs.errors import AnalysisError, ParameterError

Item = TypeVar("Item")
Answer = TypeVar("Answer")

_SHARED: dict[str, Any] = {}


def _do(path: str, function: Callable[[Any, Any], Any], item: Any) -> Any:
    if path not in _SHARED:
        _SHARED.clear()
        _SHARED[path] = pickle.loads(Path(path).read_bytes())
    return function(_SHARED[path], item)


def _one_thread() -> None:
    for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ[name] = "1"


class Team:
    """Workers for one diagnosis; with one worker everything happens in this process.

    with Team(2) as team: answers = team.map(function, shared, items)
    """

    def __init__(self, workers: int) -> None:
        if workers < 1:
            raise ParameterError(f"workers = {workers}: must be at least 1.")
        self.workers = workers
        self._pool: ProcessPoolExecutor | None = None
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self._number = 0

    def __enter__(self) -> Self:
        if self.workers > 1:
            _one_thread()  # the children's numpy reads it when it is imported
            self._folder = tempfile.TemporaryDirectory(prefix="hdrive_mbs_")
            self._pool = ProcessPoolExecutor(self.workers, mp_context=multiprocessing.get_context("spawn"))
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if self._pool is not None:
            self._pool.shutdown(wait=error is None, cancel_futures=True)
        if self._folder is not None:
            self._folder.cleanup()

    def map(
        self,
        function: Callable[[Any, Item], Answer],
        shared: Any,
        items: Sequence[Item],
        done: Callable[[int, int], None] | None = None,
    ) -> list[Answer]:
        """function(shared, item) of each item, in order; ``done(number, total)`` is called as they come in.

        Raises AnalysisError where a process dies (out of memory, say).
        """
        said = done or (lambda number, total: None)
        if self._pool is None or len(items) < 2:
            answers = []
            for k, item in enumerate(items):
                said(k, len(items))
                answers.append(function(shared, item))
            return answers
        return list(self._side_by_side(function, shared, items, said))

    def _side_by_side(
        self, function: Callable[[Any, Item], Answer], shared: Any, items: Sequence[Item], said: Callable[[int, int], None]
    ) -> Iterator[Answer]:
        assert self._pool is not None
        assert self._folder is not None
        self._number += 1
        path = Path(self._folder.name) / f"{self._number}.pickle"
        path.write_bytes(pickle.dumps(shared))
        futures = [self._pool.submit(_do, str(path), function, item) for item in items]
        waiting = set(futures)
        try:
            while waiting:
                _finished, waiting = wait(waiting, return_when=FIRST_COMPLETED)
                said(len(futures) - len(waiting), len(futures))
            for future in futures:
                yield future.result()
        except BrokenProcessPool as error:
            raise AnalysisError("A process of the diagnosis died (out of memory?); try fewer workers.") from error
        finally:
            for future in waiting:
                future.cancel()
            path.unlink(missing_ok=True)
