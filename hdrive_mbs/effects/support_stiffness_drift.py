"""One support that softens or stiffens in the course of a record."""

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
class SupportStiffnessDrift(SupportEffect):
    """The spring of one foundation, scaled by what changes while it warms up or settles.

    F = (1 + e (1 - exp(-t/h))) S(x)

    in place of S(x), for the displacement x of the housing and the time t of the run.  A support that is otherwise from the
    beginning as well has a SupportStiffnessChange beside it.

    Source: a body of one heat capacity that warms at a constant rate (Newton's law of cooling), its stiffness in proportion to its
    temperature in the first order.  Leaves out that the loss itself changes with the run, and every
    run starts cold at t = 0.  The force of gravity on the housing stays, so the housing sinks or rises as the stiffness changes.
    """

    change: float = parameter("1", "e, stiffness more in the end, as a share of it", low=-0.95, high=100.0, typical=(-0.5, 1.0))
    time_constant: float = parameter("s", "h, time in which it changes", above=0.0, high=1e6, typical=(0.2, 300.0))

    family: ClassVar[str] = "support_stiffness_drift"
    signature: ClassVar[str] = "resonances that shift in the course of a record, most in modes that move this housing"
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"change": (1e-4,), "time_constant": (1.0, 5.0)}

    def course(self, time: Value) -> Value:
        return 1.0 - np.exp(-time / self.time_constant)

    def added(self, direction: str, x: Value, rate: Value, support: SupportDraft) -> Value:
        return self.change * support.spring(direction, x)
