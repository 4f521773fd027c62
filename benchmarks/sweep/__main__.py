"""Times one sweep with no, one and two workers, on processes and dask: ``python -m benchmarks.sweep``.  See README.md beside this file."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path

HERE = Path(__file__).resolve().parent


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and write the results; returns 0 when all ways gave the same numbers."""
    parser = argparse.ArgumentParser(description="Scaling of a sweep on 1 and 2 workers: processes and dask.")
    parser.add_argument("--quick", action="store_true", help="smoke test: few short jobs, one repeat")
    parser.add_argument("--repeats", type=int, default=3, help="repeats of each way (default 3)")
    parser.add_argument("--out", type=Path, help="folder for the results; default: beside the command, none with --quick")
    options = parser.parse_args(arguments)
    if options.repeats < 1:
        parser.error("--repeats must be at least 1")
    os.environ["OPENBLAS_NUM_THREADS"] = "1"  # before numpy is loaded; the workers do so by themselves

    from benchmarks.sweep.report import report
    from benchmarks.sweep.study import study
    from benchmarks.writing import write_results

    numbers = study(quick=options.quick, repeats=1 if options.quick else options.repeats)
    text = report(numbers)
    print(text)
    folder = options.out or (None if options.quick else HERE)
    if folder is not None:
        for path in write_results(folder, numbers, text, {}):
            print(f"wrote {path}", file=sys.stderr)
    return 0 if numbers["equal"] else 1


if __name__ == "__main__":
    sys.exit(main())
