"""Which places of a scene are rotors, where they stand, and where their mass centres move."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.time_response import Response
from hdrive_mbs.network.rigid_mass import RigidMass
from hdrive_mbs.scene import Scene

ComplexArray = npt.NDArray[np.complex128]


def rotor_masses(scene: Scene) -> dict[str, RigidMass]:
    """Mass of every rotor by its place, each with its own centre of mass (not that of what is joined to it)."""
    return {
        f"{name}.{flange.name}" if flange.name else name: flange.mass
        for name, part in scene.parts.items()
        for flange in part.flanges()
        if flange.is_rotor
    }


def centre_motion(response: Response, place: str) -> tuple[ComplexArray, ComplexArray]:
    """x + i y [m] of the geometric centre at the samples, and its rate."""
    x, y, x_rate, y_rate = (response.values[f"{place}.{key}"] for key in ("x", "y", "x_rate", "y_rate"))
    return x + 1j * y, x_rate + 1j * y_rate


def mass_centre_motion(response: Response, place: str, mass: RigidMass) -> tuple[ComplexArray, ComplexArray]:
    """x + i y [m] of the centre of mass at the samples, and its rate; first order in tilts and without eccentricity times tilt."""
    z, rate = centre_motion(response, place)
    turning = complex(*mass.centre[:2]) * np.exp(1j * response.values[f"{place}.angle"])
    p, p_rate = z + turning, rate + 1j * response.values[f"{place}.speed"] * turning
    if mass.centre[2] != 0.0:
        tilt, tilt_rate = (response.values[f"{place}.theta{end}"] - 1j * response.values[f"{place}.psi{end}"] for end in ("", "_rate"))
        p, p_rate = p + mass.centre[2] * tilt, p_rate + mass.centre[2] * tilt_rate
    return p, p_rate


def spin_ratios(scene: Scene) -> dict[str, float]:
    """Forward speed of each spin coordinate over the speed of the reference shaft, prescribed ones included."""
    network = scene.network()
    ratios = {body.name: body.sense * body.ratio for body in network.bodies if not body.lateral}
    return ratios | {item.name: item.sense * item.ratio for item in network.motions if item.name != "ground"}


def reference_shaft(scene: Scene) -> str:
    """The place whose speed the ratios are counted from: that of the motor, or the first one."""
    ratios = spin_ratios(scene)
    return next((name for name, ratio in ratios.items() if abs(abs(ratio) - 1.0) < 1e-9), next(iter(ratios)))
