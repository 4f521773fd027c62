"""Radial play of a bearing."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.bearing_effect import BearingEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.network.bearing_draft import Across, BearingDraft
from hdrive_mbs.quantities import parameter

_NOTHING = 1e-15
"""m; keeps the direction of no displacement finite where there is no gap."""


@dataclass(frozen=True, kw_only=True)
class BearingClearance(BearingEffect):
    """The radial spring of a bearing acts beyond a gap; a film in the gap may carry a share.

    F = a S(u) + d D u' + N u/r + (1 - a) S_t(p),   N = max((1 - a) S_n(p) + (1 - d) D_n p', 0) where p = r - c > 0, else 0

    in place of S(u) + D u', for the displacement u of the ring, r = |u|; S and D are the spring and the damper that the
    bearing has, S_n(p) and D_n what they do along u (k p and d_xx p' of a bearing that is alike all around), and S_t(p), while
    N pushes, what the spring does across it (nothing for such a bearing).  a and d are the shares of the film.  Ring and
    housing cannot pull at each other but for the film.  c = 0 with d = 1 is the bearing, where its spring pushes.

    Source: the bilinear contact of e.g. F. F. Ehrich, J. Vibration and Acoustics 110 (1988) 9, and J. Padovan, F. K. Choy,
    J. Turbomachinery 109 (1987) 527, with a Kelvin-Voigt contact that does not pull.  Leaves out the single rolling elements, what a
    tilt does to the play, and friction along the race.  A law with forces of its own that depend on rates in x and y
    (JournalBearing) keeps that part.  The force has a corner at r = c: a fixed step has to resolve the contact, some
    1/30 of the period of the ring on its spring or less.  Without load and film nothing centres the ring.
    """

    gap: float = parameter("m", "radial gap c, half of the play between the extreme positions", low=0.0, high=1e-2, typical=(5e-8, 5e-5))
    film_stiffness: float = parameter(
        "1", "share a of the spring that acts in the gap too", default=0.0, low=0.0, high=1.0, typical=(2e-3, 0.3)
    )
    film_damping: float = parameter(
        "1", "share d of the damping that acts in the gap too; 1: all of it", default=1.0, low=0.0, high=1.0, typical=(0.05, 1.0)
    )

    family: ClassVar[str] = "bearing_clearance"
    leads: ClassVar[bool] = True
    signature: ClassVar[str] = (
        "softer at small amplitude: resonances that rise with the amplitude, jumps, harmonics and subharmonics of the spin, "
        "a ring-down whose frequency falls"
    )
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"gap": (2e-7, 1e-6, 5e-6, 2e-5)}

    def normal(self, spring: Value, damping: Value) -> Value:
        """Force of the contact, if it pushes, from what spring and damper of the bearing would give there [N]."""
        return spring + (1.0 - self.film_damping) * damping

    def added(self, s: Across, v: Across, law: BearingDraft) -> Mapping[str, Value]:
        x, y = s["x"], s["y"]
        square = x * x + y * y
        r = np.sqrt(np.maximum(square, self.gap**2 + _NOTHING**2))
        along = {"x": x / r, "y": y / r}
        inside = {**s, **{key: (r - self.gap) * n for key, n in along.items()}}
        springs = {key: law.spring(key, inside, v) for key in along}
        spring = sum(n * springs[key] for key, n in along.items())
        rate = along["x"] * v["x"] + along["y"] * v["y"]
        closing = {**v, **{key: rate * n for key, n in along.items()}}
        damping = sum(n * law.damper(key, closing) for key, n in along.items())
        normal = np.maximum(self.normal((1.0 - self.film_stiffness) * spring, damping), 0.0)
        pushing = np.where(square > self.gap**2, np.where(normal > 0.0, 1.0, 0.0), 0.0)
        across = {key: (1.0 - self.film_stiffness) * (springs[key] - spring * n) for key, n in along.items()}
        film = {key: (1.0 - self.film_stiffness) * law.spring(key, s, v) + (1.0 - self.film_damping) * law.damper(key, v) for key in along}
        return {key: pushing * (normal * n + across[key]) - film[key] for key, n in along.items()}
