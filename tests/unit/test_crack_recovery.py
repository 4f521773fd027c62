"""A crack that is put into the shaft of a small line under weight is found there, with when it opens.

A fan on two bearings with housings runs up through half of its critical speed and the speed itself.  The records are made by
the multibody engine with a step of its own, parameters off by their tolerance, and noise; the search runs compiled lines.
"""

from __future__ import annotations

import math

import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.diagnose import diagnose
from hdrive_mbs.diagnosis.result import Diagnosis
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.records.record import Record
from tests.unit.engine_records import STEP, disturbed, engine_record

DURATION, SPEED, NOISE = 2.0, 300.0, 5e-7
TRIED: tuple[type[Effect], ...] = (hm.ArcCrack, hm.BreathingCrack, hm.RotorUnbalance, hm.ShaftBow, hm.BearingCrossCoupling)
KNOWLEDGE = {
    "mass of the disc": (("disc.mass",), 0.02),
    "modulus of the shaft": (("first.youngs_modulus", "middle.youngs_modulus", "last.youngs_modulus"), 0.03),
    "eccentricity": (("disc.eccentricity",), 0.1),
}
SIDES = {"right": hm.degrees(45), "left": hm.degrees(135)}
PROBES = [f"{at}_{side}" for at in ("hub", "disc") for side in SIDES]
DISTURBED = {"mass of the disc": 0.7, "modulus of the shaft": -0.6, "eccentricity": 0.9}
CRACK = hm.ArcCrack(compliance=3e-6, position=0.4, angle=0.8, steepness=2.5, opens_at=-0.5)


def scene() -> hm.Scene:
    law = hm.LinearBearing.isotropic(radial=1e7, damping=3e3, tilt=500.0, axial=1e7, axial_damping=1e3)
    housing = hm.Housing.isotropic(mass=8.0, stiffness=2e7, damping=6e3)
    bearing = hm.Bearing(law=law, mass=1.0, polar_inertia=1e-3, transverse_inertia=8e-4, housing=housing)

    def section(length: float) -> hm.ShaftSection:
        return hm.ShaftSection(length=length, diameter=hm.mm(25), youngs_modulus=2.06e11, shear_modulus=7.9e10, density=7850.0)

    ramp = hm.IdealSpeedMotor(motion=hm.SpeedRamp(start=0.0, end=SPEED, duration=DURATION))
    return hm.Scene(
        name="cracked fan",
        parts={
            "drive": hm.DriveTorque(characteristic=ramp),
            "de": bearing,
            "first": section(0.12),
            "hub": hm.Rotor(mass=1.5, polar_inertia=1.5e-3, transverse_inertia=1.2e-3),
            "middle": section(0.16),
            "disc": hm.Rotor(mass=10.0, polar_inertia=0.06, transverse_inertia=0.035, eccentricity=1e-5),
            "last": section(0.14),
            "nde": bearing,
            "gravity": hm.Gravity(),
            **{f"{at}_{side}": hm.Probe(at=at, angle=angle) for at in ("hub", "disc") for side, angle in SIDES.items()},
        },
        connections=[("drive", "de", "first", "hub", "middle", "disc", "last", "nde")],
    )


def bench() -> hm.Bench:
    return hm.Bench(
        scene=scene(),
        knowledge={name: hm.Uncertain(paths=paths, sigma=sigma) for name, (paths, sigma) in KNOWLEDGE.items()},
        measured={name: hm.Measured(channel=name, noise=NOISE) for name in PROBES},
        settled=False,  # the records are of a model that starts undeflected
    )


def record(*effects: tuple[Effect, str]) -> Record:
    plant = disturbed(scene(), KNOWLEDGE, DISTURBED)
    return engine_record(plant, effects, PROBES, duration=DURATION, noise=NOISE, seed=5)


def found_in(*effects: tuple[Effect, str]) -> Diagnosis:
    return diagnose(bench(), record(*effects), candidates=TRIED)


@pytest.mark.slow
def test_a_crack_is_found_with_its_place_and_when_it_opens() -> None:
    """Of three sections the right one; its values within 3 standard deviations, of which the 95 % interval holds 1.96."""
    found = found_in((CRACK, "middle"))
    assert found.verdict == "effect"
    [cause] = found.causes
    assert (cause.effect, cause.at, cause.law) == ("crack", "middle", "ArcCrack")
    assert found.indistinguishable == ()
    values = {item.name.rpartition(".")[2]: item for item in cause.parameters}
    for name in ("compliance", "position", "angle", "steepness", "opens_at"):
        item, truth = values[name], getattr(CRACK, name)
        assert item.identifiable, name
        assert abs(truth - item.value) <= 3.0 / 1.96 * 0.5 * (item.high - item.low), name
    # mean square of n samples of noise, with three standard deviations of it, sqrt(2/n); a quarter of all is held out
    samples = 0.25 * len(PROBES) * DURATION / STEP
    assert found.gap.effect.value**2 == pytest.approx(1.0, abs=3.0 * math.sqrt(2.0 / samples))
    assert found.gap.refit.value > 2.0


@pytest.mark.slow
def test_nothing_is_found_where_no_crack_is() -> None:
    found = found_in()
    assert (found.verdict, found.causes) == ("none", ())
