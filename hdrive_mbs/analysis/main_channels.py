"""Which channels of a run are shown when nobody says which."""

from __future__ import annotations

from collections.abc import Collection

from hdrive_mbs.components.bearing import Bearing
from hdrive_mbs.components.drive_torque import DriveTorque
from hdrive_mbs.components.harmonic_drive import HarmonicDrive
from hdrive_mbs.components.load import Load
from hdrive_mbs.components.motor import Motor
from hdrive_mbs.components.rotor import Rotor
from hdrive_mbs.scene import Scene

MOST_LINES = 4
"""Channels of one kind that are shown."""


def main_channels(scene: Scene | None, channels: Collection[str]) -> list[str]:
    """Speeds of motors and machines, torques of motors, gears and machines; of a rotor line also how far its rotors are
    from the axis and the forces of its bearings; else all speeds and torques."""
    if scene is None:
        return [name for name in channels if name.endswith((".speed", ".torque"))][:8]
    parts = scene.parts
    ends = [name for kind in (Motor, Load) for name, part in parts.items() if isinstance(part, kind)]
    gears = [name for name, part in parts.items() if isinstance(part, HarmonicDrive)]
    wanted = [f"{name}.speed" for name in ends] + [f"{name}.torque" for name in [*gears, *ends]]
    found = [name for name in wanted if name in channels]
    rotors = [name for name, part in parts.items() if isinstance(part, Rotor) and f"{name}.radial" in channels]
    if rotors:
        found = found or [f"{rotors[0]}.speed", *(f"{name}.torque" for name, part in parts.items() if isinstance(part, DriveTorque))]
        bearings = [name for name, part in parts.items() if isinstance(part, Bearing)]
        forces = [f"{name}.force_{axis}" for axis in "yx" for name in bearings]
        return found + [f"{name}.radial" for name in rotors][:MOST_LINES] + [name for name in forces if name in channels][:MOST_LINES]
    if any(name.endswith(".speed") for name in found):
        return found
    speeds = [name for name in channels if name.endswith(".speed")][:6]
    return speeds + [name for name in channels if name.endswith(".torque")][:6]
