"""What is known of a bench before it is measured."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.ringing import Ringing
from hdrive_mbs.diagnosis.trial import FloatArray, Trial
from hdrive_mbs.errors import ParameterError, RecordError, unknown_place
from hdrive_mbs.network.network import Network
from hdrive_mbs.network.starting import angles_with_the_rest, speeds_with_the_rest
from hdrive_mbs.records.record import Record
from hdrive_mbs.scene import Scene

if TYPE_CHECKING:
    from hdrive_mbs.diagnosis.experiment.plan import Plan

HELD_OUT, BLOCKS = 0.25, 12
"""Share of each record that no fit sees, and the number of blocks it is cut into."""


@dataclass(frozen=True, kw_only=True)
class Uncertain:
    """A parameter that is not known exactly.

    paths : of the fields of the scene that hold it (several that are alike)
    sigma : relative standard deviation (0.05: known to 5 %); below 0.4 of the value the prior goes on over its logarithm
    """

    paths: tuple[str, ...]
    sigma: float

    def __post_init__(self) -> None:
        if isinstance(self.paths, str) or not self.paths:  # type: ignore[unreachable]
            raise ParameterError(f"paths = {self.paths!r}: give the paths of the fields as a tuple, like ('motor.inertia',).")
        if not (self.sigma > 0.0 and math.isfinite(self.sigma)):
            raise ParameterError(f"{self.paths[0]}: sigma = {self.sigma:g} must be greater than 0; leave out what is known exactly.")


@dataclass(frozen=True, kw_only=True)
class Input:
    """A column of the records that drives the scene.

    path : field that takes it
    law : (times [s], values), both arrays of shape (n,) -> what is put there, like
        ``lambda t, amperes: hm.TorqueHistory(times=t, torques=0.11 * amperes)``
    """

    path: str
    law: Callable[[FloatArray, FloatArray], Any]


@dataclass(frozen=True, kw_only=True, eq=False)
class Bench:
    """A nominal scene, how well its parameters are known, and what the columns of its records are.

    scene : as the data sheets say, its inputs replaceable
    knowledge : parameters that are not exact, by a name of your own
    measured : columns to compare;  inputs : columns that drive the scene
    angles, speeds : of bodies at the start of every record, forward [rad, rad/s]; the other bodies turn with the first of them by their
        ideal ratios, or with a place whose motion is given, and all start at 0 where nothing is
    run_in : time before a record that is run with its inputs [s] and not compared: for records that begin in rotation, whose line whirls
        already.  Of a rotor line free vibration that goes on from before the record is taken out of the comparison then (ringing.py).
        Inputs get times that count from its beginning, and so do the times of an answer
    settled : whether a rotor line starts every record where its weight and other steady forces let it rest, as a machine does;
        False for records of a model that starts undeflected
    together : parameters that are suspected together, by a name for the group; every other one is suspected alone
    searched : names of records on which causes are searched, all if not given; the best are fitted to all records in the end.
        Leave out a long record that shows little that the others do not

    Subclasses override ``trials`` (and ``planned`` and ``menu``) where a record needs more than its columns put into the scene.
    """

    scene: Scene
    knowledge: Mapping[str, Uncertain]
    measured: Mapping[str, Measured]
    inputs: Mapping[str, Input] = field(default_factory=dict)
    angles: Mapping[str, float] = field(default_factory=dict)
    speeds: Mapping[str, float] = field(default_factory=dict)
    together: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    searched: tuple[str, ...] = ()
    settled: bool = True
    run_in: float = 0.0

    def __post_init__(self) -> None:
        if not 0.0 <= self.run_in < math.inf:
            raise ParameterError(f"run_in = {self.run_in:g} s: must be at least 0 s and finite.")
        known = self.scene.parameters()
        for name, item in self.knowledge.items():
            for path in item.paths:
                if path not in known:
                    raise unknown_place(f"path of {name!r}", path, known, "This scene")
        channels = units_of(self.scene.network())
        for column, measured in self.measured.items():
            if measured.channel not in channels:
                raise unknown_place(f"channel of column {column!r}", measured.channel, channels, "This scene")

    @property
    def groups(self) -> dict[str, tuple[str, ...]]:
        """Groups of parameters that may be off together, by name."""
        grouped = {name for names in self.together.values() for name in names}
        return {**self.together, **{name: (name,) for name in self.knowledge if name not in grouped}}

    @property
    def _settled(self) -> bool:
        return self.settled and self.scene.network().is_lateral

    def nominal(self, name: str) -> tuple[float, ...]:
        """Nominal values of a parameter at each of its paths."""
        known = self.scene.parameters()
        return tuple(float(known[path].value) for path in self.knowledge[name].paths)

    def trials(self, record: Record) -> tuple[Trial, ...]:
        """The record laid beside the scene.  Raises RecordError where columns are missing or the clock is uneven."""
        columns = self.columns_of(record)
        times = record.times
        every = even_step(record)
        before = round(self.run_in / every)
        moments = times - times[0] + before * every
        scene = self.scene.replacing({item.path: item.law(moments, columns[name]) for name, item in self.inputs.items()})
        network = scene.network()
        unseen = np.full(before, np.nan)
        speeds = speeds_with_the_rest(network, self.speeds)
        return (
            Trial(
                name=record.name,
                scene=scene,
                every=every,
                columns={name: np.concatenate((unseen, columns[name])) for name in self.measured if name in columns},
                measured={name: item for name, item in self.measured.items() if name in columns},
                held_out=np.concatenate((np.zeros(before, bool), held_out(len(times), record.name))),
                angles=angles_with_the_rest(network, self.angles),
                speeds=speeds,
                settled=self._settled,
                ringing=self._ringing(speeds, before),
            ),
        )

    def _ringing(self, speeds: Mapping[str, float], before: int) -> Ringing | None:
        """Free vibration of a rotor line that may have been in rotation when a record began."""
        network = self.scene.network()
        if not before or not network.is_lateral:
            return None
        turning = [body for body in network.bodies if not body.lateral and body.ratio != 0.0 and body.name in speeds]
        return Ringing(next((abs(speeds[body.name] / body.ratio) for body in turning), 0.0), before)

    def planned(self, plan: Plan) -> tuple[Trial, ...]:
        """A record that has not been taken, laid beside the scene: what a planned experiment would show, measured columns zero.

        Raises ParameterError for an input that the bench has not, or for a bench that has none.
        """
        unknown = [name for name in plan.inputs if name not in self.inputs]
        if unknown or not self.inputs:
            known = ", ".join(self.inputs) or "none; a bench that is driven in another way overrides planned()"
            raise ParameterError(f"Plan {plan.name!r}: inputs {', '.join(unknown) or '(none)'}; this bench has {known}.")
        scene = self.scene.replacing({item.path: item.law(plan.times, plan.sampled(name)) for name, item in self.inputs.items()})
        network = scene.network()
        return (
            Trial(
                name=plan.name,
                scene=scene,
                every=plan.every,
                columns={name: np.zeros(plan.samples) for name in self.measured},
                measured=self.measured,
                held_out=np.zeros(plan.samples, bool),
                angles=angles_with_the_rest(network, self.angles),
                speeds=speeds_with_the_rest(network, self.speeds),
                settled=self._settled,
            ),
        )

    def menu(self) -> Sequence[Plan] | None:
        """Records that could be taken next, None for those that suit a motor with or without a load (experiment/menu.py)."""
        return None

    def columns_of(self, record: Record) -> dict[str, FloatArray]:
        """Values of the columns that this bench knows; all inputs must be there, and one measured column at least."""
        found = {
            name: np.asarray(record.channels[name].values, float) for name in (*self.measured, *self.inputs) if name in record.channels
        }
        missing = [name for name in self.inputs if name not in found]
        if missing or not any(name in found for name in self.measured):
            name = (missing or list(self.measured))[0]
            raise RecordError(
                f"Record {record.name!r} has no column {name!r}, which {'drives the scene' if missing else 'the bench measures'}."
                f" It was read with: {', '.join(record.channels)}. A column of another name is mapped when reading:"
                f" channels={{'its name': {name!r}}}, --channel 'its name'={name}."
            )
        units = units_of(self.scene.network())
        for name, item in self.measured.items():
            wanted = units.get(item.channel)
            if name in found and wanted is not None and record.channels[name].unit != wanted:
                raise RecordError(
                    f"Record {record.name!r}: column {name!r} is in {record.channels[name].unit_as_read}, but {item.channel!r}, which it"
                    f" measures, is in {wanted}. Correct the unit when reading: units={{{name!r}: ...}}."
                )
        return found


def units_of(network: Network) -> dict[str, str]:
    """Unit of every channel of a run."""
    units = {channel.name: channel.unit for channel in network.channels}
    shaken = {f"{c.name}_acceleration": f"{c.unit}/s^2" for c in network.channels if c.factors is not None}
    return units | shaken


def even_step(record: Record) -> float:
    """Sample time [s] of a record.  Raises RecordError for fewer than 64 samples or an uneven clock."""
    if len(record) < 64:
        raise RecordError(f"Record {record.name!r} has {len(record)} samples; a diagnosis needs at least 64.")
    steps = np.diff(record.times)
    every = float((record.times[-1] - record.times[0]) / (len(record) - 1))
    if not np.all(np.abs(steps - every) <= 1e-3 * every):
        raise RecordError(
            f"Record {record.name!r} is not sampled evenly (steps from {steps.min():.6g} s to {steps.max():.6g} s);"
            " repair or resample it first (see records.md)."
        )
    return every


def held_out(samples: int, name: str) -> np.ndarray[Any, np.dtype[np.bool_]]:
    """Blocks of a record that no fit sees: one of four, spread evenly; which ones depends on the record's name."""
    block = np.arange(samples) * BLOCKS // samples
    period = round(1.0 / HELD_OUT)
    first = sum(name.encode()) % (period - 1) + 1
    return np.asarray(block % period == first)
