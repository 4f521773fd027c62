"""Plans made as large as the limits allow."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.experiment.drives import motor_of
from hdrive_mbs.diagnosis.experiment.limits import Limits
from hdrive_mbs.diagnosis.experiment.plan import Plan
from hdrive_mbs.diagnosis.hypothesis import FloatArray, Hypothesis
from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.errors import ParameterError

Model = tuple[Hypothesis, FloatArray]
"""A hypothesis at some parameters."""
Shape = Callable[[float], Plan]
"""A plan of a size from 0 to 1 of its motion; loads do not shrink with it."""

TRIES, CLOSE, SHORT = 12, 0.9, 0.97
"""Sizes that are tried, how close to a limit is close enough, and the share of it that the next size aims at."""


@dataclass(frozen=True, kw_only=True)
class Peaks:
    """Largest speed [rad/s] and torque [N m] of the motor, either sense."""

    speed: float
    torque: float

    def share(self, limits: Limits) -> float:
        """Of the limits, the larger one; above 1 a limit is not kept."""
        return max(self.speed / limits.speed, self.torque / limits.torque)


def nominal_model() -> Model:
    """The scene as it is."""
    return Hypothesis(factors=()), np.zeros(0)


def peaks(bench: Bench, plan: Plan, models: Sequence[Model], step: float) -> Peaks:
    """Of a plan as models predict them, the worst of all models; infinite where one cannot be simulated."""
    motor = motor_of(bench)
    if motor is None:
        raise ParameterError(f"Bench {bench.scene.name!r} has no speed reference or motor torque among its inputs; give your own plans.")
    watched = {what: Measured(channel=f"{motor.place}.{what}", noise=1.0) for what in ("speed", "torque")}
    trials = [
        replace(trial, columns={name: np.zeros(trial.samples) for name in watched}, measured=watched) for trial in bench.planned(plan)
    ]
    simulator = Simulator(trials, step)
    found = {what: float(np.abs(plan.sampled(motor.column)).max()) if what == motor.role else 0.0 for what in watched}
    for hypothesis, z in models:
        for columns in simulator.columns(hypothesis, z):
            for what in watched:
                found[what] = max(found[what], float(np.abs(columns[what]).max()) if columns else np.inf)
    return Peaks(**found)


def largest(bench: Bench, shape: Shape, limits: Limits, models: Sequence[Model], step: float) -> Plan | None:
    """The plan of the largest size up to 1 that keeps the limits by prediction; None where even a small one does not."""
    size, best = 1.0, None
    low, high = 0.0, 1.0  # sizes that keep and, once one has been seen, do not keep the limits
    for _ in range(TRIES):
        plan = shape(size)
        share = peaks(bench, plan, models, step).share(limits)
        if share <= 1.0:
            best, low = plan, size
            if size == 1.0 or share > CLOSE:
                break
            # what does not shrink with the size (a mean speed, a load) makes the proportion wrong: stay below what was too large
            size = min(size * SHORT / share, low + 0.9 * (high - low))
        else:
            high = size
            # a torque at its limit does not say how far beyond the command is: go down to half at least
            size = low + 0.5 * (high - low) if low > 0.0 else size * min(SHORT / share, 0.5)
        if high - low < 0.02 * high:
            break
    return best
