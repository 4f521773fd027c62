"""Bearing with a stiffness that grows with an odd power of the displacement."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Self

import numpy.typing as npt

from hdrive_mbs.bearings.coefficients import check_coefficients, fields_of, matrix_of
from hdrive_mbs.bearings.law import DIRECTIONS, FloatArray, RelativeMotion
from hdrive_mbs.bearings.linear import LinearBearing
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter, table


@dataclass(frozen=True, kw_only=True)
class PowerBearing(LinearBearing):
    """A linear bearing with an odd power of each displacement on top.

    F_B = K d + K_n d^n + D d'  with (d^n)_j = d_j^n, element by element

    Source: seed M (5), (6).  Leaves out clearance and the dependence of one direction on the other
    (x^3 does not see y: the bearing is softer along the diagonal; take BallBearing for true contact).
    An even n would push the same way on both sides and is refused.
    """

    exponent: float = parameter("1", "power n, odd and at least 3", default=3.0, low=3.0)
    power_stiffness_xx: float = parameter("N/m^n", "K_n of x on x: force at 1 m")
    power_stiffness_yy: float = parameter("N/m^n", "K_n of y on y")
    power_stiffness_xy: float | None = parameter("N/m^n", "K_n of y on the force in x", default=None)
    power_stiffness_yx: float | None = parameter("N/m^n", "K_n of x on the force in y", default=None)
    power_stiffness_zz: float = parameter("N/m^n", "K_n of z on z", default=0.0)
    power_stiffness_psi: float | None = parameter("N m/rad^n", "K_n of psi on psi", default=None)
    power_stiffness_theta: float | None = parameter("N m/rad^n", "K_n of theta on theta", default=None)
    power_stiffness_couplings: tuple[float, ...] | None = table("SI", "other entries of K_n, 36 values row by row", default=None)

    def check(self) -> None:
        super().check()
        check_coefficients(self, "power_stiffness")
        if self.exponent % 2.0 != 1.0:
            what = "even: the force would push the same way on both sides" if self.exponent % 1.0 == 0.0 else "not a whole number"
            raise ParameterError(f"PowerBearing.exponent = {self.exponent:g} is {what}. Give an odd power, usually 3.")

    @classmethod
    def from_matrices(  # type: ignore[override]
        cls, *, stiffness: npt.ArrayLike, damping: npt.ArrayLike, power_stiffness: npt.ArrayLike, exponent: float = 3.0
    ) -> Self:
        """From full 6x6 matrices K, D and K_n over [x, y, z, psi, theta, phi], row and column of phi zero."""
        named = {"stiffness": stiffness, "damping": damping, "power_stiffness": power_stiffness}
        fields = {key: value for prefix, matrix in named.items() for key, value in fields_of(cls.__name__, prefix, matrix).items()}
        return cls(exponent=exponent, **fields)

    @classmethod
    def isotropic(cls, *, power_radial: float, exponent: float = 3.0, **linear: float) -> PowerBearing:  # type: ignore[override]
        """Alike in x and y.

        power_radial : K_n of x on x and of y on y [N/m^n]; linear : as of LinearBearing.isotropic
        """
        base = LinearBearing.isotropic(**linear)
        fields = {field: value for field, value, _ in base.fields()}
        return PowerBearing(exponent=exponent, power_stiffness_xx=power_radial, power_stiffness_yy=power_radial, **fields)

    def power_matrix(self) -> FloatArray:
        """K_n, 6x6."""
        return matrix_of(self, "power_stiffness")

    def forces(self, motion: RelativeMotion) -> Mapping[str, Value]:
        coordinates = (motion.x, motion.y, motion.z, motion.psi, motion.theta)
        result: dict[str, Value] = {}
        for direction, row in zip(DIRECTIONS, self.power_matrix(), strict=True):
            terms = [float(k) * self._power(value) for k, value in zip(row, coordinates) if k != 0.0]
            if terms:
                result[direction] = sum(terms[1:], terms[0])
        return result

    def _power(self, value: Value) -> Value:
        """value^n by products, right for negative values too."""
        square = value * value
        result = value
        for _ in range(int(self.exponent) // 2):
            result = result * square
        return result
