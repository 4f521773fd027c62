"""The run of a fitted model that everything is linearised about."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.idle_coordinates import without_idle
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.diagnosis.following import following
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.expression import Value
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Channel, Network

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class KnownForce:
    """A force with a given course as an element of a network.

    factors : generalized force on each coordinate per unit;  force : at the times, straight lines between
    """

    name: str
    factors: Mapping[str, float]
    times: FloatArray = field(repr=False)
    force: FloatArray = field(repr=False)

    def contribution(self, moment: Moment) -> dict[str, Value]:
        """Factors times the force at this time."""
        value = np.interp(moment.time, self.times, self.force)  # type: ignore[arg-type]
        return {name: factor * value for name, factor in self.factors.items()}


@dataclass(frozen=True, eq=False)
class Motion:
    """A run of one trial.

    network : that was run, without added forces;  values : ``angle:name``, ``speed:name`` (forward) and ``state:name`` at the samples
    columns : simulated values of the trial's columns
    """

    trial: Trial
    network: Network
    values: Mapping[str, FloatArray]
    columns: Mapping[str, FloatArray]

    def moment(self) -> Moment:
        """All samples at once."""
        picked: dict[str, dict[str, Value]] = {"angle": {}, "speed": {}, "state": {}}
        for key, item in self.values.items():
            kind, name = key.split(":", 1)
            picked[kind][name] = item
        return self.network.moment(self.trial.times, picked["angle"], picked["speed"], picked["state"])

    def reading(self, name: str) -> FloatArray:
        """Any other channel along the run."""
        channel = next(channel for channel in self.network.channels if channel.name == name)
        return np.broadcast_to(np.asarray(channel.read(self.moment()), float), self.trial.times.shape)


def motion_of(simulator: Simulator, number: int, hypothesis: Hypothesis, z: FloatArray, forces: Sequence[KnownForce] = ()) -> Motion:
    """Run a hypothesis through one of the simulator's trials.  Raises SimulationError where values stop being finite.

    forces : that act besides
    """
    trial = simulator.trials[number]
    network = following(hypothesis.scene(trial.scene, z).network(), trial.motions)
    if network.is_lateral:
        network = without_idle(network, {**trial.angles, **{f"{name}_rate": value for name, value in trial.speeds.items()}})
    watched = [_channel(f"angle:{body.name}", lambda m, n=body.name: m.angle(n)) for body in network.bodies]
    watched += [_channel(f"speed:{body.name}", lambda m, n=body.name: m.speed(n)) for body in network.bodies]
    watched += [_channel(f"state:{state.name}", lambda m, n=state.name: m.state(n)) for state in network.states]
    wide = replace(network, channels=(*network.channels, *watched), elements=(*network.elements, *forces))
    late = any(item.late for item in trial.measured.values())
    fold = 2 if late else 1
    line = CompiledLine(wide, [*(channel.name for channel in watched), *dict.fromkeys(item.channel for item in trial.measured.values())])
    angles = simulator.start_of(number, hypothesis, z)
    run = line.run(fold * trial.samples, trial.every / fold, step=simulator.step, angles=angles, speeds=trial.speeds)
    values = {channel.name: run.values[channel.name][::fold] for channel in watched}
    columns = {c: run.values[item.channel][1 if item.late else 0 :: fold] for c, item in trial.measured.items()}
    return Motion(trial, network, values, columns)


def _channel(name: str, read: Callable[[Moment], Value]) -> Channel:
    return Channel(name, "", "", read)
