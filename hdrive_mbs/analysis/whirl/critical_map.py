"""Undamped critical speeds over the stiffness of the supports."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.linalg import LinAlgError, eigh
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from hdrive_mbs.analysis.result import Result
from hdrive_mbs.analysis.unbalance.speed_line import SpeedLine, check_lateral, free_to_turn
from hdrive_mbs.bearings.linear import LinearBearing
from hdrive_mbs.components.bearing import Bearing
from hdrive_mbs.errors import AnalysisError, ParameterError, unknown_place
from hdrive_mbs.printed_table import PrintedTable, thinned
from hdrive_mbs.progress import Report, progress_bar
from hdrive_mbs.scene import Scene

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

ROUNDING = 1e-9
"""Share of the entries on the diagonal below which a difference of stiffnesses counts as none."""


class Crossing(NamedTuple):
    """Where a branch meets the stiffness curve of a bearing."""

    whirl: str
    speed: float
    stiffness: float


@dataclass(frozen=True, kw_only=True, eq=False)
class CriticalSpeedMap(Result):
    """Undamped critical speeds, without regard to whether unbalance excites them (backward whirl of like planes is not).

    stiffness : of each support [N/m], shape (k,), ascending
    speeds : critical speeds of the reference shaft [rad/s], shape (k, b); NaN where a branch has none (a disc with
        Jp > Jt has no forward one in tilt)
    whirl : "forward", "backward", or "mixed" where the planes are not alike, for each branch
    forward_share : share of the forward part in the kinetic energy of lateral motion, shape (k, b)
    order : whirl frequency over speed
    """

    stiffness: FloatArray
    speeds: FloatArray
    whirl: tuple[str, ...]
    forward_share: FloatArray
    order: float

    def tables(self) -> tuple[PrintedTable, ...]:
        """The critical speeds over the stiffness of the supports."""
        return (thinned(self.columns(), title=f"undamped critical speeds of order {self.order:g}"),)

    def columns(self) -> dict[str, np.ndarray]:
        table: dict[str, np.ndarray] = {"support stiffness [N/m]": self.stiffness}
        for k, whirl in enumerate(self.whirl):
            table[f"{k + 1} {whirl} critical speed [rad/s]"] = self.speeds[:, k]
        return table

    def crossings(self, speeds: Sequence[float] | FloatArray, stiffness: Sequence[float] | FloatArray) -> tuple[Crossing, ...]:
        """Critical speeds of a bearing whose stiffness [N/m] depends on speed [rad/s], by ascending speed.

        Straight lines between the points, in logarithms of both.
        """
        curve_speeds, curve = np.asarray(speeds, float), np.asarray(stiffness, float)
        if curve_speeds.shape != curve.shape or curve.ndim != 1 or len(curve) < 2 or not np.all(np.diff(curve_speeds) > 0.0):
            raise ParameterError("A stiffness curve needs at least two speeds [rad/s] that increase, and as many stiffnesses [N/m].")
        if curve_speeds[0] <= 0.0 or np.any(curve <= 0.0):
            raise ParameterError("A stiffness curve on logarithmic scales needs speeds and stiffnesses above zero.")
        x, y = np.log(self.stiffness), np.log(self.speeds)
        found = []
        for branch, whirl in enumerate(self.whirl):
            at = np.unique(np.concatenate([y[:, branch][np.isfinite(y[:, branch])], np.log(curve_speeds)]))
            rising = np.isfinite(y[:, branch]) & (np.concatenate([[True], np.diff(y[:, branch]) > 0.0]))
            if rising.sum() < 2:
                continue
            at = at[(at >= y[rising, branch][0]) & (at <= y[rising, branch][-1])]
            at = at[(at >= np.log(curve_speeds[0])) & (at <= np.log(curve_speeds[-1]))]
            gap = np.interp(at, y[rising, branch], x[rising]) - np.interp(at, np.log(curve_speeds), np.log(curve))
            for k in np.flatnonzero(gap[:-1] * gap[1:] < 0.0):
                speed = at[k] - gap[k] * (at[k + 1] - at[k]) / (gap[k + 1] - gap[k])
                there = np.interp(speed, np.log(curve_speeds), np.log(curve))
                found.append(Crossing(whirl, float(np.exp(speed)), float(np.exp(there))))
        return tuple(sorted(found, key=lambda item: item.speed))


def critical_speed_map(
    scene: Scene,
    stiffness: Sequence[float] | FloatArray,
    *,
    parts: Sequence[str] | None = None,
    paths: Sequence[str] | None = None,
    count: int = 4,
    order: float = 1.0,
    progress: bool | None = None,
) -> CriticalSpeedMap:
    """Critical speeds without damping, from  K Q = w^2 (M - i G/n) Q  with the speed w/n, for each support stiffness.

    stiffness : values [N/m], ascending
    parts : Bearing parts whose radial stiffness is replaced, alike in x and y; their housings are left out and their
        tilt and axial stiffness kept.  All Bearing parts if neither parts nor paths are given
    paths : numbers of the scene that get the value instead, e.g. ``("bearing.housing.stiffness_x", ...)``
    count : how many critical speeds of each direction of whirl
    order : n, whirl frequency over speed of the reference shaft: 1 for unbalance

    G w/n are the gyroscopic terms at the speed w/n: M - i G/n is Hermitian, so the direct method needs no search over
    speed (e.g. Friswell et al., Dynamics of Rotating Machines, 2010, 6.6).  Leaves out damping and whatever grows with
    it; bearings that are not linear count as they are at rest.

    Raises AnalysisError where K is not symmetric (cross-coupled bearings) or nothing holds the line.
    """
    grid = _checked(stiffness, count, order)
    check_lateral(scene, "A critical speed map")
    base = free_to_turn(scene)
    if parts is not None and paths is not None:
        raise ParameterError("Give parts or paths, not both.")
    chosen = tuple(paths) if paths is not None else _bearings(base, parts)

    def with_stiffness(value: float) -> Scene:
        return (
            base.replacing(dict.fromkeys(chosen, value))
            if paths is not None
            else base.replacing({p: _support(base, p, value) for p in chosen})
        )

    with progress_bar(f"{scene.name}: critical speed map", float(len(grid)), progress) as report:
        lines = _lines(with_stiffness, grid, report)
        first = lines[0]
        isotropic = all(_is_isotropic(line) for line in lines)
        found = [_critical(line, scene.name, value, count, order, isotropic) for line, value in zip(lines, grid, strict=True)]
    whirl = ("forward",) * count + ("backward",) * count if isotropic else ("mixed",) * (2 * count)
    speeds, shares = np.array([one[0] for one in found]), np.array([one[1] for one in found])
    keep = np.any(np.isfinite(speeds), axis=0)
    notes = ["complete"]
    if first.varying:
        where = ", ".join(dict.fromkeys(name.partition(".")[0] for name in first.varying))
        notes.append(f"forces at {where} are not linear: taken as they are at rest")
    return CriticalSpeedMap(
        scene=scene,
        status="; ".join(notes),
        settings={"replaced": chosen, "by": "paths" if paths is not None else "parts", "count": count},
        stiffness=grid,
        speeds=speeds[:, keep],
        whirl=tuple(name for name, kept in zip(whirl, keep, strict=True) if kept),
        forward_share=shares[:, keep],
        order=float(order),
    )


def _checked(stiffness: Sequence[float] | FloatArray, count: int, order: float) -> FloatArray:
    grid = np.atleast_1d(np.asarray(stiffness, float))
    if grid.ndim != 1 or not len(grid) or not np.all(np.isfinite(grid)) or grid[0] <= 0.0 or not np.all(np.diff(grid) > 0.0):
        raise ParameterError("stiffness: give values above 0 N/m in ascending order.")
    if count < 1:
        raise ParameterError(f"count = {count}: at least 1.")
    if not (np.isfinite(order) and order > 0.0):
        raise ParameterError(f"order = {order:g}: must be greater than 0 (whirl frequency over speed).")
    return grid


def _bearings(scene: Scene, parts: Sequence[str] | None) -> tuple[str, ...]:
    known = [name for name, part in scene.parts.items() if isinstance(part, Bearing)]
    for name in parts or ():
        if name not in known:
            raise unknown_place("Bearing part", name, known)
    if not known:
        raise AnalysisError(
            f"{scene.name!r} has no Bearing part whose stiffness could be replaced; name numbers of the scene with paths=(...)."
        )
    return tuple(parts) if parts is not None else tuple(known)


def _support(scene: Scene, name: str, value: float) -> Bearing:
    """The bearing with another radial stiffness, fixed to the ground."""
    part = scene.parts[name]
    assert isinstance(part, Bearing)
    matrix = np.array(part.law.stiffness_matrix(), float)
    matrix[:2, :] = matrix[:, :2] = 0.0
    matrix[0, 0] = matrix[1, 1] = value
    return part.replacing(law=LinearBearing.from_matrices(stiffness=matrix, damping=np.zeros((6, 6))), housing=None)


@dataclass(frozen=True, eq=False)
class _Undamped:
    """M, K and gyroscopic matrix G per unit reference speed, (n, n) each."""

    names: tuple[str, ...]
    mass: FloatArray
    gyroscopic: FloatArray
    stiffness: FloatArray
    varying: tuple[str, ...]


def _undamped(scene: Scene) -> _Undamped:
    endings = (".x", ".y", ".psi", ".theta")
    reach = [body.name for body in scene.network().bodies if body.lateral and body.name.endswith(endings)]
    line = SpeedLine.over(scene, np.array([0.0, 1.0]), reach)
    (still, stiffness), (turning, _) = line.matrices(0.0), line.matrices(1.0)
    change = turning - still
    gyroscopic = 0.5 * (change - change.T)
    # motions that no stiffness touches (tilts of a disc in a bearing without tilt stiffness) have no critical speed
    _, group = connected_components(csr_array(np.abs(line.mass) + np.abs(stiffness) + np.abs(gyroscopic)), directed=False)
    held = [k for k in range(line.size) if stiffness[group == group[k]].any()]
    block = np.ix_(held, held)
    names = tuple(line.names[k] for k in held)
    return _Undamped(names, line.mass[block], gyroscopic[block], stiffness[block], tuple(line.varying))


def _lines(with_stiffness: Callable[[float], Scene], grid: FloatArray, report: Report | None) -> list[_Undamped]:
    """The line for each stiffness; three are built where the matrix turns out to be a straight line of the value."""
    known = {k: _undamped(with_stiffness(float(grid[k]))) for k in sorted({0, len(grid) // 2, len(grid) - 1})}
    first, last = known[0], known[len(grid) - 1]
    if len(grid) > 3 and not first.varying and all(line.names == first.names for line in known.values()):
        slope = (last.stiffness - first.stiffness) / (grid[-1] - grid[0])
        straight = [replace(first, stiffness=first.stiffness + (value - grid[0]) * slope) for value in grid]
        middle = len(grid) // 2
        size = _sizes(known[middle].stiffness)
        same = np.array_equal(first.mass, last.mass) and np.array_equal(first.gyroscopic, last.gyroscopic)
        if same and np.all(np.abs(straight[middle].stiffness - known[middle].stiffness) <= ROUNDING * size):
            return straight
    result = []
    for k, value in enumerate(grid):
        result.append(known[k] if k in known else _undamped(with_stiffness(float(value))))
        if report is not None:
            report(k + 1)
    return result


def _sizes(matrix: FloatArray) -> FloatArray:
    size = np.sqrt(np.abs(np.diag(matrix)))
    return np.asarray(np.outer(size, size) + np.finfo(float).tiny)


def _quarter_turn(names: tuple[str, ...]) -> FloatArray | None:
    """R that turns a motion by +90 degrees about z: (x, y) -> (-y, x), tilts alike; None where a partner is missing."""
    index = {name: k for k, name in enumerate(names)}
    turn = np.zeros((len(names), len(names)))
    for name, k in index.items():
        for ending, partner, sign in (("x", "y", 1.0), ("theta", "psi", -1.0)):
            if name.endswith(ending):
                other = index.get(name.removesuffix(ending) + partner)
                if other is None:
                    return None
                turn[other, k], turn[k, other] = sign, -sign
    return turn if np.array_equal(np.abs(turn).sum(axis=0), np.ones(len(names))) else None


def _is_isotropic(line: _Undamped) -> bool:
    """Whether a quarter turn changes nothing."""
    turn = _quarter_turn(line.names)
    if turn is None:
        return False
    return all(
        bool(np.all(np.abs(turn @ matrix @ turn.T - matrix) <= ROUNDING * _sizes(matrix + turn @ matrix @ turn.T)))
        for matrix in (line.mass, line.stiffness)
    )


def _critical(line: _Undamped, name: str, value: float, count: int, order: float, isotropic: bool) -> tuple[list[float], list[float]]:
    """Critical speeds, 2 count of them (NaN where there are fewer), and their forward shares."""
    if np.any(np.abs(line.stiffness - line.stiffness.T) > ROUNDING * _sizes(line.stiffness)):
        raise AnalysisError(
            f"The stiffness of {name!r} is not symmetric (cross-coupled bearing coefficients), so it has no undamped critical "
            "speeds. Replace those bearings too (parts), or look at the Campbell diagram."
        )
    turn = _quarter_turn(line.names)
    mass = line.mass - 1j / order * line.gyroscopic
    if not isotropic or turn is None:
        speeds, shapes = _solved(mass, line.stiffness.astype(complex), 2 * count, order, name, value)
        return speeds, [float("nan") if turn is None else _forward_share(shape, line.mass, turn) for shape in shapes.T]
    # circles about +z and about -z never mix: eigenvectors of R with i and -i
    result: list[float] = []
    half, circles = len(turn) // 2, np.linalg.eigh(-1j * turn)[1]
    for basis in (circles[:, half:], circles[:, :half]):
        result += _solved(basis.conj().T @ mass @ basis, basis.conj().T @ line.stiffness @ basis, count, order, name, value)[0]
    return result, [1.0] * count + [0.0] * count


def _solved(
    mass: ComplexArray, stiffness: ComplexArray, count: int, order: float, name: str, value: float
) -> tuple[list[float], ComplexArray]:
    """The lowest w/n of  K Q = w^2 A Q  from  A Q = K Q/w^2, whose largest eigenvalues belong to them."""
    try:
        inverse, shapes = eigh(mass, 0.5 * (stiffness + stiffness.conj().T))
    except LinAlgError:
        raise AnalysisError(
            f"With {value:g} N/m nothing holds {name!r} against some lateral motion (its stiffness matrix is not positive "
            "definite), so it has no critical speeds. Add a bearing, or give one tilt stiffness."
        ) from None
    top = float(np.max(np.abs(inverse)))
    order_of = [k for k in range(len(inverse) - 1, -1, -1) if inverse[k] > 1e-14 * top][:count]
    speeds = [float(1.0 / np.sqrt(inverse[k]) / order) for k in order_of]
    missing = count - len(speeds)
    padded = np.concatenate([shapes[:, order_of], np.full((len(shapes), missing), np.nan)], axis=1)
    return speeds + [float("nan")] * missing, padded


def _forward_share(shape: ComplexArray, mass: FloatArray, turn: FloatArray) -> float:
    """Kinetic energy of the forward part (1 - i R)/2 Q over the whole."""
    if not np.all(np.isfinite(shape)):
        return float("nan")
    forward, backward = 0.5 * (shape - 1j * turn @ shape), 0.5 * (shape + 1j * turn @ shape)
    parts = [float(np.real(part.conj() @ mass @ part)) for part in (forward, backward)]
    return parts[0] / sum(parts)
