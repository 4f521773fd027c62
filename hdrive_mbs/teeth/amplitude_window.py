"""The range of w0 in which a stage works: the gate of the deformation."""

from __future__ import annotations

from dataclasses import dataclass

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.teeth.clearance import clearances
from hdrive_mbs.teeth.explain import explain_clearances
from hdrive_mbs.teeth.stage import Stage


@dataclass(frozen=True, kw_only=True)
class AmplitudeWindow:
    """Range of w0 [m] around the present one without interference, and what stops it at each end."""

    low: float
    high: float
    reason_low: str
    reason_high: str


def amplitude_window(stage: Stage, tolerance: float = 1e-7) -> AmplitudeWindow:
    """Bisect from the present w0 down to half and up to twice of it; all else stays.

    tolerance : m
    Raises ParameterError when the present w0 interferes itself.
    """
    now = stage.deformation.on_major_axis
    problem = _problem(stage, now)
    if problem:
        raise ParameterError(f"There is no window around w0 = {1e3 * now:g} mm. {problem}")
    ends = []
    for limit in (0.5 * now, 2.0 * now):
        good, bad, reason = now, limit, _problem(stage, limit)
        if not reason:
            ends.append((limit, "edge of the search"))
            continue
        while abs(bad - good) > tolerance:
            middle = 0.5 * (good + bad)
            found = _problem(stage, middle)
            if found:
                bad, reason = middle, found
            else:
                good = middle
        ends.append((good, reason))
    (low, why_low), (high, why_high) = ends
    return AmplitudeWindow(low=low, high=high, reason_low=why_low, reason_high=why_high)


def _problem(stage: Stage, amplitude: float) -> str:
    """Why this w0 does not work, or nothing."""
    try:
        changed = stage.replacing(deformation=stage.deformation.scaled(amplitude))
    except ParameterError as error:
        return str(error)
    result = clearances(changed, 360)
    return explain_clearances(result) if result.interferes else ""
