"""What one pays before a run: imports, building a scene, assembling it; and what comes after it."""

from __future__ import annotations

import itertools
import json
import statistics
import subprocess
import sys
import time
from pathlib import Path

import hdrive_mbs as hm
from hdrive_mbs.analysis.time_response import initial_values
from hdrive_mbs.engine.assembly import assemble
from hdrive_mbs.engine.simulation import run
from models.harmonic_drive_train import build

ROOT = Path(__file__).resolve().parents[2]

_FRESH = """
import json, time
clock = time.process_time
t0 = clock()
import exudyn
t1 = clock()
import hdrive_mbs as hm
t2 = clock()
hm.Scene, hm.Motor, hm.Shaft, hm.HarmonicDrive, hm.Load, hm.simulate, hm.DormandPrince
t3 = clock()
from models.harmonic_drive_train import build
from hdrive_mbs.engine.assembly import assemble
t4 = clock()
scene = build()
t5 = clock()
assemble(scene.network())
t6 = clock()
print(json.dumps({"exudyn": t1 - t0, "hdrive_mbs": t2 - t1, "names": t3 - t2, "build": t5 - t4, "assemble": t6 - t5}))
"""
"""The names are those that a script which simulates a train uses; they load the modules behind them."""


def fresh_processes(repeats: int) -> dict[str, float]:
    """Medians over fresh processes, CPU seconds: exudyn alone, then hdrive_mbs on top, then the first scene."""
    seen: list[dict[str, float]] = []
    for _ in range(repeats):
        done = subprocess.run([sys.executable, "-c", _FRESH], cwd=ROOT, capture_output=True, text=True, check=True)
        seen.append(json.loads(done.stdout.splitlines()[-1]))
    median = {name: statistics.median(item[name] for item in seen) for name in seen[0]}
    return {
        "import exudyn [s]": median["exudyn"],
        "import hdrive_mbs on top [s]": median["hdrive_mbs"],
        "and the names a script uses [s]": median["names"],
        "first scene: build [s]": median["build"],
        "first scene: equations, assemble, guard [s]": median["assemble"],
    }


def around_a_run(repeats: int, duration: float) -> dict[str, float]:
    """Medians in this process, CPU seconds: what a run with default settings costs beside its integration."""
    names = ("build", "equations", "assemble", "integrate", "collect", "simulate")
    seen: dict[str, list[float]] = {name: [] for name in names}
    for _ in range(repeats):
        marks = [time.process_time()]

        def mark(marks: list[float] = marks) -> None:
            marks.append(time.process_time())

        scene = build()
        mark()
        network = scene.network()
        mark()
        assembly = assemble(network)
        mark()
        raw = run(assembly, duration=duration, solver=hm.DormandPrince(), **initial_values(network, 0.0, {}))
        mark()
        hm.simulate(build(), duration, progress=False)
        mark()
        lengths = [b - a for a, b in itertools.pairwise(marks)]
        seen["build"].append(lengths[0])
        seen["equations"].append(lengths[1])
        seen["assemble"].append(lengths[2])
        seen["integrate"].append(raw.seconds)
        seen["collect"].append(lengths[3] - raw.seconds)
        seen["simulate"].append(lengths[4])
    median = {name: statistics.median(values) for name, values in seen.items()}
    before = median["build"] + median["equations"] + median["assemble"]
    return {
        "build the scene [s]": median["build"],
        "equations [s]": median["equations"],
        "assemble and guard [s]": median["assemble"],
        "integrate [s]": median["integrate"],
        "collect the samples [s]": median["collect"],
        "all channels [s]": max(median["simulate"] - before - median["integrate"] - median["collect"], 0.0),
        "simulate() as a whole [s]": median["simulate"],
    }
