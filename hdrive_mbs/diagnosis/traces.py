"""Measured and simulated columns side by side, thinned for pictures."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.along import along, network_of
from hdrive_mbs.diagnosis.bench import units_of
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.result import Trace
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.network.network import Network

FloatArray = npt.NDArray[np.float64]

POINTS = 3000
"""Most points of a trace."""


def traces(simulator: Simulator, nominal: Fitted, refit: Fitted, effect: Fitted) -> tuple[Trace, ...]:
    """Every column of every trial with the three models, to which an unknown offset and free vibration from before the record are added."""
    models = [simulator.columns(item.hypothesis, item.z) for item in (nominal, refit, effect)]
    found = []
    for number, trial in enumerate(simulator.trials):
        network = trial.scene.network()
        units = units_of(network)
        thin = slice(None, None, max(1, -(-trial.samples // POINTS)))
        where = _operating_point(simulator, number, effect)
        for column, values in trial.columns.items():
            measured = trial.measured[column]
            simulated = [model[number].get(column, np.full(trial.samples, np.nan)) for model in models]
            moved = [own + (_offset(values - own, trial) if measured.offset > 0.0 else 0.0) for own in simulated]
            if trial.ringing is not None:
                lines = [item.hypothesis.scene(trial.scene, item.z, to_run=True) for item in (nominal, refit, effect)]
                moved = [own + trial.ringing.part_of(values - own, line, trial.every) for own, line in zip(moved, lines, strict=True)]
            found.append(
                Trace(
                    record=trial.name,
                    column=column,
                    unit=units[measured.channel],
                    noise=measured.total,
                    times=trial.times[thin],
                    measured=values[thin],
                    nominal=moved[0][thin],
                    refit=moved[1][thin],
                    effect=moved[2][thin],
                    held_out=trial.held_out[thin],
                    **{name: history[thin] for name, history in where.items()},
                )
            )
    return tuple(found)


def _offset(left: FloatArray, trial: Trial) -> float:
    """What is left of an offset on average, over the samples of the fit, or all where it has seen none."""
    used = np.isfinite(left) & (~trial.held_out | trial.held_out.all())
    return float(left[used].mean()) if used.any() else 0.0


def _operating_point(simulator: Simulator, number: int, fitted: Fitted) -> dict[str, FloatArray]:
    """Speed and angle of the first place that turns, and the torque of the last connection, during a trial."""
    network = network_of(simulator, number, fitted)
    wanted = {} if network is None else _channels(network)
    values = along(simulator, number, fitted, list(wanted.values()))
    return {name: values[channel] for name, channel in wanted.items() if channel in values}


def _channels(network: Network) -> dict[str, str]:
    known = [channel.name for channel in network.channels]
    turning = [*(motion.name for motion in network.motions), *(body.name for body in network.bodies if not body.lateral)]
    found = {}
    for what in ("speed", "angle"):
        name = next((f"{place}.{what}" for place in turning if place != "ground" and f"{place}.{what}" in known), None)
        if name is not None:
            found[what] = name
    torques = [f"{e.name}.torque" for e in network.elements if getattr(e, "flanges", None) and f"{e.name}.torque" in known]
    if torques:
        found["torque"] = torques[-1]
    return found
