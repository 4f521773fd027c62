"""A coupling without elasticity."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.components.component import Component, Flange
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class RigidCoupling(Component):
    """Two flanges that turn as one:  w_a = w_b.

    What is connected at both ends becomes one body.  Leaves out every elasticity: use a Shaft for a
    coupling that is softer than its neighbours.  Its torque is not a channel, as no law gives it.
    """

    inertia: float = parameter("kg m^2", "inertia of the coupling", default=0.0, low=0.0)

    entry: ClassVar[str] = "a"
    exit: ClassVar[str] = "b"
    rigid: ClassVar[bool] = True

    def flanges(self) -> tuple[Flange, ...]:
        return (Flange(name="a", inertia=self.inertia), Flange(name="b"))
