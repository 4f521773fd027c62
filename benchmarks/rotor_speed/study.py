"""Both sides on the same work in one run, and the comparison."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.machine import machine
from benchmarks.rotor_speed import ours, ross, rotor
from benchmarks.rotor_speed.accuracy import element_frequencies, exact_frequencies, frequency_errors
from benchmarks.rotor_speed.run_up import RunUp, run_up


def study(*, python: Path | None, quick: bool, repeats: int) -> dict[str, Any]:
    """Times and errors of this package and, where its interpreter is given, of ROSS."""
    elements = rotor.ELEMENTS[:1] if quick else rotor.ELEMENTS
    speeds = np.linspace(0.0, rotor.HIGHEST_SPEED, 11 if quick else rotor.SPEEDS)
    steps = (2_500,) if quick else (rotor.RAMP_STEPS, 13_000, 5_000, 2_500)
    reference, motion = exact_frequencies(speeds), run_up(0.0)
    numbers: dict[str, Any] = {
        "machine": machine(),
        "speeds": len(speeds),
        "largest displacement": motion.largest,
        "reference agreement": motion.agreement,
        "elements alone": {
            str(number): np.max(frequency_errors(element_frequencies(number, speeds), reference), axis=0).tolist() for number in elements
        },
        "campbell": ours.campbells(elements, speeds, reference, repeats),
        "run_up": ours.run_ups(steps, motion, repeats),
    }
    if python is not None:
        numbers["ross"] = _ross(python, quick, repeats, reference)
    return numbers


def _ross(python: Path, quick: bool, repeats: int, reference: Any) -> dict[str, Any]:
    with tempfile.TemporaryDirectory() as folder:
        found = ross.measure(python, Path(folder), quick=quick, repeats=repeats)
        references: dict[float, RunUp] = {}
        for run in found["run_up"]:
            term = run["transient_term"]
            references.setdefault(term, run_up(term))
            times, displacements = ross.motion(Path(folder), run)
            run["error"] = references[term].error(times, displacements)
            run["error against the motion without the term"] = references.setdefault(0.0, run_up(0.0)).error(times, displacements)
            run.pop("file")
        for run in found["campbell"]:
            if "frequencies" not in run:  # a way that does not follow the branches is only timed
                continue
            run["errors"] = np.max(ross.errors(run, reference), axis=0).tolist()
            run["wrong_whirl"] = ross.wrong_whirl(run, reference)
            for bulky in ("frequencies", "log_decrements", "whirl"):
                run.pop(bulky)
        found.pop("speeds")
        return found
