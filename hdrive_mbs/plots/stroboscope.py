"""Which moments of a run an animation shows, so that the eye sees a fast shaft turn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.plots.look import number
from hdrive_mbs.signals import FloatArray, TimeHistory

SEEN = np.pi / 6.0
"""Turn from frame to frame up to which the eye follows a mark."""

STEP = np.pi / 12.0
"""Turn from frame to frame under the stroboscope."""


@dataclass(frozen=True)
class Moments:
    """Times of the frames [s], rising, and how they were chosen, in words."""

    times: FloatArray
    note: str


def check_window(times: FloatArray, window: tuple[float, float] | None) -> tuple[float, float]:
    """Start and end [s]; the whole run for None.  Raises ParameterError for a window outside it."""
    first, last = float(times[0]), float(times[-1])
    if window is None:
        return first, last
    start, end = (float(value) for value in window)
    if not first <= start < end <= last * (1.0 + 1e-12):
        raise ParameterError(f"times = ({start:g}, {end:g}) s: must rise and lie in the run, from {first:g} s to {last:g} s.")
    return start, min(end, last)


def moments(angle: TimeHistory, start: float, end: float, count: int, seconds: float) -> Moments:
    """Times between start and end [s] for a shaft of this angle [rad], shown in that many seconds.

    If the shaft turns by less than SEEN from frame to frame the frames are evenly spaced.  Else they are those of a
    stroboscope: near each evenly spaced time the moment within one turn at which the shaft stands STEP further on than in
    the frame before.  Every frame shows a true state; only the turns between are left out.
    """
    even = np.linspace(start, end, count)
    at = angle.at(even)
    if count < 2 or float(np.max(np.abs(np.diff(at)))) <= SEEN:
        return Moments(even, _slowed(end - start, seconds))
    sense = 1.0 if at[-1] >= at[0] else -1.0
    risen = np.maximum.accumulate(sense * angle.values)
    shown, turned = even.copy(), sense * at
    mark = turned[0]
    for k in range(1, count):
        mark += np.clip(turned[k] - turned[k - 1], -STEP, STEP)
        wanted = mark + 2.0 * np.pi * np.round((turned[k] - mark) / (2.0 * np.pi))
        if risen[0] < wanted < risen[-1]:
            shown[k] = np.interp(wanted, risen, angle.times)
    shown = np.clip(np.maximum.accumulate(shown), start, end)
    return Moments(shown, f"stroboscope: true states, at most {np.degrees(STEP):.0f}° apart, whole turns between left out")


def _slowed(duration: float, seconds: float) -> str:
    factor = seconds / duration
    if abs(factor - 1.0) < 0.01:
        return "real time"
    return f"slowed down {number(factor)} times" if factor > 1.0 else f"{number(1.0 / factor)} times as fast"
