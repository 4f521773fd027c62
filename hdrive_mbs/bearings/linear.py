"""Linear bearing: constant stiffness and damping coefficients."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt

from hdrive_mbs.bearings.coefficients import check_coefficients, fields_of, matrix_of
from hdrive_mbs.bearings.law import BearingLaw, FloatArray
from hdrive_mbs.quantities import parameter, table


@dataclass(frozen=True, kw_only=True)
class LinearBearing(BearingLaw):
    """Constant coefficients, of a rolling bearing or of a sliding bearing (k_xy != k_yx).

    F_B = K d + D d'

    Source: seed M (5), (6) without the nonlinear part; row and column of phi are zero.  Leaves out
    that coefficients depend on load and speed; those of a law about its static position come from
    ``law.linearised(load=..., speed=...)``, and then d counts from there and the static load is left out.

    Of a pair (xx and yy, xy and yx, psi and theta) give both or none.  ``isotropic`` and
    ``from_matrices`` make it from a few numbers or from full matrices.
    """

    stiffness_xx: float = parameter("N/m", "stiffness k_xx: force in x per displacement in x")
    stiffness_yy: float = parameter("N/m", "stiffness k_yy")
    stiffness_xy: float | None = parameter("N/m", "cross-coupled stiffness k_xy: force in x per displacement in y", default=None)
    stiffness_yx: float | None = parameter("N/m", "cross-coupled stiffness k_yx: force in y per displacement in x", default=None)
    stiffness_zz: float = parameter("N/m", "axial stiffness k_zz; zero for a floating bearing", default=0.0)
    stiffness_psi: float | None = parameter("N m/rad", "tilt stiffness about x", default=None)
    stiffness_theta: float | None = parameter("N m/rad", "tilt stiffness about y", default=None)
    stiffness_couplings: tuple[float, ...] | None = table("SI", "other entries of K, 36 values row by row", default=None)
    damping_xx: float | None = parameter("N s/m", "damping d_xx: force in x per velocity in x", default=None)
    damping_yy: float | None = parameter("N s/m", "damping d_yy", default=None)
    damping_xy: float | None = parameter("N s/m", "cross-coupled damping d_xy", default=None)
    damping_yx: float | None = parameter("N s/m", "cross-coupled damping d_yx", default=None)
    damping_zz: float = parameter("N s/m", "axial damping d_zz", default=0.0)
    damping_psi: float | None = parameter("N m s/rad", "tilt damping about x", default=None)
    damping_theta: float | None = parameter("N m s/rad", "tilt damping about y", default=None)
    damping_couplings: tuple[float, ...] | None = table("SI", "other entries of D, 36 values row by row", default=None)

    def check(self) -> None:
        check_coefficients(self, "stiffness")
        check_coefficients(self, "damping")

    @classmethod
    def isotropic(
        cls, *, radial: float, damping: float, axial: float = 0.0, axial_damping: float = 0.0, tilt: float = 0.0, tilt_damping: float = 0.0
    ) -> LinearBearing:
        """Alike in x and y.

        radial, axial : stiffness [N/m]
        damping, axial_damping : N s/m, radial and axial
        tilt, tilt_damping : N m/rad and N m s/rad, about x and about y
        """
        return LinearBearing.from_matrices(
            stiffness=np.diag([radial, radial, axial, tilt, tilt, 0.0]),
            damping=np.diag([damping, damping, axial_damping, tilt_damping, tilt_damping, 0.0]),
        )

    @classmethod
    def from_matrices(cls, *, stiffness: npt.ArrayLike, damping: npt.ArrayLike) -> Self:
        """From full 6x6 matrices over [x, y, z, psi, theta, phi], SI units, row and column of phi zero."""
        return cls(**fields_of(cls.__name__, "stiffness", stiffness), **fields_of(cls.__name__, "damping", damping))

    def stiffness_matrix(self) -> FloatArray:
        return matrix_of(self, "stiffness")

    def damping_matrix(self) -> FloatArray:
        return matrix_of(self, "damping")
