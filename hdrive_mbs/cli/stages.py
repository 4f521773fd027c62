"""Progress of work in stages: bars with the time left on a terminal, else a plain line now and then."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

StageReport = Callable[[str, int, int], None]
SELDOM = 30.0
"""Seconds from one plain line to the next."""


@contextmanager
def stage_bars(show: bool | None = None) -> Iterator[StageReport | None]:
    """Yields ``report(stage, done, total)``, or None when nothing shall be shown.

    show : True for bars, False for nothing, None for bars on a terminal and plain lines on stderr without one
    """
    if show is None and not sys.stderr.isatty():
        yield plain_lines()
        return
    if show is False:
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TaskID, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    left = TextColumn("left")
    columns = (
        TextColumn("{task.description}"),
        BarColumn(bar_width=24),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
        left,
    )
    tasks: dict[str, TaskID] = {}
    with Progress(*columns, console=Console(stderr=True), transient=True) as bars:

        def report(stage: str, done: int, total: int) -> None:
            if stage not in tasks:
                for task in tasks.values():
                    bars.update(task, visible=False)
                tasks[stage] = bars.add_task(stage, total=max(total, 1))
            bars.update(tasks[stage], total=max(total, 1), completed=min(done, total), visible=True)

        yield report


def plain_lines(every: float = SELDOM, clock: Callable[[], float] = time.monotonic) -> StageReport:
    """A report that writes a line to stderr whenever the last one is ``every`` seconds ago, and none for work that is done before.

    The time left is that of the stage, if the rest of it goes on as fast as it has since it began.
    """
    started = last = clock()
    current, begun, before = "", started, 0

    def report(stage: str, done: int, total: int) -> None:
        nonlocal last, current, begun, before
        now = clock()
        if stage != current:
            current, begun, before = stage, now, done
        if now - last >= every:
            last = now
            part = f", {min(done, total)} of {total}" if total > 1 else ""
            if total > done > before:
                part += f", about {(total - done) * (now - begun) / (done - before):.0f} s left of this"
            print(f"{now - started:.0f} s: {stage}{part}", file=sys.stderr, flush=True)

    return report
