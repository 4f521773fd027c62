"""Where the places of a line stand under weight and bearing forces, over the speed of its reference shaft."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.interpolate import PchipInterpolator

from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices
from hdrive_mbs.analysis.whirl.rotor_point import RotorPoint, rotor_point
from hdrive_mbs.components.drive_torque import DriveTorque
from hdrive_mbs.components.motor import Motor
from hdrive_mbs.components.speed_controller import SpeedController
from hdrive_mbs.errors import AnalysisError
from hdrive_mbs.motors.torque_speed_table import TorqueSpeedTable
from hdrive_mbs.scene import Scene
from hdrive_mbs.signals import FloatArray

ComplexArray = npt.NDArray[np.complex128]

SPEEDS = 25
"""Speeds at which a static deflection that changes with speed is calculated."""

COARSE = 0.05
"""Largest change from one speed to the next, as a share of the way that a place takes over all; a larger one is halved."""

CLOSEST = 1e-4
"""Share of the highest speed down to which speeds are halved: a journal leaves the wall within a fraction of a rad/s."""

SAME = 1e-9
"""Relative difference of deflections at three speeds below which they count as one."""


def without_drive(scene: Scene) -> Scene:
    """The scene with the torques of its motors and drives switched off and without speed controllers."""
    for name in [name for name, part in scene.parts.items() if isinstance(part, SpeedController)]:
        scene = scene.without(name)
    nothing = TorqueSpeedTable(speeds=(0.0, 1.0), torques=(0.0, 0.0))
    drives = [name for name, part in scene.parts.items() if isinstance(part, (Motor, DriveTorque))]
    return scene.replacing({f"{name}.characteristic": nothing for name in drives})


class FreeLine:
    """The line with every spin free, its linearisation, and its steady rotation at any speed of the reference shaft."""

    def __init__(self, scene: Scene) -> None:
        self.scene = without_drive(scene) if scene.network().motions_drive else scene
        self.lines = LineMatrices(self.scene.network())

    def point(self, speed: float, start: RotorPoint | None = None) -> RotorPoint:
        """Steady rotation.  Raises AnalysisError where forces cannot be balanced."""
        return rotor_point(self.scene, speed, lines=self.lines, start=start)

    def positions(self, point: RotorPoint, places: Sequence[str]) -> ComplexArray:
        """x + i y [m] of places at a point."""
        network = self.lines.network
        read = {channel.name: channel.read for channel in network.channels}
        moment = network.moment(np.float64(0.0), point.angles, point.speeds, point.states)
        return np.array([complex(float(read[f"{name}.x"](moment)), float(read[f"{name}.y"](moment))) for name in places])


@dataclass(frozen=True)
class RestPositions:
    """Static position of places over speed.

    table : place -> rows of speeds [rad/s], x and y [m]; one column where it does not depend on speed
    points : steady rotation at rising speeds of the reference shaft, evenly spaced, the last at the highest
    """

    table: Mapping[str, FloatArray]
    points: tuple[RotorPoint, ...]

    @classmethod
    def over(cls, line: FreeLine, places: Sequence[str], top: float) -> RestPositions:
        """Up to a speed [rad/s].  A line that has none at rest (a journal bearing) begins a little above.

        Raises AnalysisError where there is none at the speeds above.
        """
        points = []
        try:
            points.append(line.point(0.0))
        except AnalysisError:
            points = []
        points += [line.point(0.5 * top), line.point(top)]
        at = np.array([line.positions(point, places) for point in points])
        if np.allclose(at, at[:1], rtol=SAME, atol=1e-15):
            return cls({name: np.array([[top], [at[-1, k].real], [at[-1, k].imag]]) for k, name in enumerate(places)}, tuple(points))
        speeds = np.linspace(0.0 if len(points) == 3 else top / SPEEDS, top, SPEEDS)
        points = []
        for speed in speeds:
            points.append(line.point(float(speed), points[-1] if points else None))
        found = {float(speed): point for speed, point in zip(speeds, points, strict=True)}
        speeds, at = _refined(line, places, found, CLOSEST * top)
        return cls({name: np.vstack([speeds, at[:, k].real, at[:, k].imag]) for k, name in enumerate(places)}, tuple(points))

    @classmethod
    def none(cls, places: Sequence[str]) -> RestPositions:
        """On the axis."""
        return cls({name: np.zeros((3, 1)) for name in places}, ())


def _refined(line: FreeLine, places: Sequence[str], found: dict[float, RotorPoint], closest: float) -> tuple[FloatArray, ComplexArray]:
    """Speeds and positions, with speeds between where a place goes far from one to the next."""
    at = {speed: line.positions(point, places) for speed, point in found.items()}
    while True:
        speeds = np.array(sorted(at))
        rows = np.array([at[speed] for speed in speeds.tolist()])
        ways = np.abs(np.diff(rows, axis=0))
        far = np.any(ways > COARSE * np.sum(ways, axis=0), axis=1) & (np.diff(speeds) > 2.0 * closest)
        if not far.any():
            return speeds, rows
        for k in np.flatnonzero(far):
            speed = float(0.5 * (speeds[k] + speeds[k + 1]))
            found[speed] = line.point(speed, found[float(speeds[k + 1])])
            at[speed] = line.positions(found[speed], places)


def rest_position(table: FloatArray, speed: FloatArray) -> ComplexArray:
    """x + i y [m] from rows of speeds, x and y, at speeds of the reference shaft; the end values hold beyond."""
    speeds, x, y = table
    if len(speeds) == 1:
        return np.full(np.shape(speed), complex(x[0], y[0]))
    at = np.clip(np.abs(speed), speeds[0], speeds[-1])
    return np.asarray(PchipInterpolator(speeds, x)(at) + 1j * PchipInterpolator(speeds, y)(at))
