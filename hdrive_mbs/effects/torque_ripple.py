"""Torque ripple of a motor."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import Effect, add_body_torque, moving_body
from hdrive_mbs.effects.harmonics import MOTOR_ORDERS
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class TorqueRipple(Effect):
    """One order of the ripple and cogging torque of a motor, with its double.

    tau = (A + c T_m) sin(n a + p) + B sin(2 n a + q)

    with the true angle a of the body and the motor's air-gap torque T_m; positive tau drives
    forward.  The part A is there without current (cogging: n is the least common multiple of slots
    and poles), the part c T_m grows with the current (n is a multiple of the pole number).

    Source: Jahns, Soong, IEEE Trans. Industrial Electronics 43 (1996) 321.  Leaves out saturation,
    the change of amplitude with speed, and the phase between several orders (add one effect each).
    """

    amplitude: float = parameter("N m", "A, amplitude without load, 0-peak", default=0.0, low=0.0, high=1e3, typical=(1e-4, 5.0))
    relative: float = parameter("1", "c, amplitude (0-peak) per motor torque", default=0.0, low=0.0, high=1.0, typical=(1e-4, 0.3))
    order: float = parameter("1", "n, periods per turn", above=0.0, high=1e3)
    phase: float = parameter("rad", "p, phase at angle 0", default=0.0, typical=(-np.pi, np.pi))

    second_amplitude: float = parameter("N m", "B at order 2 n, 0-peak", default=0.0, low=0.0, high=1e3, typical=(1e-4, 5.0))
    second_phase: float = parameter("rad", "q, phase at angle 0", default=0.0, typical=(-np.pi, np.pi))

    acts_on: ClassVar[str] = "motor"
    family: ClassVar[str] = "torque_ripple"
    signature: ClassVar[str] = "torque and speed vibration at a fixed order of the motor, in proportion to its torque for the relative part"
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("amplitude", "phase"), ("second_amplitude", "second_phase"))
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"order": MOTOR_ORDERS, "relative": (0.0, 1e-4)}
    # both: c > 0 turns with the phase of A and hides it where there is no c, and of c alone A shows no phase

    def twins(self, sense: int) -> tuple[Effect, ...]:
        """Once a turn and without a part that grows with the torque, it is the weight of an eccentric mass."""
        from hdrive_mbs.effects.eccentric_load import EccentricLoad  # which has this one as its twin

        if self.order != 1.0 or self.relative != 0.0:
            return ()
        turned = np.pi if sense > 0 else 0.0
        whole = EccentricLoad(mass=1.0, radius=EccentricLoad.starts["radius"][0])
        return (
            whole.replacing(
                mass=self.amplitude / (whole.gravity * whole.radius),
                start_angle=self.phase + turned,
                second_torque=self.second_amplitude,
                second_phase=self.second_phase + turned,
            ),
        )

    def apply(self, draft: Draft, place: str, name: str) -> None:
        body = moving_body(self, draft, place)
        motor = draft.motor_torque(place, "TorqueRipple.relative") if self.relative > 0.0 else None

        def torque(moment: Moment) -> Value:
            size = self.amplitude if motor is None else self.amplitude + self.relative * motor(moment)
            angle = body.sense * moment.angle(body.name)
            first = size * np.sin(self.order * angle + self.phase)
            if self.second_amplitude == 0.0:
                return first
            return first + self.second_amplitude * np.sin(2.0 * self.order * angle + self.second_phase)

        add_body_torque(self, draft, body.name, name, torque)
