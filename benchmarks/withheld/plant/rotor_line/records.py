"""The three records of the rotor bench: references, hammer, start, and the run of the plant through them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from benchmarks.withheld.plant.rotor_line.equations import (
    ACTIVE_PLAIN,
    BALL,
    BALL_RATE,
    COORDINATES,
    HOUSING,
    LATERAL,
    MORE,
    RELAX,
    SPIN,
    STATES,
    SWING,
    Causes,
    FloatArray,
    Machine,
    accelerations,
    error_scales,
    integrate,
)

RATE = 4000.0
GAIN, LIMIT = 4.0, 170.0
RECORDS = ("run_up", "steps", "bump")
TOLERANCE = 2e-4  # of a step, as a share of the sensors' resolution: see error_scales
PROBES = {"r1_x": 4, "r1_y": 5, "r2_x": 12, "r2_y": 13}
ACCELEROMETERS = {"h1_ax": HOUSING, "h1_ay": HOUSING + 1, "h2_ax": HOUSING + 2, "h2_ay": HOUSING + 3}


class UnstableError(RuntimeError):
    """The plant left its range: the planted cause is too strong."""


class Run(NamedTuple):
    """What the bench did, without sensors: samples by row."""

    time: FloatArray
    states: FloatArray
    slopes: FloatArray
    torque: FloatArray
    hammer: FloatArray
    steps: int


def reference(record: str) -> FloatArray:
    """Speed reference at the samples of a record [rad/s]."""
    if record == "run_up":
        return np.interp(np.arange(16800) / RATE, [0.0, 0.1, 3.6, 4.2], [0.0, 20.0, 1000.0, 1000.0])
    if record == "steps":
        levels = [180.0, 320.0, 480.0, 640.0, 800.0, 940.0]
        corners = [(0.8 * i + s, level) for i, level in enumerate(levels) for s in (0.0, 0.6)]
        return np.interp(np.arange(19200) / RATE, [t for t, _ in corners], [level for _, level in corners])
    return np.zeros(4800)


def hammer(record: str, samples: int) -> FloatArray:
    """Force on rotor 1 in x and y at the samples [N]: half sines of 2500 N and 3 ms in the bump record."""
    force = np.zeros((samples, 2))
    if record == "bump":
        t = np.arange(samples) / RATE
        for axis, start in enumerate((0.05, 0.65)):
            inside = (t >= start) & (t < start + 3e-3)
            force[inside, axis] = 2500.0 * np.sin(np.pi * (t[inside] - start) / 3e-3)
    return force


def start_aux(causes: Causes, speed: float, lateral: FloatArray) -> FloatArray:
    """Inner states at the start: relaxation at rest, a whirl that is only a seed, a ball at the bottom that turns with the rotor."""
    aux = np.zeros(STATES - MORE)
    aux[SWING] = 0.02 if causes.whirl[0] in (2.0, 3.0) else 0.0
    aux[BALL], aux[BALL_RATE] = -0.5 * np.pi, speed
    aux[RELAX : RELAX + 16] = lateral[:16]
    return aux


def static_deflection(machine: Machine, causes: Causes) -> FloatArray:
    """Where the bench rests at spin angle 0: pseudo-transient continuation, so that a ring falls into its clearance."""
    q = np.zeros(LATERAL)
    q[1::4][:4] = -5e-5
    active = LATERAL if causes.hidden[0] else LATERAL - 2
    pseudo, before = 1e-6, np.inf
    for _ in range(400):
        a = accelerations(machine, causes, q, start_aux(causes, 0.0, q))[:active]
        size = float(np.max(np.abs(a)))
        if size < 1e-7:
            return q
        jacobian = np.empty((active, active))
        for j in range(active):
            moved = q.copy()
            moved[j] += 1e-10
            jacobian[:, j] = (accelerations(machine, causes, moved, start_aux(causes, 0.0, moved))[:active] - a) / 1e-10
        change = np.linalg.solve(np.eye(active) / pseudo - jacobian, a)
        q[:active] += change * min(1.0, 2e-5 / max(float(np.max(np.abs(change))), 1e-30))
        pseudo = min(pseudo * (4.0 if size < before else 0.5), 1e6)
        before = size
    raise UnstableError("no static deflection found: the bench does not rest with the planted cause")


def run(
    machine: Machine,
    causes: Causes,
    record: str,
    *,
    tolerance: float = TOLERANCE,
    rest: FloatArray | None = None,
    gain: float = GAIN,
    samples: int | None = None,
) -> Run:
    """Simulate one record, or its first samples, from the static deflection."""
    goal = reference(record)[:samples]
    force = hammer(record, goal.size)
    rest = static_deflection(machine, causes) if rest is None else rest
    speed = 180.0 if record == "steps" else 0.0
    y = np.zeros(STATES)
    y[:LATERAL] = rest
    y[COORDINATES + SPIN : MORE] = speed
    y[MORE:] = start_aux(causes, speed, rest)
    states, slopes, torque = np.empty((goal.size, STATES)), np.empty((goal.size, STATES)), np.empty(goal.size)
    active = STATES if causes.internal[0] == 2.0 else ACTIVE_PLAIN
    steps = integrate(y, goal, force, RATE, gain, LIMIT, machine, causes, error_scales(tolerance), active, states, torque, slopes)
    if steps < 0:
        raise UnstableError(f"{record}: the plant left its range (0.05 m); the planted cause is too strong")
    return Run(np.arange(goal.size) / RATE, states, slopes, torque, force, steps)
