"""The same run in one lane and in several, and the machine code that each needs."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from benchmarks.machine import machine as about
from hdrive_mbs.compiled.lanes import Lanes, run_lanes
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.compiled.machine import machine, processor
from models import drive_bench, rotor_bench

WIDTHS = (1, 2, 4, 8)
SPEED = 300.0
"""rad/s of the rotors at the start."""


def study(*, quick: bool, repeats: int) -> dict[str, Any]:
    """Rows: model, steps of its code, width, compile_s, run_s (least of the repeats), apart (largest from width 1, relative)."""
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
    return {"about": about(), "lanes_used": processor().lanes, "repeats": repeats, "rows": rows}


def _models() -> list[tuple[str, CompiledLine, np.ndarray, float, int]]:
    rotor = CompiledLine(rotor_bench.undriven("run_up").network(), ["rotor_1.x", "rotor_2.y"])
    drive = CompiledLine(drive_bench.build().network(), ["motor.speed", "load.speed"])
    turning = {name: SPEED for name in rotor.names if name in rotor_bench.POSITIONS}
    return [
        ("drive bench", drive, np.array([drive.initial(None, None, None)]), 1e-3, 4),
        ("rotor bench", rotor, np.array([rotor.initial(None, turning, None)]), rotor_bench.SAMPLE_TIME, 3),
    ]
