"""The command line that the benchmarks share: --quick, --repeats and --out, a report on the screen, results beside the command."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:  # numpy and matplotlib are loaded by the benchmark, after the threads of BLAS are set
    from matplotlib.figure import Figure

THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


@dataclass(frozen=True, kw_only=True, eq=False)
class Found:
    """What a benchmark has found: numbers for results.json, the report, pictures by name.

    status : exit code of the command; 0 when it ran, whatever the verdicts
    """

    numbers: Mapping[str, Any]
    text: str
    figures: Mapping[str, Figure] = field(default_factory=dict)
    status: int = 0


def command(description: str, *, quick: str, repeats: int, repeated: str) -> argparse.ArgumentParser:
    """A parser with the options that all benchmarks have; ``quick`` says what the smoke test leaves out, ``repeated`` what is repeated."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--quick", action="store_true", help=f"smoke test: {quick}")
    parser.add_argument("--repeats", type=int, default=repeats, help=f"{repeated} (default {repeats})")
    parser.add_argument("--out", type=Path, help="folder for the results; default: beside the command, none with --quick")
    return parser


def run(
    parser: argparse.ArgumentParser, arguments: Sequence[str] | None, measure: Callable[[argparse.Namespace], Found], beside: Path
) -> int:
    """Measure, print and write; ``measure`` imports what it needs itself, so that one thread of BLAS is set before numpy is loaded."""
    options = parser.parse_args(arguments)
    if options.repeats < 1:
        parser.error("--repeats must be at least 1")
    if options.quick:
        options.repeats = 1
    for name in THREADS:
        os.environ.setdefault(name, "1")
    found = measure(options)

    from benchmarks.writing import write_results

    print(found.text)
    folder = options.out or (None if options.quick else beside)
    if folder is not None:
        for path in write_results(folder, found.numbers, found.text, found.figures):
            print(f"wrote {path}", file=sys.stderr)
    return found.status
