"""Critical speeds and steady unbalance response of a line with each model, and how far they are from the full one."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

import hdrive_mbs as hm
from benchmarks.bearings.cases import FINAL
from benchmarks.bearings.run_up import ROTORS
from hdrive_mbs.analysis.unbalance.response_peaks import ResponsePeak
from hdrive_mbs.analysis.unbalance.synchronous_whirl import critical_speeds
from hdrive_mbs.analysis.unbalance.unbalance_response import unbalance_response
from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices
from hdrive_mbs.analysis.whirl.rotor_point import rotor_point
from hdrive_mbs.analysis.whirl.whirl_campbell import WhirlCampbell, campbell

FloatArray = npt.NDArray[np.float64]

NEAR = 0.15
"""A peak belongs to a critical speed within this share of it."""

CAMPBELL_SPEEDS = np.linspace(0.0, 1300.0, 53)

OFF = 0.15
"""A speed counts as away from a critical speed by more than this share of it."""

BELOW, BETWEEN, ABOVE = "below the criticals", "between them", "above them"


@dataclass(frozen=True, eq=False)
class Steady:
    """One model of one line.

    criticals : undamped critical speeds that unbalance excites [rad/s], ascending
    campbell : damped frequencies over speed
    speeds : rad/s;  amplitude : rotor -> distance of the geometric centre from the axis [m], 0-peak
    peaks : rotor -> maxima over the speed
    """

    criticals: tuple[float, ...]
    campbell: WhirlCampbell
    speeds: FloatArray
    amplitude: Mapping[str, FloatArray]
    peaks: Mapping[str, tuple[ResponsePeak, ...]]

    @property
    def damped_criticals(self) -> tuple[float, ...]:
        """Where forward whirl meets the speed, with damping [rad/s]."""
        forward = [whirl == "forward" for whirl in self.campbell.critical_whirl]
        return tuple(self.campbell.critical_speeds[forward].tolist())

    def peak(self, rotor: str, k: int) -> ResponsePeak | None:
        """The highest maximum of a rotor near critical speed number k (0 is the first)."""
        if k >= len(self.criticals):
            return None
        at = self.criticals[k]
        near = [peak for peak in self.peaks[rotor] if abs(peak.speed / at - 1.0) <= NEAR]
        return max(near, key=lambda peak: peak.amplitude, default=None)


def forward_criticals(scene: hm.Scene, highest: float = 1500.0) -> tuple[float, ...]:
    """Undamped critical speeds that unbalance excites [rad/s], up to a limit."""
    lines = LineMatrices(scene.network())
    slower, faster = (rotor_point(scene, speed, lines=lines) for speed in (100.0, FINAL))
    return tuple(item.speed for item in critical_speeds(lines, slower, faster) if item.speed <= highest)


def steady(scene: hm.Scene, speeds: FloatArray) -> Steady:
    """Critical speeds and response over speeds [rad/s]."""
    response = unbalance_response(scene, speeds, progress=False)
    return Steady(
        criticals=forward_criticals(scene),
        campbell=campbell(scene, CAMPBELL_SPEEDS, progress=False),
        speeds=speeds,
        amplitude={rotor: response[rotor].major for rotor in ROTORS},
        peaks={rotor: tuple(peak for peak in response.peaks if peak.place == rotor) for rotor in ROTORS},
    )


def bands(full: Steady) -> dict[str, FloatArray]:
    """Which speeds lie 20 % below the first critical speed, above the last one met, or between, 15 % off every one.

    A band without speeds is left out.
    """
    speeds, met = full.speeds, [w for w in full.criticals if w <= FINAL]
    away = np.all([np.abs(speeds / w - 1.0) > OFF for w in full.criticals], axis=0) & (speeds <= FINAL)
    found = {
        BELOW: away & (speeds > 0.2 * met[0]) & (speeds < 0.8 * met[0]),
        BETWEEN: away & (speeds > 1.2 * met[0]) & (speeds < met[-1]),
        ABOVE: away & (speeds > met[-1]),
    }
    return {name: inside for name, inside in found.items() if inside.any()}


def deviation(found: FloatArray, exact: FloatArray) -> float:
    """Largest relative deviation of an amplitude, over the exact one or a tenth of its mean."""
    return float(np.max(np.abs(found - exact) / np.maximum(exact, 0.1 * np.mean(exact))))


def against(model: Steady, full: Steady) -> dict[str, Any]:
    """Signed relative deviations of critical speeds and peaks, largest ones over the bands."""
    count = min(sum(w <= FINAL for w in full.criticals), len(model.criticals))
    peaks: dict[str, Any] = {}
    for rotor in ROTORS:
        pairs = [(model.peak(rotor, k), full.peak(rotor, k)) for k in range(count)]
        peaks[rotor] = [None if a is None or b is None else a.amplitude / b.amplitude - 1.0 for a, b in pairs]
    parts: dict[str, Any] = {}
    for name, inside in bands(full).items():
        parts[name] = {rotor: deviation(model.amplitude[rotor][inside], full.amplitude[rotor][inside]) for rotor in ROTORS}
    last = {rotor: float(np.interp(FINAL, model.speeds, model.amplitude[rotor] / full.amplitude[rotor])) - 1.0 for rotor in ROTORS}
    return {
        "critical_speeds": [model.criticals[k] / full.criticals[k] - 1.0 for k in range(count)],
        "damped_critical_speeds": [b / a - 1.0 for a, b in zip(full.damped_criticals, model.damped_criticals, strict=False) if a <= FINAL],
        "peaks": peaks,
        "bands": parts,
        "at_the_final_speed": last,
        "damping_ratio": [_damping(model, k) for k in range(count)],
        "damping_ratio_of_full": [_damping(full, k) for k in range(count)],
    }


def _damping(of: Steady, k: int) -> float | None:
    """By the half-power width of rotor 1."""
    peak = of.peak(ROTORS[0], k)
    return None if peak is None or not math.isfinite(peak.quality) else 0.5 / peak.quality
