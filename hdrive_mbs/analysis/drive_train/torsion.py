"""Static torsion curve of a gear, another connection or a whole line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.drive_train.elastic_law import ElasticLaw, elastic_laws
from hdrive_mbs.analysis.drive_train.static_line import StaticLine, static_line
from hdrive_mbs.analysis.drive_train.torsion_loop import slow_loop
from hdrive_mbs.analysis.result import Result
from hdrive_mbs.components.harmonic_drive import HarmonicDrive
from hdrive_mbs.errors import AnalysisError, ParameterError, unknown_place
from hdrive_mbs.network.network import Network
from hdrive_mbs.printed_table import PrintedTable, thinned
from hdrive_mbs.scene import Scene

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class TorsionCurve(Result):
    """Torque against elastic angle at the output, the input held.

    measured : what is twisted: a connection, or "a to b"
    torque : N m, shape (n,).  Of an automatic curve ascending, with zero torque twice where there is
        lost motion: at its lower and at its upper edge.  Of a loop in the order of the cycle
    angle : rad, shape (n,)
    stiffness : tangent dT/dangle on the side of growing torque [N m/rad], shape (n,); of a loop
        along its path
    parts : connection -> its part of the angle [rad], shape (n,)
    gap : angles between which no torque is carried [rad] (lower, upper); of a loop, where the
        loading and the unloading branch cross zero torque
    corner_torque, corner_angle : where the catalogue law of a gear changes its stiffness (at=gear only)
    loss : energy lost in one cycle of a loop [J]; 0 for a curve
    """

    measured: str
    torque: FloatArray
    angle: FloatArray
    stiffness: FloatArray
    parts: Mapping[str, FloatArray]
    gap: tuple[float, float]
    corner_torque: FloatArray
    corner_angle: FloatArray
    loss: float

    @property
    def lost_motion(self) -> float:
        """Width of the curve at zero torque [rad]."""
        return self.gap[1] - self.gap[0]

    def tables(self) -> tuple[PrintedTable, ...]:
        """The curve, lost motion and loss."""
        notes = [f"lost motion {self.lost_motion:.6g} rad"]
        notes += [f"loss of a cycle {self.loss:.6g} J"] if self.loss else []
        corners = zip(self.corner_torque, self.corner_angle, strict=True)
        notes += [f"stiffness changes at {torque:.6g} N m, {angle:.6g} rad" for torque, angle in corners]
        return (thinned(self.columns(), title=f"twist of {self.measured}", notes=tuple(notes)),)

    def columns(self) -> dict[str, np.ndarray]:
        table = {"torque [N m]": self.torque, "angle [rad]": self.angle, "tangent stiffness [N m/rad]": self.stiffness}
        return table | {f"part of {name} [rad]": part for name, part in self.parts.items()}


def torsion(
    scene: Scene,
    torques: Sequence[float] | FloatArray | None = None,
    *,
    at: str = "gear",
    between: tuple[str, str] | None = None,
    largest_torque: float | None = None,
    points: int = 201,
    cycles: int | None = None,
) -> TorsionCurve:
    """Static torque against angle, as a gear catalogue measures it: input held, torque at the output.

    torques : N m; zero is approached from above, as seed F (7) has it (-0.0: from below).  If not
        given, ``points`` torques between plus and minus largest_torque
    at : connection whose elastic twist is measured, referred to its own output side
    between : (held place, loaded place) for the angle of the whole line, e.g. ("motor", "load")
    largest_torque : N m; if not given, taken from the law of the gear: 1.4 times the second corner of a
        catalogue law (the rated range of Table 1), or where a fitted law or a table ends
    cycles : number of slow cycles for a law with hysteresis; the last one is returned

    Motor, load, friction on bodies and kinematic errors take no part, nor does damping.  The loop of
    a law with states is a quasi-static cycle through the scene's own state equations: the twist is
    led along a sine, slowly, so that its largest torque is largest_torque.

    Raises AnalysisError for a law with hysteresis when cycles is not given, and for a torque that
    the law never reaches.
    """
    line = static_line(scene, *between) if between is not None else _single(scene, at)
    measured = f"{between[0]} to {between[1]}" if between is not None else line.names[0]
    settings: dict[str, Any] = {"at": at if between is None else None, "between": between}
    if line.states:
        if cycles is None:
            raise AnalysisError(
                f"{', '.join(line.names)} has hysteresis (states {', '.join(line.states)}), so its angle depends on the past. "
                "Give cycles=2 for a slow loop, or take the effect away with scene.without(...)."
            )
        return _loop(scene, line, measured, settings, torques, largest_torque, points, cycles, between is not None)
    if cycles is not None:
        raise ParameterError(f"cycles = {cycles}: {measured} has no hysteresis, its curve does not depend on the past; leave cycles out.")
    wanted = _grid(scene, line, largest_torque, points) if torques is None else _given(torques, largest_torque)
    carried = line.torques(wanted)
    twists = line.twists(carried)
    compliance = line.compliances(line.stiffnesses(twists, carried)).sum(axis=1)
    parts = _parts(line, twists)
    corner_torque, corner_angle = _corners(scene, line) if between is None else (np.zeros(0), np.zeros(0))
    return TorsionCurve(
        scene=scene,
        status=_status(line, twists),
        settings=settings | {"largest_torque": float(np.max(np.abs(wanted)))},
        measured=measured,
        torque=wanted,
        angle=parts.sum(axis=1),
        stiffness=1.0 / compliance,
        parts={name: parts[:, k] for k, name in enumerate(line.names)},
        gap=_edges(line),
        corner_torque=corner_torque,
        corner_angle=corner_angle,
        loss=0.0,
    )


def _parts(line: StaticLine, twists: FloatArray) -> FloatArray:
    """Part of each connection in the angle, by the unit-load theorem: angle = sum(T_i(1 N m) x_i)."""
    return twists * line.unit


def _edges(line: StaticLine) -> tuple[float, float]:
    """Angles at which a torque falling to zero from below and from above leaves the line."""
    lower, upper = _parts(line, line.twists(np.outer([-1.0, 1.0], line.unit) * 0.0)).sum(axis=1)
    return float(lower), float(upper)


def _single(scene: Scene, at: str) -> StaticLine:
    laws = elastic_laws(scene.network())
    if at not in laws:
        raise unknown_place("connection", at, laws)
    return StaticLine(at, (laws[at],), np.ones(1), np.zeros((1, 0)))


def _given(torques: Sequence[float] | FloatArray, largest: float | None) -> FloatArray:
    wanted = np.asarray(torques, float)
    if largest is not None:
        raise ParameterError("Give torques or largest_torque, not both.")
    if wanted.ndim != 1 or not len(wanted) or not np.all(np.isfinite(wanted)):
        raise ParameterError(f"torques = {torques!r}: give a flat list of finite torques [N m].")
    return wanted


def _grid(scene: Scene, line: StaticLine, largest: float | None, points: int) -> FloatArray:
    """Even torques from -largest to largest, with the corners of the law and both edges of a gap."""
    top = _largest(scene, line, largest)
    if points < 3:
        raise ParameterError(f"points = {points}: a curve needs at least 3.")
    side = np.linspace(0.0, top, points // 2 + 1)[1:]
    corners = [abs(value) / abs(unit) for law, unit in zip(line.laws, line.unit, strict=True) for value in _corner_torques(scene, law)]
    side = np.unique(np.concatenate([side, [value for value in corners if 0.0 < value < top]]))
    lower, upper = _edges(line)
    zero = [-0.0, 0.0] if upper > lower else [0.0]
    return np.concatenate([-side[::-1], zero, side])


def _largest(scene: Scene, line: StaticLine, largest: float | None) -> float:
    if largest is not None:
        if not (np.isfinite(largest) and largest > 0.0):
            raise ParameterError(f"largest_torque = {largest:g} N m: must be greater than 0 N m.")
        return float(largest)
    limits = [_end_of_law(scene, law) / abs(unit) for law, unit in zip(line.laws, line.unit, strict=True) if unit != 0.0]
    top = min(limits, default=np.inf)
    if not np.isfinite(top):
        raise ParameterError(f"Give largest_torque: the laws of {', '.join(line.names)} name no torque up to which they hold.")
    return float(top)


def _end_of_law(scene: Scene, law: ElasticLaw) -> float:
    """Torque [N m] up to which the law of a gear is meant to hold; infinity where it does not say."""
    part = scene.parts.get(law.connection.name)
    if not isinstance(part, HarmonicDrive):
        return float("inf")
    stiffness = part.law
    corner = getattr(stiffness, "torque_2", None)
    if corner is not None:
        return 1.4 * float(corner)
    twist = getattr(stiffness, "largest_twist", None)
    if twist is not None:
        return float(stiffness.torque(float(twist)))
    table = getattr(stiffness, "torques", None)
    return float(table[-1]) if table else float("inf")


def _corner_torques(scene: Scene, law: ElasticLaw) -> tuple[float, ...]:
    """Torques of the corners of a catalogue law."""
    part = scene.parts.get(law.connection.name)
    stiffness = part.law if isinstance(part, HarmonicDrive) else None
    found = (getattr(stiffness, "torque_1", None), getattr(stiffness, "torque_2", None))
    return tuple(float(value) for value in found if value is not None)


def _corners(scene: Scene, line: StaticLine) -> tuple[FloatArray, FloatArray]:
    """Corners that the connection really has (an effect may have changed its law)."""
    law = line.laws[0]
    torques = np.array(_corner_torques(scene, law))
    if not len(torques):
        return np.zeros(0), np.zeros(0)
    angles = law.twist(torques)
    bends = np.abs(law.stiffness(angles, 1.0) / law.stiffness(angles * (1.0 - 1e-9), -1.0) - 1.0) > 1e-6
    return torques[bends], angles[bends]


def _status(line: StaticLine, twists: FloatArray) -> str:
    notes = ["complete"]
    for law, column in zip(line.laws, twists.T, strict=True):
        falls = law.falls_within(float(column.min()), float(column.max()))
        if falls is not None:
            notes.append(
                f"the torque of {law.connection.name} falls with growing twist at {falls:.4g} rad: the curve jumps there, as a "
                "test under controlled torque does"
            )
    return "; ".join(notes)


def _loop(
    scene: Scene,
    line: StaticLine,
    measured: str,
    settings: dict[str, Any],
    torques: object,
    largest: float | None,
    points: int,
    cycles: int,
    whole_line: bool,
) -> TorsionCurve:
    if whole_line:
        raise AnalysisError(f"A loop of the whole line is not offered; ask at the connection with hysteresis: {', '.join(line.names)}.")
    if torques is not None:
        raise ParameterError("A loop goes through all torques up to largest_torque; give that instead of torques.")
    if cycles < 1:
        raise ParameterError(f"cycles = {cycles}: at least 1.")
    law = line.laws[0]
    network: Network = scene.network()
    top = _largest(scene, line, largest)
    loop = slow_loop(network, law.connection, law.states, largest_torque=top, points=points, cycles=cycles)
    slope = np.gradient(loop.twist)
    stiffness = np.divide(np.gradient(loop.torque), slope, out=np.full_like(slope, np.nan), where=np.abs(slope) > 1e-15)
    return TorsionCurve(
        scene=scene,
        status=loop.status,
        settings=settings | {"largest_torque": top, "cycles": cycles},
        measured=measured,
        torque=loop.torque,
        angle=loop.twist,
        stiffness=stiffness,
        parts={line.names[0]: loop.twist},
        gap=loop.crossings,
        corner_torque=np.zeros(0),
        corner_angle=np.zeros(0),
        loss=loop.loss,
    )
