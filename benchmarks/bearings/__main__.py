"""Compares bearing models and judges the paper: ``python -m benchmarks.bearings``.  See README.md beside this file."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from benchmarks.campaign import add_where, where
from benchmarks.command import Found, command, run

HERE = Path(__file__).resolve().parent


def measure(options: Namespace) -> Found:
    from benchmarks.bearings.report import report
    from benchmarks.bearings.study import study

    found, numbers, claims, aims, drawn = study(quick=options.quick, repeats=options.repeats, where=where(options))
    return Found(numbers=numbers, text=report(found, numbers, claims, aims), figures=drawn)


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, judge, and write the results; returns 0 when it ran, whatever the verdicts."""
    parser = command(
        "Bearing models of Matyja 2015: accuracy, run time, validity, claims.",
        quick="one line, a short run-up, one repeat; most figures mean nothing",
        repeats=5,
        repeated="repeats of each run that takes less than a second",
    )
    add_where(parser)
    return run(parser, arguments, measure, HERE)


if __name__ == "__main__":
    sys.exit(main())
