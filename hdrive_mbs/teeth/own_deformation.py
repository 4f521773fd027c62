"""A user's own deformation law, as a function or as a table."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Self

import numpy as np

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.quantities import option, parameter, table
from hdrive_mbs.tables import check_table
from hdrive_mbs.teeth.deformation import DeformationLaw, FloatArray


@dataclass(frozen=True, kw_only=True)
class FunctionDeformation(DeformationLaw):
    """w = scale * function(s), a plain function of an array of angles.  A scene file cannot hold it.

    Source: the user's.  Leaves out whether a ring can take this shape; only its length is kept.
    """

    function: Callable[[FloatArray], FloatArray] = option(
        "w [m] as a function of s [rad] from the major axis, 2 pi periodic", called_with=(("s",),)
    )
    scale: float = parameter("1", "factor on the function", default=1.0, above=0.0)

    def radial(self, angle: FloatArray) -> FloatArray:
        return np.asarray(self.scale * np.asarray(self.function(np.asarray(angle, float)), float), float)

    def scaled(self, amplitude: float) -> Self:
        return self.replacing(scale=_scale(self, amplitude))


@dataclass(frozen=True, kw_only=True)
class TableDeformation(DeformationLaw):
    """A measured or computed w(s): periodic cubic spline through the points, repeated after a period.

    The table runs from 0 to pi (two equal waves) or from 0 to 2 pi and ends as it began.

    Source: the user's measurement.  Leaves out whether a ring can take this shape; only its length is kept.
    """

    angles: tuple[float, ...] = table("rad", "angles from the major axis, rising from 0 to pi or 2 pi", low=0.0)
    displacements: tuple[float, ...] = table("m", "w at these angles")
    scale: float = parameter("1", "factor on the displacements", default=1.0, above=0.0)

    def check(self) -> None:
        check_table(self, "angles", "displacements")
        first, last = self.angles[0], self.angles[-1]
        if len(self.angles) < 9 or first != 0.0 or min(abs(last - np.pi), abs(last - 2.0 * np.pi)) > 1e-6:
            raise ParameterError(
                f"TableDeformation.angles: {len(self.angles)} angles from {first:g} to {last:g} rad; they must run from 0 to pi or "
                "to 2 pi rad, with at least 9 points."
            )
        largest = max(map(abs, self.displacements))
        if abs(self.displacements[-1] - self.displacements[0]) > 1e-3 * largest:
            raise ParameterError(
                f"TableDeformation.displacements begin with {1e3 * self.displacements[0]:g} mm and end with "
                f"{1e3 * self.displacements[-1]:g} mm; after a period w must be what it was."
            )
        super().check()

    def radial(self, angle: FloatArray) -> FloatArray:
        from scipy.interpolate import CubicSpline

        values = np.array(self.displacements)
        values[-1] = values[0]
        spline = CubicSpline(np.array(self.angles), values, bc_type="periodic")
        return np.asarray(self.scale * spline(np.mod(np.asarray(angle, float), self.angles[-1])), float)

    def scaled(self, amplitude: float) -> Self:
        return self.replacing(scale=_scale(self, amplitude))


def _scale(law: FunctionDeformation | TableDeformation, amplitude: float) -> float:
    now = law.on_major_axis
    if now <= 0.0:
        raise ParameterError(
            f"{type(law).__name__}: w on the major axis (s = 0) is {1e3 * now:g} mm; it must be positive there to be scaled."
        )
    return law.scale * amplitude / now
