"""Torque ripple of a motor."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import Effect, add_body_torque, moving_body
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class TorqueRipple(Effect):
    """One order of the ripple and cogging torque of a motor.

    tau = (A + c T_m) sin(n a + p)

    with the true angle a of the body and the motor's air-gap torque T_m; positive tau drives
    forward.  The part A is there without current (cogging: n is the least common multiple of slots
    and poles), the part c T_m grows with the current (n is a multiple of the pole number).

    Source: Jahns, Soong, IEEE Trans. Industrial Electronics 43 (1996) 321.  Leaves out saturation,
    the change of amplitude with speed, and the phase between several orders (add one effect each).
    """

    amplitude: float = parameter("N m", "A, amplitude without load, 0-peak", default=0.0, low=0.0, high=1e3, typical=(1e-3, 5.0))
    relative: float = parameter("1", "c, amplitude (0-peak) per motor torque", default=0.0, low=0.0, high=1.0, typical=(1e-3, 0.3))
    order: float = parameter("1", "n, periods per turn", above=0.0, high=1e3, typical=(1.0, 48.0))
    phase: float = parameter("rad", "p, phase at angle 0", default=0.0, typical=(-np.pi, np.pi))

    acts_on: ClassVar[str] = "motor"
    family: ClassVar[str] = "torque_ripple"
    signature: ClassVar[str] = "torque and speed vibration at a fixed order of the motor, in proportion to its torque for the relative part"

    def apply(self, draft: Draft, place: str, name: str) -> None:
        body = moving_body(self, draft, place)
        motor = draft.motor_torque(place, "TorqueRipple.relative") if self.relative > 0.0 else None

        def torque(moment: Moment) -> Value:
            size = self.amplitude if motor is None else self.amplitude + self.relative * motor(moment)
            return size * np.sin(self.order * (body.sense * moment.angle(body.name)) + self.phase)

        add_body_torque(self, draft, body.name, name, torque)
