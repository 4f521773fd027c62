"""How many lanes pay for compiled runs: ``python -m benchmarks.lanes``.  See README.md beside this file."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from benchmarks.command import Found, command, run

HERE = Path(__file__).resolve().parent


def measure(options: Namespace) -> Found:
    from benchmarks.lanes.report import report
    from benchmarks.lanes.study import study

    numbers = study(quick=options.quick, repeats=options.repeats)
    return Found(numbers=numbers, text=report(numbers))


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and write the results."""
    return run(command("Lanes of compiled runs.", quick="40 samples", repeats=7, repeated="runs of each width"), arguments, measure, HERE)


if __name__ == "__main__":
    sys.exit(main())
