"""What effects on a piece of shaft look at: its bending moment at a point, and the shapes into which it bends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.network.bearing_draft import ShaftPiece
from hdrive_mbs.tracked_arrays import largest, proportions

_X, _Y = (0, 4, 6, 10), (1, 3, 7, 9)
"""Places of displacement and tilt at both ends in the 12-vector, in the plane (x, theta) and in the plane (y, -psi)."""
_SIGNS = (1.0, -1.0, 1.0, -1.0)


def _rows(values: Sequence[float]) -> tuple[list[float], list[float]]:
    """The same function of displacements and slopes in both planes, as rows over the 12-vector."""
    x, y = [0.0] * 12, [0.0] * 12
    for at_x, at_y, sign, value in zip(_X, _Y, _SIGNS, values, strict=True):
        x[at_x], y[at_y] = value, sign * value
    return x, y


@dataclass(frozen=True)
class BendingShape:
    """One quantity of the bending of a piece, alike in both planes.

    stretches : "x" and "y" -> factors of coordinates that make it, the largest of them about 1
    size : what it has to be multiplied by
    """

    stretches: dict[str, dict[str, float]]
    size: float


def moment_at(piece: ShaftPiece, share: float) -> tuple[BendingShape, float]:
    """Bending moment [N m] at a share of the length from end a, positive when the piece curves towards +x (+y), from the
    displacements of its ends; and the moment per kink [N m/rad] there with both ends held.

    M = -M_a + z F_a with the forces F_a, M_a that hold end a; a kink of angle d there has the ends pull with -d dM/dq (the
    reciprocal theorem of Betti), so that it is met by h = z dM/dx_a - dM/dtheta_a.
    """
    plane = piece.bending[np.ix_(_X, _X)]
    size = largest(plane[1])
    held = proportions(plane[:2], size)
    place = share * piece.length  # no arrays from here on, which would not see that a share is tracked (tracked.py)
    values = [place * force - moment for force, moment in zip(held[0].tolist(), held[1].tolist(), strict=True)]
    stretches = {key: piece.stretch(row) for key, row in zip("xy", _rows(values), strict=True)}
    return BendingShape(stretches, size), size * (place * values[0] - values[1])


def bent_shapes(piece: ShaftPiece) -> list[tuple[BendingShape, float]]:
    """Two shapes s_k [m] into which a piece bends, with stiffness [N/m]: energy = sum(stiffness s_k^2)/2 in each plane.

    A uniform piece of length L is two springs, shear included:  s_0 = L/2 (theta_b - theta_a)  and
    s_1 = x_b - x_a - L/2 (theta_a + theta_b), for both displace the ends in ways that store no energy together.  Read off its stiffness:
    with f_0, f_1 these factors over (x_a, theta_a, x_b, theta_b), K = k_0 f_0 f_0^T + k_1 f_1 f_1^T.
    """
    plane, half = piece.bending[np.ix_(_X, _X)].tolist(), 0.5 * piece.length
    turned, sheared = 0.5 * (plane[1][1] - plane[1][3]) / half**2, plane[0][0]
    shapes = ((0.0, -half, 0.0, half), turned), ((-1.0, -half, 1.0, -half), sheared)
    pairs = ((dict(zip("xy", _rows(values), strict=True)), stiffness) for values, stiffness in shapes)
    return [(BendingShape({key: piece.stretch(row) for key, row in rows.items()}, 1.0), stiffness) for rows, stiffness in pairs]
