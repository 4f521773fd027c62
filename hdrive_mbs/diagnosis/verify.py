"""The compiled runs of a diagnosis held against the multibody engine."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.time_response import simulate
from hdrive_mbs.diagnosis.driven import start_of
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.engine.solvers import RungeKutta4, Solver, Trapezoidal
from hdrive_mbs.errors import HdriveError, ParameterError, SimulationError
from hdrive_mbs.freed_memory import give_back

FloatArray = npt.NDArray[np.float64]

LONGEST = 4.0
"""Stretch of a record that is run on the engine [s]: its beginning."""

AGREES = 0.3
"""Standard deviations of the noise by which search and engine may differ before a warning says so."""
FINER, NEWTON = (4.0, 8.0, 16.0), 1e-6
"""The engine's steps on rotor lines by the trapezoidal rule, each half of the one before, as parts of the search's; Newton's tolerance."""
EXPLICIT = 2.0
"""Its step by the rule of fourth order, likewise."""


def engine_difference(simulator: Simulator, fitted: Fitted) -> float:
    """Largest rms difference of a measured column between search and engine, in standard deviations of its noise.

    On the beginning of the shortest record.  Where they differ, the search runs again with half its step, so that its own error
    (``step_error``) does not count.  A rotor line goes by the trapezoidal rule first, with which the phase of free vibration is late by
    (w h)^2/12 per radian, the engine's error; where they differ, by the search's own rule of fourth order with half its step; where
    that is not stable, by the trapezoidal rule with half its step, twice at most: its error falls to a quarter, and the last two runs
    together give it without (Richardson).

    Raises AnalysisError, SimulationError or ParameterError where the engine cannot run the scene.
    """
    number = _shortest(simulator)
    trial = simulator.trials[number]
    scene = fitted.hypothesis.scene(trial.scene, fitted.z)
    own = simulator.columns(fitted.hypothesis, fitted.z)[number]
    samples = min(trial.samples, int(LONGEST / trial.every))
    start = start_of(simulator, number, fitted)
    compared = [name for name, measured in trial.measured.items() if not measured.late and name in own]

    def run(solver: Solver | None) -> dict[str, FloatArray]:
        """Compared columns on the engine, by its own solver if none is given."""
        duration = (samples - 1) * trial.every
        response = simulate(scene, duration, sample_step=trial.every, initial=start or None, solver=solver)
        return {name: response.at(trial.measured[name].channel, trial.times[:samples]) for name in compared}

    def trapezoidal(parts: float) -> dict[str, FloatArray]:
        return run(Trapezoidal(step=simulator.step / parts, newton_tolerance=NEWTON))

    def worst(theirs: Mapping[str, FloatArray], ours: Mapping[str, FloatArray] = own) -> float:
        return _apart(trial, {name: theirs[name] for name in compared}, {name: ours[name][:samples] for name in compared})

    if not scene.network().is_lateral:
        theirs = run(None)
        found = worst(theirs)
        return found if found < AGREES else worst(theirs, _halved(simulator, fitted, number) or own)
    before = trapezoidal(FINER[0])
    found = worst(before)
    if found >= AGREES:
        with contextlib.suppress(ParameterError, SimulationError):  # beyond its limit of stability
            return worst(run(RungeKutta4(step=simulator.step / EXPLICIT)), _halved(simulator, fitted, number) or own)
    for finer in FINER[1:]:
        if found < AGREES:
            break
        finest = trapezoidal(finer)
        found = worst({name: finest[name] + (finest[name] - before[name]) / 3.0 for name in compared})
        before = finest
    return found


def step_error(simulator: Simulator, fitted: Fitted) -> float:
    """Largest rms difference of a measured column of the shortest record between the search and a run with half its step, in standard
    deviations of its noise: 15/16 of the error of its step where that is of fourth order.  0 where it has no such run."""
    number = _shortest(simulator)
    sharper = _halved(simulator, fitted, number)
    own = simulator.columns(fitted.hypothesis, fitted.z)[number]
    return _apart(simulator.trials[number], sharper, {name: own[name] for name in sharper}) if own else 0.0


def _halved(simulator: Simulator, fitted: Fitted, number: int) -> dict[str, FloatArray]:
    """Columns of a trial with half the step of the search; none where it cannot be run."""
    one = Simulator([simulator.trials[number]], simulator.step, parts=2 * simulator.parts)
    return one.columns(fitted.hypothesis, fitted.z)[0]


def _apart(trial: Trial, some: Mapping[str, FloatArray], others: Mapping[str, FloatArray]) -> float:
    """Largest rms difference of a column, in standard deviations of its noise."""
    apart = (float(np.sqrt(np.mean((values - others[name]) ** 2))) / trial.measured[name].total for name, values in some.items())
    return max(apart, default=0.0)


def _shortest(simulator: Simulator) -> int:
    return min(range(len(simulator.trials)), key=lambda k: simulator.trials[k].samples)


@dataclass(frozen=True)
class Verified:
    """A sentence on how far the engine is from the compiled run of a fit;  differs : whether it is a warning."""

    text: str
    differs: bool = False


def verified(simulator: Simulator, fitted: Fitted) -> Verified:
    """How far the engine is from the compiled run of a fit, or why it cannot be asked."""
    simulator.forget()  # the engine needs the memory more
    give_back()
    label = fitted.hypothesis.label
    try:
        difference = engine_difference(simulator, fitted)
    except HdriveError as error:
        return Verified(f"Not verified on the engine, {label}: {error}")
    agrees = difference < AGREES
    trial = simulator.trials[_shortest(simulator)]
    if trial.motions and not agrees:
        held = ", ".join(trial.motions)
        return Verified(
            f"Not verified on the engine, {label}: in {trial.name!r} {held} follows a measured angle, which the engine does not."
        )
    text = f"Search and multibody engine {'agree' if agrees else 'DIFFER'}: rms difference {difference:.2g} of the noise at most, {label}."
    own = step_error(simulator, fitted)
    if own < AGREES:
        return Verified(text, not agrees)
    step = simulator.step
    sharper = f"The step of {step:.3g} s errs by {own:.2g} of the noise there: diagnose again with step={0.5 * step:.3g}."
    return Verified(f"{text} {sharper}", differs=True)
