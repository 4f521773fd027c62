"""Progress of work in stages, each with its time left; silent without a terminal."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

StageReport = Callable[[str, int, int], None]


@contextmanager
def stage_bars(show: bool | None = None) -> Iterator[StageReport | None]:
    """Yields ``report(stage, done, total)``, or None when nothing shall be shown.

    show : True, False, or None for "when stderr is a terminal"
    """
    if show is None:
        show = sys.stderr.isatty()
    if not show:
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
