"""A step that torsional vibrations are followed with: torque steps and shocks excite them far above the running speeds."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from hdrive_mbs.analysis.turning_alone import TurningAlone
from hdrive_mbs.errors import SimulationError
from hdrive_mbs.signals import FloatArray

OF_SPEEDS = 4.0
"""Multiple of the relative accuracy of amplitudes that speeds are computed with."""

SHORTEST = 4
"""A step is cut to a quarter at most where a run has many steps."""

CHEAP = 50_000
"""Steps that a run may have with a step that is cut further."""

SLOW = 1e-3
"""Share of the highest speed in the line that a spin counts as having at least: a housing hardly turns."""

SATURATED = 3.0
"""Two vibrations out of phase differ by twice their size; a difference this many times the limit cannot hide an error above it by much."""


@dataclass(frozen=True)
class TorsionalStep:
    """A step [s] and what is to be said of it (or nothing): why it was cut, or how far speeds are off and where."""

    step: float
    reason: str = ""
    remark: str = ""


def torsional_step(line: TurningAlone, step: float, allowed: float, newton_tolerance: float) -> TorsionalStep:
    """The given step of the trapezoidal rule, or a shorter one that the turning of the line asks for.

    allowed : error of a speed at any moment, of the highest speed of that spin (or of a thousandth of the highest in the line)

    The rule answers a vibration of frequency w at w (1 - (w h)^2/12): its size is kept, its phase drifts by w t (w h)^2/12.
    How far that takes the speeds off is found by running the turning alone, which takes a small part of the time of the
    whole line, with several steps: as the rule is of order 2, a run with the step h is off by a third of its difference
    from one with 2 h.  The step is halved until that is allowed, as far as that is affordable: what is excited and not damped
    drifts on, and no step is short enough for long.  Then it is left as given, and a remark says how far speeds are off.
    """
    if not line.bodies:
        return TorsionalStep(step)
    quarter = math.ceil(line.duration / (4.0 * step) - 1e-9)
    runs = [_run(line, n * quarter, newton_tolerance) for n in (1, 2)]
    if _worst(runs[0], runs[1]).share <= SATURATED * allowed:
        return TorsionalStep(step)
    runs.append(_run(line, 4 * quarter, newton_tolerance))
    if _worst(runs[1], runs[2]).share / 3.0 <= allowed:
        return TorsionalStep(step)
    first, cut = None, 1
    while cut < SHORTEST or 8 * cut * quarter <= CHEAP:
        cut *= 2
        runs.append(_run(line, 4 * cut * quarter, newton_tolerance))
        found = _worst(runs[-2], runs[-1])
        first = first or found
        if found.share / 3.0 <= allowed:
            reason = f"cut to 1/{cut}, as {_off(first, line)} in torsional vibration"
            return TorsionalStep(line.duration / (4 * cut * quarter), reason)
    assert first is not None
    return TorsionalStep(
        step,
        remark=f"torsional vibration is too quick for the step of {step:.3g} s: {_off(first, line)} at some moments, and not right with "
        f"{step / cut:.2g} s either; where that matters give a solver with a shorter step",
    )


@dataclass(frozen=True)
class _Difference:
    """The largest difference of a run and one with half the step: of that spin's highest speed, in rad/s, and whose it is."""

    share: float
    size: float
    name: str


def _off(found: _Difference, line: TurningAlone) -> str:
    """How far the coarser of the two runs is off, in words: of order 2, so by 4/3 of the difference."""
    if not math.isfinite(found.share):
        return "the turning of the line could not be followed"
    place = line.places.get(found.name, found.name)
    return f"the speed of {place} would be off by {4.0 / 3.0 * found.size:.2g} rad/s ({400.0 / 3.0 * found.share:.2g} % of its highest)"


Run = tuple[FloatArray, Mapping[str, FloatArray]]


def _run(line: TurningAlone, steps: int, newton_tolerance: float) -> Run | None:
    try:
        return line.speeds(steps, newton_tolerance)
    except SimulationError:
        return None


def _worst(coarse: Run | None, fine: Run | None) -> _Difference:
    if coarse is None or fine is None:
        return _Difference(math.inf, math.inf, "")
    found = [_Difference(0.0, 0.0, "")]
    tops = {name: float(np.max(np.abs(values))) for name, values in fine[1].items()}
    floor = SLOW * max(tops.values(), default=0.0)
    for name, top in tops.items():
        size = float(np.max(np.abs(CubicSpline(fine[0], fine[1][name])(coarse[0]) - coarse[1][name])))
        if size > 0.0:
            found.append(_Difference(size / max(top, floor), size, name))
    return max(found, key=lambda one: one.share)
