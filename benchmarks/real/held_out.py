"""What a scene leaves on a record that no fit of any kind has seen."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

import hdrive_mbs as hm
from benchmarks.real.floor import Floor
from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.records.record import Record

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Unseen:
    """Columns of a record and what is left of them, an unknown offset taken out of each where the bench has one.

    measured, simulated : by column;  rms : of what is left, in the column's unit
    """

    measured: Mapping[str, FloatArray]
    simulated: Mapping[str, FloatArray]
    rms: Mapping[str, float]


def measured(channel: str, floor: Floor, *, offset: float = 0.0) -> Measured:
    """A column with the floor of its class of models as noise."""
    return Measured(channel=channel, noise=floor.white, coloured=(floor.coloured, floor.kept), offset=offset)


def unseen(bench: Bench, scene: hm.Scene, record: Record, step: float, since: float = 0.0) -> Unseen:
    """The record under a scene as it is: nothing is fitted but offsets.

    since : time from which what is left counts [s]
    """
    (trial,) = replace(bench, scene=scene).trials(record)
    (own,) = Simulator([trial], step).columns(Hypothesis(()), np.zeros(0))
    if not own:
        raise hm.AnalysisError(f"{scene.name!r} cannot be simulated through record {record.name!r}; try a shorter step than {step:g} s.")
    left = {}
    simulated = {}
    counts = trial.times >= since
    for column, values in trial.columns.items():
        moved = float(np.nanmean((values - own[column])[counts])) if bench.measured[column].offset > 0.0 else 0.0
        simulated[column] = own[column] + moved
        left[column] = float(np.sqrt(np.nanmean((values - simulated[column])[counts] ** 2)))
    return Unseen(measured=trial.columns, simulated=simulated, rms=left)
