"""A dead zone with sharp or rounded corners, for the laws that share it."""

from __future__ import annotations

import numpy as np

from hdrive_mbs.expression import Value


def dead_zone(twist: Value, width: float, rounding: float) -> Value:
    """d(x) = x + (sqrt((x - h)^2 + e^2) - sqrt((x + h)^2 + e^2))/2,  h = width/2: x outside less h, 0 inside for e = 0."""
    half = 0.5 * width
    if rounding == 0.0:
        return twist - np.clip(twist, -half, half)
    return twist + 0.5 * (np.sqrt((twist - half) ** 2 + rounding**2) - np.sqrt((twist + half) ** 2 + rounding**2))


def beyond(twist: Value, gap: float) -> Value:
    """The twist at which a law with a gap of its own, of that full width [rad], is as far beyond its edge as twist is from zero."""
    return twist + 0.5 * gap * np.sign(twist)


def contact_share(twist: Value, width: float, rounding: float) -> Value:
    """dd/dx: 0 in the middle of a wide gap, 1 far outside."""
    half = 0.5 * width
    if rounding == 0.0:
        return np.where(np.abs(twist) > half, 1.0, 0.0)
    ahead, behind = twist - half, twist + half
    return 1.0 + 0.5 * (ahead / np.sqrt(ahead**2 + rounding**2) - behind / np.sqrt(behind**2 + rounding**2))
