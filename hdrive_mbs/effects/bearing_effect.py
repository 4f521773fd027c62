"""The shape of effects that change the law of a bearing."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.expression import Value
from hdrive_mbs.network.bearing_draft import Across, BearingDraft
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment


@dataclass(frozen=True, kw_only=True)
class BearingEffect(Effect):
    """A force between the ring and the housing of one bearing, beside or in place of its law.

    Displacements are those of the ring against the housing, which is where the law counts from: zero without load.
    The channels ``<bearing>.force_x`` and ``_y`` show the force with the effect, ``<effect>.force_x`` and ``_y`` what it adds.
    """

    acts_on: ClassVar[str] = "bearing"
    kind: ClassVar[str] = "parametric"

    @abstractmethod
    def added(self, s: Across, v: Across, law: BearingDraft) -> Mapping[str, Value]:
        """Force of the ring on the housing [N] in "x" and "y" that comes on top, positive when it resists.

        s, v : displacements and rates by direction: x, y, z, psi, theta and the true spin phi
        law : that of the bearing, see its ``spring`` and ``damper``
        """

    def apply(self, draft: Draft, place: str, name: str) -> None:
        bearing = draft.bearing(place, type(self).__name__)

        def forces(s: Across, v: Across) -> Mapping[str, Value]:
            return self.added(s, v, bearing)

        draft.add_bearing_force(bearing, name, forces, dissipative=self.dissipative)
        for direction in "xy":

            def read(moment: Moment, direction: str = direction) -> Value:
                s, v = bearing.across(moment)
                return forces(s, v)[direction] + 0.0 * moment.time

            draft.add_channel(f"{name}.force_{direction}", "N", f"what {name} adds to the force of {place} in {direction}", read)
