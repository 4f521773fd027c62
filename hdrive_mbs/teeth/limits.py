"""Limits in closed form for a gear with very many teeth: profile angle and backlash without interference."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.teeth.deformation import FloatArray


def entry_angle(amplitude: float, depth: float, waves: int = 2) -> float:
    """Angle [rad] from the engagement axis at which tips of a common height ``depth`` [m] on that axis part.

    w0 (1 - cos U b) = depth.  Raises ParameterError when they never part: depth > 2 w0.
    """
    if not 0.0 < depth <= 2.0 * amplitude:
        raise ParameterError(
            f"depth = {1e3 * depth:g} mm: must be greater than 0 and at most 2 w0 = {2e3 * amplitude:g} mm, or the teeth never part."
        )
    return float(np.arccos(1.0 - depth / amplitude) / waves)


def offset(angle: npt.ArrayLike, amplitude: float, shift: float, waves: int = 2) -> FloatArray:
    """Distance [m] of the tooth's axis from the middle of the space:  x = mu b - (w0/U) sin U b.

    angle : b [rad] from the engagement axis
    shift : mu [m], half the module times the difference of the teeth: travel along the pitch circle per rad
    """
    b = np.asarray(angle, float)
    return np.asarray(shift * b - amplitude / waves * np.sin(waves * b), float)


def rack_gap(
    angle: npt.ArrayLike, profile_angle: npt.ArrayLike, amplitude: float, shift: float, backlash: float = 0.0, waves: int = 2
) -> FloatArray:
    """Distance [m] of flank from flank when z -> infinity: parallel straight flanks, no tilt, first order.

    g(b) = (j/2 - |x(b)|) cos(alpha) + (mu - w0 cos U b) sin(alpha)

    The first term is the sideways, the second the radial motion; at w0 = mu the reference circles
    touch on the engagement axis.  Derived here; leaves out the curvature of the wheels and the tilt
    theta, both of the order of 1/z.
    """
    b, alpha = np.asarray(angle, float), np.asarray(profile_angle, float)
    sideways = backlash / 2.0 - np.abs(offset(b, amplitude, shift, waves))
    apart = shift - amplitude * np.cos(waves * b)
    return np.asarray(sideways * np.cos(alpha) + apart * np.sin(alpha), float)


def least_profile_angle(amplitude: float, shift: float, depth: float, backlash: float = 0.0, waves: int = 2) -> float:
    """Smallest profile angle [rad] without interference for z -> infinity, where w0 <= mu.

    tan(alpha) = max over 0 < b <= b_entry of (|x(b)| - j/2)/(mu - w0 cos U b)

    For w0 = mu, j = 0 and two waves the maximum is at the entry:
    tan(alpha) = (b - sin(2b)/2)/(1 - cos 2b)  at b = b_entry.

    Raises ParameterError for w0 > mu without the backlash for it: then a larger angle does not help.
    """
    if amplitude > shift and backlash == 0.0:
        raise ParameterError(
            f"w0 = {1e3 * amplitude:g} mm is above {1e3 * shift:g} mm (half the module times the difference of the teeth): the teeth wedge "
            "on the engagement axis at every profile angle. Give backlash, or reduce w0."
        )
    b = np.linspace(0.0, entry_angle(amplitude, depth, waves), 20001)[1:]
    apart = shift - amplitude * np.cos(waves * b)
    over = np.abs(offset(b, amplitude, shift, waves)) - backlash / 2.0
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = np.where(over > 0.0, np.where(apart > 0.0, over / apart, np.inf), 0.0)
    return float(np.arctan(np.max(slope)))


def least_backlash(profile_angle: float, amplitude: float, shift: float, depth: float, waves: int = 2) -> float:
    """Smallest backlash [m] along the pitch circle without interference for z -> infinity.

    2 max(|x| - (mu - w0 cos U b) tan(alpha)), at least 0
    """
    b = np.linspace(0.0, entry_angle(amplitude, depth, waves), 20001)
    needed = np.abs(offset(b, amplitude, shift, waves)) - (shift - amplitude * np.cos(waves * b)) * np.tan(profile_angle)
    return float(max(0.0, 2.0 * np.max(needed)))
