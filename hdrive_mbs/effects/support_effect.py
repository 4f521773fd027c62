"""The shape of effects that change the support of a bearing."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.bearing_draft import SupportDraft
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import option

WAYS = ("x", "y", "both")


@dataclass(frozen=True, kw_only=True)
class SupportEffect(Effect):
    """A force between the housing of one bearing and the ground, beside its foundation; the place is the bearing.

    Displacements are those of the housing from where it sits without load: under gravity it starts below.
    The channels ``<effect>.force_x`` and ``_y`` show the force on the housing.
    """

    direction: str = option("'x', 'y' or 'both'", default="both")

    acts_on: ClassVar[str] = "support"
    kind: ClassVar[str] = "parametric"

    def check(self) -> None:
        if self.direction not in WAYS:
            raise ParameterError(f"{type(self).__name__}.direction = {self.direction!r}: must be one of {', '.join(WAYS)}.")

    @abstractmethod
    def added(self, direction: str, x: Value, rate: Value, support: SupportDraft) -> Value:
        """Force [N] in "x" or "y" that comes on top, positive when it resists.

        x, rate : displacement and rate of the housing in that direction [m, m/s]
        support : see its ``spring``, ``damping`` and ``mass``
        """

    def course(self, time: Value) -> Value:
        """What the force is multiplied by at a time [s] of the run; 1 unless overridden."""
        return 1.0

    def ways(self) -> tuple[str, ...]:
        """Directions in which it acts."""
        return ("x", "y") if self.direction == "both" else (self.direction,)

    def apply(self, draft: Draft, place: str, name: str) -> None:
        support = draft.support(place, type(self).__name__)
        for direction in self.ways():
            factors = support.displacement[direction]

            def force(moment: Moment, x: Value, rate: Value, direction: str = direction) -> Value:
                return self.course(moment.time) * self.added(direction, x, rate, support)

            def read(moment: Moment, factors: dict[str, float] = dict(factors), direction: str = direction) -> Value:  # noqa: B006
                x = sum(f * moment.angle(c) for c, f in factors.items())
                rate = sum(f * moment.speed(c) for c, f in factors.items())
                return -self.course(moment.time) * self.added(direction, x, rate, support) + 0.0 * moment.time

            draft.add_relative_torque(f"{name}.{direction}", dict(factors), force, dissipative=self.dissipative)
            draft.add_channel(f"{name}.force_{direction}", "N", f"force of {name} on the housing of {place} in {direction}", read)
