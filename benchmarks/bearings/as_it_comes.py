"""What ``hm.run_up`` gives without any setting: its own step, all channels, peaks."""

from __future__ import annotations

import time
from typing import Any

import hdrive_mbs as hm
from benchmarks.bearings.precision import Runs
from benchmarks.bearings.run_up import ROTORS


def as_it_comes(runs: Runs, duration: float) -> dict[str, Any]:
    """Solver it chose, error of the peaks against the converged ones, CPU time of the whole call [s]."""
    started = time.process_time()
    result = hm.run_up(runs.scene, duration, progress=False)
    seconds = time.process_time() - started
    peaks = {rotor: result.peak_amplitude[rotor] for rotor in ROTORS}
    return {
        "solver": str(result.settings["solver"]),
        "error": max(abs(peaks[rotor] / runs.converged[rotor].amplitude - 1.0) for rotor in ROTORS),
        "seconds": seconds,
    }
