"""Measured torque-twist table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.flexsplines.law import StiffnessLaw
from hdrive_mbs.quantities import table
from hdrive_mbs.tables import check_table, lines


@dataclass(frozen=True, kw_only=True)
class TableStiffness(StiffnessLaw):
    """Straight lines between measured points; the first and the last line go on beyond the table.

    The table has both senses and passes through zero; ``mirrored`` makes it from one side.

    Source: a measurement of the user's, as in the catalogue method of seed F, Fig. 5.  Leaves out
    hysteresis: of a measured loop give the mean of its two branches, less its torque at zero twist.
    """

    twists: tuple[float, ...] = table("rad", "twists, rising")
    torques: tuple[float, ...] = table("N m", "torques at these twists, not falling")

    def check(self) -> None:
        check_table(self, "twists", "torques")
        twists, torques = self.twists, self.torques
        for i in range(1, len(torques)):
            if torques[i] < torques[i - 1]:
                raise ParameterError(
                    f"TableStiffness.torques[{i}] = {torques[i]:g} N m is below torques[{i - 1}] = {torques[i - 1]:g} N m; a stiffness "
                    "is not negative. Smooth the measurement, or give the mean of the two branches of a loop."
                )
        if not twists[0] < 0.0 < twists[-1]:
            raise ParameterError(
                f"TableStiffness.twists go from {twists[0]:g} to {twists[-1]:g} rad; they must lie on both sides of zero. "
                "TableStiffness.mirrored(twists, torques) makes the other side."
            )
        at_zero = float(np.interp(0.0, twists, torques))
        if abs(at_zero) > 1e-9 * max(map(abs, torques)):
            raise ParameterError(
                f"TableStiffness gives {at_zero:g} N m at zero twist; it must give 0 N m. Subtract this torque, "
                "or shift the twists, before making the table."
            )

    @classmethod
    def mirrored(cls, twists: Sequence[float], torques: Sequence[float]) -> Self:
        """From one side, twists >= 0 and rising: the point (0, 0) is added if missing, and the other side."""
        if not len(twists) or len(twists) != len(torques) or twists[0] < 0.0:
            raise ParameterError(
                f"TableStiffness.mirrored: {len(twists)} twists and {len(torques)} torques, "
                "must be the same number of both, with twists from 0 rad upwards."
            )
        x, y = list(map(float, twists)), list(map(float, torques))
        if x[0] > 0.0:
            x, y = [0.0, *x], [0.0, *y]
        return cls(twists=(*(-v for v in reversed(x[1:])), *x), torques=(*(-v for v in reversed(y[1:])), *y))

    @property
    def half_gap(self) -> float:
        """Half the lost motion [rad]: the twist up to which both sides of the table are at zero."""
        x, y = np.array(self.twists), np.array(self.torques)
        zero = x[np.abs(y) <= 1e-9 * np.max(np.abs(y))]
        return float(max(0.0, min(-zero.min(), zero.max()))) if len(zero) else 0.0

    def torque(self, twist: Value) -> Value:
        return lines(twist, self.twists, self.torques)
