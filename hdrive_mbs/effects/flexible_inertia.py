"""A body of which a part sits on a spring: a load that is not rigid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.effect import Effect, moving_body
from hdrive_mbs.effects.hidden_mode import HiddenMode
from hdrive_mbs.effects.places import turning_bodies
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.network import Network
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class FlexibleInertia(Effect):
    """A share of a body's own inertia, attached to the rest through a spring and a damper.

    tau = k x (1 + b x^2) + (c + e J_h |v|) v,  dx/dt = v = w_h - w,  J_h dw_h/dt = -tau,  J_h = s J,  k = J_h f^2,
    c = 2 z J_h f

    with the inertia J of the place, of which (1 - s) J stays where it was: the whole keeps its inertia, as a load does
    whose arm or table bends.  f and z are natural frequency and damping ratio of the share with the rest held still;
    with the rest free the pair swings at f/sqrt(1 - s).  It is passive as HiddenMode is.

    Source: two inertias on a spring (Newton).  Leaves out further modes.  The share starts at rest, as in HiddenMode.
    """

    share: float = parameter("1", "s, part of the inertia that sits on the spring", low=0.0, high=0.95, typical=(0.02, 0.7))
    natural_frequency: float = parameter("rad/s", "f, with the rest held still", above=0.0, high=1e5, typical=(20.0, 3e3))
    damping_ratio: float = parameter("1", "z, with the rest held still", default=0.02, low=0.0, high=2.0, typical=(2e-3, 0.3))

    hardening: float = parameter(
        "1/rad^2", "b, share by which the spring is stiffer per deflection squared", default=0.0, low=0.0, high=1e9, typical=(0.1, 1e5)
    )
    square_damping: float = parameter(
        "1", "e, damping torque per inertia and rate squared", default=0.0, low=0.0, high=1e6, typical=(1e-2, 100.0)
    )

    kind: ClassVar[str] = "hidden state"
    family: ClassVar[str] = "hidden_mode"
    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = "one more resonance than the model has, with the inertia as expected in slow motion; rings after steps"

    @classmethod
    def places(cls, network: Network) -> tuple[str, ...]:
        """Bodies that only turn: the mass of a station of a rotor line stays whole."""
        return tuple(place for place in turning_bodies(network) if place not in network.positions)

    def apply(self, draft: Draft, place: str, name: str) -> None:
        inertia = self.share * moving_body(self, draft, place).inertia
        draft.add_inertia(place, -inertia, type(self).__name__)
        fields = ("natural_frequency", "damping_ratio", "hardening", "square_damping")
        HiddenMode(inertia=inertia, **{field: getattr(self, field) for field in fields}).apply(draft, place, name)
