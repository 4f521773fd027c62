"""A connection that creeps: an elastomer element, a bonded joint, a plastic gear body."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.series_compliance import SeriesCompliance
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class Creep(SeriesCompliance):
    """Twist that comes after the torque, and goes after it again: a connection that is softer when slow.

    tau = (y + t dy/dt)/C,  dy/dt = (C T(x - y, v) - y)/(t + C d)

    the law of SeriesCompliance with a time t that a record shows and a search moves.  With a spring k as the connection it is the
    standard linear solid: stiffness k when fast, k/(1 + k C) when slow, a step of twist relaxes with the time t/(1 + k C), a step of
    torque creeps with the time t, and the loss factor is largest at the angular frequency sqrt(1 + k C)/t.  The connection's own stiffness
    is the fast one: where a data sheet gives the slow one, a fit moves it up by the factor 1 + k C.

    Source: Zener's solid in its Voigt form, Lakes, Viscoelastic Materials, Cambridge 2009, ch. 2.  Leaves out a spread of times (put
    several Creep effects at the connection), amplitude (Payne) and temperature.
    """

    relaxation_time: float = parameter("s", "t in which the twist comes", default=0.1, above=0.0, high=1e6, typical=(4e-3, 10.0))

    family: ClassVar[str] = "creep"
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"relaxation_time": (0.05, 0.5)}
    signature: ClassVar[str] = (
        "twist that goes on growing under a steady torque and comes back when it is gone; stiffer when fast, most damped at one low"
        " frequency"
    )
