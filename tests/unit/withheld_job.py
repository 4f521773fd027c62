"""Withheld cases that are answered by chance, slowly; worker processes import the job from here: CASES ANSWERS."""

from __future__ import annotations

import json
import os
import signal
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.withheld import run


@dataclass(frozen=True)
class SlowJob(run.Job):
    """Says where it works and takes its time."""

    def __call__(self, point: Mapping[str, Any]) -> dict[str, str]:
        folder = Path(point["folder"])
        with (folder.parent / "log").open("a") as log:
            log.write(f"{folder.name} {os.getpid()}\n")
        time.sleep(0.3)
        json.loads((folder / "record.parquet").read_text())
        return super().__call__(point)


def written_cases(folder: Path, *names: str) -> Path:
    """Folders that look like cases."""
    for name in names:
        (folder / name).mkdir(parents=True)
        (folder / name / "record.parquet").write_text("1.5")
    return folder


def answered(cases: Path, out: Path) -> int:
    """Answer all cases on two processes."""
    return run.answer_cases(SlowJob("drive", "chance"), run.cases_of(cases, "drive"), out, workers=2)


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's job in the background ignores it, and so do its children
    from tests.unit import withheld_job  # so that the job has the name by which a worker finds it

    sys.exit(withheld_job.answered(Path(sys.argv[1]), Path(sys.argv[2])))
