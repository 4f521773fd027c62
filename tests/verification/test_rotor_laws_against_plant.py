"""Changed laws of the rotor bench against the plant of the withheld cases, whose equations, laws and integrator are its own.

The record is the one with two blows of a hammer at standstill; differences are in units of the probes' noise.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.analysis.whirl.rotor_point import rotor_point
from hdrive_mbs.effects.effect import Effect
from models import rotor_bench

pytest.importorskip("numba", reason="the plant of the withheld cases needs numba")

from benchmarks.withheld.plant.rotor_line.machine import NOMINAL
from benchmarks.withheld.plant.rotor_line.planted import Planted
from benchmarks.withheld.plant.rotor_line.records import PROBES, run, static_deflection
from hdrive_mbs.compiled.line import CompiledLine

NOISE = 2.5e-7
TOLERANCE = 1e-6
"""Of the plant's steps, in units of the sensors' resolution; with its usual 2e-4 hits on a wall move it by 0.15 noise units."""
CHANNELS = {"r1_x": "rotor_1.x", "r1_y": "rotor_1.y", "r2_x": "rotor_2.x", "r2_y": "rotor_2.y"}
STIFFNESS, LOAD, PENETRATION = 6.5e7, 800.0, 10.0 / 9.0 * 800.0 / 6.5e7
"""Of a bearing [N/m]; a load and the approach of a roller contact that has this stiffness there."""
CRACK = {"compliance": 3e-7, "cross_share": 1.0 / 3.0, "position": 0.8}

CASES: dict[str, tuple[str, int, tuple[float, ...], Effect, str]] = {
    # field of the plant's causes, first place in it, values; effect, place
    "gap": ("bearing", 0, (1, 5e-6, 0.02, 0.3), hm.BearingClearance(gap=5e-6, film_stiffness=0.02, film_damping=0.3), "bearing_1"),
    "gap with rollers": (
        "bearing",
        0,
        (2, 5e-6, 0.0, 0.3, LOAD / PENETRATION ** (10.0 / 9.0), 0.7 * 2500.0 / LOAD),
        hm.HertzianClearance(gap=5e-6, film_damping=0.3, reference_force=LOAD),
        "bearing_1",
    ),
    "cubic": ("bearing", 6, (3, 2e-5), hm.BearingCubicStiffness(stiffness=STIFFNESS / 4e-10), "bearing_2"),
    "cubic by axis": ("bearing", 6, (4, 2e-5), hm.BearingCubicStiffness(stiffness=STIFFNESS / 4e-10, by_axis=True), "bearing_2"),
    "sinh": ("bearing", 6, (5, 2e-5), hm.BearingHardening(rate=5e4), "bearing_2"),
    "cross": ("cross", 0, (1, 5e6, 0.2, 1e-4), hm.FadingCrossCoupling(stiffness=5e6, asymmetry=0.2, fading=1e8), "bearing_1"),
    "lifts": ("support", 0, (1, -8e-6, 0.0, 0.5), hm.Looseness(share=0.5, lift_off=-8e-6), "bearing_1"),
    "lifts to the bolt": ("support", 0, (3, -8e-6, -2e-6, 0.5), hm.Looseness(share=0.5, lift_off=-8e-6, play=6e-6), "bearing_1"),
    "sideways": ("support", 0, (2, 0.0, 2e-6, 0.5), hm.LooseFit(share=0.5, half_play=2e-6), "bearing_1"),
    "square damping": ("quadratic", 1, (4e5,), hm.SupportSquareDamping(coefficient=4e5, by_axis=True), "bearing_2"),
    # the plant's sliding force depends on where the housing stands, over a way that is longer here than all of them
    "sticking foot": (
        "friction",
        3,
        (2e7, 20.0, 1e3),
        hm.SupportPresliding(coulomb=20.0, presliding=20.0 / 2e7, by_axis=True, fastest_rate=1e9),
        "bearing_2",
    ),
    "hidden": (
        "hidden",
        0,
        (1, 0, 2.0, 2.0 * 400.0**2, 2.0 * 500.0**2, 2.0 * 0.02 * 2.0 * 400.0, 0.4),
        hm.HiddenModeSupport(mass=2.0, natural_frequency=400.0, ratio=1.25, damping_ratio=0.02, angle=0.4),
        "bearing_1",
    ),
    # the plant counts the angle to the side that is pressed when the crack is shut
    "crack by weight": (
        "crack",
        0,
        (2, 0, 0.8, 3e-7, 1e-7, 0.3, 2.0),
        hm.BreathingCrack(**CRACK, angle=0.3 - math.pi, steepness=2.0),
        "section_1",
    ),
    "steep crack by weight": (
        "crack",
        0,
        (2, 0, 0.8, 3e-7, 1e-7, 0.3, 4.0),
        hm.SteepCrack(**CRACK, angle=0.3 - math.pi, steepness=4.0),
        "section_1",
    ),
    "keyway": ("crack", 0, (0, 0, 0.8, 3e-7, 1e-7, 0.3, 1.0), hm.Keyway(**CRACK, angle=0.3), "section_1"),
    "crack by moment": (
        "crack",
        0,
        (1, 0, 0.8, 3e-7, 1e-7, 0.3, 20.0),
        hm.MomentCrack(**CRACK, angle=0.3 - math.pi, closing_moment=20.0),
        "section_1",
    ),
    "rub": (
        "rub",
        0,
        (1, 1.2e-4, -2e-6, -1.8e-5, 3e6, 200.0, 0.1, 0.05, 0.06, 0.0, 1),
        hm.Rub(gap=1.2e-4, centre_x=-2e-6, centre_y=-1.8e-5, stiffness=3e6, damping=200.0, friction=0.1, radius=0.06),
        "rotor_1",
    ),
    # the plant's friction that falls with the sliding speed is kept out by its last number
    "rub with Hertz's contact": (
        "rub",
        0,
        (2, 1.2e-4, -2e-6, -1.8e-5, 3e6 / math.sqrt(1e-5), 0.8, 0.1, 0.05, 0.06, 1.0, 1),
        hm.HertzianRub(gap=1.2e-4, centre_x=-2e-6, centre_y=-1.8e-5, stiffness=3e6, loss=0.8, friction=0.1, radius=0.06),
        "rotor_1",
    ),
    "rub on a coat": (
        "rub",
        0,
        (3, 1.2e-4, -2e-6, -1.8e-5, 3e6, 200.0, 0.1, 0.05, 0.06, 4e-5, 1),
        hm.CoatedRub(
            gap=1.2e-4, centre_x=-2e-6, centre_y=-1.8e-5, stiffness=3e6, damping=200.0, coat_depth=4e-5, friction=0.1, radius=0.06
        ),
        "rotor_1",
    ),
}


def measured(plant: Callable[[Planted], None], scene: hm.Scene) -> float:
    """Largest rms difference of a probe between plant and scene, over its noise."""
    bench = Planted(values=dict(NOMINAL))
    plant(bench)
    machine = bench.machine()
    made = run(machine, bench.causes, "bump", tolerance=TOLERANCE, rest=static_deflection(machine, bench.causes))
    scene = scene.replacing({"gravity.y": -machine.gravity})
    rest = rotor_point(scene.replacing({"drive.characteristic": rotor_bench.NO_TORQUE}), 0.0).angles
    ours = CompiledLine(scene.network(), list(CHANNELS.values())).run(
        len(made.time), rotor_bench.SAMPLE_TIME, step=rotor_bench.SAMPLE_TIME / 64.0, angles=rest
    )
    away = [ours.values[CHANNELS[name]] - made.states[:, column] for name, column in PROBES.items()]
    return max(float(np.sqrt(np.mean(difference**2))) for difference in away) / NOISE


@pytest.mark.parametrize("case", CASES)
def test_effect_moves_the_bench_as_the_plant_does(case: str) -> None:
    field, first, values, effect, at = CASES[case]

    def put(bench: Planted) -> None:
        getattr(bench.causes, field).flat[first : first + len(values)] = values

    bare = rotor_bench.build("bump")
    assert measured(put, bare) > 3.0  # it is there
    assert measured(put, bare.with_effect(effect, at=at)) < 0.02  # what steps of fixed length leave at corners


LOSSES = {
    "viscous": ((1, 1e-5), hm.InternalDamping(time=1e-5)),
    "relaxing": ((2, 1e-5 / 8e-4, 8e-4), hm.RelaxingDamping(time=1e-5, relaxation_time=8e-4)),
}


@pytest.mark.parametrize("law", LOSSES)
def test_internal_damping_moves_the_bench_as_the_plant_does(law: str) -> None:
    """At standstill it is damping alone; the spin is in tests of the threshold and of the poles."""
    row, effect = LOSSES[law]

    def put(bench: Planted) -> None:
        bench.causes.internal[: len(row)] = row

    bare = rotor_bench.build("bump")
    assert measured(put, bare) > 3.0
    assert measured(put, bare.with_effect(effect, at="section_1")) < 0.005
