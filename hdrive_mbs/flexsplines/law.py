"""What every law of flexspline and mesh stiffness offers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from hdrive_mbs.call_arguments import cannot_be_called
from hdrive_mbs.errors import LawError
from hdrive_mbs.expression import Value, gradient
from hdrive_mbs.quantities import Described, option

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class StiffnessLaw(Described):
    """Elastic torque M(phi) [N m] of flexspline and mesh against the twist phi [rad].

    The K_FS of seed F (11)-(17) is, by its figures and by dimension, this torque; the stiffness
    in (2)-(3) is then the secant M(phi)/phi.
    """

    _kind: ClassVar[str] = "flexspline stiffness"
    _use: ClassVar[str] = "hm.HarmonicDrive(stiffness={name}(...)) takes it"
    restoring: ClassVar[bool] = True
    """Whether the law claims M(phi)*phi >= 0 (checked when a scene is assembled)."""

    def torque(self, twist: Value) -> Value:
        """Elastic torque [N m]; twist in rad, any shape."""
        raise NotImplementedError

    @property
    def half_gap(self) -> float:
        """Half the lost motion [rad]: the torque is zero for \\|phi\\| up to here."""
        return 0.0

    def check_restoring(self, largest_twist: float = 0.1) -> None:
        """Raise LawError where a law that claims to be restoring gives M(phi)*phi < 0, or no number.

        Looks at 2 x 300 twists between 1e-7 rad and largest_twist [rad], each sign, spaced both
        evenly and by magnitude; -1e-9 of the largest torque counts as zero (rounding).
        """
        wrong = cannot_be_called(self.torque, (("twist",),))
        if wrong:
            raise LawError(f"{type(self).__name__}.torque {wrong}")
        if not self.restoring:
            return
        sizes = np.unique(np.concatenate((np.geomspace(1e-7, largest_twist, 200), np.linspace(1e-7, largest_twist, 100))))
        twists = np.concatenate((-sizes[::-1], sizes))
        torques = self._sampled(twists)
        if not np.isfinite(torques).all():
            first = int(np.argmin(np.isfinite(torques)))
            raise LawError(f"{self.describe()} gives {torques[first]} N m at a twist of {twists[first]:.4g} rad: not a finite torque.")
        pull = torques * np.sign(twists)
        worst = int(np.argmin(pull))
        if pull[worst] < -1e-9 * float(np.max(np.abs(torques))):
            raise LawError(
                f"{self.describe()} claims to be restoring but gives {torques[worst]:.4g} N m at a twist of "
                f"{twists[worst]:.4g} rad: it must not pull away from zero twist. Correct the law or, if this is "
                "meant, write it as a StiffnessLaw subclass with restoring = False."
            )

    def is_slack(self) -> bool:
        """Whether it gives no torque at a twist of 1e-7 rad to either side: inside a gap."""
        return not np.any(self._sampled(np.array([-1e-7, 1e-7])))

    def _sampled(self, twists: FloatArray) -> FloatArray:
        """Torques at many twists, also of a law that takes single numbers only."""
        try:
            return np.asarray(self.torque(twists), float) + 0.0 * twists
        except (TypeError, ValueError):
            return np.array([float(self.torque(float(twist))) for twist in twists])

    def stiffness(self, twist: Value) -> Value:
        """Tangent stiffness dM/dphi [N m/rad], by differentiation of the law."""
        return gradient(self.torque)(twist)

    def twist(self, torque: npt.ArrayLike) -> FloatArray:
        """Twist [rad] at which the law gives this torque, by bracketing and bisection (Brent).

        For torque 0 the middle of the gap.  Raises LawError where the law never reaches the torque.
        """
        wanted = np.atleast_1d(np.asarray(torque, float))
        result = np.array([self._invert(float(value)) for value in wanted.ravel()])
        return result.reshape(np.shape(torque))

    def _invert(self, torque: float) -> float:
        from scipy.optimize import brentq

        if torque == 0.0:
            return 0.0
        sign = np.sign(torque)
        low = sign * self.half_gap
        high = sign * max(2.0 * self.half_gap, 1e-9)
        for _ in range(80):
            if sign * float(self.torque(high)) >= abs(torque):
                break
            low, high = high, 2.0 * high
        else:
            raise LawError(f"{self.describe()} never reaches {torque:g} N m within a twist of {high:g} rad.")
        if sign * float(self.torque(low)) >= abs(torque):
            return float(low)  # the law jumps past this torque at the edge of its gap
        return float(brentq(lambda phi: float(self.torque(phi)) - torque, low, high, xtol=1e-16, rtol=1e-14))


@dataclass(frozen=True, kw_only=True)
class StiffnessFunction(StiffnessLaw):
    """A plain Python function torque(twist) used as a law.  A scene file cannot hold it."""

    function: Callable[[Value], Value] = option("torque [N m] as a function of twist [rad]", called_with=(("twist",),))

    def torque(self, twist: Value) -> Value:
        return self.function(twist)
