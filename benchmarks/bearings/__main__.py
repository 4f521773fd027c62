"""Compares bearing models and judges the paper: ``python -m benchmarks.bearings``.  See README.md beside this file."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path

HERE = Path(__file__).resolve().parent


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, judge, and write the results; returns 0 when it ran, whatever the verdicts."""
    parser = argparse.ArgumentParser(description="Bearing models of Matyja 2015: accuracy, run time, validity, claims.")
    parser.add_argument("--quick", action="store_true", help="smoke test: one line, a short run-up, one repeat; most figures mean nothing")
    parser.add_argument("--repeats", type=int, default=5, help="repeats of each run that takes less than a second (default 5)")
    parser.add_argument("--out", type=Path, help="folder for the results; default: beside the command, none with --quick")
    options = parser.parse_args(arguments)
    if options.repeats < 1:
        parser.error("--repeats must be at least 1")
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy is loaded

    from benchmarks.bearings.report import report
    from benchmarks.bearings.study import study
    from benchmarks.writing import write_results

    found, numbers, claims, aims, drawn = study(quick=options.quick, repeats=1 if options.quick else options.repeats)
    text = report(found, numbers, claims, aims)
    print(text)
    folder = options.out or (None if options.quick else HERE)
    if folder is not None:
        for path in write_results(folder, numbers, text, drawn):
            print(f"wrote {path}", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
