"""Speeds, ratios and senses of rotation from the numbers of teeth (Willis)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from hdrive_mbs.errors import ParameterError, unknown_place

Mesh = tuple[str, int, str, int]
"""Two wheels in mesh: name and teeth of the flexible one, name and teeth of the rigid one."""

GENERATOR = "wave_generator"


def check_assembly(name: str, flexible: int, rigid: int, waves: int, direction: int) -> None:
    """Raise ParameterError unless the teeth can mesh in every wave at once.

    The rigid wheel around an outward flexible one has more teeth, the one inside an inward flexible
    one fewer, and in each of the U waves the same teeth must come to lie opposite each other, so the
    difference is a multiple of U.
    """
    difference = direction * (rigid - flexible)
    place = "around" if direction > 0 else "inside"
    if difference <= 0:
        raise ParameterError(
            f"{name}: the rigid wheel {place} the flexible one has {rigid} teeth and the flexible one {flexible}; it needs "
            f"{'more' if direction > 0 else 'fewer'}, usually {flexible + direction * waves}."
        )
    if difference % waves:
        raise ParameterError(
            f"{name}: the numbers of teeth {flexible} (flexible) and {rigid} (rigid) do not assemble: they differ by {difference}, which "
            f"must be a multiple of the number of waves, {waves}. Take {flexible + direction * waves} teeth for the rigid wheel."
        )


def speeds(meshes: Sequence[Mesh], *, driver: str, fixed: str) -> dict[str, float]:
    """Speed of every member per speed of the driver, one member held.

    Seen from the wave generator, teeth pass a mesh in equal numbers on both wheels:

        z_flexible (w_flexible - w_generator) = z_rigid (w_rigid - w_generator)
    """
    members = list(dict.fromkeys((GENERATOR, *(name for mesh in meshes for name in (mesh[0], mesh[2])))))
    for role, member in (("driver", driver), ("fixed member", fixed)):
        if member not in members:
            raise unknown_place(role, member, members, "This gear")
    if driver == fixed:
        raise ParameterError(f"{driver!r} cannot both drive and be held.")
    index = {member: k for k, member in enumerate(members)}
    rows = []
    for flexible, z_flexible, rigid, z_rigid in meshes:
        row = np.zeros(len(members))
        row[index[flexible]] = z_flexible
        row[index[rigid]] = -z_rigid
        row[index[GENERATOR]] = z_rigid - z_flexible
        rows.append(row)
    for member in (fixed, driver):
        row = np.zeros(len(members))
        row[index[member]] = 1.0
        rows.append(row)
    right = np.zeros(len(rows))
    right[-1] = 1.0
    solution = np.linalg.solve(np.array(rows), right)
    found = {member: float(solution[k]) if abs(solution[k]) > 1e-12 else 0.0 for member, k in index.items()}
    return found | {fixed: 0.0, driver: 1.0}


def ratio(found: Mapping[str, float], driven: str) -> float:
    """Driver speed over driven speed, negative when they turn against each other."""
    if driven not in found:
        raise unknown_place("driven member", driven, found, "This gear")
    if found[driven] == 0.0:
        raise ParameterError(f"{driven!r} stands still in this arrangement: it has no ratio. Hold or drive another member.")
    return 1.0 / found[driven]
