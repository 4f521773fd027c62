"""The housing of a bearing on its elastic foundation."""

from __future__ import annotations

from dataclasses import dataclass

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import Described, parameter


@dataclass(frozen=True, kw_only=True)
class Housing(Described):
    """m_h x'' + b x' + k x + k_n x^n = F_B in x and in y (seed M (8), last two lines).

    The housing does not tilt, turn or move axially; the foundation under it is the ground.
    """

    mass: float = parameter("kg", "mass m_h", above=0.0)
    stiffness_x: float = parameter("N/m", "foundation stiffness in x", low=0.0)
    stiffness_y: float = parameter("N/m", "foundation stiffness in y", low=0.0)
    damping_x: float = parameter("N s/m", "foundation damping in x", default=0.0, low=0.0)
    damping_y: float = parameter("N s/m", "foundation damping in y", default=0.0, low=0.0)
    power_stiffness_x: float = parameter("N/m^n", "power term k_n in x", default=0.0)
    power_stiffness_y: float = parameter("N/m^n", "power term k_n in y", default=0.0)
    power: float = parameter("1", "exponent n of the power term, odd", default=3.0, low=3.0, high=9.0)

    def check(self) -> None:
        if self.power % 2.0 != 1.0:
            raise ParameterError(
                f"Housing.power = {self.power:g}: must be an odd whole number (3, 5, 7, 9); an even power would push one way on both sides."
            )

    @classmethod
    def isotropic(cls, *, mass: float, stiffness: float, damping: float = 0.0, power_stiffness: float = 0.0, power: float = 3.0) -> Housing:
        """The same foundation in x and y."""
        return cls(
            mass=mass,
            stiffness_x=stiffness,
            stiffness_y=stiffness,
            damping_x=damping,
            damping_y=damping,
            power_stiffness_x=power_stiffness,
            power_stiffness_y=power_stiffness,
            power=power,
        )

    def spring(self, direction: str, x: Value) -> Value:
        """Force of the foundation [N] against a displacement in "x" or "y" [m]: k x + k_n x^n."""
        stiffness, power = getattr(self, f"stiffness_{direction}"), getattr(self, f"power_stiffness_{direction}")
        return stiffness * x + (power * raised(x, int(self.power)) if power != 0.0 else 0.0)

    def force(self, direction: str, x: Value, v: Value) -> Value:
        """Of the housing on its foundation [N]: k x + k_n x^n + b x'."""
        return self.spring(direction, x) + getattr(self, f"damping_{direction}") * v


def raised(value: Value, exponent: int) -> Value:
    """value^n by multiplication, exact for negative values in every back end."""
    result = value
    for _ in range(exponent - 1):
        result = result * value
    return result
