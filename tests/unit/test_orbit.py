"""Orbits: ellipses of known circles, whirl between two critical speeds, self-centring, windows."""

from __future__ import annotations

import functools
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

import hdrive_mbs as hm
from tests.unit.picture_checks import assert_nothing_is_cut_off, figure_of
from tests.unit.rotor_scenes import CRITICAL, ECCENTRICITY, MASS, STIFFNESS, constant, jeffcott, made, steady, support

SPEED = 100.0


def whirl(
    forward: complex, backward: complex, static: complex = 0j, sense: float = 1.0, count: int = 2001, turns: float = 10.0
) -> hm.Response:
    """x + i y = static + F exp(i phi) + B exp(-i phi) at a constant speed of 100 rad/s."""
    t = np.linspace(0.0, 2.0 * np.pi * turns / SPEED, count)
    phi, w = sense * SPEED * t, sense * SPEED
    z = static + forward * np.exp(1j * phi) + backward * np.exp(-1j * phi)
    return made(t, phi, np.full(count, w), z, 1j * w * (forward * np.exp(1j * phi) - backward * np.exp(-1j * phi)))


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_the_ellipse_is_that_of_the_two_circles_whatever_the_sense_of_the_spin(sense: float) -> None:
    forward, backward, static = 3e-4 * np.exp(0.4j), 1e-4 * np.exp(1.0j), complex(5e-5, -2e-4)
    result = hm.orbit(whirl(forward, backward, static, sense), "disc")
    # sums over whole revolutions, sampled 200 times: exact but for rounding and the halved ends
    assert result.forward == pytest.approx(3e-4, rel=1e-6)
    assert result.backward == pytest.approx(1e-4, rel=1e-6)
    assert (result.major, result.minor) == pytest.approx((4e-4, 2e-4), rel=1e-6)
    # x + i y = exp(i 0.7) (3 exp(i (phi - 0.3)) + exp(-i (phi - 0.3))): the major axis lies at (0.4 + 1.0)/2
    assert result.inclination == pytest.approx(0.7, abs=1e-6)
    assert result.precession == "forward"
    assert np.hypot(result.x - static.real, result.y - static.imag).max() == pytest.approx(4e-4, rel=1e-4)


@pytest.mark.parametrize(("forward", "backward", "word"), [(1e-4, 2e-4, "backward"), (2e-4, 0.0, "forward"), (1e-4, 1e-4, "straight")])
def test_the_sense_of_precession_is_named(forward: float, backward: float, word: str) -> None:
    for sense in (1.0, -1.0):
        result = hm.orbit(whirl(forward, backward, sense=sense), "disc")
        assert result.precession == word
    if backward == 0.0:
        assert result.roundness == pytest.approx(1.0, abs=1e-4)


def test_between_two_critical_speeds_of_an_unsymmetric_support_the_whirl_goes_backward() -> None:
    # k_x = 1e5, k_y = 2e5: critical speeds 223.6 and 316.2 rad/s; at 270 x has passed its resonance and y has not
    speed, stiffness = 270.0, (1e5, 2e5)
    run = hm.coast_down(jeffcott(law=support(*stiffness)), 0.2, initial_speed=speed, accuracy=1e-6)
    x, y = steady(speed, stiffness[0]), -1j * steady(speed, stiffness[1])  # of Re[X exp(i w t)], Re[Y exp(i w t)]
    result = hm.orbit(run, "disc")
    assert result.precession == "backward"
    # the spin falls by whirl, c w |Z|^2/J = 0.1 rad/s^2 and less: 1e-4 of the speed in the run, some 1e-3 of the amplitude
    assert result.forward == pytest.approx(abs(x + 1j * y) / 2.0, rel=2e-3)
    assert result.backward == pytest.approx(abs(x - 1j * y) / 2.0, rel=2e-3)
    assert hm.orbit(hm.coast_down(jeffcott(law=support(*stiffness)), 0.2, initial_speed=150.0), "disc").precession == "forward"


def test_far_above_the_critical_speed_the_mass_centre_moves_to_the_axis() -> None:
    # seed M, Fig. 7: |Z + e| = e k/(m w^2 - k) without damping: 1/9 e at three times the critical speed... (1/(9 - 1))
    speed = 3.0 * CRITICAL
    run = hm.coast_down(jeffcott(), 0.05, initial_speed=speed, accuracy=1e-5)
    assert hm.orbit(run, "disc", centre="mass").radius == pytest.approx(abs(steady(speed) + ECCENTRICITY), rel=5e-3)
    assert abs(steady(speed) + ECCENTRICITY) == pytest.approx(ECCENTRICITY / 8.0, rel=1e-2)
    assert hm.orbit(run, "disc").radius == pytest.approx(abs(steady(speed)), rel=1e-3)


def test_the_static_deflection_can_be_taken_off() -> None:
    run = hm.coast_down(jeffcott(parts={"gravity": hm.Gravity()}), 0.1, initial_speed=500.0)
    sag = MASS * 9.80665 / STIFFNESS
    assert hm.orbit(run, "disc").y.mean() == pytest.approx(-sag, rel=2e-2)
    for about in ("static", "mean"):
        result = hm.orbit(run, "disc", about=about)
        assert result.origin == pytest.approx((0.0, -sag), abs=0.02 * sag)
        assert result.radius.max() == pytest.approx(abs(steady(500.0)), rel=3e-2)
    response = hm.simulate(run.scene, 0.02, solver=hm.Trapezoidal(step=1e-4), initial_speed=500.0)
    # a plain response is asked for its static deflection at the speed of the window
    assert hm.orbit(response, "disc", about="static").origin == pytest.approx((0.0, -sag), abs=1e-9)


@functools.cache
def run_up() -> hm.RunUp:
    return hm.run_up(jeffcott(), 1.2)


def test_a_window_in_speed_is_a_window_in_time() -> None:
    result = hm.orbit(run_up(), "disc", slowest=340.0, fastest=380.0)
    assert result.speed.min() >= 340.0
    assert result.speed.max() <= 380.0
    # 500 rad/s^2: the window lasts 0.08 s
    assert result.times[-1] - result.times[0] == pytest.approx(0.08, rel=5e-2)
    assert "the ellipse is a mean" in result.status
    assert result.radius.max() == pytest.approx(run_up().peak_amplitude["disc"], rel=1e-3)


def test_marks_stand_at_whole_revolutions() -> None:
    # phi = 2 pi k: x + i y = F + B
    result = hm.orbit(whirl(3e-4, 1e-4j, turns=5.5), "disc")
    assert len(result.marks) == 6
    np.testing.assert_allclose(result.marks, np.tile([3e-4, 1e-4], (6, 1)), atol=1e-6 * 3e-4 + 2e-8)


def test_few_samples_are_refined_along_the_interpolated_motion() -> None:
    result = hm.orbit(whirl(1e-4, 0.0, count=121), "disc")
    # 12 samples a revolution, cubic Hermite: (2 pi/12)^4/384 = 2e-4
    assert len(result.times) > 900
    assert result.radius == pytest.approx(1e-4, rel=2e-4)


def test_a_window_of_less_than_a_revolution_has_a_path_but_no_ellipse() -> None:
    result = hm.orbit(whirl(1e-4, 0.0), "disc", end=0.5 * 2.0 * np.pi / SPEED)
    assert np.isnan(result.forward)
    assert len(result.x) > 10


def test_housings_and_forces_have_orbits_too() -> None:
    from models.two_rotor_line import build

    run = hm.run_up(build(), 0.3)
    housing, force = (hm.orbit(run, f"bearing_a.{name}") for name in ("housing", "force"))
    assert (housing.unit, force.unit) == ("m", "N")
    np.testing.assert_array_equal(housing.x, np.interp(housing.times, run.times, run.values["bearing_a.housing.x"]))
    assert force.radius.max() == pytest.approx(np.hypot(run.values["bearing_a.force_x"], run.values["bearing_a.force_y"]).max(), rel=1e-6)


def test_an_orbit_is_saved_and_written_as_table(tmp_path: Path) -> None:
    result = hm.orbit(whirl(3e-4, 1e-4), "disc")
    again = hm.Orbit.load(result.save(tmp_path / "o.npz"))
    np.testing.assert_array_equal(again.x, result.x)
    head = result.to_csv(tmp_path / "o.csv").read_text().splitlines()[0]
    assert head == "time [s],x [m],y [m],spin angle [rad],speed [rad/s]"


def test_bad_questions_are_refused_with_the_way_out() -> None:
    response = whirl(1e-4, 0.0)
    with pytest.raises(hm.ParameterError, match=r"'disc\.x' is one channel; an orbit needs a place"):
        hm.orbit(response, "disc.x")
    with pytest.raises(hm.ParameterError, match="centre = 'gravity': must be one of geometric, mass"):
        hm.orbit(response, "disc", centre="gravity")
    with pytest.raises(hm.ParameterError, match="about = 'zero'"):
        hm.orbit(response, "disc", about="zero")
    with pytest.raises(
        hm.AnalysisError, match=r"disc\.speed lies between 100 rad/s and 100 rad/s: fewer than 3 samples between 200 and 300"
    ):
        hm.orbit(response, "disc", slowest=200.0, fastest=300.0)
    with pytest.raises(hm.ParameterError, match="must rise"):
        hm.orbit(response, "disc", slowest=300.0, fastest=200.0)
    for options in ({"centre": "mass"}, {"about": "static"}):
        with pytest.raises(hm.AnalysisError, match="without its scene"):
            hm.orbit(response, "disc", **options)


# -- the picture ------------------------------------------------------------------------------------


@pytest.mark.parametrize("changing", [False, True])
def test_the_picture_has_equal_scales_units_and_amplitudes_that_say_0_peak(changing: bool) -> None:
    result = hm.orbit(run_up(), "disc") if changing else hm.orbit(whirl(3e-4, 1e-4), "disc")
    ax = hm.plot(result)
    assert ax.get_aspect() == 1.0
    assert ax.get_xlabel().endswith("[mm]" if changing else "[µm]")
    figure = figure_of(ax)
    title = figure._suptitle.get_text()  # type: ignore[attr-defined]
    assert "0-peak" in title
    assert "forward precession" in title
    assert_nothing_is_cut_off(ax)
    own = Figure().add_subplot()
    assert hm.plot(result, ax=own) is own


def test_the_direction_of_a_run_backwards_is_that_of_its_spin() -> None:
    run = hm.run_up(jeffcott(constant(-5.0)), 0.7)
    assert hm.orbit(run, "disc", start=0.3).precession == "forward"


def test_whirl_about_a_large_sag_fills_the_picture() -> None:
    t = np.linspace(0.0, 1.0, 4001)
    phi = 100.0 * t
    whirl = 2e-6 * np.exp(1j * phi)
    response = made(t, phi, np.full_like(t, 100.0), whirl - 80e-6j, 100.0j * whirl)
    ax = hm.plot(hm.orbit(response, "disc"))
    (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
    assert (left, right) == pytest.approx((-2.4, 2.4), rel=1e-3)
    assert (low, high) == pytest.approx((-82.4, -77.6), rel=1e-3)
    assert ax.get_ylabel() == "y, counted from the axis [\u00b5m]"
    # without sag the axis is in the middle; the mean over 15.9 revolutions is off by a part of 1/100
    assert hm.plot(hm.orbit(response, "disc", about="mean")).get_xlim() == pytest.approx((-2.16, 2.16), rel=1e-2)


def test_the_static_deflection_of_what_is_no_place_is_refused() -> None:
    run = hm.run_up(jeffcott(constant(5.0)), 0.05, initial_speed=50.0)
    own = hm.TimeHistory("key phasor", "rad", run.times, run["disc.angle"].values)
    # the same circle whatever names the shaft and the place
    assert hm.orbit(run, ("disc.x", "disc.y"), reference=own).forward == pytest.approx(hm.orbit(run, "disc").forward, rel=1e-4, nan_ok=True)
    for place, reference, said in (
        ("disc", own, "the shaft 'key phasor'"),
        (("disc.x", "disc.y"), None, "'disc.x, disc.y'"),
        ("bearing.force", None, "'bearing.force'"),
    ):
        with pytest.raises(hm.ParameterError, match=f"about = 'static': {said} is no place of the scene with a static deflection"):
            hm.orbit(run, place, about="static", reference=reference)
