"""Campbell diagrams and prescribed run-ups beside ROSS: ``python -m benchmarks.rotor_speed``.  See README.md beside this file."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from benchmarks.command import Found, command, run

HERE = Path(__file__).resolve().parent


def measure(options: Namespace) -> Found:
    from benchmarks.rotor_speed.report import report
    from benchmarks.rotor_speed.ross import ross_python
    from benchmarks.rotor_speed.study import study

    numbers = study(python=ross_python(options.ross_python), quick=options.quick, repeats=options.repeats)
    return Found(numbers=numbers, text=report(numbers))


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and write the results."""
    parser = command(
        "Speed of Campbell diagrams and prescribed run-ups, beside ROSS.",
        quick="6 elements, 11 speeds, 2500 steps",
        repeats=3,
        repeated="timed calls after the first",
    )
    parser.add_argument(
        "--ross-python", type=Path, help="Python of ROSS's environment; default: the variable ROSS_PYTHON, else without ROSS"
    )
    return run(parser, arguments, measure, HERE)


if __name__ == "__main__":
    sys.exit(main())
