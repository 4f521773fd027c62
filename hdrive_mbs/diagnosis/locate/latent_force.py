"""The course of an unknown force, for pictures: against speed, torque or angle it shows a friction curve or a ripple."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.locate.motion import Motion
from hdrive_mbs.diagnosis.locate.response import Response
from hdrive_mbs.diagnosis.locate.sources import Source
from hdrive_mbs.diagnosis.locate.spectra import Spectra, joined
from hdrive_mbs.diagnosis.turning import reference_shaft

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

ACROSS = ("x", "y", "psi", "theta")
"""Ways of forces and couples across an axis."""


@dataclass(frozen=True, kw_only=True, eq=False)
class LatentForce:
    """An unknown force at a place in one trial, or the error of a sensor.

    at, way : place and direction;  record : name of the trial;  unit : of the force
    times : s;  force : generalized force that the model lacks, or reading minus model for a sensor
    angle, speed : of the place, summed along the force: those of a body, or how far the ends of a connection are turned against
        each other, in the sense in which the force does work; of a force across an axis those of the shaft
    torque : of the connection in the model, nan for other places
    """

    at: str
    way: str
    record: str
    unit: str
    times: FloatArray
    force: FloatArray
    angle: FloatArray
    speed: FloatArray
    torque: FloatArray


@dataclass(frozen=True, eq=False)
class TurnedForce:
    """A force across the axis over the angle of the shaft, in one record.

    angle : rad, shape (n,);  force : F_x + i F_y, N, shape (n,)
    """

    angle: FloatArray
    force: ComplexArray


def most_probable(transfer: ComplexArray, residuals: ComplexArray, strength: FloatArray) -> ComplexArray:
    """F = (H^H H + 1/s^2)^-1 H^H Y in every window and bin, shape (windows, bins, d).

    residuals : Y, shape (windows, bins, columns);  strength : s^2, (windows, bins), 0 where there is no force
    """
    back = np.swapaxes(transfer.conj(), 2, 3)
    system = strength[..., None, None] * (back @ transfer) + np.eye(transfer.shape[3])
    return np.asarray(np.linalg.solve(system, strength[..., None, None] * (back @ residuals[..., None]))[..., 0])


def by_direction(source: Source, force: ComplexArray) -> ComplexArray:
    """Spectra of a force in each of its directions: one that turns with the shaft along x is -i times that along y."""
    if not source.rotating:
        return force
    return np.stack([force, -1j * force], axis=-1).reshape(*force.shape[:-1], -1)


def latent_force(
    motion: Motion, spectra: Spectra, response: Response, name: str, residuals: ComplexArray, strength: FloatArray
) -> list[LatentForce]:
    """The most probable forces of every window and band, put together; see ``most_probable``.

    name : of the source
    """
    source, trial = response.sources[name], motion.trial
    at = source.at
    found = by_direction(source, most_probable(response.of[name], residuals, strength))
    nothing = np.full(trial.samples, np.nan)
    known = {channel.name for channel in motion.network.channels}
    made = []
    for k, way in enumerate(source.along or source.columns or ("error",)):
        factors = source.along.get(way, {})
        moved = [
            sum((f * motion.values[f"{kind}:{n}"] for n, f in factors.items()), np.zeros(trial.samples)) for kind in ("angle", "speed")
        ]
        if way in ACROSS:
            speed, angle = reference_shaft(motion)
            moved = [angle, speed]
        if not factors:
            moved = [motion.reading(at) if at in known else motion.columns[way if source.columns else at], nothing]
        torque = motion.reading(f"{at}.torque") if way == "torsion" and f"{at}.torque" in known else nothing
        made.append(
            LatentForce(
                at=at, way=way, record=trial.name, unit=source.unit, times=trial.times,
                force=joined(found[..., k], spectra.window, trial.samples), angle=moved[0], speed=moved[1], torque=torque,
            )
        )  # fmt: skip
    return made
