"""Campbell diagrams and prescribed run-ups beside ROSS: ``python -m benchmarks.rotor_speed``.  See README.md beside this file."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path

HERE = Path(__file__).resolve().parent


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and write the results."""
    parser = argparse.ArgumentParser(description="Speed of Campbell diagrams and prescribed run-ups, beside ROSS.")
    parser.add_argument("--quick", action="store_true", help="smoke test: 6 elements, 11 speeds, 2500 steps")
    parser.add_argument("--repeats", type=int, default=3, help="timed calls after the first (default 3)")
    parser.add_argument(
        "--ross-python", type=Path, help="Python of ROSS's environment; default: the variable ROSS_PYTHON, else without ROSS"
    )
    parser.add_argument("--out", type=Path, help="folder for the results; default: beside the command, none with --quick")
    options = parser.parse_args(arguments)
    if options.repeats < 1:
        parser.error("--repeats must be at least 1")
    for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(name, "1")  # before numpy is loaded

    from benchmarks.rotor_speed.report import report
    from benchmarks.rotor_speed.ross import ross_python
    from benchmarks.rotor_speed.study import study
    from benchmarks.writing import write_results

    numbers = study(python=ross_python(options.ross_python), quick=options.quick, repeats=1 if options.quick else options.repeats)
    text = report(numbers)
    print(text)
    folder = options.out or (None if options.quick else HERE)
    if folder is not None:
        for path in write_results(folder, numbers, text, {}):
            print(f"wrote {path}", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
