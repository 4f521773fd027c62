"""Values of a time history between its samples."""

from __future__ import annotations

import numpy as np
import pytest

from hdrive_mbs.errors import AnalysisError
from hdrive_mbs.signals import TimeHistory


def history() -> TimeHistory:
    """3,200 steps of 0.5 ms added up one by one: the end is 1.5999999999999 s or so."""
    times = np.concatenate([[0.0], np.cumsum(np.full(3200, 5e-4))])
    return TimeHistory("speed", "rad/s", times, 3.0 * times, np.full(len(times), 3.0))


def test_times_that_were_added_up_in_another_order_lie_within_the_span() -> None:
    end = history().times[-1]
    for asked in (end * (1.0 + 1e-11), -1e-11 * end):
        assert history().at(asked) == pytest.approx(3.0 * asked, abs=1e-9)


def test_nothing_is_said_of_times_outside_of_the_span() -> None:
    for asked in (history().times[-1] + 1e-6, -1e-6):
        with pytest.raises(AnalysisError, match=r"speed is recorded from 0 s to 1\.6 s"):
            history().at(asked)
