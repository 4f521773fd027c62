"""A coupling out of line that pushes harder the more torque it carries."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.misalignment import Misalignment
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class LoadedMisalignment(Misalignment):
    """Misalignment whose forces and moments grow with the torque that the coupling carries.

    F = (1 + g |T|) F_0,  F_0 that of Misalignment, T the torque that the shafts carry away from the place

    as in gear and disc couplings, whose teeth or discs have to slide or bend under load while they turn.

    Source: Gibbons, Coupling misalignment forces, Turbomachinery Symposium 5 (1976) 111: reaction forces of gear couplings
    in proportion to the torque.  Leaves out the inertia of the place itself (its share of the torque while the speed changes),
    and what Misalignment does.
    """

    growth: float = parameter("1/(N m)", "g, growth of the forces with the torque", low=0.0, high=1e3, typical=(1e-3, 0.3))
    lever: float = parameter("m", "l, how far beyond the place the force acts along +z", default=0.0, typical=(-0.3, 0.3))

    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {**Misalignment.starts, "growth": (0.01,)}
    signature: ClassVar[str] = "vibration twice per turn, with some once and three times, that grows with the torque"

    def factor(self, draft: Draft, place: str) -> Callable[[Moment], Value]:
        torque = draft.fed_in(place, type(self).__name__)
        return lambda moment: 1.0 + self.growth * np.abs(torque(moment))
