"""A record that has not been taken yet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import ParameterError

FloatArray = npt.NDArray[np.float64]

Course = tuple[Sequence[float] | FloatArray, Sequence[float] | FloatArray]
"""Times and values."""
LEAST = 64
"""Samples of a plan; a record with fewer cannot be diagnosed."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Plan:
    """What would drive a bench, and how it would be recorded.

    name : of the record;  duration, every : its length and its sample time [s]
    inputs : column -> (times [s] from the start of the record, values); straight lines between, constant outside, zero
        for an input that is left out
    """

    name: str
    inputs: Mapping[str, Course]
    duration: float
    every: float

    def __post_init__(self) -> None:
        if not (self.every > 0.0 and np.isfinite(self.duration) and self.samples >= LEAST):
            raise ParameterError(
                f"Plan {self.name!r}: {self.duration:g} s sampled every {self.every:g} s; both must be greater than 0 and give {LEAST}"
                " samples at least."
            )
        for column, (times, values) in self.inputs.items():
            at, given = np.asarray(times, float), np.asarray(values, float)
            if at.shape != given.shape or at.ndim != 1 or not len(at):
                raise ParameterError(f"Plan {self.name!r}, {column!r}: {at.size} times and {given.size} values; give as many of each.")
            if not (np.all(np.isfinite(at)) and np.all(np.isfinite(given)) and np.all(np.diff(at) > 0.0)):
                raise ParameterError(f"Plan {self.name!r}, {column!r}: times must rise, and times and values must be finite.")

    @property
    def samples(self) -> int:
        """Number of samples."""
        return round(self.duration / self.every)

    @property
    def times(self) -> FloatArray:
        """Times of the samples [s]."""
        return np.asarray(self.every * np.arange(self.samples), float)

    def sampled(self, column: str) -> FloatArray:
        """Values of an input at the samples."""
        if column not in self.inputs:
            return np.zeros(self.samples)
        times, values = self.inputs[column]
        return np.asarray(np.interp(self.times, np.asarray(times, float), np.asarray(values, float)), float)
