"""Candidates side by side in processes: what they share is sent once, results come back in order.

Processes are kept between the stages of a diagnosis, so that the machine code that each has made stays.  With a journal,
what was done in an earlier, interrupted run is taken from there.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from multiprocessing import connection
from pathlib import Path
from types import TracebackType
from typing import Any, Self, TypeVar

from hdrive_mbs.diagnosis.journal import Journal
from hdrive_mbs.diagnosis.packing import packed
from hdrive_mbs.diagnosis.worker import Worker
from hdrive_mbs.errors import AnalysisError, ParameterError
from hdrive_mbs.worker_process import READY

Item = TypeVar("Item")
Answer = TypeVar("Answer")

PATIENCE = 5.0
"""Seconds that idle processes get to end by themselves."""


class Team:
    """Workers for one diagnosis; with one worker everything happens in this process.

    with Team(2) as team: answers = team.map(function, shared, items)

    workers : processes;  journal : where finished work is kept, if it is to be
    lost : what became of processes that died; another one takes over their item, once
    """

    def __init__(self, workers: int, journal: Journal | None = None) -> None:
        if workers < 1:
            raise ParameterError(f"workers = {workers}: must be at least 1.")
        self.workers, self.journal = workers, journal
        self._running: list[Worker] = []
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self._number = 0
        self.lost: list[str] = []

    def __enter__(self) -> Self:
        if self.workers > 1:
            self._folder = tempfile.TemporaryDirectory(prefix="hdrive_mbs_")
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.dismiss(PATIENCE if error is None else 0.0)
        if self._folder is not None:
            self._folder.cleanup()

    def dismiss(self, patience: float = PATIENCE) -> None:
        """End the processes, which are idle, and with them what they keep; another map begins new ones."""
        while self._running:
            self._running.pop().end(patience)

    def map(
        self,
        function: Callable[[Any, Item], Answer],
        shared: Any,
        items: Sequence[Item],
        done: Callable[[int, int], None] | None = None,
    ) -> list[Answer]:
        """function(shared, item) of each item, in order; ``done(number, total)`` is called as they come in.

        Raises AnalysisError where a process dies twice at the same item (out of memory, say) or cannot start, and whatever the
        function raises.
        """
        said = done or (lambda number, total: None)
        answers: dict[int, Answer] = {}
        keys: dict[int, str] = {}
        if self.journal is not None:
            whole = self.journal.identity(shared)
            keys = {k: self.journal.key(function, whole, item) for k, item in enumerate(items)}
            for k, key in keys.items():
                found = self.journal.read(key, items[k])
                if found is not None:
                    answers[k] = found[0]

        def finished(k: int, answer: Answer) -> None:
            answers[k] = answer
            if self.journal is not None:
                self.journal.write(keys[k], answer)
            said(len(answers), len(items))

        said(len(answers), len(items))
        left = [k for k in range(len(items)) if k not in answers]
        if self._folder is None or len(left) < 2:
            for k in left:
                finished(k, function(shared, items[k]))
        else:
            self._side_by_side(function, shared, {k: items[k] for k in left}, finished)
        return [answers[k] for k in range(len(items))]

    def _side_by_side(
        self, function: Callable[[Any, Item], Answer], shared: Any, items: dict[int, Item], finished: Callable[[int, Answer], None]
    ) -> None:
        assert self._folder is not None
        self._number += 1
        path = Path(self._folder.name) / f"{self._number}.pickle"
        path.write_bytes(packed(shared))
        while len(self._running) < self.workers:
            self._running.append(Worker.begun())
        waiting, begun_again = list(items), set[int]()
        for worker in self._running:
            if worker.ready and waiting:
                worker.give(waiting[0], path, function, items[waiting.pop(0)])
        while waiting or any(worker.at is not None for worker in self._running):
            for pipe in connection.wait([worker.pipe for worker in self._running]):
                worker = next(one for one in self._running if one.pipe is pipe)
                try:
                    good, answer = worker.pipe.recv()
                except (EOFError, OSError):
                    at, error = worker.at, self._died(worker, items)
                    if not worker.ready or at in begun_again:
                        raise error from None
                    if at is not None:
                        begun_again.add(at)
                        waiting.insert(0, at)
                    self.lost.append(f"{error} Another one took over.")
                    self._running.append(Worker.begun())
                    continue
                if not good:
                    raise answer
                if not worker.ready:
                    assert answer == READY
                    worker.ready = True
                else:
                    assert worker.at is not None
                    number, worker.at = worker.at, None
                    finished(number, answer)
                if waiting:
                    worker.give(waiting[0], path, function, items[waiting.pop(0)])
        path.unlink(missing_ok=True)

    def _died(self, worker: Worker, items: dict[int, Item]) -> AnalysisError:
        self._running.remove(worker)
        how = worker.end(PATIENCE)
        kept = f" What is finished is kept in {self.journal.folder}." if self.journal is not None else ""
        if not worker.ready:
            return AnalysisError(
                f"A worker process of the diagnosis could not start ({how}; its own words are above). A script that calls diagnose"
                " needs the line if __name__ == '__main__': before the call, since each process reads the script; or use workers=1."
            )
        work = _named(items[worker.at]) if worker.at is not None else "nothing"
        return AnalysisError(
            f"A worker process of the diagnosis died ({how}) at work on {work}; if memory was short, use fewer workers.{kept}"
        )


def _named(item: object) -> str:
    """What an item is about, in words."""
    first = item[0] if isinstance(item, tuple) and item else item
    hypothesis = getattr(first, "hypothesis", first)
    return str(getattr(hypothesis, "label", type(first).__name__))
