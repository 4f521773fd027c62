"""A cross coupling whose entries differ and which large displacements weaken."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.bearing_cross_coupling import BearingCrossCoupling
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class FadingCrossCoupling(BearingCrossCoupling):
    """BearingCrossCoupling whose asymmetry and fading are searched.

    F = q g (-(1 + e) y, (1 - e) x)/(1 + f r^2)

    Source: what holds the whirl of an unstable film is that it weakens as the orbit grows (Muszynska, Rotordynamics, 2005, 4.2); the
    form 1/(1 + f r^2) is ours.  Leaves out what BearingCrossCoupling does.
    """

    asymmetry: float = parameter("1", "e, by which the two entries differ", default=0.0, low=-1.0, high=1.0, typical=(-0.5, 0.5))
    fading: float = parameter(
        "1/m^2", "f, by which the force falls with the square of the displacement", default=0.0, low=0.0, typical=(1e6, 1e10)
    )

    signature: ClassVar[str] = "less damping of forward and more of backward whirl; beyond a speed whirl that grows until it holds itself"
