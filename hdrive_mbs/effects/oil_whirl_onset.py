"""Whirl of an oil film that sets in at a speed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from hdrive_mbs.effects.oil_whirl import OilWhirl
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class OilWhirlOnset(OilWhirl):
    """OilWhirl whose threshold of stability is searched.

    F = A g(w) exp(i (q f + p)),  g = (|w|/w_0)^n (1 + tanh((|w| - w_1)/w_2))/2,  n = 0 if not given

    Source: a film is stable below a threshold speed (Muszynska, Rotordynamics, 2005, 4.2).  Leaves out hysteresis of the
    threshold, and what OilWhirl does.
    """

    onset: float = parameter("rad/s", "w_1, speed at which it sets in", above=0.0, high=1e5, typical=(100.0, 2e3))
    onset_width: float = parameter("rad/s", "w_2, over which it sets in", default=30.0, above=0.0)

    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"onset": (250.0, 450.0, 650.0)}
    signature: ClassVar[str] = "forward whirl at 0.42 to 0.49 of the speed from some speed on, strongest at one bearing"
