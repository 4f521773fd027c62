"""The ordinary harmonic drive: one flexspline in one circular spline."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

from hdrive_mbs.quantities import option, parameter
from hdrive_mbs.teeth.deformation import DeformationLaw
from hdrive_mbs.teeth.gear import WaveGear
from hdrive_mbs.teeth.kinematics import GENERATOR, Mesh
from hdrive_mbs.teeth.stage import Stage
from hdrive_mbs.teeth.wheel import ToothedWheel


@dataclass(frozen=True, kw_only=True)
class HarmonicGear(WaveGear):
    """Flexspline with outward teeth z2 in a circular spline with z3.

    With the circular spline held  i = -z2/(z3 - z2), with the flexspline held  i = z3/(z3 - z2).
    Source: Willis, seen from the wave generator (``kinematics.py``).
    """

    flexspline: ToothedWheel = option("flexible wheel, teeth outwards")
    circular_spline: ToothedWheel = option("rigid wheel, teeth inwards")
    fibre_radius: float = parameter("m", "r02, radius of the undeformed neutral fibre", above=0.0, high=10.0)
    deformation: DeformationLaw = option("law of the radial displacement of the fibre")

    output = "flexspline"

    def check(self) -> None:
        self.stages()

    def stages(self) -> tuple[Stage, ...]:
        return (
            Stage(
                name="mesh flexspline/circular_spline",
                flexible=self.flexspline,
                rigid=self.circular_spline,
                fibre_radius=self.fibre_radius,
                deformation=self.deformation,
            ),
        )

    def meshes(self) -> tuple[Mesh, ...]:
        return (("flexspline", self.flexspline.teeth, "circular_spline", self.circular_spline.teeth),)

    def gains(self) -> tuple[float, ...]:
        return (1.0,)

    @classmethod
    def standard(
        cls,
        *,
        flexspline_teeth: int,
        circular_spline_teeth: int,
        module: float,
        profile_angle: float,
        addendum: float,
        clearance: float,
        backlash: float,
        fibre_radius: float,
        deformation: DeformationLaw,
    ) -> Self:
        """Unshifted wheels of one module with straight flanks: see Stage.standard."""
        stage = Stage.standard(
            name="mesh flexspline/circular_spline",
            flexible_teeth=flexspline_teeth,
            rigid_teeth=circular_spline_teeth,
            module=module,
            profile_angle=profile_angle,
            addendum=addendum,
            clearance=clearance,
            backlash=backlash,
            fibre_radius=fibre_radius,
            deformation=deformation,
        )
        return cls(flexspline=stage.flexible, circular_spline=stage.rigid, fibre_radius=fibre_radius, deformation=deformation)


__all__ = ["GENERATOR", "HarmonicGear"]
