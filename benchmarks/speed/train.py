"""Error against run time for the harmonic-drive train: ``python -m benchmarks.speed.train``.

The engine with symbolic and with Python functions, scipy's LSODA and Radau with plain and with
compiled right-hand sides, and a compiled loop as the limit.  See README.md beside this file.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path

HERE = Path(__file__).resolve().parent


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, judge the targets, and write the results; returns 0 when it ran, whatever the verdicts."""
    parser = argparse.ArgumentParser(description="Error against run time for the harmonic-drive train.")
    parser.add_argument("--quick", action="store_true", help="smoke test: 10 ms simulated, two settings each; times mean nothing")
    parser.add_argument("--repeats", type=int, default=5, help="interleaved repeats of each run (default 5)")
    parser.add_argument("--out", type=Path, help="folder for the results; default: beside the command, none with --quick")
    options = parser.parse_args(arguments)
    if options.repeats < 1:
        parser.error("--repeats must be at least 1")
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy is loaded

    from benchmarks.speed.report import figure, report
    from benchmarks.speed.study import study
    from benchmarks.writing import write_results

    results = study(quick=options.quick, repeats=1 if options.quick else options.repeats)
    text = report(results)
    print(text)
    folder = options.out or (None if options.quick else HERE)
    if folder is not None:
        for path in write_results(folder, results, text, {"error_against_time": figure(results)}):
            print(f"wrote {path}", file=sys.stderr)
    return 0


if __name__ == "__main__":
    if not __package__:  # run as a file: the repository's folder is not on the path then
        sys.path.insert(0, str(HERE.parents[1]))
    sys.exit(main())
