"""The step of a run-up: which critical speeds it meets, at what highest speed, and what a step may be then."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.analysis.unbalance.synchronous_whirl import CriticalSpeed
from hdrive_mbs.errors import SceneError

NEAR = 1.1
"""A critical speed up to this multiple of the highest speed is met: its resonance has begun."""

AT_CRITICAL = 1.75
BESIDE = 24.0
"""(w h)^2 over these is the relative error that is allowed for at and away from critical speeds."""

LESSER = 4.0
"""Multiple of the accuracy that a peak may be off where another critical speed gives the rotor a larger one."""

LATE = 2.157
"""The envelope of an undamped resonance that is swept with the acceleration a is highest at w + 2.157 sqrt(a): where
|C(u) + i S(u) + (1 + i)/2|, C and S the Fresnel integrals, is largest, u = 1.217, w = w_critical + u sqrt(pi a)."""

FEWEST = 200
"""Steps that a run has at least."""


@dataclass(frozen=True)
class ChosenStep:
    """A step [s], the tolerance of Newton's method that belongs to it, and the reason in words."""

    step: float
    newton_tolerance: float
    reason: str


def choose_step(
    fastest: Mapping[str, float],
    ratios: Mapping[str, float],
    criticals: Sequence[CriticalSpeed],
    duration: float,
    accuracy: float,
    geared: float = 0.0,
) -> ChosenStep:
    """The longest step of the trapezoidal rule that keeps peaks within ``accuracy`` (relative).

    fastest : highest speed [rad/s] of each spin that moves laterally too;  ratios : speed ratios of spins
    geared : highest speed [rad/s] of anything else that turns, a motor before a reduction gear for one

    The rule answers an excitation of frequency w as the line would at  (2/h) tan(w h/2) = w (1 + (w h)^2/12): critical
    speeds come out (w h)^2/12 too low, and a peak there with them.  Its amplitude goes with m e w^2/(c w), whose
    force is that of the lower speed: at least (w h)^2/6 too small.  As the spin gives way too, run-ups of a Jeffcott
    rotor (from just above capture to very fast) and of two_rotor_line are off by (w h)^2/2.3 or less with w the frequency
    at their peak, which a run passes late, and with cubic springs in the bearings by up to (w h)^2/1.9, so

        (w h)^2/1.75 <= accuracy,  w = w_critical + 2.157 sqrt(a)     at each critical speed that is met,

    a the mean acceleration, and w no more than the highest speed.

    Where another critical speed gives every rotor a larger peak (reach x amplification, the latter 1/(2 damping ratio),
    or 1.2 w/sqrt(a) in a fast run-up), up to four times as much is allowed.  Away from critical speeds an amplitude is
    off by (w h)^2/6; there it may be four times the accuracy: (w h)^2/24 <= accuracy at the highest speed, at least
    40 steps a revolution at 1e-3.  What turns faster without lateral motion (a motor before a reduction gear, which
    excites with its own speed) counts like that too.
    """
    if not fastest:
        raise SceneError("Nothing in this scene turns.")
    top = max(fastest.values())
    reference = reference_speed(fastest, ratios)
    met = [item for item in criticals if item.speed <= NEAR * reference]
    limits = [(duration / FEWEST, f"a run has at least {FEWEST} steps")]
    for item, share in zip(met, _allowed(met, reference / duration), strict=True):
        order = item.frequency / item.speed
        late = item.frequency + LATE * math.sqrt(order * reference / duration)
        late = max(item.frequency, min(late, order * reference))
        step = math.sqrt(AT_CRITICAL * share * accuracy) / late
        name = f"w = {late:.4g} rad/s, where a run meets the critical speed of {item.frequency:.4g} rad/s"
        limits.append((step, f"(w h)^2/{AT_CRITICAL:g} <= {share * accuracy:.3g} at {name}"))
    if top > 0.0:
        name = f"at the highest speed w = {top:.4g} rad/s"
        limits.append((math.sqrt(BESIDE * accuracy) / top, f"(w h)^2/24 <= {accuracy:.3g} {name}"))
        if not met:
            limits.append((math.sqrt(AT_CRITICAL * accuracy) / top, f"(w h)^2/{AT_CRITICAL:g} <= {accuracy:.3g} {name}"))
    if geared > top:
        limits.append(
            (
                math.sqrt(BESIDE * accuracy) / geared,
                f"(w h)^2/24 <= {accuracy:.3g} at the highest speed before a gear, w = {geared:.4g} rad/s",
            )
        )
    step, reason = min(limits)
    count = math.ceil(duration / step)
    return ChosenStep(duration / count, min(max(0.01 * accuracy, 1e-10), 1e-5), reason)


def reference_speed(fastest: Mapping[str, float], ratios: Mapping[str, float]) -> float:
    """Highest speed of the reference shaft [rad/s]."""
    return max((speed / abs(ratios[name]) for name, speed in fastest.items() if ratios.get(name)), default=0.0)


def _allowed(met: Sequence[CriticalSpeed], acceleration: float) -> list[float]:
    """1 to 4 for each critical speed: how much smaller its peaks are than the largest of each rotor."""
    if not met or not met[0].reach:
        return [1.0] * len(met)
    rows = []
    for item in met:
        swept = acceleration * item.frequency / item.speed
        amplification = min(0.5 / max(item.damping_ratio, 1e-9), 1.2 * item.frequency / math.sqrt(swept) if swept > 0.0 else math.inf)
        rows.append(np.array(item.reach) * amplification)
    sizes = np.array(rows)
    largest = np.max(sizes, axis=0)
    share = np.max(sizes / np.where(largest > 0.0, largest, 1.0), axis=1)
    return [float(value) for value in np.clip(1.0 / np.maximum(share, 1e-12), 1.0, LESSER)]
