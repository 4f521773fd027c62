"""How long differences of a Jacobian should be: ``python -m benchmarks.differences``.  See README.md beside this file."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from benchmarks.command import Found, command, run

HERE = Path(__file__).resolve().parent


def measure(options: Namespace) -> Found:
    from benchmarks.differences.report import report
    from benchmarks.differences.study import study

    numbers = study(quick=options.quick, repeats=options.repeats)
    return Found(numbers=numbers, text=report(numbers))


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and write the results."""
    parser = command(
        "Joint fits with differences of many lengths.",
        quick="two lengths, another case",
        repeats=1,
        repeated="times of each fit",
    )
    return run(parser, arguments, measure, HERE)


if __name__ == "__main__":
    sys.exit(main())
