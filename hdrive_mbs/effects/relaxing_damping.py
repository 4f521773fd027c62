"""Damping that turns with the shaft, of a material that relaxes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from hdrive_mbs.effects.every_piece_effect import EveryPieceEffect
from hdrive_mbs.effects.shaft_bending import bent_shapes
from hdrive_mbs.expression import Value
from hdrive_mbs.network.bearing_draft import ShaftPiece
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.stretch_rate import RateOver
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class RelaxingDamping(EveryPieceEffect):
    """Springs behind dampers beside the bending stiffness K_b, that turn with the shaft (standard linear solid).

    F = -(t/r) K_b d,   d' = q' - w J q + w J d - d/r,   J turns by +90 degrees from x to y;   torque on the spin  (t/r) (J q)^T K_b d

    with the stretch d of the springs, as the ground sees it.  A motion of the frequency W in the turning shaft meets the loss factor
    W t/(1 + W^2 r (r + t)): for slow ones it is InternalDamping of the time t, beyond W = 1/r it fades, and the shaft is stiffer by the
    share t/r there.  Whirl at w_k of a shaft that turns at w has W = w - w_k.  The springs begin without stretch.  Two states to each of
    two shapes of every piece of shaft, ``<effect>.<piece>.0.x`` and so on.

    Source: the standard linear solid, e.g. N. W. Tschoegl, The Phenomenological Theory of Linear Viscoelastic Behavior (1989), as an
    observer sees it who does not turn with it; damping that turns: G. Genta, Dynamics of Rotating Systems (2005).  The torque follows
    from the energy (t/r) d^T K_b d/2 of the springs.  Leaves out materials with several times.
    """

    time: float = parameter("s", "t, damping over bending stiffness for slow motion", low=0.0, high=1.0, typical=(1e-7, 1e-4))
    relaxation_time: float = parameter("s", "r, in which the springs lose their stretch", above=0.0, high=10.0, typical=(1e-4, 1e-2))

    dissipative: ClassVar[bool] = True
    family: ClassVar[str] = "internal_damping"
    signature: ClassVar[str] = (
        "more damping of backward and less of forward whirl above the critical speed, that does not grow with the distance from it"
    )
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"time": (1e-6, 1e-5), "relaxation_time": (1e-3,)}

    def add_to(self, draft: Draft, piece: ShaftPiece, name: str) -> None:
        for k, (shape, stiffness) in enumerate(bent_shapes(piece)):
            stretches = {**shape.stretches, "phi": piece.spin()}
            self._add_springs(draft, f"{name}.{k}", stretches, stiffness * self.time / self.relaxation_time)

    def _add_springs(self, draft: Draft, name: str, stretches: dict[str, dict[str, float]], stiffness: float) -> None:
        """Springs of both planes of one shape."""
        stretched: dict[str, str] = {}

        def read(moment: Moment) -> tuple[Value, Value]:
            return moment.state(stretched["x"]), moment.state(stretched["y"])

        def rate(own: str, other: str, sense: float) -> RateOver:
            def of(moment: Moment, s: Mapping[str, Value], v: Mapping[str, Value]) -> Value:
                d = dict(zip("xy", read(moment), strict=True))
                return v[own] - sense * v["phi"] * (s[other] - d[other]) - d[own] / self.relaxation_time

            return of

        def forces(moment: Moment, s: Mapping[str, Value], v: Mapping[str, Value]) -> Mapping[str, Value]:
            x, y = read(moment)
            return {"x": stiffness * x, "y": stiffness * y, "phi": stiffness * (x * s["y"] - y * s["x"])}

        def stored(moment: Moment) -> Value:
            x, y = read(moment)
            return 0.5 * stiffness * (x**2 + y**2)

        for own, other, sense in (("x", "y", -1.0), ("y", "x", 1.0)):
            stretched[own] = draft.add_stretch_state(f"{name}.{own}", name, stretches, rate(own, other, sense), unit="m")
        draft.add_coupling(name, stretches, forces, dissipative=self.dissipative, stored=stored)
