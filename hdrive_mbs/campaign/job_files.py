"""Finished jobs in a folder, one file each, written whole or not at all."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from hdrive_mbs.analysis.result import Result
from hdrive_mbs.campaign.outcome import Outcome
from hdrive_mbs.campaign.points import Point
from hdrive_mbs.errors import FileFormatError


@dataclass(frozen=True, kw_only=True, eq=False)
class FinishedJob(Result):
    """One finished job.

    parameters : the point
    values : what the function returned
    seconds : of wall time [s]
    worker : machine and process
    attempts : 1 more than the number of workers that were lost with it
    """

    parameters: Mapping[str, Any]
    values: Mapping[str, Any]
    seconds: float
    worker: str
    attempts: int

    def columns(self) -> dict[str, np.ndarray]:
        numbers = {name: value for name, value in self.values.items() if isinstance(value, (str, bool, int, float))}
        return {name: np.array([value]) for name, value in {**self.parameters, **numbers}.items()}


@dataclass(frozen=True, kw_only=True)
class JobFiles:
    """The folder ``jobs`` of a campaign; None for a campaign that keeps nothing."""

    folder: Path | None

    def read(self, key: str) -> Outcome | None:
        """A finished job; None where there is none, or its file is damaged."""
        if self.folder is None or not self._path(key).exists():
            return None
        try:
            job = FinishedJob.load(self._path(key))
        except FileFormatError:
            return None  # it is run again, and the file written anew
        return Outcome(values=job.values, seconds=job.seconds, worker=job.worker, versions=job.versions, attempts=job.attempts)

    def write(self, key: str, settings: Mapping[str, Any], point: Point, outcome: Outcome) -> None:
        """Keep a finished job; one that failed is not kept.

        settings : of the function, as the campaign has them.  The scene stands in the campaign's own file alone: put
            together anew for each job that is found, it would take longer than many a job
        """
        if self.folder is None or outcome.values is None:
            return
        FinishedJob(
            scene=None,
            status="complete",
            settings={**settings, "key": key},
            versions=outcome.versions,
            parameters=dict(point),
            values=outcome.values,
            seconds=outcome.seconds,
            worker=outcome.worker,
            attempts=outcome.attempts,
        ).save(self._path(key))

    def _path(self, key: str) -> Path:
        assert self.folder is not None
        return self.folder / "jobs" / f"{key}.npz"
