"""Kinematic-error effects from the pitch and eccentricity errors of a gear's wheels."""

from __future__ import annotations

from collections.abc import Iterable

from hdrive_mbs.effects.kinematic_error import KinematicError
from hdrive_mbs.teeth.gear import WaveGear
from hdrive_mbs.teeth.pitch_errors import WheelError, error_orders


def tooth_errors(gear: WaveGear, errors: Iterable[WheelError], imbalance: float = 0.0) -> tuple[KinematicError, ...]:
    """Effects to put at the mesh of a drive made from this gear, one for each order that comes through.

    Orders below 1e-9 rad are left out.  See ``teeth/pitch_errors.py`` for the law and what it leaves out.
    """
    return tuple(
        KinematicError(amplitude=order.amplitude, order=order.order, phase=order.phase, follows="wave_generator")
        for order in error_orders(gear, errors, imbalance)
        if order.amplitude >= 1e-9
    )
