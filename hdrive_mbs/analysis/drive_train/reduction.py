"""The reduced model: shafts taken as rigid against the flexspline, and whether that is allowed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.drive_train.modes import Modes, modes_at
from hdrive_mbs.analysis.drive_train.static_line import static_line
from hdrive_mbs.analysis.operating_point import operating_point, with_load
from hdrive_mbs.analysis.result import Result
from hdrive_mbs.components.load import Load
from hdrive_mbs.components.motor import Motor
from hdrive_mbs.components.rigid_coupling import RigidCoupling
from hdrive_mbs.components.shaft import Shaft
from hdrive_mbs.engine.assembly import assemble
from hdrive_mbs.engine.linearisation import LinearSystem, linearise
from hdrive_mbs.errors import AnalysisError, ParameterError
from hdrive_mbs.printed_table import PrintedTable
from hdrive_mbs.scene import Scene

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]


@dataclass(frozen=True, kw_only=True, eq=False)
class Reduction(Result):
    """The reduced model against the full one, at one operating torque.

    replaced : the shafts that became rigid
    held, loaded : the two ends between which compliance and transfer are meant
    torque : at the loaded end [N m]
    full_undamped, reduced_undamped : natural frequencies [rad/s]; the reduced model has fewer
    mode_error : reduced over full, less 1, of the modes that both have
    compliance : connection -> its part of the compliance at the loaded end [rad/(N m)]
    shaft_share : part of the replaced shafts in it
    frequency : rad/s, shape (m,)
    full_transfer, reduced_transfer : speed of the loaded end per torque at the held one,
        now free [rad/s/(N m)], complex
    good_to : frequency [rad/s] up to which these two differ by no more than transfer_tolerance
    valid : whether the error of the first mode stays within mode_tolerance
    reason : the verdict in words
    """

    replaced: tuple[str, ...]
    held: str
    loaded: str
    torque: float
    full_undamped: FloatArray
    reduced_undamped: FloatArray
    mode_error: FloatArray
    compliance: Mapping[str, float]
    shaft_share: float
    frequency: FloatArray
    full_transfer: ComplexArray
    reduced_transfer: ComplexArray
    good_to: float
    valid: bool
    reason: str

    @property
    def shares(self) -> dict[str, float]:
        """Part of each connection in the compliance at the loaded end; they sum to 1."""
        total = sum(self.compliance.values())
        return {name: value / total for name, value in self.compliance.items()}

    @property
    def reduced_scene(self) -> Scene:
        """The scene with rigid shafts."""
        if self.scene is None:
            raise AnalysisError("The reduction came from a file that could not hold its scene; reduce the scene again.")
        return with_rigid_shafts(self.scene)

    def tables(self) -> tuple[PrintedTable, ...]:
        """Natural frequencies of both models, where the compliance is, and the verdict."""
        modes = tuple(
            (str(k + 1), float(full), float(self.reduced_undamped[k]), 100.0 * float(self.mode_error[k]))
            if k < len(self.reduced_undamped)
            else (str(k + 1), float(full), math.nan, math.nan)
            for k, full in enumerate(self.full_undamped)
        )
        heads = ("mode", "full: undamped [rad/s]", "reduced: undamped [rad/s]", "difference [%]")
        shares = self.shares
        parts = tuple((name, value, 100.0 * shares[name]) for name, value in self.compliance.items())
        where = f"compliance at {self.loaded} under {self.torque:.6g} N m"
        return (
            PrintedTable(title="natural frequencies", heads=heads, rows=modes, notes=(self.reason,)),
            PrintedTable(title=where, heads=("connection", "compliance [rad/(N m)]", "share [%]"), rows=parts),
        )

    def columns(self) -> dict[str, np.ndarray]:
        return {
            "frequency [rad/s]": self.frequency,
            "full transfer [rad/s/(N m)]": np.abs(self.full_transfer),
            "reduced transfer [rad/s/(N m)]": np.abs(self.reduced_transfer),
        }


def reduce(
    scene: Scene,
    *,
    torque: float | None = None,
    motor_speed: float | None = None,
    between: tuple[str, str] | None = None,
    mode_tolerance: float = 0.01,
    transfer_tolerance: float = 0.05,
) -> Reduction:
    """Make all shafts rigid and compare with the full model at a steady operating point.

    torque : load torque [N m] in place of the scene's own load at t = 0; the flexspline's stiffness is
        the tangent there
    motor_speed : rad/s; None for the speed at which motor and load balance
    between : the two ends of the line; the motor and the load if not given
    mode_tolerance : largest error of the first natural frequency of a valid reduction
    transfer_tolerance : largest relative difference, end to end, that counts as good

    Each shaft becomes a rigid coupling that carries its inertia; motor and wave generator then are
    one body, flexspline and machine another: the two equations of seed F (after its reference
    [16]).  Seed F says that some authors assume stiff shafts, not when they may: here the error of
    the first mode decides.

    Raises AnalysisError when there is no shaft, when no elastic mode is left (an open gap), or when an
    effect acts on a shaft's twist.
    """
    for name, value in (("mode_tolerance", mode_tolerance), ("transfer_tolerance", transfer_tolerance)):
        if not 0.0 < value < 1.0:
            raise ParameterError(f"{name} = {value:g}: must be greater than 0 and less than 1.")
    loaded_scene = scene if torque is None else with_load(scene, torque)
    reduced_scene = with_rigid_shafts(loaded_scene)
    first, last = between if between is not None else _ends(scene)
    full, full_system = _linear(loaded_scene, motor_speed)
    reduced, reduced_system = _linear(reduced_scene, full.motor_speed)
    # a constraint never lowers a natural frequency (Rayleigh), so what lies far below is a rest of a rigid-body motion
    stiffer = reduced.undamped[reduced.undamped > 0.5 * full.undamped[0]] if len(full.undamped) else reduced.undamped
    if not len(stiffer):
        raise AnalysisError(
            "With rigid shafts no elastic mode is left at this operating point: nothing else is elastic there, or the lost motion "
            "is open. Give a torque that closes it."
        )
    error = stiffer / full.undamped[: len(stiffer)] - 1.0
    compliance, carried = _compliance(loaded_scene, full, first, last)
    replaced = _shafts(scene)
    share = sum(compliance.get(name, 0.0) for name in replaced) / sum(compliance.values())
    frequency = np.geomspace(1e-2 * full.undamped[0], 3.0 * full.undamped[-1], 3000)
    transfers = [
        _transfer(system, _body(model, first, system), _body(model, last, system), frequency)
        for model, system in ((loaded_scene, full_system), (reduced_scene, reduced_system))
    ]
    good_to = _good_to(frequency, transfers[0], transfers[1], transfer_tolerance)
    valid = bool(abs(error[0]) <= mode_tolerance)
    return Reduction(
        scene=loaded_scene,
        status="; ".join(dict.fromkeys([*full.status.split("; "), *reduced.status.split("; ")])),
        settings={"mode_tolerance": mode_tolerance, "transfer_tolerance": transfer_tolerance, "motor_speed": full.motor_speed},
        replaced=replaced,
        held=first,
        loaded=last,
        torque=carried,
        full_undamped=full.undamped,
        reduced_undamped=stiffer,
        mode_error=error,
        compliance=compliance,
        shaft_share=share,
        frequency=frequency,
        full_transfer=transfers[0],
        reduced_transfer=transfers[1],
        good_to=good_to,
        valid=valid,
        reason=_reason(valid, full.undamped[0], stiffer[0], mode_tolerance, share, last, good_to, transfer_tolerance),
    )


def with_rigid_shafts(scene: Scene) -> Scene:
    """The scene with every shaft replaced by a rigid coupling of the same inertia."""
    shafts = _shafts(scene)
    if not shafts:
        raise AnalysisError(f"Scene {scene.name!r} has no shaft, so there is nothing to reduce.")
    for placed in scene.effects:
        if placed.at in shafts:
            raise AnalysisError(
                f"{placed.name!r} acts on the twist of {placed.at!r}, which would become rigid; "
                f"take it away with scene.without({placed.name!r})."
            )
    couplings = {}
    for name in shafts:
        shaft = scene.parts[name]
        assert isinstance(shaft, Shaft)
        couplings[name] = RigidCoupling(inertia=(shaft.share_a + shaft.share_b) * shaft.inertia)
    return scene.replacing(couplings)


def _shafts(scene: Scene) -> tuple[str, ...]:
    return tuple(name for name, part in scene.parts.items() if isinstance(part, Shaft))


def _ends(scene: Scene) -> tuple[str, str]:
    motors = [name for name, part in scene.parts.items() if isinstance(part, Motor)]
    loads = [name for name, part in scene.parts.items() if isinstance(part, Load)]
    if len(motors) != 1 or len(loads) != 1:
        raise AnalysisError(
            f"Scene {scene.name!r} has {len(motors)} motors and {len(loads)} loads; name the two ends with between=(..., ...)."
        )
    return motors[0], loads[0]


def _linear(scene: Scene, motor_speed: float | None) -> tuple[Modes, LinearSystem]:
    point = operating_point(scene, motor_speed=motor_speed)
    assembly = assemble(scene.network())
    system = linearise(assembly, angles=point.angles, speeds=point.speeds, states=point.states)
    return modes_at(scene, assembly, point), system


def _compliance(scene: Scene, full: Modes, held: str, loaded: str) -> tuple[dict[str, float], float]:
    """Tangent compliance of each connection at the loaded end, and the torque there at the operating point."""
    line = static_line(scene, held, loaded)
    strongest = int(np.argmax(np.abs(line.unit)))
    torque = full.torques[line.names[strongest]] / float(line.unit[strongest])
    carried = line.torques(np.array([torque]))
    parts = line.compliances(line.stiffnesses(line.twists(carried), carried))[0]
    return {name: float(value) for name, value in zip(line.names, parts, strict=True)}, torque


def _body(scene: Scene, place: str, system: LinearSystem) -> int:
    name = scene.network().places[place]
    if name not in system.bodies:
        raise AnalysisError(
            f"{place!r} is prescribed or held, so no transfer starts or ends there; name other ends with between=(..., ...)."
        )
    return system.bodies.index(name)


def _transfer(system: LinearSystem, source: int, target: int, frequency: FloatArray) -> ComplexArray:
    """Speed of one body per torque on another:  e_t^T (i w - A)^-1 (M^-1 e_s)."""
    n = len(system.bodies)
    values, vectors = np.linalg.eig(system.matrix)
    drive = np.zeros(len(values))
    drive[n : 2 * n] = np.linalg.inv(system.mass)[:, source]
    if np.linalg.cond(vectors) < 1e8:
        weights = vectors[n + target] * np.linalg.solve(vectors, drive.astype(complex))
        return np.asarray((weights / (1j * frequency[:, None] - values)).sum(axis=1))
    # a free train without drag has a defective pair at zero: solve frequency by frequency
    unit = np.eye(len(values))
    return np.array([np.linalg.solve(1j * w * unit - system.matrix, drive)[n + target] for w in frequency])


def _good_to(frequency: FloatArray, full: ComplexArray, reduced: ComplexArray, tolerance: float) -> float:
    """First frequency at which the transfers differ by more, by linear interpolation; the last one if none."""
    difference = np.abs(reduced - full) / np.abs(full)
    beyond = np.nonzero(difference > tolerance)[0]
    if not len(beyond):
        return float(frequency[-1])
    k = int(beyond[0])
    if k == 0:
        return 0.0
    share = (tolerance - difference[k - 1]) / (difference[k] - difference[k - 1])
    return float(frequency[k - 1] + share * (frequency[k] - frequency[k - 1]))


def _reason(valid: bool, full: float, reduced: float, limit: float, share: float, loaded: str, good_to: float, tolerance: float) -> str:
    verdict = "The reduced model is valid here" if valid else "The reduced model is not valid here: keep the shafts"
    return (
        f"{verdict}. Rigid shafts move the first mode from {full:.4g} to {reduced:.4g} rad/s ({100.0 * (reduced / full - 1.0):+.2g} %, "
        f"limit {100.0 * limit:g} %); the shafts hold {100.0 * share:.3g} % of the compliance at {loaded}. "
        f"End to end the two models agree within {100.0 * tolerance:g} % up to {good_to:.4g} rad/s."
    )
