"""Error against run time for the harmonic-drive train: ``python -m benchmarks.speed.train``.

The engine with symbolic and with Python functions, scipy's LSODA and Radau with plain and with
compiled right-hand sides, and a compiled loop as the limit.  See README.md beside this file.
"""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from benchmarks.command import Found, command, run

HERE = Path(__file__).resolve().parent


def measure(options: Namespace) -> Found:
    from benchmarks.speed.report import figure, report
    from benchmarks.speed.study import study

    numbers = study(quick=options.quick, repeats=options.repeats)
    return Found(numbers=numbers, text=report(numbers), figures={"error_against_time": figure(numbers)})


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, judge the targets, and write the results; returns 0 when it ran, whatever the verdicts."""
    parser = command(
        "Error against run time for the harmonic-drive train.",
        quick="10 ms simulated, two settings each; times mean nothing",
        repeats=5,
        repeated="interleaved repeats of each run",
    )
    return run(parser, arguments, measure, HERE)


if __name__ == "__main__":
    sys.exit(main())
