"""The step of a run-up: how fast the line can get, which critical speeds it meets, what a step may be then."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.analysis.synchronous_whirl import CriticalSpeed
from hdrive_mbs.analysis.time_response import initial_values
from hdrive_mbs.engine.assembly import LoweringWarning, assemble
from hdrive_mbs.engine.simulation import run
from hdrive_mbs.engine.solvers import Trapezoidal
from hdrive_mbs.errors import SceneError, SimulationError
from hdrive_mbs.network.network import Network

STEPS = 2000
"""Steps of the run that only turns."""

NEAR = 1.1
"""A critical speed up to this multiple of the highest speed is met: its resonance has begun."""

AT_CRITICAL = 3.0
BESIDE = 24.0
FEWEST = 200
"""Steps that a run has at least."""


@dataclass(frozen=True)
class ChosenStep:
    """A step [s], the tolerance of Newton's method that belongs to it, and the reason in words."""

    step: float
    newton_tolerance: float
    reason: str


def fastest_speeds(network: Network, duration: float, initial_speed: float) -> Mapping[str, float]:
    """Highest speed of each spin over a run [rad/s, size], of the line as it turns without lateral motion.

    Whirl only takes energy from the spin, so nothing turns faster than this (but for torsional vibration).
    Bearing friction is left out: an upper limit again.  Raises SimulationError where even this run fails.
    """
    turning = network.turning()
    times = np.linspace(0.0, duration, STEPS + 1)
    fastest = {item.name: float(np.max(np.abs(item.speed(times)))) for item in network.motions if item.name != "ground"}
    if not turning.bodies:
        return fastest
    steps = STEPS
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LoweringWarning)  # the run itself says it
        assembly = assemble(turning)
        starts = initial_values(turning, initial_speed, {})
        while True:
            solver = Trapezoidal(step=duration / steps, newton_tolerance=1e-6)
            try:
                raw = run(assembly, duration=duration, solver=solver, **starts)
                break
            except SimulationError:
                steps *= 10
                if steps > 100 * STEPS:
                    raise
    return fastest | {name: float(np.max(np.abs(speed))) for name, speed in raw.speeds.items()}


def choose_step(
    fastest: Mapping[str, float], ratios: Mapping[str, float], criticals: Sequence[CriticalSpeed], duration: float, accuracy: float
) -> ChosenStep:
    """The longest step of the trapezoidal rule that keeps peaks within ``accuracy`` (relative).

    fastest, ratios : highest speed [rad/s] and speed ratio of each spin

    The rule answers an excitation of frequency w as the line would at  (2/h) tan(w h/2) = w (1 + (w h)^2/12): critical
    speeds come out (w h)^2/12 too low, and a peak there with them.  Its amplitude goes with m e w^2/(c w), whose
    force is that of the lower speed: at least (w h)^2/6 too small.  Run-ups of two_rotor_line and of a Jeffcott rotor
    show up to (w h)^2/3.5, as the spin gives way too, so

        (w h)^2/3 <= accuracy     at the highest critical speed that is met.

    Away from critical speeds an amplitude is off by (w h)^2/6, and at the highest speed four times the accuracy is
    allowed,  (w h)^2/24 <= accuracy,  which is at least 40 steps a revolution at 1e-3.
    """
    if not fastest:
        raise SceneError("Nothing in this scene turns.")
    top = max(fastest.values())
    reference = max((speed / abs(ratios[name]) for name, speed in fastest.items() if ratios.get(name)), default=top)
    met = [item for item in criticals if item.speed <= NEAR * reference]
    limits = [(duration / FEWEST, f"a run has at least {FEWEST} steps")]
    if met:
        frequency = max(item.frequency for item in met)
        limits.append((math.sqrt(AT_CRITICAL * accuracy) / frequency, f"(w h)^2/3 <= {accuracy:g} at the critical speed w = {frequency:.4g} rad/s"))
    elif top > 0.0:
        limits.append((math.sqrt(AT_CRITICAL * accuracy) / top, f"(w h)^2/3 <= {accuracy:g} at the highest speed w = {top:.4g} rad/s"))
    if top > 0.0:
        limits.append((math.sqrt(BESIDE * accuracy) / top, f"(w h)^2/24 <= {accuracy:g} at the highest speed w = {top:.4g} rad/s"))
    step, reason = min(limits)
    count = math.ceil(duration / step)
    return ChosenStep(duration / count, min(max(0.01 * accuracy, 1e-10), 1e-5), reason)
