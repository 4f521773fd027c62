"""A toothed wheel: number of teeth, radii, and the outline of its tooth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hdrive_mbs.conversions import degrees
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.quantities import Described, parameter, table
from hdrive_mbs.tables import check_table
from hdrive_mbs.teeth.deformation import FloatArray
from hdrive_mbs.teeth.outline import closed, crossings, straight_flank


@dataclass(frozen=True, kw_only=True)
class ToothedWheel(Described):
    """One ring of teeth, undeformed.  Teeth point outwards if the tip radius is the larger one.

    A tooth of a user's own is ``OutlinedWheel``, or a subclass that gives ``right_flank``.
    """

    _kind = "toothed wheel"

    teeth: int = parameter("1", "number of teeth", low=8, high=5000)
    tip_radius: float = parameter("m", "radius of the addendum circle (r_a)", above=0.0, high=10.0)
    root_radius: float = parameter("m", "radius of the dedendum circle (r_f)", above=0.0, high=10.0)

    def check(self) -> None:
        name = type(self).__name__
        if self.teeth != int(self.teeth):
            raise ParameterError(f"{name}.teeth = {self.teeth:g}: must be a whole number.")
        object.__setattr__(self, "teeth", int(self.teeth))
        if self.tip_radius == self.root_radius:
            raise ParameterError(f"{name}: tip and root radius are both {1e3 * self.tip_radius:g} mm; a tooth needs a height.")
        if self.height > 0.2 * self.root_radius:
            raise ParameterError(
                f"{name}: the tooth is {1e3 * self.height:g} mm high at a root radius of {1e3 * self.root_radius:g} mm; lengths are in m "
                "(use mm(...)), and teeth of wave gears are far below a fifth of the radius."
            )
        outline = self.outline()
        flank = self.right_flank()
        if not np.isfinite(outline).all() or flank[-1, 0] <= 0.0 or bool(crossings(outline)):
            raise ParameterError(f"{name} with {self.teeth} teeth: the outline of the tooth crosses itself. {self._pointed(flank)}")
        widest = np.max(np.arctan2(flank[:, 0], flank[:, 1]))
        if widest * self.teeth > np.pi:
            raise ParameterError(
                f"{name} with {self.teeth} teeth: the outlines of neighbouring teeth cross, the tooth is up to "
                f"{2e3 * widest * self.root_radius:.4g} mm wide at a pitch of {1e3 * self.pitch_angle * self.root_radius:.4g} mm. "
                "Make the tooth thinner, lower, or its flank steeper."
            )

    def _pointed(self, flank: FloatArray) -> str:
        return f"It is {2e3 * flank[-1, 0]:.4g} mm thick at the tip; make it lower, thicker or its flank steeper."

    @property
    def direction(self) -> int:
        """+1 if the teeth point outwards, -1 if inwards."""
        return 1 if self.tip_radius > self.root_radius else -1

    @property
    def height(self) -> float:
        """Height of the tooth [m]."""
        return abs(self.tip_radius - self.root_radius)

    @property
    def pitch_angle(self) -> float:
        """2 pi / z [rad]."""
        return 2.0 * np.pi / self.teeth

    def right_flank(self) -> FloatArray:
        """Points (a, y) of the flank at +a, from root to tip; a across, y along the tooth's axis from the wheel's centre."""
        raise NotImplementedError

    def outline(self) -> FloatArray:
        """Closed outline (n, 2) of one tooth with the piece of the body below it."""
        return closed(self.right_flank())

    @property
    def tip_thickness(self) -> float:
        """Width of the tip land [m]."""
        return float(2.0 * self.right_flank()[-1, 0])


@dataclass(frozen=True, kw_only=True)
class StraightToothWheel(ToothedWheel):
    """Straight flanks at the profile angle to the tooth's axis.

    Source: seed I (profile angle alpha); the usual form of the first wave gears (Musser, US 2906143).
    Leaves out rounded edges and fillets.
    """

    reference_radius: float = parameter("m", "radius at which the thickness is given (unshifted: module * teeth / 2)", above=0.0, high=10.0)
    thickness: float = parameter("m", "tooth thickness along the reference circle", above=0.0)
    profile_angle: float = parameter("rad", "alpha, between flank and tooth axis", low=0.0, high=degrees(60.0))

    def right_flank(self) -> FloatArray:
        return straight_flank(self.tip_radius, self.root_radius, self.reference_radius, self.thickness, self.profile_angle)


@dataclass(frozen=True, kw_only=True)
class OutlinedWheel(ToothedWheel):
    """Any symmetric tooth: points of its right flank from root to tip, joined by straight lines.

    Source: the user's drawing.  Leaves out what lies between the points.
    """

    heights: tuple[float, ...] = table("m", "heights above the root circle, rising from 0 to the tooth height", low=0.0)
    half_widths: tuple[float, ...] = table("m", "half the tooth's width at these heights", above=0.0)

    def check(self) -> None:
        check_table(self, "heights", "half_widths")
        if abs(self.heights[0]) > 1e-9 or abs(self.heights[-1] - self.height) > 1e-6 * self.height + 1e-9:
            raise ParameterError(
                f"OutlinedWheel.heights run from {1e3 * self.heights[0]:g} to {1e3 * self.heights[-1]:g} mm; they must run from 0 to the "
                f"height of the tooth, {1e3 * self.height:g} mm."
            )
        super().check()

    def right_flank(self) -> FloatArray:
        a = np.array(self.half_widths)
        radius = self.root_radius + self.direction * np.array(self.heights)
        return np.stack((a, np.sqrt(radius**2 - a**2)), axis=-1)
