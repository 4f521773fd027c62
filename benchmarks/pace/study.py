"""Causes of the rotor bench at their laws: the line as it is, and in longer steps with its fast vibrations slowed."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from benchmarks.fits.study import SEED, problems
from benchmarks.machine import machine as about
from benchmarks.withheld.methods import bench_of
from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.pace import Pace, pace_of
from hdrive_mbs.diagnosis.prepared import EVERY, factors_of
from hdrive_mbs.diagnosis.simulator import Simulator, chi_square
from hdrive_mbs.diagnosis.tasks import CONVERGED, FINE

FloatArray = npt.NDArray[np.float64]

CAUSES = (
    "parameter_bearing_stiffness",
    "bearing_clearance",
    "bearing_cubic_stiffness",
    "crack",
    "rub",
    "looseness",
    "bearing_cross_coupling",
    "oil_whirl",
    "hidden_mode_support",
)
"""Names of the generator: what stiffens a bearing beside its light ring, and what has corners."""
AT_ONCE, APART = 8, 0.01
"""Points of a batch, and standard deviations of the parameters between them."""


def study(*, quick: bool, repeats: int) -> dict[str, Any]:
    """Rows: case, cause, law, place, steps [s] and those of the line as it is, slowed (number of vibrations);
    exact, quick: mean square of the law fitted with the line as it is, and of the same point at the pace;
    on, refitted: of the fit that goes on from there with the line as it is, and at the pace;
    moved: largest distance of a nominal parameter between these two in its standard deviations after the fit;
    exact_s, quick_s: CPU of a batch."""
    rows: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as folder:
        for problem, cause in problems("rotor", CAUSES[:1] if quick else CAUSES, 1, Path(folder) / "rotor"):
            exact, factors = problem.simulator, factors_of(bench_of("rotor"))
            pace = pace_of(exact.trials, factors, exact.step)
            quickly = Simulator(exact.trials, pace.steps, EVERY, slowed=pace.slowed, shortest=pace.shortest)
            fitted = fit(exact, problem.look.hypothesis, problem.look.z, steps=CONVERGED, share=FINE)
            [same] = quickly.residuals(fitted.hypothesis, [fitted.z])
            on, again = (fit(item, fitted.hypothesis, fitted.z, steps=CONVERGED, share=FINE) for item in (exact, quickly))
            rows.append(
                {
                    "case": problem.case,
                    "cause": cause,
                    "law": problem.law,
                    "place": problem.place,
                    **_steps(exact, pace),
                    "exact": fitted.chi_fit,
                    "quick": float("inf") if same is None else chi_square(same, quickly.fit),
                    "refitted": again.chi_fit,
                    "on": on.chi_fit,
                    "moved": _moved(on, again),
                    **_times({"exact_s": exact, "quick_s": quickly}, fitted, repeats),
                }
            )
    return {"about": about(), "seed": SEED, "repeats": repeats, "at_once": AT_ONCE, "rows": rows}


def _steps(exact: Simulator, pace: Pace) -> dict[str, Any]:
    steps = {trial.name: step for trial, step in zip(exact.trials, pace.steps, strict=True)}
    return {"step": exact.step, "steps": steps, "slowed": len(pace.slowed)}


def _moved(one: Fitted, other: Fitted) -> float:
    size = one.hypothesis.nominal_size
    covariance = np.linalg.inv(one.curvature + np.diag(one.hypothesis.precisions))
    return float(np.max(np.abs(one.z - other.z)[:size] / np.sqrt(np.diag(covariance)[:size])))


def _times(simulators: dict[str, Simulator], fitted: Fitted, repeats: int) -> dict[str, float]:
    """CPU seconds of a batch, least of the repeats, in turns: a machine that is shared is now fast, now slow."""
    rng, taken = np.random.default_rng(1), {name: [] for name in simulators}  # type: dict[str, list[float]]
    for number in range(repeats + 2):  # the first ones make machine code and templates
        points = [fitted.hypothesis.clipped(fitted.z + APART * rng.standard_normal(len(fitted.z))) for _ in range(AT_ONCE)]
        for name, simulator in simulators.items():
            begun = time.process_time()
            simulator.residuals(fitted.hypothesis, points)
            if number > 1:
                taken[name].append(time.process_time() - begun)
    return {name: min(seconds) for name, seconds in taken.items()}
