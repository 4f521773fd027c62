"""A multisine shaped for two given causes.

The motor's input and, where there is one, the load are each a mean and a sum of sines at a few lines; their amplitudes are
searched for the largest D, phases always chosen for a small peak, and the motion as large as the limits allow.  The search
starts from the best of a few plain spectra, changes all weights at random and keeps what is better; its steps grow after
a success and shrink after failures.  Source: (1+1) evolution strategy with the 1/5 rule, Rechenberg, Evolutionsstrategie,
1973.  It finds a good spectrum, not the best one there is.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.experiment.detectability import DISTINGUISHABLE, Predictions
from hdrive_mbs.diagnosis.experiment.drives import load_of, motor_of
from hdrive_mbs.diagnosis.experiment.limits import Limits
from hdrive_mbs.diagnosis.experiment.menu import PERIODS, RISE, TOP, standard_menu
from hdrive_mbs.diagnosis.experiment.multisine import low_phases, multisine, spread_harmonics
from hdrive_mbs.diagnosis.experiment.plan import Course, Plan
from hdrive_mbs.diagnosis.experiment.within import Model, largest, nominal_model
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.errors import AnalysisError, ParameterError

FloatArray = npt.NDArray[np.float64]

MOTOR_LINES, LOAD_LINES = 12, 4
"""Lines of the motor's input and of the load, over the whole band."""
EVALUATIONS = 60
"""Spectra that a search tries, each with a few runs for the limits and the Jacobians of both causes."""
SPREAD, GROWTH, DROPPED = 0.8, 1.5, 0.1
"""First standard deviation of the logarithm of a weight from one try to the next; growth of it after a success (after a
failure its fourth root less), and the share of the weights that are dropped or taken back."""
MEANS = (0.0, 0.35, 0.7)
"""Mean speeds and loads that are tried, shares of their limits."""


@dataclass(frozen=True, kw_only=True, eq=False)
class OptimisedMultisine:
    """What the search found, beside the best plan of the menu.

    plan : the multisine;  detectability : D of it, the smaller one of both ways round
    rival, rival_detectability : the best of the menu of the same length;  evaluations : spectra that were tried
    """

    plan: Plan
    detectability: float
    rival: str
    rival_detectability: float
    evaluations: int

    @property
    def better(self) -> bool:
        """Whether it beats the menu."""
        return self.detectability > self.rival_detectability

    def __str__(self) -> str:
        says = "beats" if self.better else "does NOT beat"
        enough = "enough" if max(self.detectability, self.rival_detectability) >= DISTINGUISHABLE else "neither is enough"
        return (
            f"{self.plan.name!r} (detectability {self.detectability:.3g}) {says} the best of the menu of the same length,"
            f" {self.rival!r} ({self.rival_detectability:.3g}; {DISTINGUISHABLE:g} is needed: {enough})."
        )


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Weights of the lines and means, shares of the limits.  Motion: a size times the lines of the motor, the peak 1."""

    motor: FloatArray
    load: FloatArray
    mean: float
    mean_load: float


def optimised_multisine(
    bench: Bench,
    first: Fitted,
    second: Fitted,
    limits: Limits,
    *,
    seconds: float,
    every: float,
    seed: int = 0,
    step: float | None = None,
    thinned: int = 2,
    evaluations: int = EVALUATIONS,
    menu: Sequence[Plan] | None = None,
    alone: bool = False,
) -> OptimisedMultisine:
    """The multisine that tells two fitted causes apart best, within limits that both models and the nominal one keep.

    seconds, every : length and sample time of the record [s];  step : of the integration; half a sample if not given
    seed : of phases and of the order in which weights are tried;  thinned : the search compares only each such sample
    menu : plans to compare with; the standard ones of the same length if not given;  alone : see ``detectability``

    Raises AnalysisError where no spectrum keeps the limits, ParameterError for a bench whose motor has no such input.
    """
    fine = step or 0.5 * every
    make = _Maker(bench, limits, seconds, every, seed)
    models: list[Model] = [nominal_model(), (first.hypothesis, first.z), (second.hypothesis, second.z)]

    def judged(plan: Plan, each: int) -> float:
        try:
            return Predictions(bench.planned(plan), (first, second), step=fine, every=each).apart(0, 1, alone=alone)
        except AnalysisError:
            return -np.inf

    def tried(spectrum: Spectrum) -> tuple[float, Plan | None]:
        plan = largest(bench, lambda size: make(spectrum, size), limits, models, fine)
        return (-np.inf, None) if plan is None else (judged(plan, thinned), plan)

    best, count = _search(tried, make, evaluations, np.random.default_rng(seed))
    if best is None:
        raise AnalysisError(f"No multisine of {seconds:g} s keeps within {limits}; give higher limits or more time.")
    usual = standard_menu(bench, limits, seconds=seconds, every=every, step=fine) if menu is None else menu
    rivals = [(judged(plan, 1), plan.name) for plan in usual]
    rival, name = max(rivals, key=lambda item: item[0], default=(0.0, "nothing"))
    return OptimisedMultisine(plan=best, detectability=judged(best, 1), rival=name, rival_detectability=rival, evaluations=count)


class _Maker:
    """Spectrum and size -> plan."""

    def __init__(self, bench: Bench, limits: Limits, seconds: float, every: float, seed: int) -> None:
        motor = motor_of(bench)
        if motor is None:
            raise ParameterError(f"Bench {bench.scene.name!r} has no speed reference or motor torque among its inputs.")
        self._motor, self._load = motor, load_of(bench) if limits.load > 0.0 else None
        self._limits, self._seconds, self._every, self._seed = limits, seconds, every, seed
        samples = round(seconds / every)
        self._unit = np.arange(samples) / samples
        rise = np.clip(self._unit / RISE, 0.0, 1.0)
        self._fading = rise**2 * (3.0 - 2.0 * rise)
        highest = max(PERIODS + 2, int(TOP * samples))
        self.motor_lines = spread_harmonics(PERIODS, highest, MOTOR_LINES)
        self.load_lines = spread_harmonics(PERIODS, max(PERIODS + 2, highest // 3), LOAD_LINES) if self._load is not None else ()
        self.means = MEANS if motor.role == "speed" else (0.0,)
        self._waves: dict[bytes, FloatArray] = {}

    def starts(self) -> list[Spectrum]:
        """Plain spectra: all lines, and each third of them, standing and turning, without and with load."""
        lines = np.asarray(self.motor_lines, float)
        third = np.arange(len(lines)) * 3 // len(lines)
        shapes = [lines[0] / lines, *(np.where(third == k, lines[0] / lines, 0.0) for k in range(3))]
        none, all_lines = np.zeros(len(self.load_lines)), np.ones(len(self.load_lines))
        found = [Spectrum(shape / shape.max(), none, mean, 0.0) for shape in shapes for mean in self.means[:2]]
        if self.load_lines:
            found += [Spectrum(shape / shape.max(), all_lines, 0.0, 0.0) for shape in shapes]
            found.append(Spectrum(np.zeros(len(lines)), all_lines, 0.0, 0.0))
        return found

    def changed(self, spectrum: Spectrum, spread: float, rng: np.random.Generator) -> Spectrum:
        """Another one nearby."""
        means = rng.random(2) < 2.0 * DROPPED
        return Spectrum(
            motor=_changed(spectrum.motor, spread, rng),
            load=_changed(spectrum.load, spread, rng),
            mean=float(rng.choice(self.means)) if means[0] else spectrum.mean,
            mean_load=float(rng.choice(MEANS)) if means[1] and self.load_lines else spectrum.mean_load,
        )

    def __call__(self, spectrum: Spectrum, size: float) -> Plan:
        motor = self._motor
        top = self._limits.speed if motor.role == "speed" else self._limits.torque
        motion = spectrum.mean + size * (1.0 - spectrum.mean) * self._wave(self.motor_lines, spectrum.motor)
        times: FloatArray = np.asarray(self._every * np.arange(len(self._unit)), float)
        inputs: dict[str, Course] = {motor.column: (times, top * self._fading * motion)}
        if self._load is not None:
            torque = spectrum.mean_load + (1.0 - spectrum.mean_load) * self._wave(self.load_lines, spectrum.load)
            inputs[self._load.column] = (times, self._limits.load * self._fading * torque)
        return Plan(name="optimised multisine", inputs=inputs, duration=self._seconds, every=self._every)

    def _wave(self, lines: Sequence[int], weights: FloatArray) -> FloatArray:
        """With a peak of 1, or nothing."""
        used = weights > 0.0
        if not used.any():
            return np.zeros_like(self._unit)
        key = np.asarray([*lines, *weights], float).tobytes()
        if key not in self._waves:
            chosen = [line for line, use in zip(lines, used, strict=True) if use]
            wave = multisine(self._unit, chosen, weights[used], low_phases(chosen, weights[used], self._seed))
            self._waves[key] = wave / float(np.abs(wave).max())
        return self._waves[key]


def _search(
    tried: Callable[[Spectrum], tuple[float, Plan | None]], make: _Maker, evaluations: int, rng: np.random.Generator
) -> tuple[Plan | None, int]:
    """The best plan, and how many spectra were tried."""
    starts = make.starts()[:evaluations]
    best, top, plan, spread = starts[0], -np.inf, None, SPREAD
    for k in range(evaluations):
        spectrum = starts[k] if k < len(starts) else make.changed(best, spread, rng)
        value, made = tried(spectrum)
        better = made is not None and value > top
        if better:
            best, top, plan = spectrum, value, made
        if k >= len(starts):
            spread *= GROWTH if better else GROWTH**-0.25
    return plan, evaluations


def _changed(weights: FloatArray, spread: float, rng: np.random.Generator) -> FloatArray:
    """All weights moved on a logarithmic scale; some dropped, some that were zero taken back; the largest is 1 again."""
    if not len(weights):
        return weights
    used = weights > 0.0
    usual = float(np.median(weights[used])) if used.any() else 1.0
    moved = np.where(used, weights, usual) * np.exp(spread * rng.standard_normal(len(weights)))
    kept = moved * (used ^ (rng.random(len(weights)) < DROPPED))
    return np.asarray(kept / kept.max()) if kept.any() else kept
