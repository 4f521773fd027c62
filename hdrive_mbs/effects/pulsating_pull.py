"""The pull of a magnet whose field turns backwards too, as on one phase or where the phases are not alike."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.pull_effect import PullEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class PulsatingPull(PullEffect):
    """Unbalanced magnetic pull of a machine of four or more poles whose supply is not symmetric: a negative spring that pulsates.

    F = (k + b cos(f t + p)) z,  F = F_x + i F_y,  z = x + i y - c_x - i c_y

    with displacements from the line without load.  For fields of the amplitudes B_1 forwards and B_2 backwards in an air gap g, stator
    radius R and length l:  k = pi R l (B_1^2 + B_2^2)/(2 mu_0 g),  b = pi R l B_1 B_2/(mu_0 g), at most k, which a single phase reaches;
    f is twice the angular frequency of the mains.  The field (B_1 cos(n a - w t) + B_2 cos(n a + w t + p)) (1 + Re(z exp(-i a))/g), a the
    angle around and n = 2, 3, ... the pole pairs, squared over 2 mu_0, is the pressure; its first order in z integrates to this.  Static
    deflection and whirl know k alone.  ``<effect>.force_x`` and ``_y`` show the part with k, ``<effect>.throb_x`` and ``_y`` that with b.

    Source: Maxwell's stress in the air gap, integrated as above.  Leaves out saturation, the growth beyond a tenth of the gap, what
    currents in the rotor and the slip do, and what turns in a machine of two poles (see MagneticPull).
    """

    pulsation: float = parameter("N/m", "b", default=0.0, low=0.0, high=1e9, typical=(1e2, 1e6))

    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("pulsation", "phase"),)
    signature: ClassVar[str] = (
        "lower resonances of a machine under voltage than without, vibration at twice the frequency of the mains along the way in which the"
        " rotor stands off its stator's middle, with side bands as far away as the spin frequency"
    )

    def throbbing(self, time: Value, x: Value, y: Value) -> tuple[Value, Value]:
        """The part with b [N] in x and y."""
        size = self.pulsation * np.cos(self.frequency * time + self.phase)
        return size * (x - self.centre_x), size * (y - self.centre_y)
