"""The run of a fitted model that everything is linearised about."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.idle_coordinates import without_idle
from hdrive_mbs.compiled.line import CompiledLine, CompiledRun
from hdrive_mbs.diagnosis.following import following
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.diagnosis.trial_runs import fold_of, measured_in, run_trial
from hdrive_mbs.errors import LawError, ParameterError, SimulationError
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
        value = np.interp(moment.time, self.times, self.force)
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
    network = as_run(trial, hypothesis, z)
    names = [body.name for body in network.bodies]
    watched = [Channel(f"angle:{name}", "", "", partial(Moment.angle, coordinate=name)) for name in names]
    watched += [Channel(f"speed:{name}", "", "", partial(Moment.speed, coordinate=name)) for name in names]
    watched += [Channel(f"state:{state.name}", "", "", partial(Moment.state, name=state.name)) for state in network.states]
    wide = replace(network, channels=(*network.channels, *watched))
    [run] = _runs(simulator, number, [_line(simulator, number, wide, forces, [channel.name for channel in watched])], [(hypothesis, z)])
    if isinstance(run, SimulationError):
        raise run
    fold = fold_of(trial)
    values = {channel.name: run.values[channel.name][::fold].copy() for channel in watched}  # views would keep the whole run
    return Motion(trial, network, values, measured_in(trial, run))


def columns_of(
    simulator: Simulator, number: int, hypothesis: Hypothesis, points: Sequence[FloatArray], forces: Sequence[KnownForce] = ()
) -> list[dict[str, FloatArray] | None]:
    """Simulated columns of a trial at several points of the parameters; None where one cannot be run."""
    trial = simulator.trials[number]
    lines: list[CompiledLine | None] = []
    for point in points:
        try:
            lines.append(_line(simulator, number, as_run(trial, hypothesis, point), forces, []))
        except (ParameterError, LawError):
            lines.append(None)
    good = [k for k, line in enumerate(lines) if line is not None]
    runs = _runs(simulator, number, [line for line in lines if line is not None], [(hypothesis, points[k]) for k in good])
    found: list[dict[str, FloatArray] | None] = [None] * len(points)
    for k, run in zip(good, runs, strict=True):
        found[k] = None if isinstance(run, SimulationError) else measured_in(trial, run)
    return found


def as_run(trial: Trial, hypothesis: Hypothesis, z: FloatArray) -> Network:
    """What is run through a trial: its measured motions given, without what nothing moves."""
    network = following(hypothesis.scene(trial.scene, z).network(), trial.motions)
    if network.is_lateral:
        network = without_idle(network, {**trial.angles, **{f"{name}_rate": value for name, value in trial.speeds.items()}})
    return network


def _line(simulator: Simulator, number: int, network: Network, forces: Sequence[KnownForce], more: Sequence[str]) -> CompiledLine:
    trial = simulator.trials[number]
    pushed = replace(network, elements=(*network.elements, *forces))
    return CompiledLine(pushed, [*more, *dict.fromkeys(item.channel for item in trial.measured.values())], simulator.slowed)


def _runs(
    simulator: Simulator, number: int, lines: Sequence[CompiledLine], points: Sequence[tuple[Hypothesis, FloatArray]]
) -> list[CompiledRun | SimulationError]:
    trial = simulator.trials[number]
    angles = [simulator.start_of(number, *point) if trial.settled else dict(trial.angles) for point in points]
    return run_trial(trial, lines, angles, simulator.steps[number])
