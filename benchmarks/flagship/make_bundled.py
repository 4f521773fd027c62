"""Makes the record that comes with the package: ``python -m benchmarks.flagship.make_bundled``.

Writes hdrive_mbs/data/robot_joint_line/to_and_fro.csv, and what is planted in it into bundled_label.json beside this
file, which the package does not hold.  The same seed gives the same record on one machine, and to rounding elsewhere.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np

from benchmarks.flagship.cases import CASES
from benchmarks.flagship.plant import DATA_SHEET, drawn
from benchmarks.flagship.records import write

HERE = Path(__file__).resolve().parent
FOLDER = HERE.parents[1] / "hdrive_mbs" / "data" / "robot_joint_line"
CASE, RECORD, SEED = "hysteresis", "to_and_fro", 20261122


def main() -> int:
    """Write record and label."""
    planted = next(case for case in CASES if case.name == CASE)
    rng = np.random.default_rng(SEED)
    values = drawn(rng)
    written = write(planted.joint(values), FOLDER, rng, records=(RECORD,))
    verdict, effect, place = planted.right
    label = {
        "seed": SEED,
        "verdict": verdict,
        "effect": effect,
        "place": place,
        "said": planted.said,
        "true_over_nominal": {name: round(value / DATA_SHEET[name], 6) for name, value in values.items() if value != DATA_SHEET[name]},
    }
    (HERE / "bundled_label.json").write_text(json.dumps(label, indent=1) + "\n", "utf-8")
    print(*written, sep="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
