"""Plants effects in the robot joint line and diagnoses them: ``python -m benchmarks.flagship``.  See README.md beside this file."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from benchmarks.campaign import add_where, where
from benchmarks.command import Found, command, run

HERE = Path(__file__).resolve().parent


def measure(options: Namespace) -> Found:
    from benchmarks.flagship.report import report
    from benchmarks.flagship.study import study

    numbers = study(quick=options.quick, names=options.cases, laws=options.laws, where=where(options))
    return Found(numbers=numbers, text=report(numbers))


def main(arguments: Sequence[str] | None = None) -> int:
    """Diagnose and write the results."""
    parser = command(
        "Planted effects in the robot joint line, diagnosed.", quick="the first case only", repeats=1, repeated="not used here"
    )
    parser.add_argument("--cases", nargs="*", default=(), metavar="NAME", help="these cases only")
    parser.add_argument("--laws", choices=("one", "all"), default="one", help="one law of each family, as in the demo, or all")
    add_where(parser)
    return run(parser, arguments, measure, HERE)


if __name__ == "__main__":
    sys.exit(main())
