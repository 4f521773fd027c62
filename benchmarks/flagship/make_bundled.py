"""Makes the record that comes with the package: ``python -m benchmarks.flagship.make_bundled``.

Writes hdrive_mbs/data/robot_joint_line/to_and_fro.csv, and what is planted in it into bundled_label.json beside this
file, which the package does not hold.  The same seed gives the same record on one machine, and to rounding elsewhere.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.flagship.cases import CASES
from benchmarks.flagship.plant import DATA_SHEET, drawn
from benchmarks.flagship.records import write

HERE = Path(__file__).resolve().parent
FOLDER = HERE.parents[1] / "hdrive_mbs" / "data" / "robot_joint_line"
CASE, RECORD, SEED = "hysteresis", "to_and_fro", 20261122


def made(folder: Path) -> tuple[Path, dict[str, Any]]:
    """The record, written into a folder, and the label: what is planted in it."""
    planted = next(case for case in CASES if case.name == CASE)
    rng = np.random.default_rng(SEED)
    values = drawn(rng)
    (written,) = write(planted.joint(values), folder, rng, records=(RECORD,))
    verdict, effect, place = planted.right
    return written, {
        "seed": SEED,
        "verdict": verdict,
        "effect": effect,
        "place": place,
        "said": planted.said,
        "true_over_nominal": {name: round(value / DATA_SHEET[name], 6) for name, value in values.items() if value != DATA_SHEET[name]},
    }


def main() -> int:
    """Write record and label."""
    written, label = made(FOLDER)
    (HERE / "bundled_label.json").write_text(json.dumps(label, indent=1) + "\n", "utf-8")
    print(written)
    return 0


if __name__ == "__main__":
    sys.exit(main())
