"""Jobs on an executor of the caller's: anything with the ``submit`` of concurrent.futures."""

from __future__ import annotations

import concurrent.futures
from collections.abc import Iterator, Mapping
from typing import Any

from hdrive_mbs.campaign.outcome import Outcome, lost, run_pickled
from hdrive_mbs.campaign.points import Point


def run_on_executor(executor: Any, task: bytes, jobs: Mapping[str, Point]) -> Iterator[tuple[str, Outcome]]:
    """Key and outcome of each job, as they are finished.

    The executor is the caller's, so it is neither mended nor shut down: jobs that it loses are reported as lost.
    """
    keys = {executor.submit(run_pickled, task, point): key for key, point in jobs.items()}
    try:
        for future in concurrent.futures.as_completed(keys):
            try:
                yield keys[future], future.result()
            except Exception as error:  # cancelled, broken, ...: what the function itself raises is in its outcome
                yield keys[future], lost(f"{type(error).__name__}: {error}", 1)
    finally:
        for future in keys:
            future.cancel()
