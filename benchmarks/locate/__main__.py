"""Locates the gap of open cases and compares with their truths: ``python -m benchmarks.locate --rotor SET``."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from benchmarks.campaign import add_where, where
from benchmarks.command import Found, command, run

HERE = Path(__file__).resolve().parent


def measure(options: Namespace) -> Found:
    from benchmarks.locate.report import report
    from benchmarks.locate.study import study

    sets = {bench: folder for bench in ("drive", "rotor") if (folder := getattr(options, bench)) is not None}
    numbers = study(sets, most=1 if options.quick else None, where=where(options))
    return Found(numbers=numbers, text=report(numbers))


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and write the results; returns 0."""
    parser = command(
        "Where the gap of open cases sits, without any law.",
        quick="one case of each set",
        repeats=1,
        repeated="not used: a case gives the same places each time",
    )
    for bench in ("drive", "rotor"):
        parser.add_argument(
            f"--{bench}", type=Path, nargs="+", help=f"open sets of the {bench} bench (benchmarks.withheld.make --open); no case twice"
        )
    add_where(parser)
    return run(parser, arguments, measure, HERE)


if __name__ == "__main__":
    sys.exit(main())
