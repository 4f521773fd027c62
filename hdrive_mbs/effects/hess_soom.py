"""Sliding torque that drops with the speed like a hyperbola, and may differ in both senses."""

from __future__ import annotations

import numpy as np

from hdrive_mbs.effects.speed_growth import grown
from hdrive_mbs.expression import Value


def hess_soom(speed: Value, *, coulomb: float, drop: float, stribeck_speed: float, exponent: float, asymmetry: float) -> Value:
    """L(w) = T_C (1 + a sign(w)) (1 + d/(1 + |w/w_S|^p)) [N m]

    Source: Hess, Soom, J. Tribology 112 (1990) 147, with p = 2.
    """
    size = coulomb * (1.0 + asymmetry * np.sign(speed))
    return size if drop == 0.0 else size * (1.0 + drop / (1.0 + grown(speed, stribeck_speed, exponent)))
