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
from hdrive_mbs.errors import HdriveError
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
    """Values of channels at the samples of a trial, from where it starts; of those that the model has, none where it cannot be run."""
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
        line = CompiledLine(network, wanted)
        run = line.run(trial.samples, trial.every, step=simulator.step, angles=start, speeds=trial.speeds)
    except HdriveError:
        return {}
    return {name: run.values[name] for name in wanted}
