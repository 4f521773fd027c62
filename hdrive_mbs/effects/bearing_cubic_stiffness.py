"""A bearing that stiffens with the cube of the displacement."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from hdrive_mbs.effects.bearing_effect import BearingEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.network.bearing_draft import Across, BearingDraft
from hdrive_mbs.quantities import option, parameter


@dataclass(frozen=True, kw_only=True)
class BearingCubicStiffness(BearingEffect):
    """A cubic spring beside the law of a bearing.

    F = b r^2 u,  alike all around, or by axis F_x = b x^3, F_y = b y^3

    with the displacement u of the ring against the housing, r = |u|, counted from where the bearing carries no load: under
    weight a static deflection u_0 adds 3 b u_0^2 to the stiffness along u_0 and b u_0^2 across it.

    Source: Duffing's spring, as for rolling bearings in e.g. T. Yamamoto, Y. Ishida, Linear and Nonlinear Rotordynamics (2001),
    ch. 6; by axis it is seed M (5).  A negative b softens and pulls away beyond r = sqrt(k/-b), where a run diverges.
    Leaves out higher powers and damping.
    """

    stiffness: float = parameter("N/m^3", "b, force at a displacement of 1 m", low=-1e20, high=1e20, typical=(1e13, 1e19))
    by_axis: bool = option("whether x and y stiffen on their own", default=False)

    family: ClassVar[str] = "bearing_cubic_stiffness"
    signature: ClassVar[str] = "resonances that bend to higher speed with the amplitude, jumps in run-up and run-down, a third harmonic"
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"stiffness": (1e15, 1e16, 1e17, 1e18)}
    decisive: ClassVar[tuple[str, ...]] = ("stiffness",)

    def added(self, s: Across, v: Across, law: BearingDraft) -> Mapping[str, Value]:
        x, y = s["x"], s["y"]
        if self.by_axis:
            return {"x": self.stiffness * x * x * x, "y": self.stiffness * y * y * y}
        square = x * x + y * y
        return {"x": self.stiffness * square * x, "y": self.stiffness * square * y}
