"""Whether what refitted nominal models leave is spread as noise is.

``python -m benchmarks.withheld.evenness --bench drive FOLDER [CASE ...]``; FOLDER holds cases as ``benchmarks.withheld.make`` writes them,
``--nulls --open`` for those in which nothing is planted.  Of each case the nominal model is fitted, and the mean square told that stands in
stretches above the rest (hdrive_mbs/diagnosis/unevenness.py): up to EVEN a gap with no cause is called noise.  No truth is
looked at.  --out FILE writes the table as well.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from benchmarks.withheld.methods import bench_of, records_of
from benchmarks.writing import table
from hdrive_mbs.diagnosis.diagnose import diagnose
from hdrive_mbs.diagnosis.gather import Evidence
from hdrive_mbs.diagnosis.unevenness import EVEN, patches, unevenness
from hdrive_mbs.effects.probe_gain import ProbeGain
from hdrive_mbs.effects.sensor_offset import SensorOffset
from hdrive_mbs.writing import write_text

CHEAP = {"drive": SensorOffset, "rotor": ProbeGain}
"""A candidate that is soon looked at: a search must have one."""
WORDS = (
    f"Mean squares in variances of the noise. Uneven: what of it stands in stretches above the rest; up to {EVEN} is called noise "
    "where no cause shows."
)
HEADS = ("case", "fitted samples", "held-out samples", "uneven", "largest stretch")


def row(bench: str, folder: Path) -> tuple[str, ...]:
    """What the refitted nominal model of a case leaves: mean squares, and the stretch with most of what comes and goes."""
    kept: list[Evidence] = []
    diagnose(bench_of(bench), records_of(folder), candidates=[CHEAP[bench]], workers=1, pictures=False, watch=kept.append)
    fine, null = kept[0].fine, kept[0].null
    found = patches(fine, null)
    where = f"{found[0].column} of {found[0].record}, {found[0].start:.3g} to {found[0].end:.3g} s" if found else ""
    return folder.name, f"{null.chi_fit:.4f}", f"{null.chi_held:.4f}", f"{unevenness(fine, found):.5f}", where


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.withheld.evenness", description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--bench", choices=sorted(CHEAP), required=True)
    parser.add_argument("folder", type=Path, help="folder with cases")
    parser.add_argument("cases", nargs="*", help="names of cases; all where none is given")
    parser.add_argument("--out", type=Path, help="file for the table")
    options = parser.parse_args(arguments)
    folders = [options.folder / name for name in options.cases] or sorted(path for path in options.folder.iterdir() if path.is_dir())
    rows = []
    for folder in folders:
        rows.append(row(options.bench, folder))
        print("  ".join(rows[-1]), flush=True)
    if options.out is not None:
        write_text(options.out, f"# What refitted models of the {options.bench} bench leave\n\n{WORDS}\n\n{table(HEADS, rows)}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
