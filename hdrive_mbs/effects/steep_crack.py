"""A crack that opens and closes faster than a cosine, and bends both ways."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from hdrive_mbs.effects.breathing_crack import BreathingCrack
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class SteepCrack(BreathingCrack):
    """BreathingCrack whose steepness and whose compliance across its front are searched.

    g = (1 + tanh(s cos b)/tanh s)/2,  c about the front and e c across it

    Source: between the cosine of Mayes and Davies (1984; small s) and the switch of Gasch (1993; large s), see BreathingCrack; e: a crack
    of half the diameter yields across its front too (A. D. Dimarogonas, Engineering Fracture Mechanics 55 (1996) 831).  Leaves out what
    BreathingCrack does.
    """

    steepness: float = parameter("1", "s; 0 for the cosine", low=0.0, high=50.0, typical=(0.3, 10.0))
    cross_share: float = parameter(
        "1", "e, compliance across over that about the front", default=0.0, low=0.0, high=1.0, typical=(0.0, 0.5)
    )

    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {**BreathingCrack.starts, "steepness": (1.5,)}
