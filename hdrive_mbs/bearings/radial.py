"""What laws of the radial forces share: linear springs and dampers along and across the axis."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.bearings.law import BearingLaw, FloatArray
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class RadialBearing(BearingLaw):
    """Base of laws that give forces in x and y; z and tilts are linear and, if not given, free."""

    axial_stiffness: float = parameter("N/m", "linear stiffness in z; zero for a floating bearing", default=0.0, low=0.0)
    axial_damping: float = parameter("N s/m", "linear damping in z", default=0.0, low=0.0)
    tilt_stiffness: float = parameter("N m/rad", "linear stiffness against tilts about x and y", default=0.0, low=0.0)
    tilt_damping: float = parameter("N m s/rad", "linear damping of tilts about x and y", default=0.0, low=0.0)

    _kind: ClassVar[str] = "radial bearing law"

    def stiffness_matrix(self) -> FloatArray:
        return np.diag([0.0, 0.0, self.axial_stiffness, self.tilt_stiffness, self.tilt_stiffness, 0.0])

    def damping_matrix(self) -> FloatArray:
        return np.diag([0.0, 0.0, self.axial_damping, self.tilt_damping, self.tilt_damping, 0.0])
