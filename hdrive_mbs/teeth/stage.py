"""One pair of conjugated wheels: a flexible ring of teeth and a rigid one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.quantities import Described, option, parameter
from hdrive_mbs.teeth.deformation import DeformationLaw
from hdrive_mbs.teeth.fibre import Fibre, fibre
from hdrive_mbs.teeth.kinematics import check_assembly
from hdrive_mbs.teeth.wheel import StraightToothWheel, ToothedWheel


def check_kind(owner: str, field: str, value: object, kind: type[Described]) -> None:
    """Raise ParameterError unless the value is of the class that the field holds."""
    if not isinstance(value, kind):
        example = "CosineDeformation(amplitude=mm(0.3))" if kind is DeformationLaw else "StraightToothWheel(...)"
        raise ParameterError(f"{owner}: {field} = {value!r} is no {kind._kind}; give one, for example {example}.")


@dataclass(frozen=True, kw_only=True)
class Stage(Described):
    """A flexible and a rigid ring of teeth, the neutral fibre and the law that deforms it.

    Outward flexible teeth mesh on the major axis and start, in the paper's counting, on the minor
    one (stage I); inward teeth mesh on the minor axis and start on the major one (stage II).
    """

    _kind = "stage"

    name: str = option("how the stage is called in messages", default="stage")
    flexible: ToothedWheel = option("flexible wheel, undeformed")
    rigid: ToothedWheel = option("rigid wheel")
    fibre_radius: float = parameter("m", "r02, radius of the undeformed neutral fibre", above=0.0, high=10.0)
    deformation: DeformationLaw = option("law of the radial displacement of the fibre")

    def check(self) -> None:
        check_kind(self.name, "flexible", self.flexible, ToothedWheel)
        check_kind(self.name, "rigid", self.rigid, ToothedWheel)
        check_kind(self.name, "deformation", self.deformation, DeformationLaw)
        if self.flexible.direction == self.rigid.direction:
            word = "outwards" if self.flexible.direction > 0 else "inwards"
            raise ParameterError(f"{self.name}: the teeth of both wheels point {word}; one must point outwards and one inwards.")
        check_assembly(self.name, self.flexible.teeth, self.rigid.teeth, self.deformation.waves, self.direction)
        if self.direction * (self.flexible.root_radius - self.fibre_radius) < 0.0:
            raise ParameterError(
                f"{self.name}: the neutral fibre (r02 = {1e3 * self.fibre_radius:g} mm) lies in the teeth, whose root radius is "
                f"{1e3 * self.flexible.root_radius:g} mm; it must lie in the rim."
            )
        self._check_depth()

    def _check_depth(self) -> None:
        tip, root = (1e3 * gap for gap in self.bottom_clearances)
        reach = 1e3 * self.reach
        allowed = reach + min(tip, root)
        if allowed <= 0.0:
            raise ParameterError(
                f"{self.name}: negative clearance, the undeformed teeth already touch the bottom of the space: {tip + reach:.4g} mm from "
                f"the flexible tip to the rigid root, {root + reach:.4g} mm from the rigid tip to the flexible root. Correct the radii."
            )
        if min(tip, root) < 0.0:
            where = "flexible tip enters the rigid root" if tip < root else "rigid tip enters the flexible root"
            raise ParameterError(
                f"{self.name}: w0 is too large for the tooth height: the fibre moves {reach:.4g} mm towards the rigid wheel, the limit is "
                f"{allowed:.4g} mm, then the {where} circle. Reduce w0, or raise the clearance at the root."
            )
        if self.engagement_depth <= 0.0:
            raise ParameterError(
                f"{self.name}: the teeth do not reach each other: with w = {reach:.4g} mm on the engagement axis "
                f"{-1e3 * self.engagement_depth:.4g} mm are missing. Raise w0, or the tooth height."
            )

    # -- what follows from the data ---------------------------------------------------------------
    @property
    def direction(self) -> int:
        """+1 for outward flexible teeth, -1 for inward ones."""
        return self.flexible.direction

    @property
    def waves(self) -> int:
        return self.deformation.waves

    @property
    def start(self) -> float:
        """s [rad] of the starting axis, where the teeth are farthest apart: pi/waves for outward teeth, 0 for inward ones."""
        return np.pi / self.waves if self.direction > 0 else 0.0

    @property
    def engagement(self) -> float:
        """s [rad] of the axis on which the teeth mesh."""
        return np.pi / self.waves - self.start

    @property
    def relative_turn(self) -> float:
        """Turn of the flexible against the rigid wheel per angle of the generator against the flexible one, (z_f - z_r)/z_r."""
        return (self.flexible.teeth - self.rigid.teeth) / self.rigid.teeth

    @property
    def reach(self) -> float:
        """Displacement [m] of the fibre towards the rigid wheel on the engagement axis."""
        return self.direction * float(self.deformation.radial(np.array([self.engagement]))[0])

    @property
    def withdrawal(self) -> float:
        """Displacement [m] of the fibre away from the rigid wheel on the starting axis."""
        return -self.direction * float(self.deformation.radial(np.array([self.start]))[0])

    @property
    def bottom_clearances(self) -> tuple[float, float]:
        """Radial gaps [m] on the engagement axis: flexible tip to rigid root, rigid tip to flexible root."""
        d = self.direction
        tip = d * (self.rigid.root_radius - self.flexible.tip_radius) - self.reach
        root = d * (self.rigid.tip_radius - self.flexible.root_radius) - self.reach
        return tip, root

    @property
    def engagement_depth(self) -> float:
        """Common height [m] of the teeth on the engagement axis."""
        return self.direction * (self.flexible.tip_radius - self.rigid.tip_radius) + self.reach

    @property
    def passing_clearance(self) -> float:
        """Radial gap [m] between the tips on the starting axis, where tooth passes tooth."""
        return self.direction * (self.rigid.tip_radius - self.flexible.tip_radius) + self.withdrawal

    def fibre(self, exact: bool = True) -> Fibre:
        """The deformed fibre."""
        return fibre(self.deformation, self.fibre_radius, exact)

    # -- from standard proportions --------------------------------------------------------------------
    @classmethod
    def standard(
        cls,
        *,
        flexible_teeth: int,
        rigid_teeth: int,
        module: float,
        profile_angle: float,
        addendum: float,
        clearance: float,
        backlash: float,
        fibre_radius: float,
        deformation: DeformationLaw,
        name: str = "stage",
    ) -> Self:
        """Unshifted wheels of one module: reference radii m z/2, tip at addendum, root at addendum + clearance.

        module, addendum, clearance : m
        profile_angle : of the flexible tooth [rad].  The rigid tooth has +-pi/z_rigid more, so that flank lies on
            flank at full depth
        backlash : m, along the reference circle; half of it is taken from each tooth thickness pi m/2
        The teeth point outwards if the rigid wheel has more teeth.
        """
        check_kind(name, "deformation", deformation, DeformationLaw)
        if rigid_teeth == flexible_teeth:
            waves = deformation.waves
            raise ParameterError(
                f"{name}: both wheels have {flexible_teeth:g} teeth. The rigid wheel needs more around the flexible one, usually "
                f"{flexible_teeth + waves:g}, or fewer inside it, usually {flexible_teeth - waves:g}."
            )
        outward = 1 if rigid_teeth > flexible_teeth else -1
        if clearance < 0.0:
            raise ParameterError(
                f"{name}: clearance = {1e3 * clearance:g} mm is negative; the teeth would enter the root. It must be at least 0 mm."
            )
        if backlash < 0.0:
            raise ParameterError(f"{name}: backlash = {1e3 * backlash:g} mm is negative; the teeth would be thicker than their spaces.")
        if addendum <= 0.0 or module <= 0.0:
            raise ParameterError(f"{name}: module = {1e3 * module:g} mm and addendum = {1e3 * addendum:g} mm must be greater than 0 mm.")
        thickness = np.pi * module / 2.0 - backlash / 2.0

        def wheel(teeth: int, direction: int, angle: float) -> ToothedWheel:
            reference = module * teeth / 2.0
            return StraightToothWheel(
                teeth=teeth,
                tip_radius=reference + direction * addendum,
                root_radius=reference - direction * (addendum + clearance),
                reference_radius=reference,
                thickness=thickness,
                profile_angle=angle,
            )

        return cls(
            name=name,
            flexible=wheel(flexible_teeth, outward, profile_angle),
            rigid=wheel(rigid_teeth, -outward, profile_angle + outward * np.pi / rigid_teeth),
            fibre_radius=fibre_radius,
            deformation=deformation,
        )
