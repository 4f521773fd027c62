"""Sweeps designs, compares with a polygon library, judges the paper: ``python -m benchmarks.teeth``.  See README.md beside this file."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path

HERE = Path(__file__).resolve().parent


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, judge, and write the results; returns 0 when it ran, whatever the verdicts."""
    parser = argparse.ArgumentParser(description="Teeth of the double harmonic transmission: sweep, interference, claims.")
    parser.add_argument("--quick", action="store_true", help="smoke test: few designs, one repeat, no pictures")
    parser.add_argument("--repeats", type=int, default=3, help="repeats of the sweep (default 3)")
    parser.add_argument("--out", type=Path, help="folder for the results; default: beside the command, none with --quick")
    options = parser.parse_args(arguments)
    if options.repeats < 1:
        parser.error("--repeats must be at least 1")
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy is loaded

    from benchmarks.teeth.report import report
    from benchmarks.teeth.study import figures, study
    from benchmarks.writing import write_results

    numbers, claims = study(quick=options.quick, repeats=1 if options.quick else options.repeats)
    text = report(numbers, claims)
    print(text)
    folder = options.out or (None if options.quick else HERE)
    if folder is not None:
        for path in write_results(folder, numbers, text, {} if options.quick else figures()):
            print(f"wrote {path}", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
