"""A first-order state that goes on with the rotation and does not come to rest."""

from __future__ import annotations

from dataclasses import dataclass

from hdrive_mbs.network.elements import StateRate


@dataclass(frozen=True)
class RunningRate(StateRate):
    """dz/dt = rate(moment) of the phase of a vibration, which runs on like the angle of a spin.

    Excitations alone may look at such a state (see Excitation).  Steady rotation leaves it out with them: operating points, static
    deflection and linearised matrices have it at its first value.
    """
