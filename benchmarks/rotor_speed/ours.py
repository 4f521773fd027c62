"""This package's side: the same rotor as a scene, its Campbell diagram and its prescribed run-up on Exudyn."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np

import hdrive_mbs as hm
from benchmarks.rotor_speed import rotor
from benchmarks.rotor_speed.accuracy import frequency_errors
from benchmarks.rotor_speed.beam import FloatArray
from benchmarks.rotor_speed.run_up import ACCELERATION, RunUp

Made = TypeVar("Made")


def timed(work: Callable[[], Made]) -> tuple[Made, float]:
    """What the work gives, and its CPU time [s]."""
    started = time.process_time()
    made = work()
    return made, time.process_time() - started


def line(elements: int, *, damping: float = 0.0, driven: bool = False) -> hm.Scene:
    """Friswell's rotor; ``driven``: the first disc unbalanced and turned by the ramp, so that its angle is exactly the ramp's."""
    rotor.disc_stations(elements)  # refuses a number that puts no station at the discs
    sections = {
        f"section_{k}": hm.ShaftSection(
            length=rotor.LENGTH / 3.0,
            diameter=rotor.DIAMETER,
            youngs_modulus=rotor.YOUNGS_MODULUS,
            shear_modulus=rotor.SHEAR_MODULUS,
            density=rotor.DENSITY,
            elements=elements // 3,
            shear=True,
        )
        for k in (1, 2, 3)
    }
    law = hm.LinearBearing.isotropic(radial=rotor.BEARING_STIFFNESS, damping=damping)
    parts: dict[str, hm.Component] = {"bearing_1": hm.Bearing(law=law), "bearing_2": hm.Bearing(law=law), **sections}
    for k, disc in enumerate(rotor.DISCS, start=1):
        eccentricity = rotor.UNBALANCE / disc.mass if driven and k == 1 else 0.0
        parts[f"disc_{k}"] = hm.Rotor(
            mass=disc.mass, polar_inertia=disc.polar_inertia, transverse_inertia=disc.transverse_inertia, eccentricity=eccentricity
        )
    chains = [("bearing_1", "section_1", "disc_1", "section_2", "disc_2", "section_3", "bearing_2")]
    if driven:
        ramp = hm.SpeedRamp(start=0.0, end=rotor.HIGHEST_SPEED, duration=rotor.RAMP_DURATION)
        parts["motor"] = hm.Motor(inertia=1e-3, characteristic=hm.IdealSpeedMotor(motion=ramp))
        chains.append(("motor", "disc_1"))
    return hm.Scene(name=f"Friswell 5.9.1, {elements} elements", parts=parts, connections=chains)


def campbells(elements: tuple[int, ...], speeds: FloatArray, reference: FloatArray, repeats: int) -> list[dict[str, Any]]:
    """hm.campbell with enough modes for six lateral ones: CPU times, largest error of each frequency, share of wrong whirl."""
    rows = []
    for number in elements:
        calls, builds = [], []
        for _ in range(repeats + 1):
            scene, build = timed(lambda number=number: _built(line(number)))
            found, seconds = timed(lambda scene=scene: hm.campbell(scene, speeds, count=7, progress=False))
            calls.append(seconds)
            builds.append(build)
        kept = [k for k, whirl in enumerate(found.whirl) if whirl in ("forward", "backward")]
        frequencies = found.frequencies[:, kept][:, :6]
        whirl = np.array([found.whirl[k] for k in kept][:6])
        order = np.argsort(frequencies[1:], axis=1)
        expected = np.where(reference[1:, :6] > 0.0, "forward", "backward")
        rows.append(
            {
                "elements": number,
                "build_seconds": builds[1:],
                "first_seconds": calls[0],
                "seconds": calls[1:],
                "errors": np.max(frequency_errors(frequencies, reference), axis=0).tolist(),
                "wrong_whirl": float(np.mean(whirl[order] != expected)),
            }
        )
    return rows


def _built(scene: hm.Scene) -> hm.Scene:
    scene.network()
    return scene


def run_ups(steps: tuple[int, ...], reference: RunUp, repeats: int) -> list[dict[str, Any]]:
    """The ramp by Exudyn's trapezoidal rule: CPU time of the solver and of the whole call, and the error."""
    rows = []
    for number in steps:
        solver = hm.Trapezoidal(step=rotor.RAMP_DURATION / number, newton_tolerance=1e-5)
        solving, whole = [], []
        for _ in range(repeats + 1):
            scene = line(rotor.RAMP_ELEMENTS, damping=rotor.BEARING_DAMPING, driven=True)
            # the ramp turns at once with its acceleration; the rest of the shaft starts at rest like the ramp
            response, seconds = timed(
                lambda scene=scene, solver=solver: hm.simulate(scene, rotor.RAMP_DURATION, solver=solver, progress=False)
            )
            solving.append(response.seconds)
            whole.append(seconds)
        moved = np.array([[response.values[f"disc_{k}.{key}"] for key in "xy"] for k in (1, 2)])
        rows.append(
            {
                "steps": number,
                "coordinates": len(scene.network().bodies),
                "first_seconds": whole[0],
                "solver_seconds": solving[1:],
                "seconds": whole[1:],
                "error": reference.error(response.times, moved),
                "acceleration": ACCELERATION,
            }
        )
    return rows
