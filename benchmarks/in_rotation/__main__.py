"""What a record that begins in rotation asks of a diagnosis: ``python -m benchmarks.in_rotation``.  See README.md beside this file."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from benchmarks.command import Found, command, run

HERE = Path(__file__).resolve().parent


def measure(options: Namespace) -> Found:
    from benchmarks.in_rotation.report import report
    from benchmarks.in_rotation.study import study

    numbers = study(quick=options.quick, repeats=options.repeats)
    return Found(numbers=numbers, text=report(numbers))


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and write the results."""
    parser = command(
        "Records that begin in rotation.",
        quick="three laws are tried, not all",
        repeats=5,
        repeated="runs of each way, of which the median counts",
    )
    return run(parser, arguments, measure, HERE)


if __name__ == "__main__":
    sys.exit(main())
