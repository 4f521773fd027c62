"""A whole line over the speed of its reference shaft: mass, damping and stiffness about steady rotation."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.operating_point import at_speed
from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices
from hdrive_mbs.analysis.whirl.rotor_point import RotorPoint, rotor_point
from hdrive_mbs.components.motor import Motor
from hdrive_mbs.components.rotor import Rotor
from hdrive_mbs.motors.inverter import InverterMotor
from hdrive_mbs.motors.torque_speed_table import TorqueSpeedTable
from hdrive_mbs.scene import Scene

FloatArray = npt.NDArray[np.float64]

UNIT_SPEED = 1024.0
"""Second speed [rad/s] at which a line that is linear in the speed is evaluated; a power of two, so that dividing by it is exact."""


def without_unbalance(scene: Scene) -> Scene:
    """The scene with all rotors balanced: unbalance excites motion about steady rotation, it is no part of its modes."""
    changes: dict[str, float] = {}
    for name, part in scene.parts.items():
        if isinstance(part, Rotor) and (part.eccentricity != 0.0 or part.tilt != 0.0):
            changes |= {f"{name}.eccentricity": 0.0, f"{name}.tilt": 0.0}
    return scene.replacing(changes) if changes else scene


def eccentric_inertia(scene: Scene, names: Sequence[str]) -> FloatArray:
    """What eccentric masses add to the inertias about the axis, sum of m e^2 on each spin, (n, n): of an arm that is most of it."""
    found = np.zeros((len(names), len(names)))
    places = scene.network().places
    for name, part in scene.parts.items():
        if isinstance(part, Rotor) and places[name] in names:
            k = list(names).index(places[name])
            found[k, k] += part.mass * part.eccentricity**2
    return found


def fed_in_step(scene: Scene) -> Scene:
    """The scene with inverters that feed their motors with the frequency of the speed at hand, not with that at t = 0.

    A motor near its synchronous speed has the slope of Kloss's curve at no slip, dM/dw = -2 M_b/(s_b w_s), at every frequency
    (constant flux).  Its torque itself does not matter: the motor turns at a given speed.
    """
    far = 1e6
    changes = {}
    for name, part in scene.parts.items():
        motor = part.characteristic if isinstance(part, Motor) else None
        if isinstance(motor, InverterMotor):
            torque = far * 2.0 * motor.breakdown_torque / (motor.breakdown_slip * motor.synchronous_speed)
            changes[f"{name}.characteristic"] = TorqueSpeedTable(speeds=(-far, far), torques=(torque, -torque))
    return scene.replacing(changes) if changes else scene


class SpinningLine:
    """M q'' + D(W) q' + K(W) q = 0 of all coordinates at speed W of the reference shaft, seen from the fixed frame.

    Every other shaft turns at its ideal ratio.  A line of constant stiffness and damping has D = D0 + W D1 and
    K = K0 + W K1 and is evaluated twice; any other one is evaluated about the static deflection at each speed.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene = fed_in_step(without_unbalance(scene))
        first = at_speed(self.scene, 0.0)
        self.network = first.network()
        self._prescribed = first is not self.scene
        self._lines = LineMatrices(self.network)
        self._lines.check_memory()
        self.names = self._lines.names
        self.mass = self._lines.mass + eccentric_inertia(scene, self.names)
        self.couplings = self._lines.couplings()
        self._spins = {body.name: body.sense * body.ratio for body in self.network.bodies if not body.lateral}
        self._spins |= {motion.name: motion.sense * motion.ratio for motion in self.network.motions}
        depends_on = self._lines.depends_on()
        self._deflects = depends_on is None or not depends_on <= {"t"} | {f"speed:{name}" for name in self._spins}
        self._near: RotorPoint | None = None
        self._pattern = np.nonzero(self.couplings)
        self._known: dict[float, tuple[FloatArray, FloatArray]] = {}
        self._affine: tuple[FloatArray, ...] | None = None
        if depends_on is not None and not depends_on:
            damping, stiffness = self._evaluated(0.0)
            faster, stiffer = self._evaluated(UNIT_SPEED)
            self._affine = (damping, stiffness, (faster - damping) / UNIT_SPEED, (stiffer - stiffness) / UNIT_SPEED)

    @property
    def ratios(self) -> dict[str, float]:
        """Ideal speed of each turning coordinate per speed of the reference shaft, true sense."""
        network = self.network
        turning = {body.name: body.ratio for body in network.bodies if not body.lateral}
        return turning | {motion.name: motion.ratio for motion in network.motions if motion.name != "ground"}

    @property
    def is_affine(self) -> bool:
        """Whether D and K are straight lines over the speed."""
        return self._affine is not None

    def at(self, speed: float) -> tuple[FloatArray, FloatArray]:
        """D and K, (n, n) each.  Raises AnalysisError where there is no steady rotation at this speed."""
        if self._affine is not None:
            damping, stiffness, damping_slope, stiffness_slope = self._affine
            return damping + speed * damping_slope, stiffness + speed * stiffness_slope
        if speed not in self._known:
            self._known[speed] = tuple(matrix[self._pattern] for matrix in self._evaluated(speed))  # type: ignore[assignment]
        found = []
        for values in self._known[speed]:
            matrix = np.zeros(self.mass.shape)
            matrix[self._pattern] = values
            found.append(matrix)
        return found[0], found[1]

    def slopes(self, speed: float) -> tuple[FloatArray, FloatArray]:
        """dD/dW and dK/dW, (n, n) each; by a difference unless the line is linear in the speed."""
        if self._affine is not None:
            return self._affine[2], self._affine[3]
        step = 1e-5 * max(1.0, abs(speed))
        (here, soft), (there, stiff) = self.at(speed), self._evaluated(speed + step)
        return (there - here) / step, (stiff - soft) / step

    def _evaluated(self, speed: float) -> tuple[FloatArray, FloatArray]:
        scene, lines = self.scene, self._lines
        if self._prescribed:
            scene = at_speed(self.scene, speed)
            lines = LineMatrices(scene.network())
        if self._deflects:
            point = self._near = rotor_point(scene, speed, lines=lines, start=self._near)
            system = lines.at(point.angles, point.speeds, point.states)
        else:
            still = dict.fromkeys(self.names, 0.0)
            turning = {name: factor * speed for name, factor in self._spins.items()}
            system = lines.at(still, {**still, **turning}, {state.name: state.initial for state in self.network.states})
        return system.damping, system.stiffness
