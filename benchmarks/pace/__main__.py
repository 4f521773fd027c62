"""What slowed vibrations save a search on rotor lines, and cost: ``python -m benchmarks.pace``.  See README.md beside this file."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from benchmarks.command import Found, command, run

HERE = Path(__file__).resolve().parent


def measure(options: Namespace) -> Found:
    from benchmarks.pace.report import report
    from benchmarks.pace.study import study

    numbers = study(quick=options.quick, repeats=options.repeats)
    return Found(numbers=numbers, text=report(numbers))


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and write the results."""
    return run(command("Slowed vibrations.", quick="one cause", repeats=5, repeated="batches of points"), arguments, measure, HERE)


if __name__ == "__main__":
    sys.exit(main())
