"""Times one sweep with no, one and two workers, on processes and dask: ``python -m benchmarks.sweep``.  See README.md beside this file."""

from __future__ import annotations

import os
import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from benchmarks.command import Found, command, run

HERE = Path(__file__).resolve().parent


def measure(options: Namespace) -> Found:
    os.environ["OPENBLAS_NUM_THREADS"] = "1"  # whatever was set: the workers do so by themselves

    from benchmarks.sweep.report import report
    from benchmarks.sweep.study import study

    numbers = study(quick=options.quick, repeats=options.repeats)
    return Found(numbers=numbers, text=report(numbers), status=0 if numbers["equal"] else 1)


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and write the results; returns 0 when all ways gave the same numbers."""
    parser = command(
        "Scaling of a sweep on 1 and 2 workers: processes and dask.",
        quick="few short jobs, one repeat",
        repeats=3,
        repeated="repeats of each way",
    )
    return run(parser, arguments, measure, HERE)


if __name__ == "__main__":
    sys.exit(main())
