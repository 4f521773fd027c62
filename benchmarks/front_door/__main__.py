"""Times import and demo: ``python -m benchmarks.front_door``.  See README.md beside this file."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from benchmarks.command import Found, command, run

HERE = Path(__file__).resolve().parent


def measure(options: Namespace) -> Found:
    from benchmarks.front_door.report import report
    from benchmarks.front_door.study import study

    numbers = study(repeats=options.repeats, with_demo=not options.quick)
    return Found(numbers=numbers, text=report(numbers))


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and write the results."""
    parser = command("Import time, demo time, page size.", quick="imports only", repeats=7, repeated="processes for each import")
    return run(parser, arguments, measure, HERE)


if __name__ == "__main__":
    sys.exit(main())
