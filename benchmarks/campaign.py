"""Benchmarks whose cases can be worked on side by side: here, on processes of this machine, or on a dask cluster."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:  # it loads numpy, and the threads of BLAS are set before
    from hdrive_mbs.campaign.campaign import Campaign


@dataclass(frozen=True, kw_only=True)
class Where:
    """Where jobs run, and where finished ones are kept.

    workers : processes, as many as the machine has cores if None; 0 for this process
    scheduler : address of a dask scheduler, whose workers are used instead
    kept : folder of finished jobs, from which an interrupted benchmark goes on; None keeps nothing
    """

    workers: int | None = 0
    scheduler: str | None = None
    kept: Path | None = None

    def sweep(self, function: Callable[[dict[str, Any]], Any], points: Sequence[Mapping[str, Any]], **more: Any) -> Campaign:
        """Every point, in order; a job that fails is said on stderr and stays empty.

        Raises SystemExit, with the way to go on, where it was stopped or the cluster was lost.
        """
        from hdrive_mbs.campaign.sweeping import sweep

        executor = self.scheduler or ("here" if self.workers == 0 else "processes")
        found = sweep(function, points, executor=executor, workers=self.workers or None, folder=self.kept, **more)
        for failure in found.failures:
            print(f"failed: {failure['parameters']}: {failure['error']}", file=sys.stderr)
        if not found.done.all() and len(found.failures) < len(found) - int(found.done.sum()):
            raise SystemExit(f"{found.status}{'' if self.kept else ' (give --kept FOLDER to keep what is finished)'}")
        return found


def add_where(parser: argparse.ArgumentParser) -> None:
    """The options --workers, --scheduler and --kept."""
    parser.add_argument("--workers", type=int, help="cases side by side, a process each (default: one a core); 0: in this process")
    parser.add_argument(
        "--scheduler",
        metavar="ADDRESS",
        help="use the dask cluster of this scheduler, like tcp://host:8786; its workers see the same folders and have this on PYTHONPATH",
    )
    parser.add_argument("--kept", type=Path, metavar="FOLDER", help="keep finished cases there; a case that is there is not run again")


def where(options: argparse.Namespace) -> Where:
    """What was asked for.  Raises SystemExit for a negative number of workers."""
    if options.workers is not None and options.workers < 0:
        raise SystemExit(f"--workers {options.workers}: must be at least 0")
    return Where(workers=options.workers, scheduler=options.scheduler, kept=options.kept)
