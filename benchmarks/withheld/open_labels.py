"""Opens the labels of a sealed set, after the answers: ``python -m benchmarks.withheld.open_labels FOLDER ANSWERS.json --out truths.json``.

The truths are proven against the commitments.  The file written is what ``score.py`` reads as TRUTHS.  made.json beside it
holds the seed, with which ``benchmarks.withheld.make`` makes the same records again.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
from collections.abc import Sequence
from pathlib import Path

from benchmarks.withheld.sealing import COMMITMENTS, SealError, open_key, read_about


def main(arguments: Sequence[str] | None = None) -> int:
    """Open; returns 0, or 1 when something does not fit."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.withheld.open_labels", description="Opens the labels of a sealed set.")
    parser.add_argument("folder", type=Path, help="the cases, with their commitments")
    parser.add_argument("answers", type=Path, help="answers.json with every case")
    parser.add_argument("--key", type=Path, help="default: FOLDER.key.zip beside FOLDER")
    parser.add_argument("--out", type=Path, required=True, help="file for the truths")
    options = parser.parse_args(arguments)
    key = options.key or options.folder.with_name(options.folder.name + ".key.zip")
    answers = options.answers.read_bytes()
    try:
        labels = open_key(key, options.folder / COMMITMENTS, answered={answer["case"] for answer in json.loads(answers)})
    except SealError as error:
        print(error, file=sys.stderr)
        return 1
    options.out.write_text(json.dumps(labels, indent=1) + "\n", encoding="utf-8")
    options.out.with_name("made.json").write_text(json.dumps(read_about(key), indent=1) + "\n", encoding="utf-8")
    print(f"{len(labels)} truths in {options.out}; SHA-256 of the answers: {hashlib.sha256(answers).hexdigest()}", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
