"""Where the places of a line stand under weight and bearing forces, over the speed of its reference shaft."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.interpolate import PchipInterpolator

from hdrive_mbs.analysis.line_matrices import LineMatrices
from hdrive_mbs.analysis.rotor_point import RotorPoint, rotor_point
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
    points : steady rotation at rising speeds of the reference shaft, the last at the highest
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
        at = np.array([line.positions(point, places) for point in points])
        return cls({name: np.vstack([speeds, at[:, k].real, at[:, k].imag]) for k, name in enumerate(places)}, tuple(points))

    @classmethod
    def none(cls, places: Sequence[str]) -> RestPositions:
        """On the axis."""
        return cls({name: np.zeros((3, 1)) for name in places}, ())


def rest_position(table: FloatArray, speed: FloatArray) -> ComplexArray:
    """x + i y [m] from rows of speeds, x and y, at speeds of the reference shaft; the end values hold beyond."""
    speeds, x, y = table
    if len(speeds) == 1:
        return np.full(np.shape(speed), complex(x[0], y[0]))
    at = np.clip(np.abs(speed), speeds[0], speeds[-1])
    return np.asarray(PchipInterpolator(speeds, x)(at) + 1j * PchipInterpolator(speeds, y)(at))
