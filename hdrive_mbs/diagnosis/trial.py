"""One record laid beside the scene that is to reproduce it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.ringing import Ringing
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.scene import Scene

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Trial:
    """A scene with the inputs of one record in it, and what was measured.

    name : of the record, and of the view where one record has several
    scene : the nominal scene, driven as the record was
    every : sample time [s]; samples are at 0, every, 2 every, ...
    columns : measured values by column, each of shape (n,); nan where there is none
    measured : what each of these columns is
    held_out : samples that no fit may see, shape (n,)
    angles, speeds : of bodies at the start [rad, m, rad/s, m/s]; 0 if not given
    settled : whether lateral coordinates start where the line, with the very parameters and effects of a run, stays at rest;
        forces of time are those at the start of the first of the trials that share a scene
    ringing : free vibration of unknown size that the columns begin with
    motions : places that follow a measured angle, by name, whatever turns them in the scene: forward angle over time
    """

    name: str
    scene: Scene
    every: float
    columns: Mapping[str, FloatArray]
    measured: Mapping[str, Measured]
    held_out: npt.NDArray[np.bool_]
    angles: Mapping[str, float] = field(default_factory=dict)
    speeds: Mapping[str, float] = field(default_factory=dict)
    settled: bool = False
    ringing: Ringing | None = None
    motions: Mapping[str, Callable[[Value], Value]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if set(self.columns) != set(self.measured):
            raise ParameterError(f"Trial {self.name!r}: columns {sorted(self.columns)} and measured {sorted(self.measured)} differ.")
        for name, values in self.columns.items():
            if len(values) != self.samples:
                raise ParameterError(f"Trial {self.name!r}: column {name!r} has {len(values)} samples, held_out {self.samples}.")

    @property
    def samples(self) -> int:
        """Number of samples."""
        return len(self.held_out)

    @property
    def times(self) -> FloatArray:
        """Times of the samples [s]."""
        return np.asarray(self.every * np.arange(self.samples), float)

    @cached_property
    def largest(self) -> Mapping[str, float]:
        """The largest value that was measured of each column, without its sign, in the units of the columns."""
        return {name: float(np.max(np.abs(values[np.isfinite(values)]), initial=0.0)) for name, values in self.columns.items()}
