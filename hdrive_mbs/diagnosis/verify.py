"""The compiled runs of a diagnosis held against the multibody engine."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hdrive_mbs.analysis.time_response import simulate
from hdrive_mbs.diagnosis.driven import start_of
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.engine.solvers import Trapezoidal
from hdrive_mbs.errors import HdriveError

LONGEST = 4.0
"""Stretch of a record that is run on the engine [s]: its beginning."""

AGREES = 0.3
"""Standard deviations of the noise by which search and engine may differ before a warning says so."""
FINER, NEWTON = 8.0, 1e-6
"""The engine's step on rotor lines, as a part of the search's: the trapezoidal rule is of second order where the search is of
fourth; and its Newton tolerance."""


def engine_difference(simulator: Simulator, fitted: Fitted) -> float:
    """Largest rms difference of a measured column between search and engine, in standard deviations of its noise.

    On the beginning of the shortest record.  Raises AnalysisError, SimulationError or ParameterError where the engine cannot run the
    scene.
    """
    number = _shortest(simulator)
    trial = simulator.trials[number]
    scene = fitted.hypothesis.scene(trial.scene, fitted.z)
    own = simulator.columns(fitted.hypothesis, fitted.z)[number]
    samples = min(trial.samples, int(LONGEST / trial.every))
    start = start_of(simulator, number, fitted)
    duration = (samples - 1) * trial.every
    solver = Trapezoidal(step=simulator.step / FINER, newton_tolerance=NEWTON) if scene.network().is_lateral else None
    response = simulate(scene, duration, sample_step=trial.every, initial=start or None, solver=solver)
    worst = 0.0
    for column, measured in trial.measured.items():
        if measured.late or column not in own:
            continue
        theirs = response.at(measured.channel, trial.times[:samples])
        worst = max(worst, float(np.sqrt(np.mean((theirs - own[column][:samples]) ** 2))) / measured.total)
    return worst


def _shortest(simulator: Simulator) -> int:
    return min(range(len(simulator.trials)), key=lambda k: simulator.trials[k].samples)


def verified(simulator: Simulator, fits: Sequence[Fitted]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Of each fit, the answer first, how far the engine is from its compiled run: notes, and warnings where that is too far."""
    notes: list[str] = []
    warnings: list[str] = []
    for fitted in fits:
        label = fitted.hypothesis.label
        try:
            difference = engine_difference(simulator, fitted)
        except HdriveError as error:
            notes.append(f"Not verified on the engine, {label}: {error}")
            continue
        agrees = difference < AGREES
        trial = simulator.trials[_shortest(simulator)]
        if trial.motions and not agrees:
            held = ", ".join(trial.motions)
            notes.append(
                f"Not verified on the engine, {label}: in {trial.name!r} {held} follows a measured angle, which the engine does not."
            )
            continue
        text = (
            f"Search and multibody engine {'agree' if agrees else 'DIFFER'}: rms difference {difference:.2g} of the noise at most, {label}."
        )
        (notes if agrees else warnings).append(text)
    return tuple(notes), tuple(warnings)
