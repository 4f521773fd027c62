"""Contours of whole wheels: all teeth at once, around the generator or around one rigid tooth."""

from __future__ import annotations

import numpy as np

from hdrive_mbs.teeth.deformation import FloatArray
from hdrive_mbs.teeth.motion import placed
from hdrive_mbs.teeth.stage import Stage


def turned(points: FloatArray, angle: FloatArray) -> FloatArray:
    """Points (..., k, 2) turned towards +x (from y) by angles (...)."""
    c, s = np.cos(angle)[..., None], np.sin(angle)[..., None]
    x, y = points[..., 0], points[..., 1]
    return np.stack((x * c + y * s, y * c - x * s), axis=-1)


def tooth_line(stage: Stage, flexible: bool) -> FloatArray:
    """Open outline of one tooth without the body below it, from -x to +x."""
    outline = (stage.flexible if flexible else stage.rigid).outline()
    return np.asarray(outline[1:-1][::-1], float)


def flexible_teeth(stage: Stage, phi: float, numbers: FloatArray) -> FloatArray:
    """Outlines (n, k, 2) in m of flexible teeth at the generator angle phi, in the frame of the rigid wheel.

    Tooth 0 faces the rigid tooth 0 at phi = 0; the others follow towards +x.  Tooth k does what tooth
    0 did at phi - 2 pi k/z_f, k pitches of the rigid wheel further.
    """
    own = phi - numbers * stage.flexible.pitch_angle
    return turned(placed(stage, tooth_line(stage, True), own), numbers * stage.rigid.pitch_angle)


def rigid_teeth(stage: Stage, numbers: FloatArray) -> FloatArray:
    """Outlines (n, k, 2) in m of rigid teeth in their own frame."""
    line = tooth_line(stage, False)
    return turned(np.broadcast_to(line, (len(numbers), *line.shape)), numbers * stage.rigid.pitch_angle)


def generator_angle(stage: Stage, phi: float) -> float:
    """Direction of the generator's major axis [rad] in the frame of the rigid wheel, from y towards +x."""
    return phi * (1.0 + stage.relative_turn) - stage.start


def around(stage: Stage, phi: float = 0.0) -> tuple[FloatArray, FloatArray]:
    """Closed contours (n, 2) in m of all flexible and all rigid teeth, the generator's major axis along y."""
    back = np.array(-generator_angle(stage, phi))
    flexible = flexible_teeth(stage, phi, np.arange(stage.flexible.teeth, dtype=float))
    rigid = rigid_teeth(stage, np.arange(stage.rigid.teeth, dtype=float))
    return tuple(turned(teeth.reshape(-1, 2), back) for teeth in (flexible, rigid))  # type: ignore[return-value]


def fibre_line(stage: Stage, offset: float = 0.0, number: int = 721) -> FloatArray:
    """The deformed fibre, or a line at a distance [m] outside it, the major axis along y."""
    s = np.linspace(0.0, 2.0 * np.pi, number)
    fibre = stage.fibre()
    theta = fibre.rotation(s)
    radial = stage.fibre_radius + fibre.radial(s) + offset * np.cos(theta)
    tangential = fibre.tangential(s) + offset * np.sin(theta)
    return np.stack((radial * np.sin(s) + tangential * np.cos(s), radial * np.cos(s) - tangential * np.sin(s)), axis=-1)
