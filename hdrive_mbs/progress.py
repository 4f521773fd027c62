"""A progress bar with time left for long work; silent for short work and without a terminal."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

Report = Callable[[float], None]


@contextmanager
def progress_bar(title: str, total: float, show: bool | None = None, after: float = 1.0) -> Iterator[Report | None]:
    """Yields ``report(done)``, or None when nothing shall be shown.

    show : True, False, or None for "when stderr is a terminal"
    after : show the bar only once the work has taken this long [s]
    """
    if show is None:
        show = sys.stderr.isatty()
    if not show:
        yield None
        return
    started = time.monotonic()
    bar: Any = None
    task: Any = None

    def report(done: float) -> None:
        nonlocal bar, task
        if bar is None and time.monotonic() - started >= after:
            from rich.console import Console
            from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

            columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.percentage:>3.0f} %"))
            bar = Progress(*columns, TimeElapsedColumn(), TimeRemainingColumn(), console=Console(stderr=True), transient=True)
            bar.start()
            task = bar.add_task(title, total=total)
        if bar is not None:
            bar.update(task, completed=min(done, total))

    try:
        yield report
    finally:
        if bar is not None:
            bar.stop()
