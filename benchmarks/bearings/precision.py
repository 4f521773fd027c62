"""Error against CPU time: every model of every line with every solver, interleaved.

The error of a run is that of its peaks, the larger of both rotors: against the converged peaks of the same model
(what the solver costs), and against those of the full model (what the solver and the model cost together).  The
converged run is the explicit one with fixed steps at its finest; the implicit rule, extrapolated from its two finest
steps, has to agree with it.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import hdrive_mbs as hm
from benchmarks.bearings.cases import MODELS, PAPER, Case
from benchmarks.bearings.run_up import ROTORS, Peak, RunUp, run_up
from benchmarks.bearings.stability import eigenvalues, longest_step
from benchmarks.speed.study import time_at
from hdrive_mbs.errors import SimulationError

IMPLICIT, FIXED, ADAPTIVE = "implicit", "explicit, fixed step", "explicit, adaptive"
SOLVERS = (IMPLICIT, FIXED, ADAPTIVE)
TARGET = 1e-3
"""Relative error of the peaks at which times are compared."""

STEPS = (2.5e-5, 5e-5, 1e-4, 2e-4, 4e-4)
TOLERANCES = (1e-7, 1e-4)
SHARES = (0.45, 0.9)
"""Of the longest stable step; the smaller one only where that is not below SHORT."""

SHORT = 2.5e-5
"""A step that needs no shorter one to compare with [s]: (w h)^4 = 8e-7 at w = 1200 rad/s, the third critical speed."""

SAMPLES = 40_000
"""Of a history that is kept for the figures."""

LONG = 1.0
"""A run that takes longer than this [s of CPU time] is not repeated."""


@dataclass(frozen=True)
class Setting:
    """A solver with a step [s] or a relative tolerance."""

    kind: str
    value: float
    solver: hm.Solver


@dataclass(eq=False)
class Runs:
    """One model of one line: its settings, and what the runs gave.

    fastest : largest eigenvalue [1/s];  step_limit : longest stable step of the fixed explicit method [s]
    """

    case: Case
    model: str
    scene: hm.Scene
    fastest: float
    step_limit: float
    settings: Sequence[Setting]
    seconds: dict[Setting, list[float]] = field(default_factory=dict)
    steps: dict[Setting, tuple[int, int]] = field(default_factory=dict)
    peaks: dict[Setting, dict[str, Peak]] = field(default_factory=dict)
    failures: dict[Setting, str] = field(default_factory=dict)
    history: RunUp | None = None

    @classmethod
    def of(cls, case: Case, model: str, *, quick: bool) -> Runs:
        """The settings for one model of one line."""
        scene = case.scene(model)
        values = eigenvalues(scene)
        limit = longest_step(values)
        shares = [share for share in SHARES if share == SHARES[-1] or (share * limit >= SHORT and not quick)]
        chosen = [Setting(FIXED, share * limit, hm.RungeKutta4(step=share * limit)) for share in shares]
        if case in PAPER and not quick:
            pairs = [(tol, hm.DormandPrince(relative_tolerance=tol, absolute_tolerance=1e-2 * tol)) for tol in TOLERANCES]
            chosen += [Setting(ADAPTIVE, tol, solver) for tol, solver in pairs]
        chosen += [Setting(IMPLICIT, h, hm.Trapezoidal(step=h, newton_tolerance=1e-5)) for h in (STEPS[-3:-1] if quick else STEPS)]
        return cls(case, model, scene, float(abs(values).max()), limit, chosen)

    def due(self, setting: Setting) -> bool:
        """Whether to run it once more."""
        return setting not in self.failures and (setting not in self.seconds or self.seconds[setting][0] < LONG)

    def once(self, setting: Setting, duration: float) -> None:
        """Run it and keep what it gives."""
        try:
            run = run_up(self.scene, duration, setting.solver)
        except SimulationError as error:
            self.failures[setting] = str(error).split(" with ")[0]
            return
        self.seconds.setdefault(setting, []).append(run.seconds)
        if setting not in self.peaks:
            self.steps[setting] = run.steps, run.rejected
            self.peaks[setting] = {rotor: run.peak(rotor) for rotor in ROTORS}
            if setting == self._finest(FIXED) and self.case in PAPER:
                self.history = run.thinned(SAMPLES)

    def _finest(self, kind: str) -> Setting:
        return min((s for s in self.settings if s.kind == kind), key=lambda s: s.value)

    @property
    def converged(self) -> Mapping[str, Peak]:
        """Peaks of the explicit method at its finest step."""
        finest = self._finest(FIXED)
        if finest not in self.peaks:
            why = self.failures.get(finest, "not run")
            raise SimulationError(f"{self.case.name}, {self.model}: {why}; there is nothing to compare with.")
        return self.peaks[finest]

    @property
    def agreement(self) -> float:
        """Difference between the converged peaks and the implicit rule extrapolated: (4 A(h/2) - A(h))/3."""
        coarse, fine = sorted((s for s in self.settings if s.kind == IMPLICIT), key=lambda s: -s.value)[-2:]
        ratio = (coarse.value / fine.value) ** 2
        limits = {r: (ratio * self.peaks[fine][r].amplitude - self.peaks[coarse][r].amplitude) / (ratio - 1.0) for r in ROTORS}
        return max(abs(limits[r] / self.converged[r].amplitude - 1.0) for r in ROTORS)

    def error(self, setting: Setting, exact: Mapping[str, Peak]) -> float:
        """Largest relative error of the peaks; NaN for a run that failed."""
        found = self.peaks.get(setting)
        return math.nan if found is None else max(abs(found[r].amplitude / exact[r].amplitude - 1.0) for r in ROTORS)

    def median(self, setting: Setting) -> float:
        """CPU time [s]."""
        return statistics.median(self.seconds[setting]) if setting in self.seconds else math.nan

    def time_at_target(self, kind: str) -> float:
        """CPU time at TARGET with one kind of solver; NaN where it was not run or does not get there."""
        done = [s for s in self.settings if s.kind == kind and s in self.peaks]
        return time_at(TARGET, [self.error(s, self.converged) for s in done], [self.median(s) for s in done])

    def numbers(self, full: Runs) -> dict[str, Any]:
        """For results.json."""
        rows = []
        for s in self.settings:
            row: dict[str, Any] = {"solver": s.kind, "setting": s.value}
            if s in self.failures:
                rows.append(row | {"failure": self.failures[s]})
                continue
            steps, rejected = self.steps[s]
            rows.append(
                row
                | {
                    "error": self.error(s, self.converged),
                    "error_against_full": self.error(s, full.converged),
                    "median_seconds": self.median(s),
                    "best_seconds": min(self.seconds[s]),
                    "samples": len(self.seconds[s]),
                    "steps": steps,
                    "rejected": rejected,
                }
            )
        times = {kind: self.time_at_target(kind) for kind in SOLVERS}
        return {
            "coordinates": len(self.scene.network().bodies),
            "fastest_eigenvalue": self.fastest,
            "longest_explicit_step": self.step_limit,
            "converged_peaks": {r: {"amplitude": p.amplitude, "speed": p.speed} for r, p in self.converged.items()},
            "agreement": self.agreement,
            "runs": rows,
            "seconds_at_target": times,
        }

    def best(self) -> tuple[str, float]:
        """The fastest solver at TARGET and its CPU time [s]."""
        times = {kind: self.time_at_target(kind) for kind in SOLVERS}
        kind = min((k for k in times if math.isfinite(times[k])), key=times.__getitem__)
        return kind, times[kind]


def measure(
    cases: Sequence[Case], duration: float, *, repeats: int, quick: bool, report: Callable[[float], None] | None
) -> dict[Case, dict[str, Runs]]:
    """All runs, each round of repeats through all of them in turn; ``report`` gets the share done, 0 to 1."""
    every = {case.name: {model: Runs.of(case, model, quick=quick) for model in MODELS} for case in cases}
    plan = [(runs, s) for of in every.values() for runs in of.values() for s in runs.settings]
    for k in range(repeats):
        for j, (runs, setting) in enumerate(plan):
            if runs.due(setting):
                runs.once(setting, duration)
            if report is not None:
                first = 0.7 if repeats > 1 else 1.0  # the first round holds the long runs
                report(first * (j + 1) / len(plan) if k == 0 else first + (1.0 - first) * (k - 1 + (j + 1) / len(plan)) / (repeats - 1))
    return {case: every[case.name] for case in cases}
