"""The double harmonic transmission: one short flexspline between a held ring and an output wheel."""

from __future__ import annotations

from dataclasses import dataclass

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.quantities import option, parameter
from hdrive_mbs.teeth.deformation import DeformationLaw
from hdrive_mbs.teeth.gear import WaveGear
from hdrive_mbs.teeth.kinematics import Mesh
from hdrive_mbs.teeth.stage import Stage, check_kind
from hdrive_mbs.teeth.wheel import ToothedWheel


@dataclass(frozen=True, kw_only=True)
class DoubleHarmonicGear(WaveGear):
    """Generator 1, flexspline 2 with outward teeth z2 and inward teeth z2', rings 3 (held) and 4 (output).

    i14 = z2 z4 / (z2 z4 - z3 z2')   with wheel 3 held

    Stage I (2/3) meshes on the major axis of the generator, stage II (2'/4) on the minor one: four
    zones a quarter turn apart.  z3 > z2 and z2' > z4, so the output always turns backwards.
    Source: seed I; the ratio from Willis (``kinematics.py``).
    """

    flexspline_outer: ToothedWheel = option("z2, flexible, teeth outwards")
    circular_spline: ToothedWheel = option("z3, rigid, teeth inwards")
    flexspline_inner: ToothedWheel = option("z2', flexible, teeth inwards")
    output_wheel: ToothedWheel = option("z4, rigid, teeth outwards")
    fibre_radius: float = parameter("m", "r02, radius of the undeformed neutral fibre", above=0.0, high=10.0)
    deformation: DeformationLaw = option("law of the radial displacement of the fibre")

    output = "output_wheel"

    def check(self) -> None:
        for name in ("flexspline_outer", "circular_spline", "flexspline_inner", "output_wheel"):
            check_kind("DoubleHarmonicGear", name, getattr(self, name), ToothedWheel)
        if self.flexspline_outer.direction < 0 or self.flexspline_inner.direction > 0:
            raise ParameterError("DoubleHarmonicGear: the outer teeth of the flexspline must point outwards and the inner ones inwards.")
        self.stages()

    def stages(self) -> tuple[Stage, ...]:
        return (
            Stage(
                name="stage I",
                flexible=self.flexspline_outer,
                rigid=self.circular_spline,
                fibre_radius=self.fibre_radius,
                deformation=self.deformation,
            ),
            Stage(
                name="stage II",
                flexible=self.flexspline_inner,
                rigid=self.output_wheel,
                fibre_radius=self.fibre_radius,
                deformation=self.deformation,
            ),
        )

    def meshes(self) -> tuple[Mesh, ...]:
        return (
            ("flexspline", self.flexspline_outer.teeth, "circular_spline", self.circular_spline.teeth),
            ("flexspline", self.flexspline_inner.teeth, "output_wheel", self.output_wheel.teeth),
        )

    def gains(self) -> tuple[float, ...]:
        return (self.flexspline_inner.teeth / self.output_wheel.teeth, 1.0)
