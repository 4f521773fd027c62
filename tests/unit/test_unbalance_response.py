"""Steady unbalance response: closed forms of a disc in one bearing, and lines against runs of the whole model on Exudyn.

A disc of mass m in a bearing (k_x, k_y, c) at its centre, U = m e exp(i angle), spins with w > 0:

    X = U w^2/(k_x - m w^2 + i c w),   Y = -i U w^2/(k_y - m w^2 + i c w)

Its tilt on the stiffness k_t:  (k_t - (Jt - Jp) w^2) (theta - i psi) = (Jt - Jp) sin(tau) cos(tau) exp(i a) w^2.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.analysis.unbalance import speed_line
from hdrive_mbs.analysis.unbalance.speed_line import SpeedLine
from hdrive_mbs.analysis.unbalance.unbalance_response import UnbalanceResponse
from hdrive_mbs.analysis.unbalance.whirl_orbit import WhirlOrbit, lag
from hdrive_mbs.errors import AnalysisError, ParameterError, PlaceError
from models.two_rotor_line import build

M, E, ANGLE = 2.5, 3e-5, 0.7
JP, JT, TILT, TILT_ANGLE, K_TILT = 0.02, 0.014, 2e-3, -1.1, 4e4
K, C = 1e6, 60.0
W = math.sqrt(K / M)
SPEEDS = np.linspace(0.0, 1500.0, 61)
CLOSED = 1e-9
"""Agreement with closed forms: a few hundred roundings, magnified by 1/(2 zeta) = 26 at the peak."""


def disc(k_x: float = K, k_y: float | None = None, c: float = C, law: Any = None, **rotor: Any) -> hm.Scene:
    rotor = {"eccentricity": E, "angle": ANGLE} | rotor
    stiffness, damping = np.diag([k_x, k_x if k_y is None else k_y, 1e6, K_TILT, K_TILT, 0.0]), np.diag([c, c, 0.0, 0.0, 0.0, 0.0])
    bearing = law or hm.LinearBearing.from_matrices(stiffness=stiffness, damping=damping)
    parts: dict[str, Any] = {
        "rotor": hm.Rotor(mass=M, polar_inertia=JP, transverse_inertia=JT, **rotor),
        "bearing": hm.Bearing(law=bearing),
    }
    return hm.Scene(name="disc", parts=parts, connections=[("rotor", "bearing")])


def closed(w: Any, k: float = K, c: float = C) -> Any:
    return M * E * np.exp(1j * ANGLE) * w**2 / (k - M * w**2 + 1j * c * w)


# -- closed forms ----------------------------------------------------------------------------------
def test_amplitude_and_phase_of_a_disc_follow_the_closed_form() -> None:
    result = hm.unbalance_response(disc(), SPEEDS)
    x = closed(SPEEDS)
    np.testing.assert_allclose(result["rotor"].x, x, rtol=CLOSED, atol=1e-20)
    np.testing.assert_allclose(result["rotor"].y, -1j * x, rtol=CLOSED, atol=1e-20)
    np.testing.assert_allclose(result["rotor"].major, np.abs(x), rtol=CLOSED)
    np.testing.assert_allclose(result["rotor"].phase_lag_x[1:], lag(x[1:]), rtol=CLOSED)
    np.testing.assert_allclose(result.force("bearing").x, (K + 1j * C * SPEEDS) * x, rtol=CLOSED, atol=1e-15)
    assert result.status == "complete"
    assert np.all(result["rotor"].whirl[1:] == 1.0)


def test_lag_of_a_disc_with_its_heavy_side_at_the_mark_goes_from_zero_over_a_quarter_to_half_a_turn() -> None:
    result = hm.unbalance_response(disc(angle=0.0), [0.01 * W, W, 100.0 * W])
    # tan(lag) = c w/(k - m w^2): 2 zeta r/(1 - r^2)
    zeta = C / (2.0 * math.sqrt(K * M))
    assert result["rotor"].phase_lag_x == pytest.approx(
        [math.atan2(0.02 * zeta, 1.0 - 1e-4), math.pi / 2.0, math.atan2(200.0 * zeta, 1.0 - 1e4)], rel=1e-9
    )
    assert result["rotor"].phase_lag_y[1] == pytest.approx(math.pi, rel=1e-9), "y follows a quarter turn behind x"


def test_a_leaning_disc_tilts_as_the_closed_form_says() -> None:
    scene = disc(eccentricity=0.0, tilt=TILT, tilt_angle=TILT_ANGLE)
    result = hm.unbalance_response(scene, SPEEDS)
    moment = (JT - JP) * math.sin(TILT) * math.cos(TILT) * np.exp(1j * TILT_ANGLE) * SPEEDS**2
    # of the body as it leans: polar and transverse moments about its own axis of rotation, of second order in the tilt
    polar = JP + (JT - JP) * math.sin(TILT) ** 2
    transverse = JT + 0.5 * (JP - JT) * math.sin(TILT) ** 2
    tau = moment / (K_TILT - (transverse - polar) * SPEEDS**2)
    one = result["rotor"]
    np.testing.assert_allclose(one.theta, tau, rtol=CLOSED, atol=1e-20)
    np.testing.assert_allclose(one.psi, 1j * tau, rtol=CLOSED, atol=1e-20)
    assert not one.major.any(), "a leaning disc in a bearing at its centre does not move it"


def test_whirl_is_backward_between_the_critical_speeds_of_unlike_planes() -> None:
    k_x, k_y = K, 1.5 * K
    result = hm.unbalance_response(disc(k_x, k_y, c=1e-3), SPEEDS[1:])
    x, y = closed(SPEEDS[1:], k_x, 1e-3), -1j * closed(SPEEDS[1:], k_y, 1e-3)
    np.testing.assert_allclose(result["rotor"].x, x, rtol=CLOSED)
    np.testing.assert_allclose(result["rotor"].y, y, rtol=CLOSED)
    between = (SPEEDS[1:] > math.sqrt(k_x / M)) & (SPEEDS[1:] < math.sqrt(k_y / M))
    assert between.any()
    np.testing.assert_array_equal(result["rotor"].whirl, np.where(between, -1.0, 1.0))
    np.testing.assert_allclose(result["rotor"].backward, np.abs(np.conj(x - 1j * y)) / 2.0, rtol=CLOSED)


def test_an_orbit_has_the_semi_axes_and_the_direction_that_its_points_have() -> None:
    rng = np.random.default_rng(1)
    turn = np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 200_001))
    for x, y in rng.normal(size=(20, 2)) + 1j * rng.normal(size=(20, 2)):
        orbit = WhirlOrbit(np.array(x), np.array(y), np.array(1.0))
        points = np.real(x * turn) + 1j * np.real(y * turn)
        far = int(np.argmax(np.abs(points)))
        # a maximum is flat: 2e5 points miss it by (pi/2e5)^2/2, its direction by pi/2e5 times the ratio of the axes
        assert orbit.major == pytest.approx(np.abs(points).max(), rel=1e-9)
        assert orbit.minor == pytest.approx(np.abs(points).min(), rel=1e-4)
        assert np.exp(2j * orbit.inclination) == pytest.approx(np.exp(2j * np.angle(points[far])), abs=1e-3)
        area = 0.5 * np.sum(np.imag(np.conj(points[:-1]) * points[1:]))
        assert orbit.whirl == np.sign(area)


# -- peaks -----------------------------------------------------------------------------------------
def half_power(zeta: float) -> tuple[float, float, float]:
    """Peak amplitude over e, its speed over W and the half-power width over W.

    |X|/e = r^2/sqrt((1 - r^2)^2 + 4 zeta^2 r^2) = 1/sqrt((s - 1)^2 + 4 zeta^2 s) with s = 1/r^2: the peak is at
    s = 1 - 2 zeta^2, and half its power where (s - 1)^2 + 4 zeta^2 s = 8 zeta^2 (1 - zeta^2).
    """
    half = math.sqrt((1.0 - 2.0 * zeta**2) ** 2 - 1.0 + 8.0 * zeta**2 * (1.0 - zeta**2))
    ends = [1.0 / math.sqrt(1.0 - 2.0 * zeta**2 + sign * half) for sign in (1.0, -1.0)]
    return 1.0 / (2.0 * zeta * math.sqrt(1.0 - zeta**2)), 1.0 / math.sqrt(1.0 - 2.0 * zeta**2), ends[1] - ends[0]


@pytest.mark.parametrize("zeta", [1e-4, 0.02, 0.2])
def test_a_peak_is_found_between_the_speeds_with_its_height_and_width(zeta: float) -> None:
    # spacing 25 rad/s: the narrowest peak is 0.13 rad/s wide
    result = hm.unbalance_response(disc(c=2.0 * zeta * math.sqrt(K * M)), np.linspace(0.0, 2500.0, 101))
    (peak,) = result.peaks
    height, speed, width = half_power(zeta)
    assert peak.place == "rotor"
    assert peak.speed == pytest.approx(W * speed, rel=1e-6)
    assert peak.amplitude == pytest.approx(E * height, rel=1e-4 if zeta < 1e-3 else 1e-8)
    assert peak.width == pytest.approx(W * width, rel=1e-4 if zeta < 1e-3 else 1e-7)
    assert peak.quality == pytest.approx(peak.speed / peak.width)


def test_a_line_without_damping_has_no_amplitude_at_its_critical_speed_and_says_so() -> None:
    speed = math.sqrt(1.25e6 / M)
    assert 1.25e6 - M * speed**2 == pytest.approx(0.0, abs=1e-9)
    result = hm.unbalance_response(disc(1.25e6, c=0.0), [500.0, speed, 900.0])
    assert np.isnan(result["rotor"].x[1])
    assert np.isfinite(result["rotor"].x[[0, 2]]).all()
    assert "no steady amplitude at 707.107 rad/s: an undamped critical speed" in result.status
    (peak,) = result.peaks
    assert peak.amplitude == math.inf
    assert peak.speed == pytest.approx(speed, rel=1e-6)


# -- against time integration ------------------------------------------------------------------------
def unlike_line(**changes: Any) -> hm.Scene:
    """The two-rotor line without drive torque, unlike foundations, static and dynamic unbalance at odd angles; small, as theory has it."""
    scene = build().replacing(
        {
            "drive.characteristic": lambda speed: 0.0 * speed,
            "rotor_1.eccentricity": 2e-6,
            "rotor_1.angle": 0.7,
            "rotor_1.tilt": 5e-5,
            "rotor_1.tilt_angle": -1.1,
            "rotor_2.eccentricity": 3e-6,
            "rotor_2.angle": 2.0,
            "rotor_2.tilt": 2e-5,
            "rotor_2.tilt_angle": 1.9,
            "bearing_a.housing.stiffness_x": 3e6,
        }
    )
    return scene.replacing(changes)


def started_steadily(result: UnbalanceResponse, scene: hm.Scene) -> dict[str, float]:
    """Displacements and rates of all coordinates at t = 0 from the response at its only speed."""
    names = {body.name for body in scene.network().bodies}
    initial: dict[str, float] = {}
    for group, ratio in enumerate(result.frequency_ratios):
        w = ratio * abs(float(result.speeds[0]))
        for place in result.places:
            for key in ("x", "y", "psi", "theta"):
                if f"{place}.{key}" in names:
                    amplitude = complex(getattr(result.of(place, group), key)[0])
                    for name, value in ((f"{place}.{key}", amplitude), (f"{place}.{key}_rate", 1j * w * amplitude)):
                        initial[name] = initial.get(name, 0.0) + value.real
    return initial


def largest_difference(result: UnbalanceResponse, run: hm.Response, places: tuple[str, ...]) -> float:
    """Between the run and the response, over the largest amplitude of the same kind in the line."""
    angle = abs(float(result.speeds[0])) * run.times
    worst = 0.0
    for keys in (("x", "y"), ("psi", "theta")):
        size = max(float(np.abs(getattr(result.of(place), key)[0])) for place in places for key in keys)
        for place in places:
            for key in keys:
                steady = sum(
                    np.real(getattr(result.of(place, group), key)[0] * np.exp(1j * ratio * angle))
                    for group, ratio in enumerate(result.frequency_ratios)
                )
                if f"{place}.{key}" in run:
                    worst = max(worst, float(np.max(np.abs(run[f"{place}.{key}"].values - steady))) / size)
    size = max(float(np.abs(result.force(b).x[0])) for b in result.bearings)
    for bearing in result.bearings:
        for key in "xy":
            steady = sum(
                np.real(getattr(result.force(bearing, group), key)[0] * np.exp(1j * ratio * angle))
                for group, ratio in enumerate(result.frequency_ratios)
            )
            worst = max(worst, float(np.max(np.abs(run[f"{bearing}.force_{key}"].values - steady))) / size)
    return worst


FINE = hm.DormandPrince(relative_tolerance=1e-12, absolute_tolerance=1e-15, max_step=1e-4)


@pytest.mark.parametrize("speed", [300.0, 600.0, -300.0])
def test_the_whole_model_started_on_the_steady_orbit_stays_on_it(speed: float) -> None:
    """Signs and sizes of static and dynamic unbalance: free spins, exact rigid bodies, three revolutions."""
    scene = unlike_line()
    result = hm.unbalance_response(scene, [speed])
    run = hm.simulate(scene, 6.0 * math.pi / abs(speed), solver=FINE, initial_speed=speed, initial=started_steadily(result, scene))
    # damping takes 4e-7 rad/s of the spin, an angle of 1e-8 rad; tilts of 3e-5 rad bend by 1e-9
    assert largest_difference(result, run, result.places) < 1e-7


def test_a_rotor_on_a_prescribed_shaft_and_one_behind_a_gear_whirl_at_their_own_frequencies() -> None:
    """Output against input at a third of its speed; the two lines meet in one flexible housing through the matrices only of their own."""
    side = {"mass": 0.2, "polar_inertia": 1e-4, "transverse_inertia": 1e-4}
    law = hm.LinearBearing.isotropic(radial=2e6, damping=100.0, axial=1e6, tilt=3e4, tilt_damping=1.0)
    rotor = {"polar_inertia": 0.02, "transverse_inertia": 0.014, "eccentricity": 2e-6, "tilt": 1e-5}
    parts: dict[str, Any] = {
        "motor": hm.Motor(inertia=1e-3, characteristic=hm.IdealSpeedMotor(motion=hm.ConstantSpeed(value=300.0))),
        "fast": hm.Rotor(mass=3.0, angle=0.4, tilt_angle=1.0, **rotor),
        "front": hm.Bearing(law=law, **side),
        "gear": hm.HarmonicDrive(ratio=3.0, stiffness=lambda twist: 1e5 * twist, damping=10.0),
        "slow": hm.Rotor(mass=40.0, angle=2.5, tilt_angle=-0.6, **rotor),
        "rear": hm.Bearing(law=law.replacing(stiffness_xx=5e5), **side),
    }
    scene = hm.Scene(name="geared", parts=parts, connections=[("motor", "fast", "front", "gear", "slow", "rear")])
    result = hm.unbalance_response(scene, [300.0])
    assert result.frequency_ratios == pytest.approx([1.0, 1.0 / 3.0])
    assert "unbalance at other frequencies too (0.333333 per reference speed)" in result.status
    # the slow rotor turns the other way: forward whirl is about -z
    assert result.senses[result.places.index("slow")] == -1.0
    assert result.of("slow", 1).major[0] > 0.0
    assert result["slow"].major[0] == 0.0
    assert result.of("fast", 1).major[0] == 0.0
    run = hm.simulate(scene, 6.0 * math.pi / 100.0, solver=FINE, initial_speed=300.0, initial=started_steadily(result, scene))
    # centrifugal forces on the vibrating slow rotor shake its spin by about (e/r)^2: below 1e-7 here
    assert largest_difference(result, run, ("fast", "slow")) < 1e-6
    x, y = result.orbit("slow", 300.0, turns=3.0)
    assert x == pytest.approx(
        np.interp(np.linspace(0.0, 6.0 * math.pi / 300.0, 361), run.times, run["slow.x"].values), abs=1e-3 * np.ptp(x)
    )
    assert y[0] == pytest.approx(y[-1], abs=1e-12)


def test_unbalance_of_a_rotor_lags_by_the_twist_of_a_loaded_shaft() -> None:
    twist, w = 0.2, 300.0
    shaft = hm.ShaftSection(length=0.5, diameter=0.02, youngs_modulus=2.1e11, shear_modulus=8.1e10, damping=1e-5)
    torque = twist * 8.1e10 * math.pi * 0.02**4 / 32.0 / 0.5
    law = hm.LinearBearing.isotropic(radial=1e6, damping=200.0, axial=1e6, tilt=1e4, tilt_damping=1.0)
    rotor = {"mass": 5.0, "polar_inertia": 0.03, "transverse_inertia": 0.02}
    parts: dict[str, Any] = {
        "drive": hm.DriveTorque(characteristic=lambda speed: torque + 0.0 * speed),
        "one": hm.Rotor(eccentricity=1e-6, angle=0.3, **rotor),
        "front": hm.Bearing(law=law),
        "shaft": shaft,
        "two": hm.Rotor(eccentricity=2e-6, angle=2.0, **rotor),
        "rear": hm.Bearing(law=law),
        "load": hm.Load(inertia=1e-4, torque=hm.ConstantTorque(value=torque)),
    }
    scene = hm.Scene(name="loaded", parts=parts, connections=[("drive", "one", "front", "shaft", "two", "rear", "load")])
    result = hm.unbalance_response(scene, [w])
    turned = hm.unbalance_response(scene.replacing({"load.torque": hm.ConstantTorque(value=0.0), "two.angle": 2.0 - twist}), [w])
    np.testing.assert_allclose(result.x, turned.x, rtol=1e-8)
    initial = started_steadily(result, scene) | {"two.angle": -twist}
    run = hm.simulate(scene, 6.0 * math.pi / w, solver=FINE, initial_speed=w, initial=initial)
    # damping of 200 N s/m over circles of 1e-6 m takes 1e-8 of the spin
    assert largest_difference(result, run, result.places) < 1e-6


# -- places, trial masses, balancing -----------------------------------------------------------------
def test_a_trial_mass_does_what_an_eccentricity_of_the_same_size_does() -> None:
    speeds = [200.0, 370.0, 800.0]
    size, angle = 3e-5, 1.3
    plain = unlike_line(**{"rotor_2.eccentricity": 0.0, "rotor_2.tilt": 0.0})
    mass = plain.parts["rotor_2"].mass  # type: ignore[attr-defined]
    built = hm.unbalance_response(plain.replacing({"rotor_2.eccentricity": size / mass, "rotor_2.angle": angle}), speeds)
    added = hm.unbalance_response(plain, speeds, extra={"rotor_2": (size, angle)})
    # the eccentricity also moves the centre of mass, which changes the inertia by m e^2/J = 4e-8
    np.testing.assert_allclose(added.x, built.x, rtol=1e-6)
    np.testing.assert_allclose(added.theta, built.theta, rtol=1e-6)


def test_an_influence_coefficient_of_a_disc_is_the_response_to_one_kilogram_metre() -> None:
    influence = hm.unbalance_response(disc(), SPEEDS[1:]).influence("rotor")
    w = SPEEDS[1:]
    np.testing.assert_allclose(influence["rotor"].x, w**2 / (K - M * w**2 + 1j * C * w), rtol=CLOSED)


@pytest.mark.parametrize("speed", [290.0, -290.0])
def test_two_correction_masses_still_a_line_of_unlike_unbalance_at_their_places(speed: float) -> None:
    scene = unlike_line(**{"bearing_a.housing.stiffness_x": 6e6})
    result = hm.unbalance_response(scene, [speed])
    masses = result.correction(["rotor_1", "rotor_2"], ["rotor_1", "rotor_2"], speed)
    balanced = hm.unbalance_response(scene, [speed], extra=masses)
    for place in ("rotor_1", "rotor_2"):
        # two planes and two places with like foundations: exact up to rounding
        assert balanced[place].major[0] < 1e-9 * result[place].major[0]


def test_a_trial_mass_on_a_merged_bearing_pushes_at_its_own_place() -> None:
    """Places on one rigid body: a force at distance a from the centre is the force and the moment F a on it."""
    law = hm.LinearBearing.isotropic(radial=K, damping=C, axial=1e6, tilt=K_TILT, tilt_damping=1.0)
    parts: dict[str, Any] = {
        "rotor": hm.Rotor(mass=M, polar_inertia=JP, transverse_inertia=JT),
        "arm": hm.RigidSection(length=0.1),
        "bearing": hm.Bearing(law=law),
    }
    scene = hm.Scene(name="arm", parts=parts, connections=[("rotor", "arm", "bearing")])
    w, u = 400.0, 1e-5
    result = hm.unbalance_response(scene, [w], extra={"bearing": (u, 0.0)})
    # circles: complex x + i y and tilt theta - i psi, bearing at a: z = x + a t
    a, s, st = 0.1, K + 1j * C * w, K_TILT + 1j * w
    matrix = np.array([[s - M * w**2, a * s], [a * s, a * a * s + st - (JT - JP) * w**2]])
    x, tilt = np.linalg.solve(matrix, u * w**2 * np.array([1.0, a]))
    assert result["rotor"].x[0] == pytest.approx(x, rel=CLOSED)
    assert result["bearing"].x[0] == pytest.approx(x + a * tilt, rel=CLOSED)
    assert result["bearing"].theta[0] == pytest.approx(tilt, rel=CLOSED)


def test_the_response_at_a_speed_between_is_calculated_and_not_interpolated() -> None:
    result = hm.unbalance_response(disc(), [0.0, 1500.0])
    assert result.at("rotor", 700.0).x[0] == pytest.approx(closed(700.0), rel=CLOSED)
    x, y = result.orbit("rotor", 700.0, points=5)
    quarter = closed(700.0) * np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 5))
    assert x == pytest.approx(quarter.real, rel=1e-9)
    assert y == pytest.approx(quarter.imag, rel=1e-9)


def sharpest(curve: Any) -> float:
    """Largest angle [rad] between neighbouring pieces, of which one is longer than 1 % of the largest amplitude."""
    piece = np.diff(curve)
    long = np.abs(piece) > 0.01 * np.abs(curve).max()
    return float(np.max(np.abs(np.angle(piece[1:] / piece[:-1])), where=long[1:] | long[:-1], initial=0.0))


@pytest.mark.parametrize("zeta", [1e-4, 0.02, 0.2])
def test_more_speeds_are_put_where_a_phase_turns(zeta: float) -> None:
    c = 2.0 * zeta * math.sqrt(K * M)
    result = hm.unbalance_response(disc(c=c), np.linspace(0.0, 1500.0, 16))
    finer = result.refined()
    assert set(result.speeds) < set(finer.speeds)
    # a circle is a polygon of 48 corners or more; halving an angle of at most two of them leaves fewer than 4 x 48 for each of x and y
    assert sharpest(result["rotor"].x) > 0.5
    assert sharpest(finer["rotor"].x) < 2.0 * math.pi / 48 + 1e-9
    assert len(finer.speeds) < 16 + 2 * 4 * 48
    (peak,) = result.peaks
    # half a corner beside the peak of a circle: cos(pi/48)
    assert finer["rotor"].major.max() > 0.997 * peak.amplitude
    x = closed(finer.speeds, c=c)
    np.testing.assert_allclose(finer["rotor"].x, x, rtol=1e-6 if zeta < 1e-3 else CLOSED, atol=1e-20)
    np.testing.assert_allclose(finer.force("bearing").x, (K + 1j * c * finer.speeds) * x, rtol=1e-6 if zeta < 1e-3 else CLOSED, atol=1e-15)
    assert finer.refined() is finer


def test_a_small_circle_within_a_large_one_is_found_between_the_speeds() -> None:
    # unlike planes that are coupled: x alone makes a loop where y resonates; both do between 600 and 650 rad/s, two speeds asked for
    stiffness = np.diag([K, 1.02 * K, 1e6, K_TILT, K_TILT, 0.0])
    stiffness[0, 1] = stiffness[1, 0] = 0.005 * K
    law = hm.LinearBearing.from_matrices(stiffness=stiffness, damping=np.diag([C, C / 20.0, 0.0, 0.0, 0.0, 0.0]))
    finer = hm.unbalance_response(disc(law=law), np.linspace(0.0, 1500.0, 31)).refined()
    assert sharpest(finer["rotor"].x) < 2.0 * math.pi / 48 + 1e-9
    w = finer.speeds[1:]
    system = np.array([[K - M * w**2 + 1j * C * w, 0.005 * K + 0.0 * w], [0.005 * K + 0.0 * w, 1.02 * K - M * w**2 + 1j * C / 20.0 * w]])
    force = M * E * np.exp(1j * ANGLE) * w[:, None] ** 2 * np.array([1.0, -1j])
    np.testing.assert_allclose(finer["rotor"].x[1:], np.linalg.solve(np.moveaxis(system, 2, 0), force[..., None])[:, 0, 0], rtol=1e-8)


def test_beside_an_undamped_critical_speed_no_speed_is_added() -> None:
    finer = hm.unbalance_response(disc(c=0.0), np.linspace(0.0, 1500.0, 61)).refined()
    assert not np.any((finer.speeds > 625.0) & (finer.speeds < 650.0)), "W = 632.5 rad/s lies there"
    assert np.all(np.isfinite(finer["rotor"].x))


# -- bearings that are not linear ---------------------------------------------------------------------
def test_a_cubic_bearing_counts_with_its_slope_at_the_static_deflection() -> None:
    cubic = 4e15
    law = hm.PowerBearing.isotropic(power_radial=cubic, radial=K, damping=C, axial=1e6, tilt=K_TILT)
    scene = disc(law=law)
    scene = hm.Scene(name="heavy", parts={**scene.parts, "gravity": hm.Gravity()}, connections=scene.connections)
    result = hm.unbalance_response(scene, [500.0, 600.0])
    # K y + K3 y^3 = -m g
    sag = float(np.real(next(r for r in np.roots([cubic, 0.0, K, M * 9.80665]) if abs(r.imag) < 1e-12)))
    w = np.array([500.0, 600.0])
    # the static deflection is found to 1e-10 of the weight
    np.testing.assert_allclose(result["rotor"].x, closed(w), rtol=1e-8)
    np.testing.assert_allclose(result["rotor"].y, -1j * closed(w, K + 3.0 * cubic * sag**2), rtol=1e-8)
    assert "forces at rotor are not linear and were linearised about the static deflection at each speed" in result.status


@pytest.mark.parametrize("eccentricity", [1e-9, 1e-6])
def test_the_status_tells_by_how_much_whirl_bends_a_law(eccentricity: float) -> None:
    cubic, w = 4e15, 500.0
    law = hm.PowerBearing.isotropic(power_radial=cubic, radial=K, damping=C, axial=1e6, tilt=K_TILT)
    result = hm.unbalance_response(disc(law=law, eccentricity=eccentricity), [w])
    # without weight the slope K + 3 K3 x^2 grows from K by 3 K3 x^2/K; four instants of a turn see the largest x within cos(45 degrees)
    largest = 3.0 * cubic * float(result["rotor"].major[0]) ** 2 / K
    text = result.status.partition("they change a stiffness by ")[2]
    assert 0.49 * largest <= float(text.partition(" %")[0]) / 100.0 <= 1.01 * largest
    assert ("simulate that speed" in text) == (largest > 0.1)


def test_a_bearing_from_a_table_has_at_each_speed_the_coefficients_of_that_speed() -> None:
    law = hm.TableBearing(
        speeds=(0.0, 1000.0),
        stiffness_xx=(1e6, 3e6),
        stiffness_yy=(1e6, 3e6),
        damping_xx=(C, 2.0 * C),
        damping_yy=(C, 2.0 * C),
        tilt_stiffness=K_TILT,
        axial_stiffness=1e6,
    )
    result = hm.unbalance_response(disc(law=law), np.linspace(0.0, 1500.0, 31))
    w = result.speeds
    share = np.minimum(w / 1000.0, 1.0)
    k, c = 1e6 + 2e6 * share, C * (1.0 + share)
    np.testing.assert_allclose(result["rotor"].x, closed(w, k, c), rtol=CLOSED, atol=1e-20)
    np.testing.assert_allclose(result.force("bearing").x, (k + 1j * c * w) * closed(w, k, c), rtol=CLOSED, atol=1e-15)
    assert result.status == "complete; coefficients at rotor change with speed and are those of each speed"


# -- stability ---------------------------------------------------------------------------------------
def whirl_fed_by_speed(per_speed: float) -> hm.Scene:
    """k_xy = -k_yx = b w.  m z'' + c z' + (k - i b w) z = 0 grows when b w > c sqrt(k/m)."""
    law = hm.TableBearing(
        speeds=(0.0, 2000.0),
        stiffness_xx=(K, K),
        stiffness_yy=(K, K),
        stiffness_xy=(0.0, 2000.0 * per_speed),
        stiffness_yx=(0.0, -2000.0 * per_speed),
        damping_xx=(C, C),
        damping_yy=(C, C),
        tilt_stiffness=K_TILT,
        axial_stiffness=1e6,
    )
    return disc(law=law)


def test_an_unstable_line_is_refused_with_the_speed_from_which_it_is() -> None:
    onset = 1000.0
    scene = whirl_fed_by_speed(C * W / onset)
    with pytest.raises(AnalysisError, match=r"has no steady response up to 1500 rad/s: it is unstable from (\d+\.?\d*) rad/s on") as caught:
        hm.unbalance_response(scene, SPEEDS)
    found = float(str(caught.value).partition("unstable from ")[2].partition(" rad/s")[0])
    # halved down to 1e-6 of the speed, printed with six digits
    assert found == pytest.approx(onset, rel=5e-6)
    assert "grows with" in str(caught.value)
    assert "rotating_damping" in str(caught.value)
    stable = hm.unbalance_response(scene, SPEEDS[onset > SPEEDS])
    # F_x = k x + b w y with Y = -i X: k - i b w
    w = stable.speeds
    expected = M * E * np.exp(1j * ANGLE) * w**2 / (K - 1j * C * W / onset * w - M * w**2 + 1j * C * w)
    np.testing.assert_allclose(stable["rotor"].x, expected, rtol=CLOSED, atol=1e-20)
    with pytest.raises(AnalysisError, match="unstable already at 1100 rad/s"):
        hm.unbalance_response(scene, [1100.0, 1200.0])


def shaft_line(elements: int, **shaft: float) -> hm.Scene:
    section = {"diameter": 0.03, "youngs_modulus": 2.1e11, "shear_modulus": 8.1e10, "density": 7800.0, "elements": float(elements)}
    law = hm.LinearBearing.isotropic(radial=1e7, damping=500.0, axial=1e7, tilt=0.0)
    parts: dict[str, Any] = {
        "left": hm.Bearing(law=law),
        "one": hm.ShaftSection(length=0.4, **section, **shaft),
        "disc": hm.Rotor(mass=8.0, polar_inertia=0.04, transverse_inertia=0.021, eccentricity=1e-5, tilt=1e-4, tilt_angle=1.0),
        "two": hm.ShaftSection(length=0.3, **section, **shaft),
        "right": hm.Bearing(law=law.replacing(stiffness_xx=5e6)),
    }
    return hm.Scene(name="shaft", parts=parts, connections=[("left", "one", "disc", "two", "right")])


@pytest.mark.parametrize("elements", [2, 20])
def test_damping_that_turns_with_the_shaft_is_found_unstable_in_short_and_long_lines(elements: int) -> None:
    with pytest.raises(AnalysisError, match="it is unstable from") as caught:
        hm.unbalance_response(shaft_line(elements, rotating_damping=5e-4), np.linspace(0.0, 1200.0, 61))
    found = float(str(caught.value).partition("unstable from ")[2].partition(" rad/s")[0])
    # the same line below that speed is stable, above it is not: eigenvalues of the whole first-order system
    for speed, grows in ((0.999 * found, False), (1.001 * found, True)):
        assert (growth(shaft_line(elements, rotating_damping=5e-4), speed) > 0.0) == grows


def growth(scene: hm.Scene, speed: float) -> float:
    from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices
    from hdrive_mbs.analysis.whirl.rotor_point import rotor_point

    lines = LineMatrices(scene.network())
    point = rotor_point(scene, speed, lines=lines)
    system = lines.at(point.angles, point.speeds, point.states)
    kept = [k for k, name in enumerate(system.names) if name.rpartition(".")[2] in ("x", "y", "psi", "theta")]
    m, d, k = (matrix[np.ix_(kept, kept)] for matrix in (system.mass, system.damping, system.stiffness))
    n = len(kept)
    whole = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(m, k), -np.linalg.solve(m, d)]])
    # rounding of 1e-13 of the largest eigenvalue of about 1e6 1/s stays far below what 0.1 % of speed changes
    return float(np.linalg.eigvals(whole).real.max())


def test_a_long_line_is_solved_by_bands_as_it_is_by_full_matrices(monkeypatch: pytest.MonkeyPatch) -> None:
    speeds = np.linspace(100.0, 1000.0, 4)
    line = SpeedLine.over(shaft_line(20, damping=1e-5), speeds, ["disc.x", "disc.y"])
    assert line.size > speed_line.DENSE_LIMIT
    rng = np.random.default_rng(2)
    forces = rng.normal(size=(4, line.size)) + 1j * rng.normal(size=(4, line.size))
    banded = line.solve(speeds, speeds, forces)
    monkeypatch.setattr(speed_line, "DENSE_LIMIT", line.size)
    dense = line.solve(speeds, speeds, forces)
    # condition of the dynamic stiffness (ends of the elements against the whole, about 1e9) times rounding
    np.testing.assert_allclose(banded, dense, rtol=0.0, atol=1e-7 * np.max(np.abs(dense)))


def test_finer_shafts_converge_to_one_response() -> None:
    speeds = [150.0, 700.0]
    found = [hm.unbalance_response(shaft_line(n, damping=1e-5), speeds)["disc"].x for n in (1, 2, 4)]
    errors = [np.max(np.abs(one - found[-1])) for one in found[:-1]]
    # consistent beam elements converge with the fourth power of their length: a factor of 16, less a little at n = 1
    assert errors[1] < errors[0] / 8.0
    assert errors[1] < 1e-3 * np.max(np.abs(found[-1]))


def test_matrices_of_a_linear_line_are_those_of_each_speed() -> None:
    from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices
    from hdrive_mbs.analysis.whirl.rotor_point import rotor_point

    scene = unlike_line()
    line = SpeedLine.over(scene, np.array([0.0, 500.0, 1000.0]), ["rotor_1.x", "rotor_1.y"])
    assert list(line.knots) == [0.0, 1000.0]
    lines = LineMatrices(scene.network())
    point = rotor_point(scene, 300.0, lines=lines)
    system = lines.at(point.angles, point.speeds, point.states)
    kept = [system.names.index(name) for name in line.names]
    damping, stiffness = line.matrices(300.0)
    np.testing.assert_allclose(damping, system.damping[np.ix_(kept, kept)], rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(stiffness, system.stiffness[np.ix_(kept, kept)], rtol=1e-12)
    assert not any(name.endswith(".z") for name in line.names), "axial motion takes no part"


# -- results and refusals ------------------------------------------------------------------------------
def test_a_saved_response_comes_back_and_goes_on_calculating(tmp_path: Path) -> None:
    result = hm.unbalance_response(disc(), SPEEDS, extra={"rotor": (1e-6, 0.5)})
    result.save(tmp_path / "u.npz")
    loaded = UnbalanceResponse.load(tmp_path / "u.npz")
    np.testing.assert_array_equal(loaded.x, result.x)
    assert loaded.peaks == result.peaks
    assert loaded.at("rotor", 500.0).x[0] == result.at("rotor", 500.0).x[0]
    np.testing.assert_array_equal(loaded.refined()["rotor"].x, result.refined()["rotor"].x)
    header, first, *_ = result.to_csv(tmp_path / "u.csv").read_text().splitlines()
    assert header.startswith("speed [rad/s],")
    assert '"rotor major semi-axis, 0-peak [m]"' in header
    assert len(first.split(",")) == len(result.columns())


def test_a_line_that_turns_the_other_way_whirls_as_its_mirror_image() -> None:
    scene = disc(angle=0.0)
    forth, back = hm.unbalance_response(scene, [500.0]), hm.unbalance_response(scene, [-500.0])
    assert back["rotor"].x[0] == pytest.approx(forth["rotor"].x[0], rel=CLOSED)
    assert back["rotor"].y[0] == pytest.approx(-forth["rotor"].y[0], rel=CLOSED)
    assert back["rotor"].whirl[0] == forth["rotor"].whirl[0] == 1.0


@pytest.mark.parametrize(
    ("speeds", "message"),
    [
        ([500.0, 100.0], "speeds must increase, but 500 rad/s is followed by 100 rad/s"),
        ([0.0, 0.0], "speeds must increase"),
        ([], "give a list of speeds"),
        ([0.0, math.nan], "give a list of speeds"),
        ("fast", "give a list of speeds"),
    ],
)
def test_speeds_that_do_not_increase_are_refused(speeds: Any, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        hm.unbalance_response(disc(), speeds)


def test_a_balanced_line_and_one_that_only_turns_are_refused() -> None:
    with pytest.raises(AnalysisError, match="The line is balanced"):
        hm.unbalance_response(disc(eccentricity=0.0), SPEEDS)
    parts = {"motor": hm.Inertia(inertia=1.0), "shaft": hm.Shaft(stiffness=1.0), "load": hm.Inertia(inertia=1.0)}
    turning = hm.Scene(name="train", parts=parts, connections=[("motor", "shaft", "load")])
    with pytest.raises(AnalysisError, match="everything in 'train' only turns"):
        hm.unbalance_response(turning, SPEEDS)


def test_wrong_places_and_trial_masses_are_named() -> None:
    result = hm.unbalance_response(disc(), [500.0])
    with pytest.raises(PlaceError, match=r"No place 'roter'\. This response has: rotor, bearing"):
        result["roter"]
    with pytest.raises(PlaceError, match=r"No turning place 'roter'\. This scene has: rotor, bearing"):
        hm.unbalance_response(disc(), [500.0], extra={"roter": (1e-5, 0.0)})
    with_motor = hm.Scene(
        name="driven",
        parts={**disc().parts, "motor": hm.Inertia(inertia=1.0), "gear": hm.Shaft(stiffness=1e3)},
        connections=[("motor", "gear", "rotor"), ("rotor", "bearing")],
    )
    with pytest.raises(PlaceError, match=r"No turning place 'motor'\. This scene has: rotor, bearing"):
        hm.unbalance_response(with_motor, [500.0], extra={"motor": (1e-5, 0.0)})
    with pytest.raises(ParameterError, match=r"extra\['rotor'\] = \(-1e-05 kg m, 0 rad\)"):
        hm.unbalance_response(disc(), [500.0], extra={"rotor": (-1e-5, 0.0)})
    with pytest.raises(ParameterError, match="give \\(mass times radius"):
        hm.unbalance_response(disc(), [500.0], extra={"rotor": 1e-5})  # type: ignore[dict-item]
    with pytest.raises(AnalysisError, match="cannot tell the planes rotor, bearing apart"):
        result.correction(["rotor", "bearing"], ["rotor"], 500.0)
