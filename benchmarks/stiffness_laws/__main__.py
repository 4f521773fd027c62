"""Judges the paper's claims about its stiffness laws: ``python -m benchmarks.stiffness_laws``.

Reproduces Table 1 and the content of Figs 4-11.  See README.md beside this file.
"""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from benchmarks.command import Found, command, run

HERE = Path(__file__).resolve().parent


def measure(options: Namespace) -> Found:
    from benchmarks.stiffness_laws.report import report
    from benchmarks.stiffness_laws.study import study

    numbers, claims, drawn = study(quick=options.quick, repeats=options.repeats)
    return Found(numbers=numbers, text=report(numbers, claims), figures=drawn)


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, judge, and write the results; returns 0 when it ran, whatever the verdicts."""
    parser = command(
        "The stiffness laws of Folega et al. 2014: table, figures, claims.",
        quick="short runs, one repeat; most figures mean nothing",
        repeats=3,
        repeated="repeats of each run that takes less than a second",
    )
    return run(parser, arguments, measure, HERE)


if __name__ == "__main__":
    sys.exit(main())
