"""Whether the step of an implicit solver follows the motion that came out: what it steps over at rest does not count."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator

import numpy as np

from hdrive_mbs.engine.assembly import Assembly
from hdrive_mbs.engine.linearisation import linearise
from hdrive_mbs.engine.simulation import RawRun
from hdrive_mbs.engine.solvers import Implicit, Solver
from hdrive_mbs.network.network import Network
from hdrive_mbs.signals import FloatArray

FEWEST = 10.0
"""Steps in a turn or a period below which a motion is not followed.

The trapezoidal rule answers an excitation of frequency w as the line would at w (1 + (w h)^2/12), here 3 % off, and a peak at a
critical speed by up to (w h)^2/1.75 (see run_up_step), here 23 %.
"""

JUDGED = 3
"""Steps from which the shape of a motion can be judged."""

STILL = 1e-8
"""Share of all speeds, weighted by their masses, below which a motion is rounding."""


class CoarseStepWarning(UserWarning):
    """The step is too long for the motion that came out."""


def coarse_step(assembly: Assembly, solver: Solver, raw: RawRun) -> str:
    """What is to be said of the step of an implicit solver, or nothing.

    Two things are counted: steps in a turn of what whirls while it turns, whose unbalance excites at that frequency; and
    steps in a period of the motion itself.  For the latter the speeds v are weighted by the masses, so that stiff
    parts which hardly move may be stepped over: a vibration of frequency w has second differences of 4 sin^2(w h/2) of its
    size, and so what is the largest second difference over half the range of v gives w h.  Turning and lateral motion
    are counted each for itself, the latter only where every step is recorded.
    """
    if not isinstance(solver, Implicit) or raw.status != "complete" or raw.steps < JUDGED:
        return ""
    found = [*_turning(assembly.network, raw, solver.step), *(_moving(assembly, raw) if len(raw.times) == raw.steps + 1 else ())]
    count, what = min(found, default=(math.inf, ""))
    if count >= FEWEST:
        return ""
    return (
        f"the step of {solver.step:g} s is too long for what comes out: {count:.2g} steps in {what} (with fewer than {FEWEST:g} a "
        f"resonance is off by a fifth and more), give at most {solver.step * count / FEWEST:.2g} s, or no solver: then it is chosen"
    )


def warn_of(name: str, status: str, stacklevel: int = 1) -> None:
    """Warn of what the status of a time response has to say besides ``complete``; stacklevel 1 names the caller's caller."""
    done, _, remark = status.partition("; ")
    if done == "complete" and remark:
        warnings.warn(f"{name}: {remark}.", CoarseStepWarning, stacklevel=stacklevel + 2)


def _turning(network: Network, raw: RawRun, step: float) -> Iterator[tuple[float, str]]:
    """Steps in the fastest turn of each spin that moves laterally too."""
    speeds: dict[str, FloatArray] = dict(raw.speeds)
    speeds |= {motion.name: np.asarray(motion.speed(raw.times), float) for motion in network.motions if motion.name != "ground"}
    lateral = {body.name for body in network.bodies if body.lateral}
    for name, values in speeds.items():
        fastest = float(np.max(np.abs(values)))
        if f"{name}.x" in lateral and fastest > 0.0:
            yield 2.0 * math.pi / (fastest * step), f"a turn of {name} at {fastest:.4g} rad/s"


def _moving(assembly: Assembly, raw: RawRun) -> Iterator[tuple[float, str]]:
    """Steps in a period of the motion, turning and lateral."""
    angles, speeds, states = ({name: float(values[0]) for name, values in group.items()} for group in (raw.angles, raw.speeds, raw.states))
    mass = linearise(assembly, angles=angles, speeds=speeds, states=states).mass
    everything = _largest(np.array([raw.speeds[name] for name in assembly.bodies]), mass)
    lateral = {body.name for body in assembly.network.bodies if body.lateral}
    for what, wanted in (("turning", False), ("lateral motion", True)):
        at = [k for k, name in enumerate(assembly.bodies) if (name in lateral) is wanted]
        if not at:
            continue
        v = np.array([raw.speeds[assembly.bodies[k]] for k in at])
        weights = mass[np.ix_(at, at)]
        middle = 0.5 * (np.max(v, axis=1) + np.min(v, axis=1))
        size = _largest(v - middle[:, None], weights)
        if size > STILL * everything:
            ratio = _largest(np.diff(v, 2, axis=1), weights) / size
            angle = 2.0 * math.asin(min(1.0, 0.5 * math.sqrt(ratio)))
            if angle > 0.0:
                yield 2.0 * math.pi / angle, f"a period of the fastest vibration that its {what} is like"


def _largest(speeds: FloatArray, mass: FloatArray) -> float:
    """sqrt of the largest v^T M v over the run."""
    return math.sqrt(max(float(np.max(np.einsum("it,ij,jt->t", speeds, mass, speeds))), 0.0))
