"""The shape of effects that are a property of a whole shaft: the same law on each of its pieces."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.effects.shaft_bending import bent_shapes
from hdrive_mbs.expression import Value
from hdrive_mbs.network.bearing_draft import ShaftPiece
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network
from hdrive_mbs.quantities import option


@dataclass(frozen=True, kw_only=True)
class WholeShaftEffect(Effect):
    """Forces along the shapes into which each piece of shaft bends, that turn with the shaft.

    Both planes together: a shape has a displacement s in x and t in y, and (s + i t) exp(-i phi) is what the shaft sees.
    """

    alone: bool = option("whether it acts on the piece it is put at alone, not on all pieces of shaft", default=False)

    acts_on: ClassVar[str] = "shaft"
    kind: ClassVar[str] = "parametric"

    @classmethod
    def places(cls, network: Network) -> tuple[str, ...]:
        """The first piece: it acts on all, wherever it is put."""
        return network.members.get("shaft", ())[:1]

    @abstractmethod
    def pair(
        self, stiffness: float, s: Value, t: Value, s_rate: Value, t_rate: Value, angle: Value, spin: Value
    ) -> tuple[Value, Value, Value]:
        """Forces that resist s and t and the torque that resists the spin, of a shape with that bending stiffness."""

    def apply(self, draft: Draft, place: str, name: str) -> None:
        chosen = draft.shaft(place, type(self).__name__)
        for piece in (chosen,) if self.alone else draft.shafts:
            self._add(draft, piece, f"{name}.{piece.name}")

    def _add(self, draft: Draft, piece: ShaftPiece, name: str) -> None:
        shapes = bent_shapes(piece)
        stretches = {f"{key}{k}": shape.stretches[key] for k, (shape, _) in enumerate(shapes) for key in "xy"}
        draft.add_coupling(
            name, stretches | {"phi": piece.spin()}, self._forces([stiffness for _, stiffness in shapes]), dissipative=self.dissipative
        )

    def _forces(self, stiffnesses: list[float]) -> Callable[[Moment, Mapping[str, Value], Mapping[str, Value]], Mapping[str, Value]]:
        def forces(moment: Moment, s: Mapping[str, Value], v: Mapping[str, Value]) -> Mapping[str, Value]:
            found: dict[str, Value] = {"phi": 0.0}
            for k, stiffness in enumerate(stiffnesses):
                x, y = f"x{k}", f"y{k}"
                found[x], found[y], torque = self.pair(stiffness, s[x], s[y], v[x], v[y], s["phi"], v["phi"])
                found["phi"] = found["phi"] + torque
            return found

        return forces
