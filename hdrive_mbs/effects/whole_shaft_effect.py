"""The shape of laws over the bending of a whole shaft that know the moment alone."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from hdrive_mbs.effects.every_piece_effect import EveryPieceEffect
from hdrive_mbs.effects.shaft_bending import bent_shapes
from hdrive_mbs.expression import Value
from hdrive_mbs.network.bearing_draft import ShaftPiece
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment


@dataclass(frozen=True, kw_only=True)
class WholeShaftEffect(EveryPieceEffect):
    """Forces along the shapes into which each piece of shaft bends, that turn with the shaft.

    Both planes together: a shape has a displacement s in x and t in y, and (s + i t) exp(-i phi) is what the shaft sees.
    """

    @abstractmethod
    def pair(
        self, stiffness: float, s: Value, t: Value, s_rate: Value, t_rate: Value, angle: Value, spin: Value
    ) -> tuple[Value, Value, Value]:
        """Forces that resist s and t and the torque that resists the spin, of a shape with that bending stiffness."""

    def add_to(self, draft: Draft, piece: ShaftPiece, name: str) -> None:
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
