"""Orders tracked along a run: exact for what the model holds, and a Bode plot of a slow run-up by the closed form."""

from __future__ import annotations

import functools
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

import hdrive_mbs as hm
from tests.unit.picture_checks import assert_nothing_is_cut_off, figure_of
from tests.unit.rotor_scenes import CRITICAL, DAMPING, ECCENTRICITY, MASS, STIFFNESS, constant, jeffcott, made, steady

ACCELERATION = 40.0


def run(
    forward: complex = 3e-6, backward: complex = 0j, second: complex = 0j, static: complex = 0j, sense: float = 1.0, growth: float = 0.0
) -> hm.Response:
    """From rest at 40 rad/s^2 for 6 s, 115 revolutions:  x + i y = static + F (1 + growth phi) e^(i phi) + B e^(-i phi) + S e^(2 i phi)."""
    t = np.linspace(0.0, 6.0, 60001)
    phi, w = 0.5 * sense * ACCELERATION * t**2, sense * ACCELERATION * t
    parts = (forward * (1.0 + growth * phi) * np.exp(1j * phi), backward * np.exp(-1j * phi), second * np.exp(2j * phi))
    rate = 1j * w * (parts[0] - parts[1] + 2.0 * parts[2]) + forward * growth * w * np.exp(1j * phi)
    return made(t, phi, w, static + sum(parts), rate)


EXACT = 1e-6
"""Cubic Hermite interpolation of the made run: (w h)^4/384 = (240 x 1e-4)^4/384 = 1e-9 of the amplitude, times the filters' gain."""


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_forward_and_backward_whirl_are_told_apart_with_their_phases(sense: float) -> None:
    forward, backward = 3e-6 * np.exp(0.5j), 1e-6 * np.exp(-1.2j)
    result = hm.order_tracking(run(forward, backward, static=4e-6 - 2e-6j, sense=sense), "disc")
    assert result.tracks == ("1 forward", "1 backward")
    np.testing.assert_allclose(result.track(1.0, "forward"), forward, rtol=EXACT)
    np.testing.assert_allclose(result.track(1.0, "backward"), backward, rtol=3.0 * EXACT)
    assert np.all(np.sign(result.speeds) == sense)
    # the lag of x: x = |A| cos(phi - lag), of A exp(i phi) as of A exp(-i phi)
    np.testing.assert_allclose(result.lag(1.0, "forward"), -0.5, rtol=EXACT)
    np.testing.assert_allclose(result.lag(1.0, "backward"), 2.0 * np.pi - 1.2, rtol=EXACT)


def test_the_lag_of_a_slow_run_up_is_that_of_the_unbalance_response() -> None:
    tracked = hm.order_tracking(slow(), "disc")
    below, above = (int(np.argmax(tracked.speeds > speed)) for speed in (200.0, 420.0))
    steady_state = hm.unbalance_response(slow().scene, tracked.speeds[[below, above]])["disc"].phase_lag_x
    # 5 rad/s^2 behind a rotor that answers within 2 m/c = 0.16 s: a lag of the drift below 0.02 rad
    np.testing.assert_allclose(tracked.lag()[[below, above]], steady_state, atol=0.02)
    assert steady_state[0] < 0.1
    assert steady_state[1] == pytest.approx(np.pi, abs=0.1)


def test_two_orders_of_one_channel_are_told_apart() -> None:
    # x = Re[(3 e^0.5i) e^(i phi) + (1 e^(-1.2 i)) e^(2 i phi)]
    result = hm.order_tracking(run(3e-6 * np.exp(0.5j), second=1e-6 * np.exp(-1.2j)), "disc.x", orders=(1.0, 2.0))
    assert result.tracks == ("1", "2")
    np.testing.assert_allclose(result.track(1.0), 3e-6 * np.exp(0.5j), rtol=EXACT)
    np.testing.assert_allclose(result.track(2.0), 1e-6 * np.exp(-1.2j), rtol=3.0 * EXACT)


def test_an_amplitude_that_changes_like_a_parabola_within_the_window_is_exact() -> None:
    response = run(growth=0.01)
    result = hm.order_tracking(response, "disc")
    np.testing.assert_allclose(result.track(), 3e-6 * (1.0 + 0.01 * result.angles), rtol=EXACT)


def test_speeds_and_times_are_those_of_the_middle_of_each_window() -> None:
    result = hm.order_tracking(run(), "disc", revolutions=6.0)
    np.testing.assert_allclose(result.speeds, ACCELERATION * result.times, rtol=1e-6)
    np.testing.assert_allclose(result.angles, 0.5 * ACCELERATION * result.times**2, rtol=1e-6)
    # the first window covers revolutions 0 to 6
    assert result.angles[0] == pytest.approx(3.0 * 2.0 * np.pi, rel=1e-9)
    assert result.revolutions == 6.0


def test_what_is_no_order_is_rejected_the_better_the_further_off_it_lies() -> None:
    # a tone of 60 rad/s is order 60/w: 1 at 1.5 s, 1/3 and less from 4.5 s on.  The main lobe is as wide as that of Hann's window
    # (2/revolutions) and of a parabola in it (2/revolutions more); beyond it less than 5 % is left
    t = np.linspace(0.0, 6.0, 60001)
    phi, w, tone = 0.5 * ACCELERATION * t**2, ACCELERATION * t, 1e-6 * np.exp(60j * t)
    result = hm.order_tracking(made(t, phi, w, tone, 60j * tone), "disc", revolutions=6.0)
    order = 60.0 / result.speeds
    away = np.abs(order - 1.0) > 4.0 / 6.0
    assert away.sum() > 150
    assert np.abs(result.track())[away].max() < 0.05e-6
    assert np.abs(result.track())[int(np.argmin(np.abs(order - 1.0)))] > 0.5e-6


@functools.cache
def slow() -> hm.RunUp:
    """0.3 N m, 30 rad/s^2: 13 s through the resonance at 316 rad/s; damping ratio 2 %, a half-power width of 12.6 rad/s takes 0.4 s."""
    return hm.run_up(jeffcott(constant(0.3)), 9.0, initial_speed=180.0)


def slowly_rising(speed: float, rise: float) -> complex:
    """A of x + i y = A exp(i phi), to first order in a = phi'':  D A0 = m e w^2,  D A1 = -i m e a - (2 i m w + c) A0' - i m a A0.

    From m (A'' + 2 i w A' + i a A - w^2 A) + c (A' + i w A) + k A = m e (w^2 - i a), with D = k - m w^2 + i c w and A0' = a dA0/dw.
    """
    first, step = steady(speed), 1e-3
    change = rise * (steady(speed + step) - steady(speed - step)) / (2.0 * step)
    stiffness = complex(STIFFNESS - MASS * speed**2, DAMPING * speed)
    right = -1j * MASS * ECCENTRICITY * rise - (2j * MASS * speed + DAMPING) * change - 1j * MASS * rise * first
    return first + right / stiffness


def test_a_slow_run_up_gives_the_bode_plot_of_the_closed_form() -> None:
    result = hm.order_tracking(slow(), "disc", revolutions=4.0)
    assert result.tracks[0] == "1 forward"
    expected = np.array([steady(float(w)) for w in result.speeds])
    # far below the resonance the rest is of the order (a/(w0 - w)^2)^2; the run itself is good to 1e-3
    before = (result.speeds > 190.0) & (result.speeds < 300.0)
    w = result.speeds[before]
    drifting = np.array([slowly_rising(float(value), 30.0) for value in w])
    allowed = 5.0 * (30.0 / (CRITICAL - w) ** 2) ** 2 + 1e-3
    assert np.all(np.abs(result.track()[before] / drifting - 1.0) < allowed)
    assert allowed[w < 270.0].max() < 3e-3
    # a lag of 90 degrees just after the critical speed, as the whirl lags by its time constant: a 2 m/c = 4.8 rad/s
    crossing = result.speeds[int(np.argmax(result.lag() > np.pi / 2.0))]
    assert CRITICAL < crossing < CRITICAL + 4.8
    late = result.speeds > 420.0
    np.testing.assert_allclose(np.abs(result.track())[late], np.abs(expected)[late], rtol=0.05)


def test_the_backward_track_of_a_symmetric_rotor_is_empty() -> None:
    result = hm.order_tracking(slow(), "disc")
    assert np.abs(result.track(1.0, "backward")).max() < 2e-4 * np.abs(result.track()).max()


def test_tracks_are_saved_and_written_as_a_table(tmp_path: Path) -> None:
    result = hm.order_tracking(run(), "disc")
    again = hm.OrderTracking.load(result.save(tmp_path / "t.npz"))
    np.testing.assert_array_equal(again.amplitudes, result.amplitudes)
    head = result.to_csv(tmp_path / "t.csv").read_text().splitlines()[0]
    assert "order 1 forward amplitude 0-peak [m],order 1 forward lag [rad]" in head


def test_the_picture_shows_amplitude_0_peak_and_lag_over_speed(tmp_path: Path) -> None:
    upper = hm.plot(hm.order_tracking(slow(), "disc"))
    assert_nothing_is_cut_off(upper)
    lower = figure_of(upper).axes[1]
    assert upper.get_ylabel() == "amplitude, 0-peak [mm]"
    assert lower.get_ylabel() == "lag behind the spin [degrees]"
    assert lower.get_xlabel() == "speed of disc [rad/s]"
    assert [text.get_text() for text in upper.get_legend().get_texts()] == ["order 1 forward"], "what is not there is not drawn"
    lags = lower.get_lines()[0].get_ydata()
    assert np.nanmin(lags) >= -45.0
    assert np.nanmax(lags) <= 315.0
    assert lags[-1] == pytest.approx(180.0, abs=10.0), "above the critical speed it follows by half a turn"
    png, _ = hm.save_figure(upper, tmp_path / "bode")
    assert png.stat().st_size > 5000
    assert "below 5 % of the largest and not drawn: order 1 backward" in figure_of(upper).get_suptitle()
    own = Figure().add_subplot()
    assert hm.plot(hm.order_tracking(run(), "disc"), ax=own, tracks=["1 backward"]) is own
    with pytest.raises(hm.PlaceError, match="No track '3'"):
        hm.plot(hm.order_tracking(run(), "disc"), tracks=["3"])


def test_bad_questions_are_refused_with_the_way_out() -> None:
    response = run()
    with pytest.raises(hm.ParameterError, match=r"orders = .*: must be different numbers greater than 0"):
        hm.order_tracking(response, "disc", orders=(1.0, -1.0))
    with pytest.raises(hm.ParameterError, match="samples_per_revolution = 8: must be at least 4 for each period"):
        hm.order_tracking(response, "disc", orders=(4.0,), samples_per_revolution=8)
    with pytest.raises(hm.AnalysisError, match=r"lie too close together for windows of 1 revolutions; take longer windows"):
        hm.order_tracking(response, "disc", orders=(1.0, 1.1), revolutions=1.0)
    with pytest.raises(hm.AnalysisError, match=r"turns by 115 revolutions .* less than a window of 500"):
        hm.order_tracking(response, "disc", revolutions=500.0)
    with pytest.raises(hm.PlaceError, match=r"No track '2 forward'\. This order tracking has: 1 forward, 1 backward"):
        hm.order_tracking(response, "disc").track(2.0)


def test_an_order_spectrum_of_a_line_without_a_motor_counts_from_the_place() -> None:
    found = hm.order_spectrum(run(), "disc.x", start=3.0)
    assert found.against == "disc"
    # x = Re[3e-6 e^(i phi)] is order 1 however the speed changes
    assert found.peaks(1)[0] == pytest.approx((1.0, 3e-6), rel=1e-3)
    ax = hm.plot(found)
    assert ax.get_ylabel() == "amplitude, 0-peak [\u00b5m]"
    with pytest.raises(hm.PlaceError, match=r"No channel 'motor\.angle'"):
        hm.order_spectrum(run(), "disc.x", against="motor.angle")
