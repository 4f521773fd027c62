"""Jobs one after the other in the caller's own process: for short work and for a debugger."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from hdrive_mbs.campaign.outcome import Outcome, run_job
from hdrive_mbs.campaign.points import Point


def run_here(function: Callable[[dict[str, Any]], Any], jobs: Mapping[str, Point]) -> Iterator[tuple[str, Outcome]]:
    """Key and outcome of each job, in order."""
    for key, point in jobs.items():
        yield key, run_job(function, point)
