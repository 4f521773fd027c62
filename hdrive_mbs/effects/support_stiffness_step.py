"""One support that softens or stiffens at some moment of a record."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.support_effect import SupportEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.network.bearing_draft import SupportDraft
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class SupportStiffnessStep(SupportEffect):
    """The spring of one foundation, scaled by what gives way, or is tightened, at a moment.

    F = (1 + e (1 + tanh((t - t_0)/h))/2) S(x)

    in place of S(x), for the displacement x of the housing and the time t of the run: half of the change is there at t_0, and nine tenths
    of it come within 2.9 h.  A support that is otherwise from the beginning as well has a SupportStiffnessChange beside it.

    Source: the curve is ours, a smooth step between two levels.  Leaves out what makes the support give way, so that every run has it at
    the same time.  Static deflection and whirl have what is there at t = 0.  The force of gravity on the housing stays, so the housing
    sinks or rises as the stiffness changes.
    """

    change: float = parameter("1", "e, stiffness more in the end, as a share of it", low=-0.95, high=100.0, typical=(-0.5, 1.0))
    middle_time: float = parameter("s", "t_0, when half of it has changed", low=0.0, high=1e6, typical=(0.2, 300.0))
    length: float = parameter("s", "h, in which it changes", above=0.0, high=1e6, typical=(0.05, 100.0))

    family: ClassVar[str] = "support_stiffness_drift"
    signature: ClassVar[str] = "resonances that are elsewhere after some moment of a record, most in modes that move this housing"
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"change": (1e-4,), "middle_time": (0.7, 2.0, 6.0), "length": (0.5, 2.0)}

    def course(self, time: Value) -> Value:
        return 0.5 + 0.5 * np.tanh((time - self.middle_time) / self.length)

    def added(self, direction: str, x: Value, rate: Value, support: SupportDraft) -> Value:
        return self.change * support.spring(direction, x)
