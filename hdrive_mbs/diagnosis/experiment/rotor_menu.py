"""Plans for a rotor line whose speed is controlled, with or without a hammer at some of its places.

From rest: a slow run-up, a dwell at half of each critical speed (where twice the speed meets the resonance, and a crack or
misalignment shows), a coast-down, and blows of a hammer at standstill.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from hdrive_mbs.diagnosis.experiment.plan import Course, FloatArray, Plan
from hdrive_mbs.errors import ParameterError

RISE, DWELL = 0.3, 0.3
"""Of a record: the time a coast-down takes to its top speed, and a dwell to its speed."""
BLOWS = 3
"""Of the hammer in a record, evenly apart."""


def rotor_menu(
    speed: str,
    *,
    top: float,
    seconds: float,
    every: float,
    critical: Sequence[float] = (),
    hammers: Mapping[str, str] | None = None,
    blow: float = 0.0,
    blow_time: float = 3e-3,
) -> tuple[Plan, ...]:
    """Plans of one length for a bench with these inputs.

    speed : column of the speed reference;  top : largest speed [rad/s];  critical : speeds [rad/s], those up to twice top count
    seconds, every : length and sample time of the records [s]
    hammers : column of a force -> place that it hits, for the name;  blow, blow_time : peak [N] and length [s], a half sine

    Raises ParameterError for a top speed that is not above 0, or a hammer without force or shorter than four samples.
    """
    if not top > 0.0:
        raise ParameterError(f"top = {top:g} rad/s must be greater than 0.")
    if hammers and not (blow > 0.0 and blow_time >= 4.0 * every):
        raise ParameterError(
            f"A blow of {blow:g} N over {blow_time:g} s, sampled every {every:g} s: give a force above 0 and four samples at least."
        )

    def turning(name: str, shares: Sequence[float], speeds: Sequence[float]) -> Plan:
        course: Course = ([seconds * share for share in shares], speeds)
        return Plan(name=name, inputs={speed: course}, duration=seconds, every=every)

    plans = [turning("slow run-up", (0.0, 0.02, 0.98), (0.0, 0.0, top))]
    for value in critical:
        if 0.0 < value <= 2.0 * top:
            plans.append(turning(f"dwell at half of {value:.4g} rad/s", (0.0, DWELL), (0.0, 0.5 * value)))
    plans.append(turning("coast-down", (0.0, RISE, RISE + 0.05, 1.0), (0.0, top, top, 0.0)))
    times: FloatArray = np.asarray(every * np.arange(round(seconds / every)), float)
    for column, place in (hammers or {}).items():
        since = (times - 0.02 * seconds) % (seconds / BLOWS)
        force = np.where((times >= 0.02 * seconds) & (since < blow_time), blow * np.sin(np.pi * since / blow_time), 0.0)
        plans.append(Plan(name=f"hammer at {place}", inputs={column: (times, force)}, duration=seconds, every=every))
    return tuple(plans)
