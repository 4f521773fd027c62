"""Damping that turns with the shaft."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from hdrive_mbs.effects.whole_shaft_effect import WholeShaftEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class InternalDamping(WholeShaftEffect):
    """Damping of the bending rates that the turning shaft sees, in proportion to its bending stiffness K_b.

    F = -t K_b (q' - w J q),   J turns by +90 degrees from x to y;   torque on the spin  -t (J q)^T K_b (w J q - q')

    Below the first critical speed it damps, above it the term w J q feeds forward whirl: with an outer damping c_a of the
    mode it grows beyond w = w_k (1 + c_a/c_i), c_i = t k.  What whirl gains, the spin loses: the law makes heat only.

    Source: A. L. Kimball, General Electric Review 27 (1924) 244; R. Gasch et al., Rotordynamik (2006), ch. 8.  The same law as
    ``rotating_damping`` of ShaftSection.  Leaves out joints that slip, and material whose loss does not grow with the frequency.
    """

    time: float = parameter("s", "t, damping over bending stiffness", low=0.0, high=1.0, typical=(1e-7, 1e-4))

    dissipative: ClassVar[bool] = True
    family: ClassVar[str] = "internal_damping"
    signature: ClassVar[str] = (
        "more damping of backward and less of forward whirl above the critical speed; "
        "beyond a speed whirl at the first natural frequency that grows"
    )
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"time": (1e-6, 1e-5)}

    def pair(
        self, stiffness: float, s: Value, t: Value, s_rate: Value, t_rate: Value, angle: Value, spin: Value
    ) -> tuple[Value, Value, Value]:
        damping = self.time * stiffness
        along, across = s_rate + spin * t, t_rate - spin * s
        return damping * along, damping * across, damping * (along * t - across * s)
