"""A mass on a spring that the model does not have: a neighbour that resonates."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.effect import MemoryTorqueEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class HiddenMode(MemoryTorqueEffect):
    """An inertia attached to a body through a spring and a damper.

    tau = k x + c (w_h - w),  dx/dt = w_h - w,  J_h dw_h/dt = -tau,  k = J_h f^2,  c = 2 z J_h f

    with the inertia J_h, its natural frequency f and damping ratio z on the body held still.  Below f it adds J_h to
    the body, above it does next to nothing, at f it absorbs.  With the energy k x^2/2 + J_h w_h^2/2 the heat is
    c (w_h - w)^2.  On a housing or a motor it is the resonance of a neighbour.

    Source: dynamic vibration absorber, Den Hartog, Mechanical Vibrations (1956), 3.2.  Leaves out further modes.  The
    attached inertia starts at rest: in a run that starts with a turning body give it that forward speed,
    ``initial={"<effect>.inertia_speed": w}``.
    """

    inertia: float = parameter("kg m^2", "J_h, attached inertia", low=0.0, high=1e4, typical=(1e-5, 5.0))
    natural_frequency: float = parameter("rad/s", "f, on the body held still", above=0.0, high=1e5, typical=(20.0, 3e3))
    damping_ratio: float = parameter("1", "z, on the body held still", default=0.02, low=0.0, high=2.0, typical=(2e-3, 0.3))

    kind: ClassVar[str] = "hidden state"
    family: ClassVar[str] = "hidden_mode"
    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = "a resonance with an antiresonance beside it that no part of the model has; rings after steps"

    def states(self) -> Mapping[str, str]:
        return {"deflection": "rad", "inertia_speed": "rad/s"}

    def spring(self, speed: Value, state: Mapping[str, Value], inertia: float) -> Value:
        """Torque of spring and damper on the body [N m]."""
        damping = 2.0 * self.damping_ratio * self.natural_frequency
        return inertia * (self.natural_frequency**2 * state["deflection"] + damping * (state["inertia_speed"] - speed))

    def state_rate(self, name: str, time: Value, angle: Value, speed: Value, state: Mapping[str, Value]) -> Value:
        return state["inertia_speed"] - speed if name == "deflection" else -self.spring(speed, state, 1.0)

    def torque(self, time: Value, angle: Value, speed: Value, state: Mapping[str, Value]) -> Value:
        return self.spring(speed, state, self.inertia)

    def stored(self, state: Mapping[str, Value]) -> Value:
        return energy(self.inertia, self.natural_frequency, state)


def energy(inertia: float, frequency: float, state: Mapping[str, Value]) -> Value:
    """Energy [J] of an inertia on a spring: J_h (f^2 x^2 + w_h^2)/2."""
    return 0.5 * inertia * (frequency**2 * state["deflection"] * state["deflection"] + state["inertia_speed"] * state["inertia_speed"])
