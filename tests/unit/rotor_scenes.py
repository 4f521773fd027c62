"""Small rotor scenes for the tests of time-domain analyses, and responses made by hand."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

import hdrive_mbs as hm

MASS, POLAR, ECCENTRICITY = 2.0, 0.01, 1e-4
STIFFNESS, DAMPING = 2e5, 25.0
CRITICAL = float(np.sqrt(STIFFNESS / MASS))
"""316.2 rad/s, damping ratio 2 %."""


def constant(torque: float) -> hm.TorqueSpeedTable:
    return hm.TorqueSpeedTable(speeds=(0.0, 1.0), torques=(torque, torque))


def holding(speed: float, slope: float) -> hm.TorqueSpeedTable:
    """Torque slope x (speed - w)."""
    return hm.TorqueSpeedTable(speeds=(0.0, speed), torques=(slope * speed, 0.0), extrapolate=True)


def support(x: float = STIFFNESS, y: float = STIFFNESS, damping: float = DAMPING) -> hm.LinearBearing:
    return hm.LinearBearing.from_matrices(
        stiffness=np.diag([x, y, 1e5, 5e3, 5e3, 0.0]), damping=np.diag([damping, damping, 10.0, 0.5, 0.5, 0.0])
    )


def jeffcott(
    drive: hm.TorqueSpeedTable | None = None,
    law: hm.BearingLaw | None = None,
    parts: Mapping[str, hm.Component] | None = None,
    **rotor: float,
) -> hm.Scene:
    """One disc on one support, driven by 5 N m (500 rad/s^2) unless told otherwise."""
    values = {"mass": MASS, "polar_inertia": POLAR, "transverse_inertia": 0.006, "eccentricity": ECCENTRICITY, **rotor}
    everything = {
        "drive": hm.DriveTorque(characteristic=drive or constant(5.0)),
        "disc": hm.Rotor(**values),
        "bearing": hm.Bearing(law=law or support()),
        **(parts or {}),
    }
    return hm.Scene(name="jeffcott", parts=everything, connections=[("drive", "disc", "bearing")])


def steady(speed: float, stiffness: float = STIFFNESS, damping: float = DAMPING) -> complex:
    """Z of x + i y = Z exp(i w t):  m e w^2/(k - m w^2 + i c w)."""
    return MASS * ECCENTRICITY * speed**2 / complex(stiffness - MASS * speed**2, damping * speed)


def made(times: np.ndarray, angle: np.ndarray, speed: np.ndarray, z: np.ndarray, rate: np.ndarray) -> hm.Response:
    """A response of one place ``disc`` with the motion z = x + i y, as simulate would return it."""
    values = {
        "disc.angle": angle,
        "disc.speed": speed,
        "disc.x": z.real.copy(),
        "disc.y": z.imag.copy(),
        "disc.x_rate": rate.real.copy(),
        "disc.y_rate": rate.imag.copy(),
    }
    units = {"disc.angle": "rad", "disc.speed": "rad/s", "disc.x": "m", "disc.y": "m", "disc.x_rate": "m/s", "disc.y_rate": "m/s"}
    return hm.Response(
        scene=None,
        status="complete",
        settings={},
        times=times,
        values=values,
        units=units,
        docs=dict.fromkeys(values, ""),
        slopes={"disc.angle": "disc.speed", "disc.x": "disc.x_rate", "disc.y": "disc.y_rate"},
        steps=len(times) - 1,
        rejected=0,
        seconds=0.0,
        lowering={},
    )


def damped_disc(damping: float) -> hm.Scene:
    """A balanced disc on one support; nothing turns it, so it keeps the speed it starts with."""
    return jeffcott(constant(0.0), support(damping=damping), eccentricity=0.0)


def z_of(response: hm.Response, place: str) -> np.ndarray:
    """x + i y of a place."""
    return np.asarray(response[f"{place}.x"].values + 1j * response[f"{place}.y"].values)
