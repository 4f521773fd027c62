"""The pull of a magnet on the rotor of an electrical machine that does not run in the middle of its stator."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.pull_effect import PullEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class MagneticPull(PullEffect):
    """Unbalanced magnetic pull: a negative spring about the centre of the stator, and in two-pole machines a pull that turns.

    F = k z + b exp(i (f t + p)) z*,  F = F_x + i F_y,  z = x + i y - c_x - i c_y,  z* its conjugate

    with displacements from the line without load.  For a field of p pole pairs with the amplitude B in an air gap g, stator radius R and
    length l:  k = pi R l B^2/(2 mu_0 g),  b = k/2 for one pole pair and none for more,  f twice the angular frequency of the mains.
    The field B cos(p a - w t) (1 + Re(z exp(-i a))/g), a the angle around, squared over 2 mu_0, is the pressure; its first order in z
    integrates to this.  Static deflection and whirl know k alone.  ``<effect>.force_x`` and ``_y`` show the part with k,
    ``<effect>.throb_x`` and ``_y`` that with b.

    Source: Maxwell's stress in the air gap, integrated as above; compare Smith, Dorrell, IEE Proc. Electric Power Applications 143 (1996)
    193.  Leaves out saturation, the growth beyond a tenth of the gap, what currents in the rotor and the slip do, and a field that turns
    backwards (see PulsatingPull).
    """

    throb: float = parameter("N/m", "b", default=0.0, low=0.0, high=1e9, typical=(1e2, 1e6))

    leads: ClassVar[bool] = True
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("throb", "phase"),)
    signature: ClassVar[str] = (
        "lower resonances of a machine under voltage than without; in two-pole machines vibration at twice the frequency of the mains, with"
        " side bands as far away as the spin frequency"
    )

    def throbbing(self, time: Value, x: Value, y: Value) -> tuple[Value, Value]:
        """The part with b [N] in x and y."""
        turn = self.frequency * time + self.phase
        across, up = x - self.centre_x, y - self.centre_y
        cosine, sine = np.cos(turn), np.sin(turn)
        return self.throb * (cosine * across + sine * up), self.throb * (sine * across - cosine * up)
