"""The converged run-ups of one line by each model, set against that of the full model."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.signal import butter, sosfiltfilt

from benchmarks.bearings.cases import FULL
from benchmarks.bearings.run_up import ROTORS, RunUp
from benchmarks.bearings.steady import Steady, bands

FloatArray = npt.NDArray[np.float64]

RIPPLE_LIMIT = 300.0
"""Frequency [rad/s] below which the unbalance moves the spin near the first critical speed: spin less whirl."""

WINDOW = 0.25
"""Half of the time around the passage of the peak in which that is looked at [s]."""


def ripple(run: RunUp, rotor: str = "rotor_1") -> tuple[FloatArray, FloatArray]:
    """Times [s] and speed of the rotor about its trend [rad/s] around the largest peak, torsional modes filtered out.

    The start makes the shaft vibrate in torsion (965 rad/s and more, for ever without shaft damping), alike in all
    models; what the passage adds is the low-frequency part: the unbalance whirls at one speed and turns at another.
    """
    step = 1e-4
    middle = float(run.times[int(np.argmax(run.distance(rotor)))])
    whole = np.arange(run.times[0], run.times[-1], step)
    speed = np.interp(whole, run.times, run.speed[rotor])
    filtered = sosfiltfilt(butter(4, RIPPLE_LIMIT * step / np.pi, output="sos"), speed - np.polyval(np.polyfit(whole, speed, 1), whole))
    inside = np.abs(whole - middle) <= WINDOW
    times = whole[inside]
    return times, filtered[inside] - np.polyval(np.polyfit(times, filtered[inside], 1), times)


def compared(histories: Mapping[str, RunUp], full: Steady) -> dict[str, Any]:
    """Model -> deviations of its run-up from that of the full model.

    bands : band -> rotor -> rms of the difference of the distances from the axis at equal speeds over their rms
    ripple : half the peak-to-peak value of the spin about its trend around the peak [rad/s]
    """
    exact = histories[FULL]
    found: dict[str, Any] = {}
    for model, run in histories.items():
        parts: dict[str, Any] = {}
        for name, inside in bands(full).items():
            speeds = np.linspace(full.speeds[inside][0], full.speeds[inside][-1], 4000)
            speeds = speeds[np.interp(speeds, full.speeds, inside.astype(float)) > 0.5]
            parts[name] = {}
            for rotor in ROTORS:
                a, b = (one.over_speed(one.distance(rotor), rotor, speeds) for one in (run, exact))
                known = np.isfinite(a) & np.isfinite(b)
                parts[name][rotor] = float(np.sqrt(np.mean((a - b)[known] ** 2) / np.mean(b[known] ** 2))) if known.any() else None
        found[model] = {"bands": parts, "ripple": 0.5 * float(np.ptp(ripple(run)[1]))}
    return found
