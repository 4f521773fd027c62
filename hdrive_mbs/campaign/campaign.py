"""What a campaign gives: every point with its figures, in the order of the points."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.result import Result
from hdrive_mbs.errors import unknown_place


@dataclass(frozen=True, kw_only=True, eq=False)
class Campaign(Result):
    """A finished or interrupted campaign of n jobs.

    parameters : name -> value at each point, (n,)
    units : unit of each parameter, "" where it has none
    values : what the function returned, one mapping per point; empty where a job is missing or failed
    done : whether a job is finished, (n,)
    failures : of each job that failed: index, parameters, error, traceback, attempts
    seconds : wall time of each job in its worker [s], NaN where it is not finished
    attempts : how often each job was begun, 0 where it was not
    reused : number of points whose job was found finished in the folder
    """

    parameters: Mapping[str, np.ndarray]
    units: Mapping[str, str]
    values: tuple[Mapping[str, Any], ...]
    done: npt.NDArray[np.bool_]
    failures: tuple[Mapping[str, Any], ...]
    seconds: npt.NDArray[np.float64]
    attempts: npt.NDArray[np.int64]
    reused: int

    def __len__(self) -> int:
        return len(self.values)

    def __getitem__(self, name: str) -> np.ndarray:
        """A parameter or figure at every point: numbers with NaN, texts with "" where a job has none."""
        columns = {**self.columns(), **self.parameters}
        if name in columns:
            return columns[name]
        raise unknown_place("column", name, columns, "This campaign")

    def columns(self) -> dict[str, np.ndarray]:
        """Parameters, then every figure that is a single number or text, then what became of the job."""
        named = {f"{name} [{unit}]" if (unit := self.units.get(name)) else name: column for name, column in self.parameters.items()}
        found: dict[str, list[Any]] = {}
        for index, values in enumerate(self.values):
            for name, value in values.items():
                if isinstance(value, (str, bool, int, float)):
                    found.setdefault(name, [None] * len(self))[index] = value
        failed = {int(failure["index"]): str(failure["error"]) for failure in self.failures}
        words = ["done" if self.done[k] else f"failed: {failed[k]}" if k in failed else "not run" for k in range(len(self))]
        table = dict(named)
        for name, items in found.items():
            table[f"{name} (result)" if name in named or name == "job" else name] = _column(items)
        return {**table, "job": np.array(words)}


def _column(items: list[Any]) -> np.ndarray:
    """An array of one kind, with NaN or "" for what is missing."""
    if any(isinstance(item, str) for item in items):
        return np.array(["" if item is None else str(item) for item in items])
    if None in items or any(isinstance(item, float) for item in items):
        return np.array([np.nan if item is None else float(item) for item in items])
    return np.array(items)
