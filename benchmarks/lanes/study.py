"""The same run in one lane and in several, the machine code that each needs, and lines of several records side by side."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

import hdrive_mbs as hm
from benchmarks.machine import machine as about
from hdrive_mbs.compiled.lanes import Lanes, run_lanes
from hdrive_mbs.compiled.line import CompiledLine, CompiledRun, run_many
from hdrive_mbs.compiled.machine import machine, processor
from hdrive_mbs.errors import SimulationError
from models import drive_bench, rotor_bench

WIDTHS = (1, 2, 4, 8)
SPEED = 300.0
"""rad/s of the rotors at the start."""
RECORDS, COUNTS = 3, (1, 2, 3, 4)
"""Records that are run together, and lines of each."""


def study(*, quick: bool, repeats: int) -> dict[str, Any]:
    """Rows: model, steps of its code, width, compile_s, run_s (least of the repeats), apart (largest from width 1, relative);
    records as ``_records_together`` says."""
    rows: list[dict[str, Any]] = []
    for name, line, initial, every, inner in _models():
        samples = 40 if quick else 1000
        alone = None
        for width in WIDTHS:
            begun = time.process_time()
            machine(line.structure, width, shared=True)
            compiling = time.process_time() - begun
            taken = []
            for _ in range(repeats):
                begun = time.process_time()
                out, good = run_lanes(Lanes([line.program], width), initial, samples, every, inner, 0.0)
                taken.append(time.process_time() - begun)
            if good[0] != samples:
                raise RuntimeError(f"{name}: not finite after {good[0]} of {samples} samples")
            alone = out[:, 0] if alone is None else alone
            apart = float(np.max(np.abs(out - alone[:, None])) / np.max(np.abs(alone)))
            rows.append({"model": name, "width": width, "compile_s": compiling, "run_s": min(taken), "apart": apart, "samples": samples})
    together = _records_together(20 if quick else 3000, repeats)
    return {"about": about(), "lanes_used": processor().lanes, "repeats": repeats, "rows": rows, "records": together}


def _records_together(samples: int, repeats: int) -> list[dict[str, Any]]:
    """Rows: lines of each of RECORDS records of the drive bench, apart_s (each record by itself), together_s, differ (the largest)."""
    every, step = 1e-3, 2.5e-4
    tables = [hm.SpeedTable(times=(0.0, 1.0, 3.0), speeds=(0.0, 100.0 * (k + 1), 20.0)) for k in range(RECORDS)]
    scenes = [drive_bench.build().replacing({"motor.characteristic.reference": table}) for table in tables]
    lines = [CompiledLine(scene.network(), ["motor.speed", "load.speed"]) for scene in scenes]
    rows = []
    for count in COUNTS:
        apart, both = [], []
        for _ in range(repeats + 1):  # the first one makes the machine code
            begun = time.process_time()
            alone = [run for line in lines for run in run_many([line] * count, samples, every, step=step)]
            apart.append(time.process_time() - begun)
            begun = time.process_time()
            found = run_many([line for line in lines for _ in range(count)], samples, every, step=step)
            both.append(time.process_time() - begun)
        differ = max(_difference(a, b) for a, b in zip(alone, found, strict=True))
        rows.append({"lines": count, "apart_s": min(apart[1:]), "together_s": min(both[1:]), "differ": differ})
    return rows


def _difference(a: CompiledRun | SimulationError, b: CompiledRun | SimulationError) -> float:
    if isinstance(a, SimulationError) or isinstance(b, SimulationError):
        raise RuntimeError(f"a run of the drive bench failed: {a if isinstance(a, SimulationError) else b}")
    return max(float(np.max(np.abs(values - b.values[name]))) for name, values in a.values.items())


def _models() -> list[tuple[str, CompiledLine, np.ndarray, float, int]]:
    rotor = CompiledLine(rotor_bench.undriven("run_up").network(), ["rotor_1.x", "rotor_2.y"])
    drive = CompiledLine(drive_bench.build().network(), ["motor.speed", "load.speed"])
    turning = {name: SPEED for name in rotor.names if name in rotor_bench.POSITIONS}
    return [
        ("drive bench", drive, np.array([drive.initial(None, None, None)]), 1e-3, 4),
        ("rotor bench", rotor, np.array([rotor.initial(None, turning, None)]), rotor_bench.SAMPLE_TIME, 3),
    ]
