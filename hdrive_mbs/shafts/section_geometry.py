"""Area, moments of area and shear coefficient of a circular section."""

from __future__ import annotations

import math
from dataclasses import dataclass

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.quantities import Described, parameter


def poisson_ratio(youngs_modulus: float, shear_modulus: float) -> float:
    """nu = E / (2 G) - 1 of an isotropic material, which needs -1 < nu <= 0.5."""
    ratio = youngs_modulus / (2.0 * shear_modulus) - 1.0
    if not -1.0 < ratio <= 0.5:
        raise ParameterError(
            f"E = {youngs_modulus:g} Pa and G = {shear_modulus:g} Pa give a Poisson ratio E/(2G) - 1 = {ratio:.4g}: an isotropic material "
            "has more than -1 and at most 0.5. Check the two moduli (steel: 2.1e11 and 8.1e10 Pa)."
        )
    return ratio


def cowper_shear_coefficient(poisson: float, bore_ratio: float = 0.0) -> float:
    """Mean shear stress over G times the mean shear angle of a round section, with m = bore / diameter:

        kappa = 6 (1 + nu) (1 + m^2)^2 / ((7 + 6 nu) (1 + m^2)^2 + (20 + 12 nu) m^2)

    Source: G. R. Cowper, The shear coefficient in Timoshenko's beam theory, J. Appl. Mech. 33 (1966) 335-340.
    It comes from static stresses far from the ends; Hutchinson (J. Appl. Mech. 68, 2001) fits vibrating beams better,
    6 (1 + nu)^2 / (7 + 12 nu + 4 nu^2) for the solid section, 4 % more at nu = 0.3.
    """
    if not -1.0 < poisson <= 0.5:
        raise ParameterError(f"Poisson ratio = {poisson:g}: an isotropic material has more than -1 and at most 0.5.")
    if not 0.0 <= bore_ratio < 1.0:
        raise ParameterError(f"bore / diameter = {bore_ratio:g}: must be at least 0 (solid) and below 1, to leave a wall.")
    squared = bore_ratio**2
    wall = (1.0 + squared) ** 2
    return 6.0 * (1.0 + poisson) * wall / ((7.0 + 6.0 * poisson) * wall + (20.0 + 12.0 * poisson) * squared)


@dataclass(frozen=True, kw_only=True)
class CircularSection(Described):
    """A round section, solid or bored: A = pi (D^2 - d^2) / 4, I = pi (D^4 - d^4) / 64, Ip = 2 I.

    Leaves out keyways, splines and fillets, which soften a shaft in bending by up to some per cent.
    """

    diameter: float = parameter("m", "outer diameter D", above=0.0)
    bore: float = parameter("m", "inner diameter d", default=0.0, low=0.0)

    def check(self) -> None:
        if self.bore >= self.diameter:
            raise ParameterError(
                f"{type(self).__name__}.bore = {self.bore:g} m: must be smaller than the diameter, {self.diameter:g} m, to leave a wall."
            )

    @property
    def area(self) -> float:
        """A [m^2]."""
        return math.pi / 4.0 * (self.diameter**2 - self.bore**2)

    @property
    def second_moment(self) -> float:
        """I about a diameter [m^4]."""
        return math.pi / 64.0 * (self.diameter**4 - self.bore**4)

    @property
    def polar_moment(self) -> float:
        """Ip about the axis [m^4]: the torsion constant too, since round sections do not warp."""
        return 2.0 * self.second_moment

    def shear_area(self, youngs_modulus: float, shear_modulus: float) -> float:
        """A_s = kappa A [m^2] of Cowper, with the Poisson ratio that the two moduli [Pa] imply."""
        return cowper_shear_coefficient(poisson_ratio(youngs_modulus, shear_modulus), self.bore / self.diameter) * self.area
