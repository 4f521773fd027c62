"""A mass on a spring that the model does not have: a neighbour that resonates."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import MemoryTorqueEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class HiddenMode(MemoryTorqueEffect):
    """An inertia attached to a body through a spring and a damper.

    tau = k x (1 + b x^2) + (c + e J_h |v|) v,  dx/dt = v = w_h - w,  J_h dw_h/dt = -tau,  k = J_h f^2,  c = 2 z J_h f

    with the inertia J_h, its natural frequency f and damping ratio z on the body held still.  Below f it adds J_h to
    the body, above it does next to nothing, at f it absorbs.  With the energy k x^2 (1 + b x^2/2)/2 + J_h w_h^2/2 the heat is
    c v^2 + e J_h |v|^3.  On a housing or a motor it is the resonance of a neighbour.

    Source: dynamic vibration absorber, Den Hartog, Mechanical Vibrations (1956), 3.2.  Leaves out further modes.  The
    attached inertia starts at rest: in a run that starts with a turning body give it that forward speed,
    ``initial={"<effect>.inertia_speed": w}``.
    """

    inertia: float = parameter("kg m^2", "J_h, attached inertia", low=0.0, high=1e4, typical=(1e-5, 5.0))
    natural_frequency: float = parameter("rad/s", "f, on the body held still", above=0.0, high=1e5, typical=(20.0, 3e3))
    damping_ratio: float = parameter("1", "z, on the body held still", default=0.02, low=0.0, high=2.0, typical=(2e-3, 0.3))

    hardening: float = parameter(
        "1/rad^2", "b, share by which the spring is stiffer per deflection squared", default=0.0, low=0.0, high=1e9, typical=(0.1, 1e5)
    )
    square_damping: float = parameter(
        "1", "e, damping torque per inertia and rate squared", default=0.0, low=0.0, high=1e6, typical=(1e-2, 100.0)
    )

    kind: ClassVar[str] = "hidden state"
    family: ClassVar[str] = "hidden_mode"
    dissipative: ClassVar[bool] = True
    leads: ClassVar[bool] = True
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {
        "natural_frequency": (30.0, 45.0, 70.0, 110.0, 165.0, 250.0, 380.0, 580.0, 1000.0),
        "damping_ratio": (0.05,),  # wide: away from its resonance a sharp one does not show
    }
    decisive: ClassVar[tuple[str, ...]] = ("natural_frequency",)
    signature: ClassVar[str] = "a resonance with an antiresonance beside it that no part of the model has; rings after steps"

    def states(self) -> Mapping[str, str]:
        return {"deflection": "rad", "inertia_speed": "rad/s"}

    def spring(self, speed: Value, state: Mapping[str, Value], inertia: float) -> Value:
        """Torque of spring and damper on the body [N m]."""
        twist, rate = state["deflection"], state["inertia_speed"] - speed
        stiffness: Value = self.natural_frequency**2
        damping: Value = 2.0 * self.damping_ratio * self.natural_frequency
        if self.hardening != 0.0:
            stiffness = stiffness * (1.0 + self.hardening * twist * twist)
        if self.square_damping != 0.0:
            damping = damping + self.square_damping * np.abs(rate)
        return inertia * (stiffness * twist + damping * rate)

    def state_rate(self, name: str, time: Value, angle: Value, speed: Value, state: Mapping[str, Value]) -> Value:
        return state["inertia_speed"] - speed if name == "deflection" else -self.spring(speed, state, 1.0)

    def torque(self, time: Value, angle: Value, speed: Value, state: Mapping[str, Value]) -> Value:
        return self.spring(speed, state, self.inertia)

    def stored(self, state: Mapping[str, Value]) -> Value:
        return energy(self.inertia, self.natural_frequency, self.hardening, state)


def energy(inertia: float, frequency: float, hardening: float, state: Mapping[str, Value]) -> Value:
    """Energy [J] of an inertia on a spring: J_h (f^2 (x^2 + b x^4/2) + w_h^2)/2."""
    square = state["deflection"] * state["deflection"]
    spring = square if hardening == 0.0 else square + 0.5 * hardening * square * square
    return 0.5 * inertia * (frequency**2 * spring + state["inertia_speed"] * state["inertia_speed"])
