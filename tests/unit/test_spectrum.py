"""Spectra and order spectra of signals whose amplitudes are known."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.analysis.signals.windows import WINDOWS, Window


def history(function: Callable[[np.ndarray], np.ndarray], times: np.ndarray, slope: Callable[[np.ndarray], np.ndarray] | None = None):
    return hm.TimeHistory("signal", "N m", times, function(times), None if slope is None else slope(times))


def even(count: int, span: float = 1.0) -> np.ndarray:
    return np.linspace(0.0, span, count + 1)


def uneven(count: int, span: float = 1.0) -> np.ndarray:
    """Steps between 0.5 and 1.5 of their mean, as an adaptive solver makes them."""
    steps = np.random.default_rng(1).uniform(0.5, 1.5, count)
    return np.concatenate([[0.0], np.cumsum(steps)]) / steps.sum() * span


ROUNDING = 1e-12
"""An FFT of some thousand samples: a few hundred roundings of 1.1e-16."""


# -- amplitude --------------------------------------------------------------------------------------


@pytest.mark.parametrize("window", WINDOWS)
def test_a_sine_with_whole_periods_shows_its_amplitude_through_every_window(window: str) -> None:
    signal = history(lambda t: 3.0 * np.sin(2.0 * np.pi * 50.0 * t), even(1000))
    result = hm.spectrum(signal, window=window)
    assert result.frequency[50] == pytest.approx(2.0 * np.pi * 50.0)
    assert result.amplitude[50] == pytest.approx(3.0, rel=ROUNDING)


def test_uneven_times_cost_no_more_than_the_error_of_hermite_interpolation() -> None:
    # cubic Hermite: |error| <= h^4/384 max|y''''| = h^4/384 w^4 A, with the longest step 1.5/2000 s and more (the mean is 1/2000 s)
    omega, amplitude, times = 2.0 * np.pi * 20.0, 2.0, uneven(2000)
    bound = np.max(np.diff(times)) ** 4 / 384.0 * omega**4 * amplitude
    signal = history(lambda t: amplitude * np.sin(omega * t), times, lambda t: amplitude * omega * np.cos(omega * t))
    result = hm.spectrum(signal)
    # a Hann window passes at most twice the largest error into one line
    assert abs(result.amplitude[20] - amplitude) < 2.0 * bound
    assert 2.0 * bound < 1e-6


def test_two_tones_keep_their_frequencies_and_amplitudes() -> None:
    signal = history(lambda t: 1.5 + 2.0 * np.sin(2.0 * np.pi * 30.0 * t) + 0.25 * np.cos(2.0 * np.pi * 110.0 * t), even(2048))
    result = hm.spectrum(signal)
    (first, second) = result.peaks(2)
    assert first == pytest.approx((2.0 * np.pi * 30.0, 2.0), rel=1e-9)
    assert second == pytest.approx((2.0 * np.pi * 110.0, 0.25), rel=1e-9)
    assert result.mean == pytest.approx(1.5, rel=ROUNDING)
    assert result.amplitude[0] == pytest.approx(1.5, rel=ROUNDING)
    assert result.amplitude[1] < 1e-12, "the mean must not leak into the first line"
    assert result.phase[110] == pytest.approx(0.0, abs=1e-9)
    assert result.phase[30] == pytest.approx(-math.pi / 2.0, abs=1e-9)


@pytest.mark.parametrize("window", ["hann", "blackman", "flat_top"])
@pytest.mark.parametrize("frequency", [100.2, 100.5, 100.9])
def test_a_peak_between_two_lines_is_found_with_its_true_amplitude(window: str, frequency: float) -> None:
    # what disturbs is the mirror image at -frequency, some 200 lines away: a Hann window lets through less than
    # 1/(pi 200^3) = 4e-8 of it, the others less than 3e-5 (their side lobes fall more slowly).  The main lobe of the
    # flat-top window hides the frequency: its neighbours say little about it
    signal = history(lambda t: 4.0 * np.sin(2.0 * np.pi * frequency * t + 0.3), even(4000))
    (peak,) = hm.spectrum(signal, window=window).peaks(1)
    tolerance = 1e-6 if window == "hann" else 1e-4
    assert peak.frequency / (2.0 * np.pi) == pytest.approx(frequency, abs=1e-2 if window == "flat_top" else tolerance)
    assert peak.amplitude == pytest.approx(4.0, rel=tolerance)


def test_the_hann_window_shows_15_percent_less_half_way_between_lines() -> None:
    # W(1/2) = (sin(pi/2)/(pi/2)) / (1 - 1/4) = 8/(3 pi)
    signal = history(lambda t: np.sin(2.0 * np.pi * 100.5 * t), even(4000))
    assert hm.spectrum(signal).amplitude.max() == pytest.approx(8.0 / (3.0 * math.pi), rel=1e-5)


@pytest.mark.parametrize("window", WINDOWS.values(), ids=lambda window: window.name)
def test_the_response_of_a_window_is_its_transform(window: Window) -> None:
    count, offset = 4096, 0.37
    values = window.values(count)
    transform = np.sum(values * np.exp(2j * np.pi * offset * np.arange(count) / count)) / np.sum(values)
    # the sum over n samples differs from the integral by the order 1/n^2 of a periodic sum, times some units
    assert window.response(offset) == pytest.approx(abs(transform), abs=10.0 / count**2)


def test_the_lines_hold_the_mean_square_of_the_signal() -> None:
    # Parseval with a rectangular window: mean(y^2) = a_0^2 + sum(a_k^2)/2 (+ a_N/2^2 for the last line)
    values = np.random.default_rng(2).normal(size=1001)
    result = hm.spectrum(hm.TimeHistory("noise", "1", even(1000), values), window="rectangular")
    total = result.amplitude[0] ** 2 + 0.5 * np.sum(result.amplitude[1:-1] ** 2) + result.amplitude[-1] ** 2
    assert total == pytest.approx(np.mean(values[:-1] ** 2), rel=ROUNDING)


def test_a_span_is_cut_out_of_the_record() -> None:
    # 10 Hz before 1 s, 40 Hz after it
    signal = history(lambda t: np.where(t < 1.0, np.sin(20.0 * np.pi * t), 2.0 * np.sin(80.0 * np.pi * t)), even(4000, 2.0))
    late = hm.spectrum(signal, start=1.0, end=2.0)
    assert late.amplitude[40] == pytest.approx(2.0, rel=1e-9)
    assert late.amplitude[10] < 1e-9
    assert late.resolution == pytest.approx(2.0 * np.pi)


def test_a_record_that_ends_a_rounding_before_the_end_asked_for_is_taken_whole() -> None:
    times = np.append(np.arange(1000) * 1e-3, 1.0 - 5e-12)
    history = hm.TimeHistory("tone", "N m", times, np.sin(2.0 * np.pi * 50.0 * times))
    found = hm.spectrum(history, end=1.0)
    assert abs(found.peaks(1)[0].amplitude - 1.0) < 1e-3


def test_content_at_the_upper_limit_is_reported_as_folded() -> None:
    signal = history(lambda t: np.sin(2.0 * np.pi * 490.0 * t), even(1000))
    assert "folded" in hm.spectrum(signal).status
    assert hm.spectrum(history(lambda t: np.sin(2.0 * np.pi * 49.0 * t), even(1000))).status == "complete"


def test_frequencies_come_in_radians_per_second_and_in_hertz() -> None:
    result = hm.spectrum(history(lambda t: np.sin(300.0 * t), even(1000, 4.0)))
    assert result.peaks(1)[0].frequency == pytest.approx(300.0, rel=1e-4)
    np.testing.assert_allclose(2.0 * np.pi * result.hertz, result.frequency)
    assert result.columns()["frequency [rad/s]"] is result.frequency
    assert "amplitude 0-peak" in next(name for name in result.columns() if "amplitude" in name)


def test_the_spectrum_of_a_run_shows_the_natural_frequency() -> None:
    # two discs J1, J2 on a shaft k, twisted by x0 and let go: x(t) = x0 cos(w t), w = sqrt(k (1/J1 + 1/J2))
    first, second, stiffness, twist = 0.02, 0.05, 800.0, 1e-3
    omega = math.sqrt(stiffness * (1.0 / first + 1.0 / second))
    parts = {"a": hm.Inertia(inertia=first), "shaft": hm.Shaft(stiffness=stiffness), "b": hm.Inertia(inertia=second)}
    scene = hm.Scene(name="oscillator", parts=parts, connections=[("a", "shaft", "b")])
    periods = 20.0 * 2.0 * math.pi / omega
    solver = hm.DormandPrince(relative_tolerance=1e-12, absolute_tolerance=1e-13)
    response = hm.simulate(scene, periods, initial={"a.angle": twist}, solver=solver)
    # Hermite error h^4 w^4/384 of the amplitude, twice through a Hann window; the solver's own is far below
    bound = 2.0 * (np.max(np.diff(response.times)) * omega) ** 4 / 384.0
    result = hm.spectrum(response, "shaft.twist")
    (peak,) = result.peaks(1)
    assert peak.frequency == pytest.approx(omega, rel=bound)
    assert peak.amplitude == pytest.approx(twist, rel=bound)
    assert bound < 1e-6
    assert result.scene == scene


# -- orders -----------------------------------------------------------------------------------------

ACCELERATION = 40.0
"""Angular acceleration of the run-up [rad/s^2]: 20 revolutions in 2.5 s."""


def run_up(count: int = 20000, end: float = 2.6) -> tuple[hm.TimeHistory, hm.TimeHistory]:
    """A shaft from rest, angle = a t^2/2, and a signal of order 2 on it, both with exact slopes."""
    t = np.linspace(0.0, end, count)
    angle, speed = 0.5 * ACCELERATION * t**2, ACCELERATION * t
    shaft = hm.TimeHistory("shaft.angle", "rad", t, angle, speed)
    signal = hm.TimeHistory("signal", "N m", t, 1.0 + 0.7 * np.sin(2.0 * angle), 1.4 * speed * np.cos(2.0 * angle))
    return signal, shaft


def test_order_two_stays_one_sharp_line_while_the_speed_grows_from_zero() -> None:
    signal, shaft = run_up()
    result = hm.order_spectrum(signal, against=shaft)
    # cubic Hermite error h^4/384 max|y''''|; the fourth derivative is led by A (2 w)^4 at the highest speed w
    step, speed = 2.6 / 19999, ACCELERATION * 2.6
    bound = 2.0 * step**4 / 384.0 * 0.7 * (2.0 * speed) ** 4 * 2.0
    line = int(np.argmin(np.abs(result.order - 2.0)))
    assert result.order[line] == pytest.approx(2.0, rel=1e-12)
    assert abs(result.amplitude[line] - 0.7) < bound < 1e-6
    assert result.mean == pytest.approx(1.0, abs=bound)
    assert result.slowest == 0.0
    smeared = hm.spectrum(signal)
    assert smeared.amplitude[1:].max() < 0.35, "over frequency the same signal has no line"


def test_the_span_ends_at_a_whole_revolution_unless_told_otherwise() -> None:
    signal, shaft = run_up()
    # 0.5 * 40 * 2.6^2 / (2 pi) = 21.5 revolutions
    assert hm.order_spectrum(signal, against=shaft).revolutions == 21.0
    rest = hm.order_spectrum(signal, against=shaft, whole_revolutions=False)
    assert rest.revolutions == pytest.approx(0.5 * ACCELERATION * 2.6**2 / (2.0 * math.pi), rel=1e-12)
    assert rest.resolution == pytest.approx(1.0 / rest.revolutions)


def test_a_shaft_that_turns_backwards_has_the_same_orders() -> None:
    signal, shaft = run_up()
    assert shaft.slope is not None
    back = hm.TimeHistory("shaft.angle", "rad", shaft.times, -shaft.values, -shaft.slope)
    forward, backward = hm.order_spectrum(signal, against=shaft), hm.order_spectrum(signal, against=back)
    np.testing.assert_allclose(backward.amplitude, forward.amplitude, atol=1e-12)


def test_orders_are_refused_where_the_shaft_turns_back() -> None:
    t = np.linspace(0.0, 10.0, 2000)
    shaft = hm.TimeHistory("arm.angle", "rad", t, 20.0 * np.sin(t), 20.0 * np.cos(t))
    signal = hm.TimeHistory("signal", "1", t, np.sin(5.0 * t))
    with pytest.raises(hm.AnalysisError, match=r"arm.angle does not run in one direction: .* first at t = 1.571 s and last at t = 7.854 s"):
        hm.order_spectrum(signal, against=shaft)


def test_orders_are_refused_below_one_revolution() -> None:
    signal, shaft = run_up()
    with pytest.raises(hm.AnalysisError, match=r"only 0\.796 revolutions"):
        # 0.5 * 40 * 0.5^2 / (2 pi) = 0.796
        hm.order_spectrum(signal, against=shaft, end=0.5)


def test_the_kinematic_error_of_a_gear_shows_at_its_order_of_the_wave_generator() -> None:
    from models.harmonic_drive_train import build

    scene = build().with_effect(hm.KinematicError(amplitude=1e-4, order=2.0), at="gear.mesh")
    response = hm.simulate(scene, 0.8)
    result = hm.order_spectrum(response, "gear.torque", against="gear.wave_generator", start=0.4)
    strongest = max((peak for peak in result.peaks() if peak.order > 0.5), key=lambda peak: peak.amplitude)
    # one line is 1/9 orders wide here; the line must sit on it
    assert strongest.order == pytest.approx(2.0, abs=0.5 * result.resolution)
    assert result.against == "gear.wave_generator"


# -- bad input --------------------------------------------------------------------------------------


def test_bad_questions_are_refused_with_the_way_out(tmp_path: Path) -> None:
    signal = history(np.sin, even(100))
    with pytest.raises(hm.PlaceError, match=r"No window 'hanning'.*hann"):
        hm.spectrum(signal, window="hanning")
    with pytest.raises(hm.AnalysisError, match="recorded from 0 s to 1 s"):
        hm.spectrum(signal, start=0.5, end=1.5)
    with pytest.raises(hm.AnalysisError, match="3 samples"):
        hm.spectrum(signal, step=1.0 / 3.0)
    with pytest.raises(hm.ParameterError, match="step = -1"):
        hm.spectrum(signal, step=-1.0)
    with pytest.raises(hm.ParameterError, match=r"not 'motor\.speed'"):
        hm.spectrum(signal, "motor.speed")
    with pytest.raises(hm.ParameterError, match="give the angle as a TimeHistory"):
        hm.order_spectrum(signal)


def test_spectra_are_saved_and_loaded_whole(tmp_path: Path) -> None:
    signal, shaft = run_up(4000)
    for result in (hm.spectrum(signal), hm.order_spectrum(signal, against=shaft)):
        copy = hm.load(result.save(tmp_path / "spectrum.npz"))
        assert type(copy) is type(result)
        assert copy.peaks() == result.peaks()  # type: ignore[attr-defined]
        lengths = {len(column) for column in result.columns().values()}
        assert lengths == {len(result.amplitude)}


def test_a_torque_recorded_six_times_a_period_keeps_its_amplitude() -> None:
    # a free oscillator J q'' + k q = 0: torque amplitude k q0 exactly.  Cubic Hermite interpolation with h = T/6 errs by at
    # most (h omega)^4 / 384 = 0.31 % of the amplitude; monotone slopes (PCHIP) flatten the tops by some per cent
    parts = {"disc": hm.Inertia(inertia=1.0), "spring": hm.Shaft(stiffness=(2.0 * np.pi) ** 2)}
    scene = hm.Scene(name="oscillator", parts=parts, connections=[("disc", "spring", "ground")])
    response = hm.simulate(scene, 20.0, initial={"disc.angle": 1e-3}, sample_step=1.0 / 6.0, solver=hm.RungeKutta4(step=1.0 / 600.0))
    expected = 1e-3 * (2.0 * np.pi) ** 2
    (by_law,) = hm.spectrum(response, "spring.torque", end=18.0, step=0.05).peaks(1)
    (by_values,) = hm.spectrum(response["spring.torque"], end=18.0, step=0.05).peaks(1)
    assert by_law.amplitude == pytest.approx(expected, rel=4e-3)
    assert by_values.amplitude < 0.98 * expected
