"""How fast and how far joint fits go: ``python -m benchmarks.fits``.  See README.md beside this file."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from benchmarks.command import Found, command, run

HERE = Path(__file__).resolve().parent


def measure(options: Namespace) -> Found:
    from benchmarks.fits.report import report
    from benchmarks.fits.study import study

    numbers = study(quick=options.quick, repeats=options.repeats)
    return Found(numbers=numbers, text=report(numbers))


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and write the results."""
    parser = command(
        "Joint fits of nominal parameters and a cause.", quick="one case of the drive bench", repeats=1, repeated="cases of each cause"
    )
    return run(parser, arguments, measure, HERE)


if __name__ == "__main__":
    sys.exit(main())
