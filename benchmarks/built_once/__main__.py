"""What it saves to build a hypothesis once: ``python -m benchmarks.built_once``.  See README.md beside this file."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from benchmarks.command import Found, command, run

HERE = Path(__file__).resolve().parent


def measure(options: Namespace) -> Found:
    from benchmarks.built_once.report import report
    from benchmarks.built_once.study import study

    numbers = study(quick=options.quick, repeats=options.repeats)
    return Found(numbers=numbers, text=report(numbers))


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and write the results."""
    parser = command("Lines built once or each time.", quick="every eighth law", repeats=5, repeated="batches of parameter sets")
    return run(parser, arguments, measure, HERE)


if __name__ == "__main__":
    sys.exit(main())
