"""The shaft over a bearing, condensed to its ends and to what has to stay between them."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.components.supported_line import ENDS, SupportedLine
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.shafts.condensation import Condensed, craig_bampton

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class CondensedLine:
    """What is left over the ends a and b (6-vectors, phi without entries) and the coordinates kept between them.

    kept : names of the coordinates kept, then ``mode_1``...
    falling : forces per acceleration of gravity [kg], (n, 3)
    ring : rows of the ring's x, y, z, psi, theta, (5, n);  ring_sag : what its own weight adds, per gravity, (5, 3)
    frequencies : of the fixed-interface modes kept;  neglected : lowest one left out [rad/s]
    lag : longest relaxation time of what was eliminated, its damping over its stiffness [s]
    """

    kept: tuple[str, ...]
    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    circulatory: FloatArray
    rotating: FloatArray
    falling: FloatArray
    ring: FloatArray
    ring_sag: FloatArray
    frequencies: FloatArray
    neglected: float
    lag: float


def condensed_line(line: SupportedLine, kept: Sequence[str], *, above: float = 0.0) -> CondensedLine:
    """Everything but the ends, the coordinates ``kept`` and the fixed-interface modes below ``above`` [rad/s] eliminated statically."""
    ends = [*range(10)]
    boundary = [*ends, *line.at(*kept)]
    interior = [k for k in range(len(line.names)) if k not in boundary]
    result = _with_modes(line, boundary, interior, above)
    count = len(result.frequencies)
    scale = _scales(line, result, len(boundary))
    shapes = result.transformation * scale

    wide = np.zeros((12 + len(kept) + count, len(scale)))
    wide[[*ENDS, *range(12, len(wide))], range(len(scale))] = 1.0

    def spread(matrix: FloatArray) -> FloatArray:
        return wide @ (shapes.T @ matrix @ shapes) @ wide.T

    inner_stiffness = line.stiffness[np.ix_(interior, interior)]
    flexibility = np.zeros_like(line.stiffness)
    flexibility[np.ix_(interior, interior)] = np.linalg.inv(inner_stiffness)
    modal = result.transformation[:, len(boundary) :]
    if count:
        flexibility -= (modal / result.frequencies**2) @ modal.T
    ring = line.place[[*range(10, 15)]]
    return CondensedLine(
        kept=(*kept, *(f"mode_{k}" for k in range(1, count + 1))),
        mass=spread(line.mass),
        damping=spread(line.damping),
        stiffness=spread(line.stiffness),
        circulatory=spread(line.circulatory),
        rotating=spread(line.rotating),
        falling=wide @ shapes.T @ line.falling,
        ring=ring @ shapes @ wide.T,
        ring_sag=ring @ flexibility @ line.falling,
        frequencies=result.frequencies,
        neglected=result.neglected,
        lag=_lag(line, interior),
    )


def _with_modes(line: SupportedLine, boundary: Sequence[int], interior: Sequence[int], above: float) -> Condensed:
    """Craig and Bampton's method with all modes below a frequency."""
    result = _projected(line, boundary, interior, 0)
    for modes in range(1, len(interior) + 1):
        if not result.neglected < above:
            break
        with contextlib.suppress(ParameterError):  # a cut through a pair of equal frequencies: take both
            result = _projected(line, boundary, interior, modes)
    return result


def _projected(line: SupportedLine, boundary: Sequence[int], interior: Sequence[int], modes: int) -> Condensed:
    return craig_bampton(line.mass, line.damping, line.stiffness, boundary, interior, modes=modes, names=line.names, galerkin=True)


def _scales(line: SupportedLine, result: Condensed, boundary: int) -> FloatArray:
    """Factors of the columns: 1 for coordinates; modes get a largest displacement of 1 (tilts times the spread of the line)."""
    modal = (line.place @ result.transformation)[:, boundary:]
    tilts = np.array([name.endswith((".psi", ".theta")) for name in line.names])
    lengths = np.where(tilts, _arm(line), 1.0)
    sizes = np.max(np.abs(modal) * lengths[:, None], axis=0, initial=0.0)
    return np.concatenate([np.ones(boundary), 1.0 / sizes])


def _arm(line: SupportedLine) -> float:
    """Length that makes a displacement of a tilt: root of tilt stiffness over radial stiffness at the ring."""
    radial, tilt = (line.stiffness[line.at(name)[0], line.at(name)[0]] for name in ("ring.x", "ring.theta"))
    return math.sqrt(tilt / radial)


def _lag(line: SupportedLine, interior: Sequence[int]) -> float:
    """Largest d/k of D v = (d/k) K v over the interior [s]; symmetric parts."""
    at = np.ix_(interior, interior)
    stiffness, damping = (0.5 * (m[at] + m[at].T) for m in (line.stiffness, line.damping))
    lower = np.linalg.cholesky(stiffness)
    half = np.linalg.solve(lower, damping)
    return float(np.max(np.linalg.eigvalsh(np.linalg.solve(lower, half.T)), initial=0.0))
