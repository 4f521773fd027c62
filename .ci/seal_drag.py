"""An effect of one's own, in one file."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

import hdrive_mbs as hm


@dataclass(frozen=True, kw_only=True)
class SealDrag(hm.TorqueEffect):
    """Lip-seal drag that grows slowly with speed: tau = -a sign(w) |w|^n."""

    scale: float = hm.parameter("N m", "drag at 1 rad/s", low=0.0, high=50.0, typical=(1e-3, 5.0))
    exponent: float = hm.parameter("1", "speed exponent", default=0.4, low=0.0, high=2.0)
    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = "drag at every speed, nearly independent of load"

    def torque(self, time, angle, speed):
        return -self.scale * np.sign(speed) * np.abs(speed) ** self.exponent
