"""What is read from the histories of a run-up: peaks of every rotor, speeds and torques at its end."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.analysis.run_up.rest_positions import rest_position
from hdrive_mbs.analysis.run_up.speed_peaks import SpeedPeak, Whirl, speed_peaks
from hdrive_mbs.analysis.run_up.torque_balance import TorqueBalance, torque_balance
from hdrive_mbs.analysis.time_response import Response
from hdrive_mbs.analysis.whirl.rotor_places import centre_motion, mass_centre_motion
from hdrive_mbs.network.network import Network
from hdrive_mbs.network.rigid_mass import RigidMass
from hdrive_mbs.signals import FloatArray, TimeHistory

LAST_PART = 0.1
"""Share of the run at its end over which torques are balanced."""

BALANCED = 4.0
"""Revolutions over which they are balanced at least."""

SETTLED = 1.0
"""Revolutions of a rotor before its largest whirl is looked for: a journal lifts off its wall, a start rings."""

REVOLUTIONS = 2.0
"""Revolutions at the end of the run whose parabola gives the final speed."""


@dataclass(frozen=True)
class Peak:
    """Largest amplitude [m, 0-peak], speed of the rotor [rad/s] and time [s] then."""

    amplitude: float
    speed: float
    time: float


@dataclass(frozen=True)
class RotorFigures:
    """Of one rotor.

    centre, mass_centre : peak of the whirl about the static deflection, after the first revolution
    distance : largest distance of the centre from the axis [m], of the whole run
    maxima : rows of SpeedPeak
    channels : ending -> values and doc of histories that the response does not have
    """

    centre: Peak
    mass_centre: Peak
    distance: float
    maxima: FloatArray
    final_speed: float
    channels: Mapping[str, tuple[FloatArray, str]]


def rotor_figures(
    response: Response, name: str, mass: RigidMass, still: FloatArray, reference: FloatArray, criticals: FloatArray
) -> RotorFigures:
    """Figures of the rotor at a place.

    still : its static deflection, rows of speeds, x and y;  reference : speed of the reference shaft at the samples
    criticals : critical speeds [rad/s]
    """
    times, speed = response.times, response[f"{name}.speed"]
    angle = response.values[f"{name}.angle"]
    static = rest_position(still, reference)
    z, rate = centre_motion(response, name)
    p, p_rate = mass_centre_motion(response, name, mass)
    whirl, mass_whirl = Whirl(times, z - static, rate), Whirl(times, p - static, p_rate)
    found = speed_peaks(whirl, angle, reference, criticals, lambda t: float(speed.at(t)))
    settled = np.abs(angle - angle[0]) >= SETTLED * 2.0 * math.pi
    first = int(np.argmax(settled))  # 0, the whole run, where the rotor does not turn that far
    about = f"the centre of mass of {name}"
    return RotorFigures(
        centre=_peak(whirl, speed, first),
        mass_centre=_peak(mass_whirl, speed, first),
        distance=Whirl(times, z, rate).maximum()[1],
        maxima=np.array(found, float).reshape(-1, len(SpeedPeak._fields)),
        final_speed=final_speed(times, angle, speed.values)[0],
        channels={
            "whirl": (whirl.distance, f"whirl amplitude of the centre of {name} about its static position"),
            "mass_centre_radial": (np.abs(p), f"distance of {about} from the axis"),
            "mass_centre_whirl": (mass_whirl.distance, f"whirl amplitude of {about} about the static position"),
        },
    )


def _peak(whirl: Whirl, speed: TimeHistory, first: int) -> Peak:
    time, amplitude = whirl.maximum(first)
    return Peak(amplitude, float(speed.at(time)), time)


def final_speed(times: FloatArray, angle: FloatArray, speed: FloatArray) -> tuple[float, float]:
    """Speed [rad/s] and acceleration [rad/s^2] at the end, of the parabola through the last revolutions."""
    before = np.nonzero(np.abs(angle - angle[-1]) > REVOLUTIONS * 2.0 * math.pi)[0]
    first = int(before[-1]) + 1 if len(before) else 0
    if len(times) - first < 4:
        return float(speed[-1]), 0.0
    span = times[-1] - times[first]
    _, slope, last = np.polyfit((times[first:] - times[-1]) / span, speed[first:], 2) / (1.0, span, 1.0)
    return float(last), float(slope)


@dataclass(frozen=True)
class LineFigures:
    """Of all rotors and of the reference shaft; ``balance`` is None where the motion is prescribed."""

    rotors: Mapping[str, RotorFigures]
    final_speed: float
    final_acceleration: float
    balance: TorqueBalance | None

    @property
    def captured(self) -> bool:
        """Whether whirl holds the spin below the speed of its drive."""
        return self.balance is not None and self.balance.is_captured


def line_figures(
    network: Network,
    response: Response,
    reference: str,
    masses: Mapping[str, RigidMass],
    static: Mapping[str, FloatArray],
    criticals: Sequence[float],
) -> LineFigures:
    """Figures of a run; ``masses`` names the rotors."""
    times, speed, angle = response.times, response.values[f"{reference}.speed"], response.values[f"{reference}.angle"]
    speeds = np.array(criticals)
    last, slope = final_speed(times, angle, speed)
    revolutions = times[np.abs(angle - angle[-1]) >= BALANCED * 2.0 * math.pi]
    begin = min(times[-1] - LAST_PART * (times[-1] - times[0]), revolutions[-1] if len(revolutions) else times[0])
    prescribed = network.motions_drive
    return LineFigures(
        rotors={name: rotor_figures(response, name, mass, static[name], speed, speeds) for name, mass in masses.items()},
        final_speed=last,
        final_acceleration=slope,
        balance=None if prescribed else torque_balance(network, response, reference, float(begin), float(times[-1])),
    )
