"""One run-up of a line with one solver: motion of both rotors, steps and CPU time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

import hdrive_mbs as hm
from hdrive_mbs.analysis.time_response import read_over, run_moment
from hdrive_mbs.engine.assembly import assemble
from hdrive_mbs.engine.simulation import run

FloatArray = npt.NDArray[np.float64]

ROTORS = ("rotor_1", "rotor_2")
COORDINATES = ("x", "y", "psi", "theta")


@dataclass(frozen=True)
class Peak:
    """The largest distance of a geometric centre from the axis.

    amplitude : m, 0-peak
    speed : of the rotor at that moment [rad/s]
    """

    amplitude: float
    speed: float


@dataclass(frozen=True, eq=False)
class RunUp:
    """What a run did, at the solver's own times.

    angle, speed : rotor -> true spin angle [rad] and speed [rad/s]
    lateral : rotor -> x, y [m] and tilts psi, theta [rad]
    eccentricity : rotor -> distance of the mass centre from the geometric centre [m], at the angle of the rotor
    drive_speed : of the drive disc [rad/s]
    """

    times: FloatArray
    angle: Mapping[str, FloatArray]
    speed: Mapping[str, FloatArray]
    lateral: Mapping[str, Mapping[str, FloatArray]]
    eccentricity: Mapping[str, float]
    drive_speed: FloatArray
    seconds: float
    steps: int
    rejected: int

    def distance(self, rotor: str) -> FloatArray:
        """Of the geometric centre C from the axis [m]."""
        return np.hypot(self.lateral[rotor]["x"], self.lateral[rotor]["y"])

    def mass_centre(self, rotor: str) -> tuple[FloatArray, FloatArray]:
        """x and y of the mass centre P [m]; the tilt shortens the eccentricity by less than a millionth."""
        e, angle = self.eccentricity[rotor], self.angle[rotor]
        return self.lateral[rotor]["x"] + e * np.cos(angle), self.lateral[rotor]["y"] + e * np.sin(angle)

    def mass_centre_distance(self, rotor: str) -> FloatArray:
        """Of the mass centre P from the axis [m]."""
        return np.hypot(*self.mass_centre(rotor))

    def peak(self, rotor: str) -> Peak:
        """The largest distance of C, by a parabola through three samples; the speed is the line between their ends."""
        distance, speed = self.distance(rotor), self.speed[rotor]
        k = int(np.clip(np.argmax(distance), 1, len(distance) - 2))
        t = self.times[k - 1 : k + 2] - self.times[k]
        a, b, c = np.polyfit(t, distance[k - 1 : k + 2], 2)
        top = -b / (2.0 * a) if a < 0.0 else 0.0
        return Peak(float(c + b * top + a * top * top), float(np.interp(top, t, speed[k - 1 : k + 2])))

    def thinned(self, samples: int) -> RunUp:
        """Every k-th sample, so that about so many are left."""
        k = max(1, len(self.times) // samples)

        def thin(values: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
            return {name: value[::k].copy() for name, value in values.items()}

        return replace(
            self,
            times=self.times[::k].copy(),
            angle=thin(self.angle),
            speed=thin(self.speed),
            lateral={rotor: thin(values) for rotor, values in self.lateral.items()},
            drive_speed=self.drive_speed[::k].copy(),
        )

    def over_speed(self, values: FloatArray, rotor: str, speeds: FloatArray) -> FloatArray:
        """A history at speeds of the rotor [rad/s], while it speeds up; NaN beyond the speed it reaches.

        Torsional vibration makes the speed go back and forth a little: the last passage counts.
        """
        lowest = np.minimum.accumulate(self.speed[rotor][::-1])[::-1]  # from each moment on
        last = np.concatenate((np.diff(lowest) > 0.0, [True]))
        return np.interp(speeds, lowest[last], values[last], left=np.nan, right=np.nan)


def run_up(scene: hm.Scene, duration: float, solver: hm.Solver) -> RunUp:
    """Run the line up from rest.  Raises SimulationError when it diverges."""
    assembly = assemble(scene.network())
    try:
        raw = run(assembly, duration=duration, solver=solver, angles={}, speeds={}, states={})
    finally:
        assembly.mbs.Reset()  # the engine would keep all samples for as long as the process lives
    moment = run_moment(assembly.network, raw)
    channels = {channel.name: channel for channel in assembly.network.channels}

    def read(name: str) -> FloatArray:
        return read_over(channels[name].read, moment)

    return RunUp(
        times=raw.times,
        angle={rotor: read(f"{rotor}.angle") for rotor in ROTORS},
        speed={rotor: read(f"{rotor}.speed") for rotor in ROTORS},
        lateral={rotor: {name: read(f"{rotor}.{name}") for name in COORDINATES} for rotor in ROTORS},
        eccentricity={rotor: float(scene.parts[rotor].eccentricity) for rotor in ROTORS},  # type: ignore[attr-defined]
        drive_speed=read("drive_disc.speed"),
        seconds=raw.seconds,
        steps=raw.steps,
        rejected=raw.rejected,
    )
