"""Candidates side by side in processes: what they share is sent once, results come back in order.

Processes are kept between the stages of a diagnosis, so that the machine code that each has made stays.  With a journal,
what was done in an earlier, interrupted run is taken from there.

Work that is needed later may begin at once, beside the stages until then (``Team.begin``).  Where fewer are at work than there are
processes, at the end of a stage or in one with a single item, these run their lines in as many threads as there are cores to spare.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping, Sequence
from multiprocessing import connection
from pathlib import Path
from types import TracebackType
from typing import Any, Self, TypeVar

from hdrive_mbs.compiled.threads import allowed
from hdrive_mbs.diagnosis.deadline import Deadline
from hdrive_mbs.diagnosis.journal import Journal
from hdrive_mbs.diagnosis.later import Later
from hdrive_mbs.diagnosis.packing import packed
from hdrive_mbs.diagnosis.refusals import taken
from hdrive_mbs.diagnosis.worker import Worker, threads_of_each
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
    deadline : until when those who give it work look for more; never if not given
    lost : what became of processes that died; another one takes over their item, once
    refused : causes whose law raised at work, with what it said (refusals.py)
    """

    def __init__(self, workers: int, journal: Journal | None = None, deadline: Deadline | None = None) -> None:
        if workers < 1:
            raise ParameterError(f"workers = {workers}: must be at least 1.")
        self.workers, self.journal, self.deadline = workers, journal, deadline or Deadline()
        self._running: list[Worker] = []
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self._number = 0
        self._threads = threads_of_each()
        self.lost: list[str] = []
        self.refused: dict[str, str] = {}

    def __enter__(self) -> Self:
        taken()  # of whoever was here before
        if self.workers > 1:
            self._folder = tempfile.TemporaryDirectory(prefix="hdrive_mbs_")
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.dismiss(PATIENCE if error is None else 0.0)
        if self._folder is not None:
            self._folder.cleanup()

    def stand_by(self, *needed: str) -> None:
        """Begin the processes, if there are to be several, before there is work;  needed : modules that they read meanwhile."""
        if self._folder is not None:
            self._fill(needed)

    def dismiss(self, patience: float = PATIENCE) -> None:
        """End the processes, which have no items, and with them what they keep; another map begins new ones."""
        while self._running:
            worker = self._running.pop()
            if worker.apart is not None:
                worker.apart.state = "waiting"
            worker.end(0.0 if worker.is_busy else patience)

    @property
    def is_at_hand(self) -> bool:
        """Whether processes are there already, which another map need not begin."""
        return bool(self._running)

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

        def finished(k: int, answer: Answer, refused: Mapping[str, str]) -> None:
            answers[k] = answer
            self.refused |= refused
            if self.journal is not None and not refused:  # else it is worked out again, so that a diagnosis that goes on warns too
                self.journal.write(keys[k], answer)
            said(len(answers), len(items))

        said(len(answers), len(items))
        left = [k for k in range(len(items)) if k not in answers]
        if self._folder is None or len(left) < 2:
            for k in left:
                with allowed(lambda: self._share(1 + self._apart)):
                    answer = function(shared, items[k])
                finished(k, answer, taken())
        else:
            self._side_by_side(function, shared, {k: items[k] for k in left}, finished)
        return [answers[k] for k in range(len(items))]

    def begin(self, function: Callable[[Any, Item], Answer], shared: Any, item: Item) -> Later:
        """Begin function(shared, item) in a process of its own, for ``answer``; other work goes on meanwhile.

        With a single process, or if all but one are at such work, nobody begins until it is asked for.
        """
        later = Later(function, shared, item)
        if self._folder is not None and self._apart < self.workers - 1 and not self._is_done(later):
            self._fill()
            worker = next(one for one in self._running if not one.is_busy)
            later.file = self._shared(shared)
            worker.give_apart(later)
            later.state = "begun"
            self._share_with_this()
        return later

    def answer(self, later: Later) -> Any:
        """The answer to what was begun; waits for it.  Raises what the function raises, and what ``map`` does."""
        while later.state == "begun":
            worker = next(one for one in self._running if one.apart is later)
            self._threads.value = self._share(self._apart)  # this process only waits
            try:
                self._read(worker)
            except (EOFError, OSError):
                raise self._died(worker, later.item) from None
            finally:
                self._share_with_this()
        if later.state == "waiting":
            [found] = self.map(later.function, later.shared, [later.item])
            later.came(True, found)
        if later.state == "failed":
            raise later.answer
        return later.answer

    @property
    def _apart(self) -> int:
        """Processes at work that is asked for later."""
        return sum(worker.apart is not None for worker in self._running)

    def _share(self, busy: int) -> int:
        """Threads for each of so many that are at work."""
        return max(1, self.workers // max(busy, 1))

    def _share_with_this(self) -> None:
        """Threads of processes at work for later while this one is at work too."""
        self._threads.value = self._share(1 + self._apart)

    def _is_done(self, later: Later) -> bool:
        """Whether the journal has its answer."""
        found = None if self.journal is None else self.journal.read(self._key(later), later.item)
        if found is not None:
            later.came(True, found[0])
        return found is not None

    def _key(self, later: Later) -> str:
        assert self.journal is not None
        return self.journal.key(later.function, self.journal.identity(later.shared), later.item)

    def _fill(self, needed: Sequence[str] = ()) -> None:
        while len(self._running) < self.workers:
            self._running.append(Worker.begun(self._threads, needed))

    def _shared(self, shared: Any) -> Path:
        """A file with what items share."""
        assert self._folder is not None
        self._number += 1
        path = Path(self._folder.name) / f"{self._number}.pickle"
        path.write_bytes(packed(shared))
        return path

    def _read(self, worker: Worker) -> tuple[bool, Any, Mapping[str, str]] | None:
        """The next message of a process, if it is an answer to an item: whether it is good, the answer, and what laws raised meanwhile.

        A process that dies at work for later is gone, and that work waits until it is asked for.

        Raises EOFError or OSError where a process died at an item.
        """
        try:
            good, answer, refused = worker.pipe.recv()
        except (EOFError, OSError):
            if worker.apart is None or not worker.ready:
                raise
            self.lost.append(f"{self._died(worker, worker.apart.item)} This process takes over when it is needed.")
            return None
        if not worker.ready:
            assert answer == READY
            worker.ready = True
            return None
        if worker.apart is None:
            return good, answer, refused
        later, worker.apart = worker.apart, None
        later.came(good, answer)
        self.refused |= refused
        if later.file is not None:
            later.file.unlink(missing_ok=True)
        if good and self.journal is not None and not refused:
            self.journal.write(self._key(later), answer)
        return None

    def _side_by_side(
        self,
        function: Callable[[Any, Item], Answer],
        shared: Any,
        items: dict[int, Item],
        finished: Callable[[int, Answer, Mapping[str, str]], None],
    ) -> None:
        path = self._shared(shared)
        self._fill()
        waiting, begun_again = list(items), set[int]()

        def give(worker: Worker) -> None:
            if waiting and worker.ready and not worker.is_busy:
                worker.give(waiting[0], path, function, items[waiting.pop(0)])
            self._threads.value = self._share(sum(one.is_busy for one in self._running))

        try:
            for worker in self._running:
                give(worker)
            while waiting or any(worker.at is not None for worker in self._running):
                for pipe in connection.wait([worker.pipe for worker in self._running]):
                    worker = next(one for one in self._running if one.pipe is pipe)
                    try:
                        found = self._read(worker)
                    except (EOFError, OSError):
                        at = worker.at
                        error = self._died(worker, None if at is None else items[at])
                        if not worker.ready or at in begun_again:
                            raise error from None
                        if at is not None:
                            begun_again.add(at)
                            waiting.insert(0, at)
                        self.lost.append(f"{error} Another one took over.")
                        self._running.append(Worker.begun(self._threads))
                        continue
                    if found is not None:
                        good, answer, refused = found
                        if not good:
                            raise answer
                        assert worker.at is not None
                        number, worker.at = worker.at, None
                        finished(number, answer, refused)
                    if worker in self._running:
                        give(worker)
                    else:
                        self._fill()
        except BaseException:
            for worker in [one for one in self._running if one.at is not None]:  # nobody asks for their answers any more
                self._running.remove(worker)
                worker.end()
            raise
        finally:
            path.unlink(missing_ok=True)
            self._share_with_this()

    def _died(self, worker: Worker, item: object) -> AnalysisError:
        self._running.remove(worker)
        if worker.apart is not None:
            worker.apart.state = "waiting"
        how = worker.end(PATIENCE)
        kept = f" What is finished is kept in {self.journal.folder}." if self.journal is not None else ""
        if not worker.ready:
            return AnalysisError(
                f"A worker process of the diagnosis could not start ({how}; its own words are above). A script that calls diagnose"
                " needs the line if __name__ == '__main__': before the call, since each process reads the script; or use workers=1."
            )
        work = _named(item) if item is not None else "nothing"
        return AnalysisError(
            f"A worker process of the diagnosis died ({how}) at work on {work}; if memory was short, use fewer workers.{kept}"
        )


def _named(item: object) -> str:
    """What an item is about, in words."""
    first = item[0] if isinstance(item, tuple) and item else item
    hypothesis = getattr(first, "hypothesis", first)
    return str(getattr(hypothesis, "label", type(first).__name__))
