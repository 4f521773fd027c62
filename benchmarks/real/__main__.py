"""Diagnoses of other people's measurements: ``python -m benchmarks.real [kuka|staubli|rk4 ...]``.  See README.md beside this file."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.campaign import add_where, where

HERE = Path(__file__).resolve().parent
FOLDERS = {"kuka": "kuka_kr300", "staubli": "staubli_tx40", "rk4": "rk4_rotor"}


def main(arguments: Sequence[str] | None = None) -> int:
    """Diagnose and write the results; a study without its measurements, or that failed, keeps its earlier results.

    Returns 0, or 1 when one failed.
    """
    parser = argparse.ArgumentParser(description="Diagnosis of real measurements.")
    parser.add_argument("studies", nargs="*", metavar="STUDY", help=f"one or more of {', '.join(FOLDERS)}; all if none is given")
    parser.add_argument("--out", type=Path, default=HERE, help="folder for the results (default: beside the command)")
    add_where(parser)
    options = parser.parse_args(arguments)
    wrong = [name for name in options.studies if name not in FOLDERS]
    if wrong:
        parser.error(f"no study {wrong[0]!r}; there are: {', '.join(FOLDERS)}")
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy is loaded

    from benchmarks.real.data import missing
    from benchmarks.real.report import earlier, report
    from benchmarks.real.studies import studied
    from benchmarks.writing import write_results

    numbers, asked, status = earlier(options.out), where(options), 0
    figures: dict[str, Any] = {}
    for name in options.studies or FOLDERS:
        why = missing(FOLDERS[name])
        if why is not None:
            print(f"{name}: skipped, {why}", file=sys.stderr)
            continue
        found = studied(name, asked)
        if found is None:
            status = 1
            continue
        numbers[name], drawn = found
        figures |= drawn
    text = report(numbers)
    print(text)
    for path in write_results(options.out, numbers, text, figures):
        print(f"wrote {path}", file=sys.stderr)
    return status


if __name__ == "__main__":
    sys.exit(main())
