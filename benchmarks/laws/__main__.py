"""What each law costs in a compiled run: ``python -m benchmarks.laws``.  See README.md beside this file."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from benchmarks.command import Found, command, run

HERE = Path(__file__).resolve().parent


def measure(options: Namespace) -> Found:
    from benchmarks.laws.report import report
    from benchmarks.laws.study import study

    numbers = study(quick=options.quick, repeats=options.repeats)
    return Found(numbers=numbers, text=report(numbers))


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and write the results."""
    return run(
        command("Laws in compiled runs.", quick="40 samples of some laws", repeats=12, repeated="runs of each law"),
        arguments,
        measure,
        HERE,
    )


if __name__ == "__main__":
    sys.exit(main())
