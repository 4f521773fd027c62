"""The lateral part of a rotor line over the speed of its reference shaft: matrices and their harmonic solution."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.linalg import eigvals, solve_banded
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components, reverse_cuthill_mckee

from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices
from hdrive_mbs.analysis.whirl.rotor_point import RotorPoint, rotor_point
from hdrive_mbs.components.drive_torque import DriveTorque
from hdrive_mbs.components.motor import Motor
from hdrive_mbs.errors import AnalysisError
from hdrive_mbs.motors.ideal_speed import IdealSpeedMotor
from hdrive_mbs.progress import Report
from hdrive_mbs.scene import Scene

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

DENSE_LIMIT = 60
"""Coordinates up to which a dense solution is faster than a banded one."""

LARGEST_POLES = 120
"""Coordinates up to which the poles over speed are calculated (twice as many eigenvalues)."""

CHUNK = 2_000_000
"""Numbers in one stack of dense matrices."""

LOST = 100.0
"""Rounding, in units of the double precision times the largest eigenvalue, below which a dynamic stiffness counts as zero."""


def free_to_turn(scene: Scene) -> Scene:
    """The scene with motors of prescribed motion replaced by motors without torque: every spin is a coordinate.

    An analysis that holds the spins at given speeds asks the same of both, and rotors on a prescribed shaft keep
    their unbalance as a property instead of a force over time.
    """
    prescribed = [
        name
        for name, part in scene.parts.items()
        if isinstance(part, (Motor, DriveTorque)) and isinstance(part.characteristic, IdealSpeedMotor)
    ]
    return scene.replacing({f"{name}.characteristic": _no_torque for name in prescribed}) if prescribed else scene


def _no_torque(speed: float) -> float:
    return 0.0 * speed


def check_lateral(scene: Scene, analysis: str) -> None:
    """Raise AnalysisError for a scene that only turns."""
    if not scene.network().is_lateral:
        raise AnalysisError(
            f"{analysis} needs a line that moves laterally, but everything in {scene.name!r} only turns. "
            "Build it of Rotor, ShaftSection and Bearing parts."
        )


@dataclass(frozen=True, eq=False)
class SpeedLine:
    """M q'' + D q' + K q = F of the lateral coordinates that are coupled to given ones.

    names : the n coordinates
    mass : (n, n)
    knots : speeds of the reference shaft [rad/s], ascending; D and K are straight lines between them, which is
        exact for a line whose bearings are linear (two knots)
    rows, columns : entries of D and K that are not zero
    damping, stiffness : values at the knots, (knots, entries)
    points : the steady rotation at each knot
    varying : coordinates whose forces are not linear in the lateral motion, with what their slopes depend on
    """

    lines: LineMatrices
    names: tuple[str, ...]
    mass: FloatArray
    knots: FloatArray
    rows: npt.NDArray[np.intp]
    columns: npt.NDArray[np.intp]
    damping: FloatArray
    stiffness: FloatArray
    points: tuple[RotorPoint, ...]
    varying: dict[str, set[str]]

    @classmethod
    def over(cls, scene: Scene, speeds: FloatArray, reach: Sequence[str], report: Report | None = None) -> SpeedLine:
        """The line over ascending speeds [rad/s].

        scene : one that is free to turn
        reach : coordinates that are of interest; what is coupled to none of them is left out

        A line of linear bearings is evaluated at its first and last speed, another at every speed, each about the
        static deflection there.
        """
        network = scene.network()
        lines = LineMatrices(network)
        lines.check_memory()
        varying = lines.varying()
        knots = speeds if varying else np.unique(speeds[[0, -1]])
        points: list[RotorPoint] = []
        found: list[tuple[csr_array, csr_array]] = []
        lateral = [k for k, body in enumerate(network.bodies) if body.lateral]
        for k, speed in enumerate(knots):
            points.append(rotor_point(scene, float(speed), lines=lines, start=points[-1] if points else None))
            system = lines.at(points[-1].angles, points[-1].speeds, points[-1].states)
            found.append((csr_array(system.damping[np.ix_(lateral, lateral)]), csr_array(system.stiffness[np.ix_(lateral, lateral)])))
            if report is not None:
                report(k + 1)
        mass = lines.mass[np.ix_(lateral, lateral)]
        pattern = csr_array(np.abs(mass)) + sum((abs(d) + abs(k) for d, k in found), start=csr_array(mass.shape))
        names = [lines.names[k] for k in lateral]
        _, group = connected_components(pattern, directed=False)
        wanted = {int(group[names.index(name)]) for name in reach}
        kept = np.flatnonzero(np.isin(group, list(wanted)))
        rows, columns = pattern[kept][:, kept].nonzero()

        def values(matrix: csr_array) -> FloatArray:
            return np.asarray(matrix[kept[rows], kept[columns]], float).ravel()

        return cls(
            lines=lines,
            names=tuple(names[k] for k in kept),
            mass=mass[np.ix_(kept, kept)],
            knots=knots,
            rows=rows,
            columns=columns,
            damping=np.array([values(d) for d, _ in found]),
            stiffness=np.array([values(k) for _, k in found]),
            points=tuple(points),
            varying={name: on for name, on in varying.items() if name in {names[k] for k in kept}},
        )

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return len(self.names)

    def between(self, values: FloatArray, speeds: FloatArray) -> FloatArray:
        """Values given at the knots, (knots, ...), at other speeds: straight lines, and beyond the ends too."""
        if len(self.knots) == 1:
            return np.broadcast_to(values, (len(speeds), *values.shape[1:]))
        k = np.clip(np.searchsorted(self.knots, speeds, side="right") - 1, 0, len(self.knots) - 2)
        share = ((speeds - self.knots[k]) / (self.knots[k + 1] - self.knots[k])).reshape(-1, *[1] * (values.ndim - 1))
        return np.asarray((1.0 - share) * values[k] + share * values[k + 1])

    def full(self, values: FloatArray) -> FloatArray:
        """Entries as a matrix, (n, n)."""
        matrix = np.zeros((self.size, self.size))
        matrix[self.rows, self.columns] = values
        return matrix

    def matrices(self, speed: float) -> tuple[FloatArray, FloatArray]:
        """D and K at a speed, (n, n) each."""
        at = np.array([speed])
        return self.full(self.between(self.damping, at)[0]), self.full(self.between(self.stiffness, at)[0])

    def solve(self, speeds: FloatArray, frequencies: FloatArray, forces: ComplexArray) -> ComplexArray:
        """Amplitudes Q of Re[Q exp(i w t)] under Re[F exp(i w t)]: (K + i w D - w^2 M) Q = F.

        speeds, frequencies : of the reference shaft and of the force [rad/s], (s,)
        forces : (s, n)

        Returns (s, n); zero where the force is zero and NaN where the dynamic stiffness is singular within rounding
        (an undamped line at a critical speed).
        """
        result = np.zeros((len(speeds), self.size), complex)
        mass = self.mass[self.rows, self.columns]
        acting = np.flatnonzero(np.any(forces != 0.0, axis=1))
        solve = self._dense if self.size <= DENSE_LIMIT else self._banded
        step = max(1, CHUNK // (self.size**2 if self.size <= DENSE_LIMIT else len(self.rows)))
        for part in (acting[k : k + step] for k in range(0, len(acting), step)):
            w = frequencies[part, None]
            entries = self.between(self.stiffness, speeds[part]) + 1j * w * self.between(self.damping, speeds[part]) - w**2 * mass
            result[part] = solve(np.asarray(entries, complex), forces[part])
        lost = acting[self._is_lost(result[acting], forces[acting], frequencies[acting])]
        result[lost] = np.nan
        return result

    def _dense(self, entries: ComplexArray, forces: ComplexArray) -> ComplexArray:
        matrices = np.zeros((len(entries), self.size, self.size), complex)
        matrices[:, self.rows, self.columns] = entries
        try:
            return np.asarray(np.linalg.solve(matrices, forces[..., None])[..., 0])
        except np.linalg.LinAlgError:
            return np.array([_solved(matrix, force) for matrix, force in zip(matrices, forces, strict=True)])

    @cached_property
    def _banded(self) -> Callable[[ComplexArray, ComplexArray], ComplexArray]:
        """The solver of a long line, whose coordinates can be ordered so that only few diagonals are not zero."""
        pattern = csr_array((np.ones(len(self.rows)), (self.rows, self.columns)), shape=(self.size, self.size))
        order = reverse_cuthill_mckee(pattern + pattern.T, symmetric_mode=True)
        place = np.argsort(order)
        rows, columns = place[self.rows], place[self.columns]
        width = int(np.max(np.abs(rows - columns)))

        def solve(entries: ComplexArray, forces: ComplexArray) -> ComplexArray:
            result = np.empty(forces.shape, complex)
            bands = np.zeros((2 * width + 1, self.size), complex)
            for k, force in enumerate(forces):
                bands[width + rows - columns, columns] = entries[k]
                try:
                    result[k, order] = solve_banded((width, width), bands, force[order], check_finite=False)
                except np.linalg.LinAlgError:
                    result[k] = np.nan
            return result

        return solve

    def _is_lost(self, result: ComplexArray, forces: ComplexArray, frequencies: FloatArray) -> npt.NDArray[np.bool_]:
        """Where |F|/|Q|, both measured with the mass, is below what rounding makes of the largest eigenvalue."""
        if not len(result):
            return np.zeros(0, bool)
        root, inverse, stiffest = self._by_mass
        largest = np.maximum(stiffest, frequencies**2)
        force = np.linalg.norm(inverse @ forces.T, axis=0)
        motion = np.linalg.norm(root.T @ result.T, axis=0)
        return np.asarray(~(motion * LOST * np.finfo(float).eps * largest < force))

    @cached_property
    def _by_mass(self) -> tuple[FloatArray, FloatArray, float]:
        """R with M = R R^T, its inverse, and the largest eigenvalue of the stiffness with the mass made one (by its norm)."""
        root = np.asarray(np.linalg.cholesky(self.mass), float)
        inverse = np.linalg.inv(root)
        return root, inverse, float(np.linalg.norm(inverse @ self.matrices(float(self.knots[-1]))[1] @ inverse.T, 2))

    def poles(self, ratio: float) -> ComplexArray:
        """Speeds W, complex, at which K(W) + i r W D(W) - r^2 W^2 M is singular; none unless bearings are linear.

        The response over speed is large near the real part, within about the imaginary part of it.
        """
        n = self.size
        if self.varying or len(self.knots) < 2 or n > LARGEST_POLES:
            return np.zeros(0, complex)
        (d0, k0), (d1, k1) = self.matrices(0.0), self.matrices(float(self.knots[-1]))
        top = float(self.knots[-1]) if self.knots[-1] != 0.0 else float(self.knots[0])
        if self.knots[-1] == 0.0:
            d1, k1 = self.matrices(top)
        # in W/top:  A0 + A1 s + A2 s^2
        a0, a1 = k0.astype(complex), (k1 - k0) + 1j * ratio * top * d0
        a2 = 1j * ratio * top * (d1 - d0) - (ratio * top) ** 2 * self.mass
        eye, zero = np.eye(n), np.zeros((n, n))
        pencil = eigvals(np.block([[zero, eye], [-a0, -a1]]), np.block([[eye, zero], [zero, a2]]))
        return np.asarray(top * pencil[np.isfinite(pencil)])


def _solved(matrix: ComplexArray, force: ComplexArray) -> ComplexArray:
    try:
        return np.asarray(np.linalg.solve(matrix, force))
    except np.linalg.LinAlgError:
        return np.full(len(force), np.nan + 0j)
