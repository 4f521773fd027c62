"""Clearance over generator angle and w0."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import LawError, ParameterError
from hdrive_mbs.teeth.clearance import beside
from hdrive_mbs.teeth.deformation import FloatArray
from hdrive_mbs.teeth.polygons import signed_gap
from hdrive_mbs.teeth.stage import Stage


@dataclass(frozen=True, kw_only=True, eq=False)
class ClearanceMap:
    """gap [m] of the tooth outlines over w0 (rows) and the generator angle phi (columns), negative for interference.

    Rows in which the stage cannot be built at all (a tip in a root, teeth that do not reach) are not a number.
    """

    stage: Stage
    angles: FloatArray
    amplitudes: FloatArray
    gap: FloatArray


def clearance_map(stage: Stage, amplitudes: npt.ArrayLike | None = None, angles: npt.ArrayLike | None = None) -> ClearanceMap:
    """Gaps for several w0 [m] (by default 0.8 to 1.2 of the present one) from the starting axis through a whole wave."""
    now = stage.deformation.on_major_axis
    chosen = now * np.linspace(0.8, 1.2, 41) if amplitudes is None else np.asarray(amplitudes, float)
    phi = np.linspace(0.0, 2.0 * np.pi / stage.waves, 181) if angles is None else np.asarray(angles, float)
    fixed = stage.rigid.outline()
    gap = np.full((len(chosen), len(phi)), np.nan)
    for row, amplitude in enumerate(chosen):
        try:
            changed = stage.replacing(deformation=stage.deformation.scaled(float(amplitude)))
        except (ParameterError, LawError):
            continue
        gap[row] = np.min(signed_gap(beside(changed, phi), fixed).distance, axis=1)
    return ClearanceMap(stage=stage, angles=phi, amplitudes=chosen, gap=gap)
