"""Sweeps designs, compares with a polygon library, judges the paper: ``python -m benchmarks.teeth``.  See README.md beside this file."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from benchmarks.command import Found, command, run

HERE = Path(__file__).resolve().parent


def measure(options: Namespace) -> Found:
    from benchmarks.teeth.report import report
    from benchmarks.teeth.study import figures, study

    numbers, claims = study(quick=options.quick, repeats=options.repeats)
    return Found(numbers=numbers, text=report(numbers, claims), figures={} if options.quick else figures())


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, judge, and write the results; returns 0 when it ran, whatever the verdicts."""
    parser = command(
        "Teeth of the double harmonic transmission: sweep, interference, claims.",
        quick="few designs, one repeat, no pictures",
        repeats=3,
        repeated="repeats of the sweep",
    )
    return run(parser, arguments, measure, HERE)


if __name__ == "__main__":
    sys.exit(main())
