"""The same run in one lane and in several, the machine code that each needs, and lines of several records side by side."""

from __future__ import annotations

import time
from typing import Any
from unittest import mock

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
LENGTHS, COUNTS = {"equal": (1.0, 1.0, 1.0), "as on the rotor bench": (1.0, 0.875, 0.25)}, (1, 2, 3, 4)
"""Lengths of three records that are run together, of that of the longest, and lines of each."""


def study(*, quick: bool, repeats: int) -> dict[str, Any]:
    """Rows: model, steps of its code, width, compile_s, run_s (least of the repeats), apart (largest from width 1, relative);
    records as ``_records_together`` says."""
    rows: list[dict[str, Any]] = []
    for name, line, initial, every, inner in _models():
        samples = 40 if quick else 1000
        compiling = {width: _compiling(line, width) for width in WIDTHS}
        taken: dict[int, list[float]] = {width: [] for width in WIDTHS}
        outs: dict[int, np.ndarray] = {}
        for _ in range(repeats):
            for width in WIDTHS:  # in turns: a machine that is shared is now fast, now slow
                begun = time.process_time()
                outs[width], good = run_lanes(Lanes([line.program], width), initial, samples, every, inner, 0.0)
                taken[width].append(time.process_time() - begun)
                if good[0] != samples:
                    raise RuntimeError(f"{name}: not finite after {good[0]} of {samples} samples")
        alone = outs[1][:, 0]
        for width, out in outs.items():
            apart = float(np.max(np.abs(out - alone[:, None])) / np.max(np.abs(alone)))
            row = {"model": name, "width": width, "compile_s": compiling[width], "run_s": min(taken[width]), "apart": apart}
            rows.append({**row, "samples": samples})
    together = _records_together(20 if quick else 3000, repeats)
    return {"about": about(), "lanes_used": [processor().lanes, processor().wide], "repeats": repeats, "rows": rows, "records": together}


def _compiling(line: CompiledLine, width: int) -> float:
    """CPU time of making machine code [s], also where it has been kept on disk."""
    machine.cache_clear()
    with mock.patch("hdrive_mbs.compiled.machine.kept_code", return_value=None):
        begun = time.process_time()
        machine(line.structure, width, shared=True)
        return time.process_time() - begun


def _records_together(samples: int, repeats: int) -> list[dict[str, Any]]:
    """Rows: model, lengths, lines of each of three records, apart_s (each record by itself), together_s, differ (the largest)."""
    rows = []
    for model, (lines, every, inner, starts) in _records().items():
        for lengths, shares in LENGTHS.items():
            counts = [round(share * samples) for share in shares]
            for number in COUNTS:
                apart, both = [], []
                for _ in range(repeats + 1):  # the first one makes the machine code
                    begun = time.process_time()
                    alone = [
                        run
                        for line, count in zip(lines, counts, strict=True)
                        for run in run_many([line] * number, count, every, step=every / inner, speeds=starts)
                    ]
                    apart.append(time.process_time() - begun)
                    begun = time.process_time()
                    side = [line for line in lines for _ in range(number)]
                    each = [count for count in counts for _ in range(number)]
                    found = run_many(side, each, every, step=every / inner, speeds=starts)
                    both.append(time.process_time() - begun)
                differ = max(_difference(a, b) for a, b in zip(alone, found, strict=True))
                rows.append(
                    {
                        "model": model,
                        "lengths": lengths,
                        "lines": number,
                        "apart_s": min(apart[1:]),
                        "together_s": min(both[1:]),
                        "differ": differ,
                    }
                )
    return rows


def _records() -> dict[str, tuple[list[CompiledLine], float, int, dict[str, float]]]:
    """By model lines of three records, the sample time [s], steps in it, and speeds at the start [rad/s]."""
    tables = [hm.SpeedTable(times=(0.0, 1.0, 3.0), speeds=(0.0, 100.0 * (k + 1), 20.0)) for k in range(3)]
    drives = [drive_bench.build().replacing({"motor.characteristic.reference": table}) for table in tables]
    rotors = [_rotor(rotor_bench.undriven("run_up", rotor_1_eccentricity=size)) for size in (1e-5, 2e-5, 3e-5)]
    turning = {name: SPEED for name in rotors[0].names if name in rotor_bench.POSITIONS}
    return {
        "drive bench": ([CompiledLine(scene.network(), ["motor.speed", "load.speed"]) for scene in drives], 1e-3, 4, {}),
        "rotor bench": (rotors, rotor_bench.SAMPLE_TIME, 3, turning),
    }


def _rotor(scene: hm.Scene) -> CompiledLine:
    return CompiledLine(scene.network(), ["rotor_1.x", "rotor_2.y"])


def _difference(a: CompiledRun | SimulationError, b: CompiledRun | SimulationError) -> float:
    if isinstance(a, SimulationError) or isinstance(b, SimulationError):
        raise RuntimeError(f"a run failed: {a if isinstance(a, SimulationError) else b}")
    return max(float(np.max(np.abs(values - b.values[name]))) for name, values in a.values.items())


def _models() -> list[tuple[str, CompiledLine, np.ndarray, float, int]]:
    rotor = _rotor(rotor_bench.undriven("run_up"))
    drive = CompiledLine(drive_bench.build().network(), ["motor.speed", "load.speed"])
    turning = {name: SPEED for name in rotor.names if name in rotor_bench.POSITIONS}
    return [
        ("drive bench", drive, np.array([drive.initial(None, None, None)]), 1e-3, 4),
        ("rotor bench", rotor, np.array([rotor.initial(None, turning, None)]), rotor_bench.SAMPLE_TIME, 3),
    ]
