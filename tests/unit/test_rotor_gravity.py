"""Weight of rotors, rings, housings and shafts, against statics and the pendulum."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.special import ellipk

import hdrive_mbs as hm
from hdrive_mbs.analysis.whirl.rotor_point import rotor_point
from tests.unit.rotor_pieces import (
    DISC,
    EARTH,
    STEEL,
    E,
    bearing,
    line,
    section,
)


def test_bearings_carry_the_weight_of_everything_that_hangs_on_them() -> None:
    housing = hm.Housing.isotropic(mass=2.5, stiffness=6e6)
    law = hm.LinearBearing.isotropic(radial=1e7, damping=0.0)
    ring = {"mass": 0.3, "polar_inertia": 3e-4, "transverse_inertia": 2e-4}
    shaft = section(0.25, density=STEEL, elements=3.0)
    parts = {
        "a": hm.Bearing(law=law, housing=housing, **ring), "s": shaft, "d": DISC, "t": shaft, "b": hm.Bearing(law=law, **ring),
        "u": section(0.1, density=STEEL), "arm": hm.RigidSection(length=0.05), "e": DISC, "gravity": hm.Gravity(),
    }  # fmt: skip
    scene = line("heavy", parts, ("a", "s", "d", "t", "b", "u", "arm", "e"))
    point = rotor_point(scene, 0.0)
    network = scene.network()
    at = network.moment(0.0, point.angles, point.speeds, point.states)
    channels = {channel.name: channel for channel in network.channels}
    a, b = (float(channels[f"{name}.force_y"].read(at)) for name in "ab")
    per_length = STEEL * math.pi / 4.0 * 0.03**2
    weight = EARTH * (8.0 + 8.0 + 0.3 + 0.3 + per_length * 0.6)
    assert a + b == pytest.approx(-weight, rel=1e-9)
    # moments about a
    moment = EARTH * (8.0 * 0.25 + 8.0 * 0.65 + 0.3 * 0.5 + per_length * 0.6 * 0.3)
    assert b == pytest.approx(-moment / 0.5, rel=1e-9)
    # the foundation of a carries the housing too
    assert point.angles["a.housing.y"] == pytest.approx((a - 2.5 * EARTH) / 6e6, rel=1e-9)


@pytest.mark.parametrize("elements", [1.0, 4.0])
def test_a_shaft_sags_by_five_w_l4_over_384_e_i(elements: float) -> None:
    # on springs k at both ends w L/(2 k) more; consistent weights make the stations exact with any number of elements
    L, d, k = 1.2, 0.03, 1e7
    half = section(L / 2.0, density=STEEL, elements=elements)
    parts = {"a": bearing(k), "s": half, "t": half, "b": bearing(k), "gravity": hm.Gravity()}
    point = rotor_point(line("sagging", parts, ("a", "s", "t", "b")), 0.0)
    per_length = STEEL * math.pi / 4.0 * d**2 * EARTH
    sag = 5.0 * per_length * L**4 / (384.0 * E * math.pi * d**4 / 64.0) + per_length * L / (2.0 * k)
    assert point.angles["s.b.y"] == pytest.approx(-sag, rel=1e-8)
    assert abs(point.angles["s.b.psi"]) < 1e-9 * sag
    # at the ends the slope of the deflection, w L^3/24 E I: downwards behind a, and psi about x is minus dy/dz
    assert point.angles["a.psi"] == pytest.approx(per_length * L**3 / (24.0 * E * math.pi * d**4 / 64.0), rel=1e-8)


def drooping(kind: str) -> hm.Scene:
    """A mass at the end of an arm in a bearing that resists tilt, as free rotor, as prescribed rotor and as ring."""
    arm, held = hm.RigidSection(length=0.2), bearing(1e6, tilt=2e3)
    parts: dict[str, hm.Component] = {"b": held, "arm": arm, "gravity": hm.Gravity()}
    if kind == "ring":
        parts["m"] = bearing(0.0, mass=8.0)
        return line(kind, parts, ("b", "arm", "m"))
    parts["m"] = DISC
    if kind == "free":
        return line(kind, parts, ("b", "arm", "m"))
    parts["motor"] = hm.Motor(inertia=0.1, characteristic=hm.IdealSpeedMotor(motion=lambda time: 0.0 * time))
    return line(kind, parts, ("motor", "b", "arm", "m"))


@pytest.mark.parametrize("kind", ["free", "prescribed", "ring"])
def test_an_overhung_mass_droops(kind: str) -> None:
    # psi = m g a/k_tilt at the bearing (positive about x: +z end down), y = -m g/k; whatever carries the mass
    scene = drooping(kind)
    point = rotor_point(scene, 0.0)
    network = scene.network()
    channels = {channel.name: channel for channel in network.channels}
    at = network.moment(0.0, point.angles, point.speeds, point.states)
    droop = 8.0 * EARTH * 0.2 / 2e3
    assert float(channels["b.psi"].read(at)) == pytest.approx(droop, rel=1e-9)
    assert float(channels["b.y"].read(at)) == pytest.approx(-8.0 * EARTH / 1e6, rel=1e-7)
    assert float(channels["m.y"].read(at)) == pytest.approx(-8.0 * EARTH / 1e6 - 0.2 * droop, rel=1e-9)


def test_three_ways_to_carry_a_mass_fall_alike() -> None:
    # let go from straight: rotor, prescribed rotor and ring have the same mass, lever and weight (Jt of the ring 8e-3)
    histories = []
    for kind in ("free", "prescribed", "ring"):
        scene = drooping(kind)
        if kind != "ring":
            scene = scene.replacing(m=DISC.replacing(transverse_inertia=8e-3, polar_inertia=8e-3))
        response = hm.simulate(scene, 0.05, solver=hm.Trapezoidal(step=2e-5))
        histories.append(response.values["m.y"])
    np.testing.assert_allclose(histories[1], histories[2], rtol=0.0, atol=1e-9 * np.max(np.abs(histories[2])))
    # the rigid body keeps second orders of its tilt, 0.015 rad
    np.testing.assert_allclose(histories[0], histories[2], rtol=0.0, atol=0.015**2 * np.max(np.abs(histories[2])))
    assert np.min(histories[0]) < -2e-3


def test_an_eccentric_rotor_swings_as_a_pendulum_of_any_amplitude() -> None:
    # T = 4 K(sin^2(a/2)) sqrt(J/(m g e)), J = Jp + m e^2; the bearing gives way by m g/k = 8e-7 m, of J/(m e) = 0.51 m
    e, k, start = 0.01, 1e8, 2.0
    rotor = DISC.replacing(eccentricity=e, angle=-math.pi / 2.0)
    parts = {"d": rotor, "b": bearing(k, damping=2e3, axial=1e6, tilt=1e6), "gravity": hm.Gravity()}
    period = 4.0 * float(ellipk(math.sin(start / 2.0) ** 2)) * math.sqrt((0.04 + 8.0 * e**2) / (8.0 * EARTH * e))
    solver = hm.DormandPrince(relative_tolerance=1e-9, absolute_tolerance=1e-11)
    initial = {"d.angle": start, "d.y": -8.0 * EARTH / k}
    response = hm.simulate(line("swinging", parts, ("b", "d")), 0.6 * period, solver=solver, initial=initial)
    speed, times = response.values["d.speed"], response.times
    inside = times > 0.4 * period
    back = float(np.interp(0.0, speed[inside], times[inside]))
    assert back == pytest.approx(0.5 * period, rel=8.0 * EARTH / k / 0.51)
    assert response["d.angle"].at(back) == pytest.approx(-start, abs=1e-6)


def test_gravity_may_point_anywhere() -> None:
    parts = {"d": DISC, "b": bearing(1e6, axial=2e6), "gravity": hm.Gravity(x=3.0, y=0.0, z=-4.0)}
    point = rotor_point(line("tilted", parts, ("b", "d")), 0.0)
    assert point.angles["d.x"] == pytest.approx(8.0 * 3.0 / 1e6, rel=1e-9)
    assert point.angles["d.z"] == pytest.approx(-8.0 * 4.0 / 2e6, rel=1e-9)
    assert point.angles["d.y"] == 0.0
