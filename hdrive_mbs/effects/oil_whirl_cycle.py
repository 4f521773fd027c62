"""Whirl of an oil film that grows to a limit cycle."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.drifting_share import add_drift, spin_speed
from hdrive_mbs.effects.lateral_effect import LateralEffect, Push, Stretches
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class OilWhirlCycle(LateralEffect):
    """A whirl whose size grows above a threshold speed until it holds itself, and dies below it.

    F = A r exp(i (q f + d + p)),  r' = g (r (c - r^2) + e),  c = m tanh((|w|/w_1 - 1)/m),  d' = s (|w|/w_0 - 1) w

    on the ring, with its spin angle f and its speed w.  Slowly above the threshold w_1 r comes to sqrt(|w|/w_1 - 1), and never goes
    beyond sqrt(m), which the clearance sets; e keeps it alive below.  r and d are states that begin at 0, ``<effect>.size`` and
    ``<effect>.drift``.

    Source: a journal bearing loses stability in a Hopf bifurcation, C. J. Myers, J. Applied Mechanics 51 (1984) 244; r' is its
    normal form (e.g. Strogatz, Nonlinear Dynamics and Chaos, 8.2), the bound m and the straight line of the share are ours.  Leaves out
    thresholds that jump (a subcritical bifurcation), and that the motion of the line pulls the whirl along (whip).
    """

    amplitude: float = parameter(
        "N", "A, 0-peak where r = 1, at twice the threshold if nothing bounds it", low=0.0, high=1e6, typical=(0.1, 2e3)
    )
    phase: float = parameter("rad", "p, phase at spin angle 0", default=0.0, typical=(-np.pi, np.pi))
    ratio: float = parameter("1", "q, speed of the whirl over that of the spin", default=0.47, above=0.0, high=1.0, typical=(0.4, 0.5))
    slope: float = parameter("1", "s, change of the share per reference speed", default=0.0, low=-0.5, high=0.5, typical=(-0.05, 0.05))
    reference_speed: float = parameter("rad/s", "w_0, where the share is q", default=500.0, above=0.0)
    onset: float = parameter("rad/s", "w_1, threshold of stability", above=0.0, high=1e5, typical=(100.0, 2e3))
    rate: float = parameter(
        "1/s", "g, rate at which it grows at twice the threshold", default=15.0, above=0.0, high=1e4, typical=(2.0, 100.0)
    )
    bound: float = parameter("1", "m, square of the largest r", default=1.0, above=0.0, high=100.0, typical=(0.1, 10.0))
    seed: float = parameter("1", "e, what keeps it alive", default=3e-3, above=0.0, high=1.0, typical=(1e-4, 0.1))

    acts_on: ClassVar[str] = "bearing"
    family: ClassVar[str] = "oil_whirl"
    excites: ClassVar[bool] = True
    periodic: ClassVar[Mapping[str, str]] = {"ratio": "turn"}
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("amplitude", "phase"),)
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {
        "onset": (250.0, 450.0, 650.0), "rate": (15.0,), "bound": (1.0,), "seed": (3e-3,)
    }  # fmt: skip
    signature: ClassVar[str] = "forward whirl at 0.42 to 0.49 of the speed that grows and dies with a delay at a threshold speed"

    def force(self, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> tuple[Value, Value]:
        """The force [N] of a whirl of size r = 1."""
        turned = self.ratio * angle + self.phase
        return self.amplitude * np.cos(turned), self.amplitude * np.sin(turned)

    def size_rate(self, size: Value, speed: Value) -> Value:
        """r' [1/s] at a size r and a speed [rad/s]."""
        c = self.bound * np.tanh((np.abs(speed) / self.onset - 1.0) / self.bound)
        return self.rate * (size * (c - size * size) + self.seed)

    def pushing(self, draft: Draft, stretches: Stretches, name: str) -> Push:
        drift = add_drift(draft, stretches, name, self.slope, self.reference_speed)
        size = draft.add_running_state(
            f"{name}.size", unit="1", rate=lambda moment: self.size_rate(moment.state(size), spin_speed(stretches, moment))
        )

        def push(moment: Moment, time: Value, angle: Value, *across: Value) -> tuple[Value, Value]:
            x, y = self.force(time, angle + drift(moment) / self.ratio, *across)
            return moment.state(size) * x, moment.state(size) * y

        return push
