"""The compiled runs of a diagnosis held against the multibody engine."""

from __future__ import annotations

import numpy as np

from hdrive_mbs.analysis.time_response import simulate
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.simulator import Simulator

LONGEST = 4.0
"""Stretch of a record that is run on the engine [s]: its beginning."""


def engine_difference(simulator: Simulator, fitted: Fitted) -> float:
    """Largest rms difference of a measured column between search and engine, in standard deviations of its noise.

    On the beginning of the shortest record.  Raises AnalysisError, SimulationError or ParameterError where the engine cannot run the
    scene.
    """
    number = min(range(len(simulator.trials)), key=lambda k: simulator.trials[k].samples)
    trial = simulator.trials[number]
    scene = fitted.hypothesis.scene(trial.scene, fitted.z)
    own = simulator.columns(fitted.hypothesis, fitted.z)[number]
    samples = min(trial.samples, int(LONGEST / trial.every))
    start = simulator.start_of(number, fitted.hypothesis, fitted.z)
    response = simulate(scene, (samples - 1) * trial.every, sample_step=trial.every, initial=dict(start) or None)
    worst = 0.0
    for column, measured in trial.measured.items():
        if measured.late or column not in own:
            continue
        theirs = response.at(measured.channel, trial.times[:samples])
        worst = max(worst, float(np.sqrt(np.mean((theirs - own[column][:samples]) ** 2))) / measured.total)
    return worst
