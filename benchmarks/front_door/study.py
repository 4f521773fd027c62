"""Import times in processes of their own, and one run of the demo."""

from __future__ import annotations

import json
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from benchmarks.machine import machine

ROOT = Path(__file__).resolve().parents[2]
IMPORTS = {
    "nothing": "pass",
    "numpy and scipy": "import numpy, scipy",
    "hdrive_mbs": "import hdrive_mbs",
    "hdrive_mbs and a scene": "import hdrive_mbs as hm; hm.Motor; hm.Shaft; hm.HarmonicDrive; hm.Load; hm.Scene",
    "hdrive_mbs and simulate": "import hdrive_mbs as hm; hm.Scene; hm.simulate",
    "exudyn alone": "import exudyn",
    "hdrive-mbs --help": "import sys; sys.argv = ['hdrive-mbs', '--help']; from hdrive_mbs.cli.main import main; main()",
}
"""What a process does.  Each is timed as a whole, from its start to its end."""


def study(*, repeats: int, with_demo: bool) -> dict[str, Any]:
    """Medians over processes, taken in turn so that a busy moment meets all alike; seconds."""
    found: dict[str, list[tuple[float, float]]] = {name: [] for name in IMPORTS}
    for code in IMPORTS.values():
        _process(code)  # byte code and file cache
    for _ in range(repeats):
        for name, code in IMPORTS.items():
            found[name].append(_process(code))
    base = statistics.median(cpu for cpu, _ in found["numpy and scipy"])
    rows = {
        name: {
            "cpu_s": statistics.median(cpu for cpu, _ in runs),
            "wall_s": statistics.median(wall for _, wall in runs),
            "over_numpy_and_scipy": statistics.median(cpu for cpu, _ in runs) / base,
        }
        for name, runs in found.items()
    }
    return {"machine": machine(), "repeats": repeats, "imports": rows, "demo": _demo() if with_demo else None}


def _process(code: str) -> tuple[float, float]:
    """CPU and wall time of a new interpreter that runs the code."""
    done = _run([sys.executable, "-c", code])
    return done[0], done[1]


def _run(command: list[str]) -> tuple[float, float]:
    import resource

    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    started = time.perf_counter()
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    wall = time.perf_counter() - started
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        raise RuntimeError(f"{' '.join(command)} ended with {done.returncode}: {done.stderr[-2000:]}")
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, wall


def _demo() -> dict[str, Any]:
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder)
        command = [sys.executable, "-m", "hdrive_mbs.cli.main", "demo", "--out", str(target / "demo"), "--json", str(target / "demo.json")]
        cpu, wall = _run(command)
        document = json.loads((target / "demo.json").read_text("utf-8"))
    return {
        "cpu_s": cpu,
        "wall_s": wall,
        "sections_wall_s": document["sections"],
        "sections_cpu_s": document["cpu_sections"],
        "page_bytes": document["page_bytes"],
        "verdict": document["diagnosis"],
    }
