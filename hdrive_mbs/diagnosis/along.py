"""Channels of a fitted model along a trial, whatever its columns measure."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.idle_coordinates import without_idle
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.following import following
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.trial_runs import fold_of, run_trial
from hdrive_mbs.errors import HdriveError, SimulationError
from hdrive_mbs.network.network import Network

FloatArray = npt.NDArray[np.float64]


def network_of(simulator: Simulator, number: int, fitted: Fitted) -> Network | None:
    """What is run through a trial, its measured motions given; None where the values do not go together."""
    trial = simulator.trials[number]
    try:
        return following(fitted.hypothesis.scene(trial.scene, fitted.z).network(), trial.motions)
    except HdriveError:
        return None


def along(simulator: Simulator, number: int, fitted: Fitted, channels: Sequence[str]) -> dict[str, FloatArray]:
    """Values of channels at the samples of a trial, from where it starts; of those that the model has, none where it cannot be run.

    It is run as a fit runs it: with half of the step where it grows.
    """
    trial, network = simulator.trials[number], network_of(simulator, number, fitted)
    if network is None:
        return {}
    known = {channel.name for channel in network.channels}
    wanted = [name for name in dict.fromkeys(channels) if name in known]
    if not wanted:
        return {}
    try:
        start = simulator.start_of(number, fitted.hypothesis, fitted.z)
        if network.is_lateral:
            network = without_idle(network, {**start, **{f"{name}_rate": value for name, value in trial.speeds.items()}})
        measured = (item.channel for item in trial.measured.values())  # whose growth tells that the step is too long
        line = CompiledLine(network, tuple(dict.fromkeys((*wanted, *measured))), simulator.slowed)
    except HdriveError:
        return {}
    [run] = run_trial(trial, [line], [start], simulator.steps[number], parts=simulator.parts)
    return {} if isinstance(run, SimulationError) else {name: run.values[name][:: fold_of(trial)].copy() for name in wanted}
