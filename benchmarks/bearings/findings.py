"""Everything that was measured, with the few quantities that several verdicts need."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.bearings.cases import FULL, Case
from benchmarks.bearings.precision import TARGET, Runs
from benchmarks.bearings.run_up import ROTORS
from benchmarks.bearings.steady import Steady, against

SCIPY = Path(__file__).resolve().parents[2] / "tests" / "verification" / "reference_rotor_values.json"
"""Peaks of the same line by an independent model, integrated with scipy."""

SCIPY_NAMES = {"M-REF": "m_ref full", "M-REF2": "m_ref2 full", "cubic bearing": "m_ref full, bearings 1.2e7 N/m and 1e18 N/m3"}


@dataclass(frozen=True, eq=False)
class Findings:
    """Case -> model -> what was found; ``run_ups`` only for the two cases of the paper.

    defaults : what run_up gives without any setting
    without_tilt : case -> deviations of the simplified model without tilt stiffness, tilt damping and tilt inertia
    """

    duration: float
    runs: Mapping[Case, Mapping[str, Runs]]
    steady: Mapping[Case, Mapping[str, Steady]]
    run_ups: Mapping[Case, Mapping[str, Any]]
    without_tilt: Mapping[Case, Mapping[str, Any]]
    defaults: Mapping[Case, Mapping[str, Mapping[str, Any]]]
    swept: Mapping[str, Any]

    def peak_deviation(self, case: Case, model: str) -> dict[str, float]:
        """Rotor -> signed relative deviation of its run-up peak from that of the full model."""
        model_peaks, exact = self.runs[case][model].converged, self.runs[case][FULL].converged
        return {rotor: model_peaks[rotor].amplitude / exact[rotor].amplitude - 1.0 for rotor in ROTORS}

    def peak_speed_deviation(self, case: Case, model: str) -> float:
        """Of the speed at which rotor 1 has its run-up peak, signed."""
        return self.runs[case][model].converged["rotor_1"].speed / self.runs[case][FULL].converged["rotor_1"].speed - 1.0

    def steady_deviation(self, case: Case, model: str) -> dict[str, Any]:
        """See ``steady.against``."""
        return against(self.steady[case][model], self.steady[case][FULL])

    def time_ratio(self, case: Case, model: str) -> float:
        """CPU time over that of the full model at TARGET, each with its best solver."""
        of = self.runs[case]
        return of[model].best()[1] / of[FULL].best()[1]

    def same_setting(self, case: Case, model: str, kind: str, value: float) -> dict[str, float]:
        """CPU time and steps over those of the full model with one and the same solver; NaN where it was not run."""
        found = []
        for runs in (self.runs[case][model], self.runs[case][FULL]):
            setting = next((s for s in runs.settings if s.kind == kind and s.value == value and s in runs.peaks), None)
            found.append((math.nan, math.nan) if setting is None else (runs.median(setting), float(sum(runs.steps[setting]))))
        (seconds, steps), (seconds_full, steps_full) = found
        return {"seconds": seconds / seconds_full, "steps": steps / steps_full}

    def swept_cells(self, model: str) -> list[dict[str, float]]:
        """All deviations of a model in the sweeps, one mapping per line."""
        cells: list[dict[str, float]] = []
        for name in ("bearing", "foundation"):
            tables = self.swept["maps"][name]["models"][model]
            cells += [
                dict(zip(tables, row, strict=True)) for row in zip(*(table.ravel().tolist() for table in tables.values()), strict=True)
            ]
        return cells + [row[model] for rows in self.swept["damping"].values() for row in rows if model in row]

    def scipy(self) -> dict[str, Any]:
        """Largest relative difference of converged peaks of the full model from the independent one; or why there is none."""
        if not SCIPY.is_file():
            return {"skipped": f"{SCIPY.name} lies in the tests of the checkout, which are not here"}
        kept = json.loads(SCIPY.read_text("utf-8"))
        found: dict[str, Any] = {}
        for case, of in self.runs.items():
            name = SCIPY_NAMES.get(case.name)
            if name in kept:
                peaks, ours = kept[name]["peaks"], of[FULL].converged
                found[case.name] = {
                    "amplitude": max(abs(ours[r].amplitude / peaks[r]["amplitude"] - 1.0) for r in ROTORS),
                    "speed": max(abs(ours[r].speed / peaks[r]["speed"] - 1.0) for r in ROTORS),
                }
        return found

    def numbers(self) -> dict[str, Any]:
        """For results.json."""
        cases: dict[str, Any] = {}
        for case, of in self.runs.items():
            models: dict[str, Any] = {}
            for model, runs in of.items():
                kind, seconds = runs.best()
                models[model] = runs.numbers(of[FULL]) | {
                    "run_up_peak_deviation": self.peak_deviation(case, model),
                    "run_up_peak_speed_deviation": self.peak_speed_deviation(case, model),
                    "best_solver": kind,
                    "seconds_with_it": seconds,
                    "seconds_per_simulated_second": seconds / self.duration,
                    "time_over_full": self.time_ratio(case, model),
                    "critical_speeds": list(self.steady[case][model].criticals),
                    "damped_critical_speeds": list(self.steady[case][model].damped_criticals),
                    "run_up_as_it_comes": self.defaults[case][model],
                    "steady": self.steady_deviation(case, model),
                }
            cases[case.name] = {"what": case.what, "models": models}
        return {
            "duration": self.duration,
            "target_error": TARGET,
            "cases": cases,
            "run_up_deviation": {case.name: value for case, value in self.run_ups.items()},
            "simplified_without_tilt": {case.name: value for case, value in self.without_tilt.items()},
            "scipy": self.scipy(),
            "sweep": self.swept,
        }
