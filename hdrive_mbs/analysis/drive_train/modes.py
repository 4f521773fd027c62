"""Torsional modes of the linearised scene at an operating point."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import numpy.typing as npt
from scipy.optimize import linear_sum_assignment

from hdrive_mbs.analysis.decay_note import decay_note
from hdrive_mbs.analysis.operating_point import OperatingPoint, at_speed, operating_point, with_load
from hdrive_mbs.analysis.result import Result
from hdrive_mbs.analysis.whirl.spinning_line import without_unbalance
from hdrive_mbs.engine.assembly import Assembly, assemble
from hdrive_mbs.engine.linearisation import LinearSystem, linearise
from hdrive_mbs.printed_table import PrintedTable
from hdrive_mbs.scene import Scene

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

_Shapes = TypeVar("_Shapes", FloatArray, ComplexArray)

RIGID = 1e-7
"""A mode x is a rigid-body motion where x'Kx is below this share of |x|'|K||x|, its terms without their signs.

Exudyn differentiates user functions numerically, which leaves up to 1e-8 of an exact zero.  So a
spring softer than 1e-7 of what it is connected to counts as open.
"""


@dataclass(frozen=True, kw_only=True, eq=False)
class Modes(Result):
    """Modes at one operating point.

    bodies : names of the n bodies, in the order of the shapes
    undamped : natural frequencies without damping [rad/s], ascending, rigid-body motion left out; stiffness
        that sits in the states of an effect (hysteresis, bristles) counts in the damped ones only
    shapes : (n, len(undamped)), angle of each body in true sense, largest entry 1
    damped : frequencies of the oscillating damped modes [rad/s], ascending; a mode that damping
        turns into pure decay is not in it (see decay_rates)
    damping_ratio : -Re(lambda)/|lambda| of each damped mode; negative when it grows
    damped_shapes : (n, len(damped)), complex
    decay_rates : -lambda of the non-oscillating motions [1/s], ascending, without rigid-body motion
    rigid_modes : number of rigid-body motions (1 for a free train, 2 with an open gap)
    motor_speed : rad/s
    torques : torque through each connection at the operating point [N m]
    """

    bodies: tuple[str, ...]
    undamped: FloatArray
    shapes: FloatArray
    damped: FloatArray
    damping_ratio: FloatArray
    damped_shapes: ComplexArray
    decay_rates: FloatArray
    rigid_modes: int
    motor_speed: float
    torques: Mapping[str, float]

    @property
    def stable(self) -> bool:
        """Whether no motion grows."""
        return bool(np.all(self.damping_ratio >= -1e-9) and np.all(self.decay_rates >= -1e-6))

    def tables(self) -> tuple[PrintedTable, ...]:
        """Undamped modes with their shapes, and damped ones."""
        rows = []
        for k, frequency in enumerate(self.undamped.tolist()):
            shape = ", ".join(f"{body} {self.shapes[i, k]:+.3f}" for i, body in enumerate(self.bodies))
            rows.append((str(k + 1), frequency, frequency / (2.0 * np.pi), shape))
        heads = ("mode", "[rad/s]", "[Hz]", "shape: angles, true sense")
        damped = zip(self.damped.tolist(), self.damping_ratio.tolist(), strict=True)
        return (
            PrintedTable(title="undamped", heads=heads, rows=tuple(rows)),
            PrintedTable(
                title="damped",
                heads=("mode", "[rad/s]", "damping ratio"),
                rows=tuple((str(k), *row) for k, row in enumerate(damped, start=1)),
                notes=decay_note(self.decay_rates),
            ),
        )

    def columns(self) -> dict[str, np.ndarray]:
        rows = max(len(self.undamped), len(self.damped))

        def padded(values: FloatArray) -> FloatArray:
            return np.concatenate([values, np.full(rows - len(values), np.nan)])

        return {
            "mode": np.arange(1, rows + 1),
            "undamped [rad/s]": padded(self.undamped),
            "damped [rad/s]": padded(self.damped),
            "damping ratio [1]": padded(self.damping_ratio),
        }


def modes(scene: Scene, *, torque: float | None = None, motor_speed: float | None = None) -> Modes:
    """Linearise on Exudyn at a steady operating point and solve the eigenproblem.

    torque : load torque [N m] in place of the scene's own load at t = 0
    motor_speed : rad/s; None for the speed at which motor and load balance

    The motor's torque-speed slope counts as damping.  Of a rotor line these are the torsional modes alone, with balanced
    rotors; ``whirl_modes`` gives whirl, torsion and axial motion together.  Raises AnalysisError when no steady
    operating point exists.
    """
    point = operating_point(without_unbalance(scene), motor_speed=motor_speed, torque=torque)
    loaded = at_speed(scene if torque is None else with_load(scene, torque), point.motor_speed)
    return modes_at(loaded, assemble(without_unbalance(loaded).network().turning()), point)


def modes_at(scene: Scene, assembly: Assembly, point: OperatingPoint) -> Modes:
    """Modes of an assembled scene at a given state (build once, ask for many points)."""
    # differences across a corner would mix both sides: all twists a little larger
    outwards = 1.0 + 1e-3 if point.at_corner else 1.0
    angles = {name: outwards * angle for name, angle in point.angles.items()}
    system = linearise(assembly, angles=angles, speeds=point.speeds, states=point.states)
    undamped, shapes, rigid, basis = _undamped(system)
    senses = np.array([body.sense for body in assembly.network.bodies], float)
    damped, ratio, damped_shapes, decay = _damped(system, rigid, basis)
    notes = [f"{name} is inside its lost motion or backlash: stiffness 0 there" for name in point.in_gap]
    notes += [f"{name} sits at a corner of its law: the stiffness towards larger twist is taken" for name in point.at_corner]
    if len(undamped) + rigid < len(system.bodies):
        notes.append("statically unstable: a stiffness is negative there, and a motion grows")
    status = "; ".join(["complete", *notes])
    return Modes(
        scene=scene,
        status=status,
        settings={"motor_speed": point.motor_speed, "torques": dict(point.torques)},
        bodies=system.bodies,
        undamped=undamped,
        shapes=_scaled(senses[:, None] * shapes),
        damped=damped,
        damping_ratio=ratio,
        damped_shapes=_scaled(senses[:, None] * damped_shapes),
        decay_rates=decay,
        rigid_modes=rigid,
        motor_speed=point.motor_speed,
        torques=point.torques,
    )


def _scaled(shapes: _Shapes) -> _Shapes:
    """Each column divided by its entry of largest size."""
    for k in range(shapes.shape[1]):
        largest = shapes[np.argmax(np.abs(shapes[:, k])), k]
        if largest != 0.0:
            shapes[:, k] = shapes[:, k] / largest
    return shapes


def _undamped(system: LinearSystem) -> tuple[FloatArray, FloatArray, int, FloatArray]:
    """sqrt of the eigenvalues of M^-1 K (states at rest), shapes, number of rigid motions, and a basis of all others."""
    values, vectors = np.linalg.eig(np.linalg.solve(system.mass, system.stiffness))
    order = np.argsort(values.real)
    values, vectors = values[order].real, vectors[:, order].real
    frequencies = np.sqrt(np.maximum(values, 0.0))
    size = np.abs(vectors)
    terms = np.einsum("ik,ij,jk->k", size, np.abs(system.stiffness), size)
    mass = np.einsum("ik,ij,jk->k", vectors, system.mass, vectors)
    zero = np.abs(values) * mass <= RIGID * terms
    elastic = ~zero & (values > 0.0)
    basis = np.concatenate([vectors[:, ~zero], vectors[:, zero]], axis=1)
    return frequencies[elastic], vectors[:, elastic], int(zero.sum()), basis


def _damped(system: LinearSystem, rigid: int, basis: FloatArray) -> tuple[FloatArray, FloatArray, ComplexArray, FloatArray]:
    """Eigenvalues of the first-order matrix without the angles of rigid-body motion.

    Nothing depends on those angles; kept in, each makes a double zero, which rounding splits into pairs of
    the size of its square root that look like slow modes.
    """
    n = len(system.bodies)
    kept = n - rigid
    into = np.linalg.inv(basis)[:kept]
    rest = system.matrix.shape[0] - n
    left = np.block([[into, np.zeros((kept, rest))], [np.zeros((rest, n)), np.eye(rest)]])
    right = np.block([[basis[:, :kept], np.zeros((n, rest))], [np.zeros((rest, kept)), np.eye(rest)]])
    values, vectors = np.linalg.eig(left @ system.matrix @ right)
    floor = 1e-9 * float(np.max(np.abs(values), initial=0.0))
    oscillating = values.imag > floor
    order = np.argsort(values[oscillating].imag)
    picked = values[oscillating][order]
    shapes = vectors[kept : kept + n, oscillating][:, order] / picked  # angle = speed / lambda
    real = np.sort(-values[np.abs(values.imag) <= floor].real)
    return picked.imag, -picked.real / np.abs(picked), shapes, real[np.abs(real) > floor]


def matching_damping(point: Modes) -> FloatArray:
    """Damping ratio of the damped mode most like each undamped one (NaN where there is none)."""
    result = np.full(len(point.undamped), np.nan)
    if not len(point.damped) or not len(point.undamped):
        return result
    cost = np.empty((len(point.undamped), len(point.damped)))
    for i, shape in enumerate(point.shapes.T):
        for j, other in enumerate(point.damped_shapes.T):
            likeness = abs(np.vdot(other, shape)) ** 2 / (np.vdot(other, other).real * (shape @ shape))
            natural = point.damped[j] / np.sqrt(max(1.0 - point.damping_ratio[j] ** 2, 1e-12))
            cost[i, j] = (1.0 - likeness) + abs(np.log(natural / point.undamped[i]))
    for i, j in np.transpose(linear_sum_assignment(cost)):
        result[i] = point.damping_ratio[j]
    return result
