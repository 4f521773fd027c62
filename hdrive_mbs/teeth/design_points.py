"""Designs of a stage as points: what is varied, why a point is refused, and what became of each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.teeth.deformation import FloatArray

VARIABLES = ("profile_angle", "height", "clearance", "amplitude")
UNITS = {"profile_angle": "rad", "height": "m", "clearance": "m", "amplitude": "m"}

REASONS = (
    "admissible",
    "the addendum is not positive: the tooth height is used up by the clearance",
    "the neutral fibre would lie in the teeth: the tooth is too high for the rim",
    "the tooth is pointed: its tip land is thinner than allowed",
    "neighbouring teeth run into each other at the root",
    "a tip comes too close to the root circle opposite: w0 is too large for the tooth height and clearance",
    "the teeth do not reach each other: w0 or the tooth height is too small",
    "tip interference on the starting axis: w0 does not draw the teeth apart",
    "tip interference on the way in and out of mesh: the profile angle is too small for the tooth height and w0",
    "flank interference near full depth: w0 does not fit the module, or the backlash is too small",
)


@dataclass(frozen=True, kw_only=True, eq=False)
class DesignPoints:
    """What became of each design, arrays of one length (lengths in m, angles in rad).

    verdict : number of the first broken condition in REASONS, 0 for admissible
    flank_gap : smallest separation of the teeth in mesh (minus infinity where there are no proper teeth)
    gap_angle : phi where it is
    bottom_gap : smaller of the two radial gaps between tip and root circle on the engagement axis
    passing_gap : radial gap between the tips on the starting axis
    tip_thickness : of the thinner tooth
    teeth_in_engagement : flexible teeth with a common height, all waves
    """

    profile_angle: FloatArray
    height: FloatArray
    clearance: FloatArray
    amplitude: FloatArray
    verdict: npt.NDArray[np.intp]
    flank_gap: FloatArray
    gap_angle: FloatArray
    bottom_gap: FloatArray
    passing_gap: FloatArray
    tip_thickness: FloatArray
    teeth_in_engagement: FloatArray

    @property
    def admissible(self) -> npt.NDArray[np.bool_]:
        return np.asarray(self.verdict == 0)
