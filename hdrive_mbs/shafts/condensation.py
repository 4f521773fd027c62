"""Condensation of interior coordinates: static (Guyan) and with fixed-interface modes (Craig-Bampton)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import ParameterError, SceneError

FloatArray = npt.NDArray[np.float64]

SINGULAR = 1e-13
"""Interior stiffness, scaled to a unit diagonal, counts as singular below this share of its largest singular value.

Rounding alone leaves some 1e-16 times the number of coordinates of an exact zero.
"""

PAIR = 1e-9
"""Frequencies closer than this share are one pair: the same mode in two planes, equal but for rounding."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Condensed:
    """M, D and K over the boundary coordinates and, after them, the amplitudes of fixed-interface modes.

    boundary, interior : places in the full vector
    transformation : T (full, reduced), full = T reduced, in the order of the full vector
    left_transformation : W (full, reduced), forces reduced = W^T forces; equal to T for symmetric K or ``galerkin``
    mass, damping, stiffness : W^T M T, W^T D T, W^T K T
    frequencies : of the fixed-interface modes kept [rad/s], ascending
    neglected : lowest fixed-interface frequency left out [rad/s]: the result holds well below it; infinite when
        none is left, nan when the interior has no undamped modes to speak of (its stiffness is not positive)
    """

    boundary: tuple[int, ...]
    interior: tuple[int, ...]
    transformation: FloatArray
    left_transformation: FloatArray
    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    frequencies: FloatArray
    neglected: float

    def recover(self, reduced: FloatArray) -> FloatArray:
        """All coordinates in the full order from the reduced ones (also of rates and accelerations)."""
        return np.asarray(self.transformation @ reduced)

    def recovery(self, index: int) -> FloatArray:
        """Row of T: the full coordinate at this place is the row times the reduced vector."""
        if not 0 <= index < len(self.transformation):
            raise ParameterError(f"No coordinate {index}: the full system has {len(self.transformation)}, counted from 0.")
        return np.array(self.transformation[index])

    def reduce_force(self, force: FloatArray) -> FloatArray:
        """Reduced forces from the forces on all coordinates."""
        return np.asarray(self.left_transformation.T @ force)


def guyan(
    mass: FloatArray,
    damping: FloatArray,
    stiffness: FloatArray,
    boundary: Sequence[int],
    interior: Sequence[int],
    *,
    names: Sequence[str] | None = None,
    galerkin: bool = False,
) -> Condensed:
    """Interior coordinates follow the boundary statically; see ``craig_bampton`` with no modes.

    Source: R. J. Guyan, AIAA J. 3 (1965) 380.  Leaves out what the interior does by itself:
    frequencies come out too high, by a share that grows with (frequency / ``neglected``)^2.
    """
    return craig_bampton(mass, damping, stiffness, boundary, interior, modes=0, names=names, galerkin=galerkin)


def craig_bampton(
    mass: FloatArray,
    damping: FloatArray,
    stiffness: FloatArray,
    boundary: Sequence[int],
    interior: Sequence[int],
    *,
    modes: int,
    names: Sequence[str] | None = None,
    galerkin: bool = False,
) -> Condensed:
    """Static shapes of the boundary coordinates and the ``modes`` lowest modes of the interior held at the boundary.

        q_i = S q_b + P eta,   S = -Kii^-1 Kib,   sym(Kii) P = Mii P diag(w^2),   P^T Mii P = 1

    Source: R. R. Craig, M. C. C. Bampton, AIAA J. 6 (1968) 1313, for symmetric K.  For unsymmetric K (sliding
    bearings) the equations are projected from the left with the shapes of the transposed stiffness,
    S_left = -Kii^-T Kbi^T.  So

    * the static motion of the boundary is exact, for forces on the boundary and in the interior; of the interior,
      for forces on the boundary (its own forces move it further only through the modes kept);
    * without modes, the dynamic stiffness is exact to the first power of the frequency, and to the second (the mass)
      if undamped.

    ``galerkin=True`` projects with T on both sides.  That keeps M symmetric and D passive, and the static stiffness
    seen by forces on the boundary exact; but mass, damping and forces in the interior are then wrong in first order
    of the asymmetry.  For symmetric K both are the same.

    Modes are those of the symmetric part of Kii (real, and complete).  Groups of interior coordinates that do not touch
    each other keep modes of their own, so that planes do not mix.  A cut through a pair of equal frequencies is refused:
    it would make a round shaft look oval.  Leaves out damping in the choice of the modes.

    ``names`` of all coordinates serve the error messages.
    """
    full = tuple(np.array(matrix, dtype=float) for matrix in (mass, damping, stiffness))
    held, inner = _index_sets(full, boundary, interior, modes, names)
    kept = len(held)
    whole_mass, _, whole_stiffness = full
    inner_stiffness = whole_stiffness[np.ix_(inner, inner)]
    _refuse_singular(inner_stiffness, [_called(index, names) for index in inner])
    shapes, frequencies = _fixed_modes(whole_mass[np.ix_(inner, inner)], inner_stiffness, modes)
    if modes and math.isclose(frequencies[modes - 1], frequencies[modes] if modes < len(frequencies) else math.inf, rel_tol=PAIR):
        raise ParameterError(
            f"modes = {modes} cuts through modes of equal frequency ({frequencies[modes - 1]:g} rad/s, the same mode in two planes), "
            "which would make the parts unequal in direction. Keep one mode fewer or one more."
        )
    right = np.zeros((len(whole_mass), kept + modes))
    right[list(held), range(kept)] = 1.0
    left = right.copy()
    right[inner, :kept] = -np.linalg.solve(inner_stiffness, whole_stiffness[np.ix_(inner, held)])
    left[inner, :kept] = -np.linalg.solve(inner_stiffness.T, whole_stiffness[np.ix_(held, inner)].T)
    right[inner, kept:] = left[inner, kept:] = shapes[:, :modes]
    if galerkin or np.array_equal(whole_stiffness, whole_stiffness.T):
        left = right.copy()
    reduced = [left.T @ matrix @ right for matrix in full]
    return Condensed(
        boundary=held,
        interior=inner,
        transformation=right,
        left_transformation=left,
        mass=reduced[0],
        damping=reduced[1],
        stiffness=reduced[2],
        frequencies=frequencies[:modes],
        neglected=float(frequencies[modes]) if modes < len(frequencies) else math.inf,
    )


def _called(index: int, names: Sequence[str] | None) -> str:
    return f"coordinate {index}" if names is None else f"coordinate {index} ({names[index]!r})"


def _index_sets(
    matrices: tuple[FloatArray, ...], boundary: Sequence[int], interior: Sequence[int], modes: int, names: Sequence[str] | None
) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """The two sets as tuples, after checks that they share out all coordinates of square matrices of one size."""
    size = len(matrices[-1])
    for word, matrix in zip(("mass", "damping", "stiffness"), matrices):
        if matrix.shape != (size, size):
            raise ParameterError(f"The {word} matrix is {matrix.shape}: it must be square and of the size of the others, ({size}, {size}).")
        if not np.all(np.isfinite(matrix)):
            raise ParameterError(f"The {word} matrix has entries that are not finite: check the data it is made from.")
    if names is not None and len(names) != size:
        raise ParameterError(f"{len(names)} names for {size} coordinates: give one name each.")
    held, inner = tuple(int(index) for index in boundary), tuple(int(index) for index in interior)
    given, known = {*held, *inner}, set(range(size))
    if given - known:
        raise ParameterError(f"No coordinate {min(given - known)}: the matrices have {size}, counted from 0.")
    twice = [index for index in given if (held + inner).count(index) > 1]
    if twice:
        raise ParameterError(f"{_called(min(twice), names)} is given twice: each belongs once, to the boundary or to the interior.")
    if known - given:
        raise ParameterError(f"{_called(min(known - given), names)} is in neither set: put it into the boundary or into the interior.")
    if not 0 <= modes <= len(inner):
        raise ParameterError(f"modes = {modes}: must be from 0 to the {len(inner)} interior coordinates.")
    return held, inner


def _refuse_singular(stiffness: FloatArray, called: Sequence[str]) -> None:
    """Raise SceneError, with the coordinate that moves most, when the interior can move without force."""
    if not called:
        return
    size = np.abs(np.diag(stiffness))
    largest = np.maximum(np.abs(stiffness).max(axis=0), np.abs(stiffness).max(axis=1))
    scale = np.where(size > 0.0, size, largest)
    if not np.all(scale > 0.0):
        free = called[int(np.argmin(scale))]
    else:
        scale = 1.0 / np.sqrt(scale)
        _, values, rows = np.linalg.svd(scale[:, None] * stiffness * scale)
        if values[-1] > SINGULAR * values[0]:
            return
        free = called[int(np.argmax(np.abs(rows[-1])))]
    raise SceneError(
        f"The interior stiffness is singular: with the boundary held, {free} can move without force, so it does not follow the boundary. "
        "Make it a boundary coordinate, or connect it."
    )


def _fixed_modes(mass: FloatArray, stiffness: FloatArray, modes: int) -> tuple[FloatArray, FloatArray]:
    """Shapes (unit modal mass) and frequencies [rad/s] of all modes that have mass, ascending."""
    size = len(stiffness)
    symmetric, mass = 0.5 * (stiffness + stiffness.T), 0.5 * (mass + mass.T)
    shapes: list[FloatArray] = []
    squares: list[float] = []
    for group in _groups((symmetric != 0.0) | (mass != 0.0)):
        try:
            # M x = mu K x with mu = 1 / w^2 allows coordinates without mass
            lower = np.linalg.cholesky(symmetric[np.ix_(group, group)])
        except np.linalg.LinAlgError:
            if not modes:
                return np.zeros((size, 0)), np.array([math.nan])
            raise SceneError(
                "The interior has no fixed-interface modes: the symmetric part of its stiffness is not positive. Use guyan, or make "
                "the coordinates that it does not hold boundary coordinates."
            ) from None
        half = np.linalg.solve(lower, mass[np.ix_(group, group)])
        values, vectors = np.linalg.eigh(np.linalg.solve(lower, half.T))
        floor = len(group) * np.finfo(float).eps * max(abs(values[0]), abs(values[-1]))
        if values[0] < -10.0 * floor:
            raise SceneError("The mass of the interior coordinates is negative in some direction: check the inertias of the parts.")
        for value, vector in zip(values, np.linalg.solve(lower.T, vectors).T):
            if value > 10.0 * floor:
                shape = np.zeros(size)
                shape[group] = vector / math.sqrt(value)
                shapes.append(shape)
                squares.append(value)
    order = np.argsort(-np.array(squares), kind="stable")
    if modes > len(order):
        raise ParameterError(f"modes = {modes}: the interior has mass for {len(order)} only. Ask for no more.")
    matrix = np.array(shapes).T if shapes else np.zeros((size, 0))
    return matrix[:, order], 1.0 / np.sqrt(np.array(squares)[order])


def _groups(coupled: npt.NDArray[np.bool_]) -> list[npt.NDArray[np.intp]]:
    """Sets of coordinates that are coupled with each other, directly or through others."""
    size = len(coupled)
    reach = np.eye(size, dtype=bool) | coupled
    for _ in range(size.bit_length()):
        reach = (reach.astype(float) @ reach.astype(float)) > 0.0
    firsts = sorted({int(np.argmax(row)) for row in reach})
    return [np.flatnonzero(reach[first]) for first in firsts]
