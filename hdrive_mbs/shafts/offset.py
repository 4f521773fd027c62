"""Displacements at a point beside a station, on a rigid arm along the axis."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import ParameterError

FloatArray = npt.NDArray[np.float64]


def rigid_arm(distance: float) -> FloatArray:
    """6x6 matrix T: [x, y, z, psi, theta, phi] at ``distance`` [m] along +z from a station is T times the station's own.

        x + a theta,   y - a psi,   the others unchanged

    Forces and moments at the point act on the station as T' times them (T' the transpose), matrices as T' () T.
    Leaves out second orders of the tilts, z - a (psi^2 + theta^2) / 2.
    """
    if not math.isfinite(distance):
        raise ParameterError(f"distance = {distance} m: the arm from the station to the point must have a finite length.")
    arm = np.eye(6)
    arm[0, 4] = distance
    arm[1, 3] = -distance
    return arm
