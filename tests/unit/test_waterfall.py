"""Waterfalls and spectrograms of signals whose amplitudes are known."""

from __future__ import annotations

import functools
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

import hdrive_mbs as hm
from tests.unit.picture_checks import assert_nothing_is_cut_off, figure_of, written
from tests.unit.rotor_scenes import CRITICAL, constant, jeffcott, made

TURN = 2.0 * np.pi
ACCELERATION = 50.0
"""Angular acceleration of the made runs [rad/s^2]."""


def chirp(sense: float = 1.0, end: float = 10.0, start: float = 100.0) -> hm.Response:
    """From 100 rad/s on: x + i y = 3 exp(i phi) + 1 exp(-i phi) + 0.5 exp(400 i t), in um."""
    t = np.linspace(0.0, end, 40001)
    phi, w = sense * (start * t + 0.5 * ACCELERATION * t**2), sense * (start + ACCELERATION * t)
    tone = np.exp(400j * t)
    z = 1e-6 * (3.0 * np.exp(1j * phi) + np.exp(-1j * phi) + 0.5 * tone)
    rate = 1e-6 * (1j * w * (3.0 * np.exp(1j * phi) - np.exp(-1j * phi)) + 200j * tone)
    return made(t, phi, w, z, rate)


# -- over speed -------------------------------------------------------------------------------------


def test_orders_move_and_a_tone_stands_still_on_an_axis_of_frequency() -> None:
    result = hm.waterfall(chirp(), "disc", pieces=30)
    assert result.two_sided
    assert np.all(np.diff(result.speeds) > 0.0)
    apart = (np.abs(result.speeds - 400.0) > 4.0 * result.resolution) & (result.speeds > 4.0 * result.resolution)
    # what the change of speed within a piece leaves is known: 0.9 % less here; zero padding adds 1 % at most
    assert result.kept.min() > 0.98
    np.testing.assert_allclose(result.along(1.0)[apart], (3e-6 * result.kept)[apart], rtol=0.01)
    np.testing.assert_allclose(result.along(-1.0)[apart], (1e-6 * result.kept)[apart], rtol=0.015)
    line = int(np.argmin(np.abs(result.lines - 400.0)))
    np.testing.assert_allclose(result.amplitude[apart, line], 0.5e-6, rtol=0.02)


def test_long_pieces_smear_order_one_and_the_result_says_by_how_much() -> None:
    result = hm.waterfall(chirp(), "disc", pieces=20, length=1.0)
    assert "order 1 reads up to" in result.status
    middle = (np.abs(result.speeds - 400.0) > 60.0) & (result.speeds > 200.0)
    assert result.kept[middle].max() < 0.75
    np.testing.assert_allclose(result.along(1.0, width=0.2)[middle], (3e-6 * result.kept)[middle], rtol=0.05)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_on_an_axis_of_orders_the_amplitude_is_whole_and_forward_is_positive(sense: float) -> None:
    result = hm.waterfall(chirp(sense), "disc", axis="order", pieces=20, length=16.0)
    np.testing.assert_array_equal(result.kept, 1.0)
    one, back = (int(np.argmin(np.abs(result.lines - order))) for order in (1.0, -1.0))
    assert result.lines[one] == pytest.approx(1.0, abs=1e-12)
    # where the tone, order 400/w, stays out of the Hann window's lobes of order 1 and -1
    away = np.abs(np.abs(400.0 / result.speeds) - 1.0) > 4.0 * result.resolution
    assert away.sum() > 8
    np.testing.assert_allclose(result.amplitude[away, one], 3e-6, rtol=5e-3)
    np.testing.assert_allclose(result.amplitude[away, back], 1e-6, rtol=1e-2)


def test_a_single_channel_has_a_one_sided_spectrum() -> None:
    result = hm.waterfall(chirp(), "disc.x", axis="order", pieces=10)
    # x = (3 + 1) cos(phi) + 0.5 cos(400 t)
    away = np.abs(400.0 / result.speeds - 1.0) > 4.0 * result.resolution
    np.testing.assert_allclose(result.along(1.0)[away], 4e-6, rtol=1e-2)
    assert result.lines[0] == 0.0


def test_the_mean_stands_at_line_0_and_does_not_leak() -> None:
    # 5 + sin(60 t) in an uneven number of periods: the weighted mean is 5 within the side lobe of the tone
    t = np.linspace(0.0, 10.0, 20001)
    signal = hm.TimeHistory("signal", "N", t, 5.0 + np.sin(60.0 * t), 60.0 * np.cos(60.0 * t))
    result = hm.spectrogram(signal, length=1.03)
    zero = int(np.argmin(np.abs(result.frequency)))
    np.testing.assert_allclose(result.amplitude[:, zero], 5.0, atol=2e-3)
    low = (np.abs(result.frequency) > 0.0) & (np.abs(result.frequency) < 3.0 * result.resolution)
    assert result.amplitude[:, low].max() < 5e-3
    near = np.abs(result.frequency - 60.0) < result.resolution
    np.testing.assert_allclose(result.amplitude[:, near].max(axis=1), 1.0, rtol=1e-2)


def test_a_coast_down_has_ascending_speeds_too() -> None:
    run = hm.coast_down(jeffcott().with_effect(hm.ViscousDrag(coefficient=0.02), at="disc"), 1.0, initial_speed=600.0)
    result = hm.waterfall(run, "disc", axis="order", pieces=40, length=3.0)
    assert np.all(np.diff(result.speeds) > 0.0)
    assert np.all(np.diff(result.times) < 0.0)
    # three revolutions at 290 rad/s and -580 rad/s^2 take 38 rad/s
    assert result.speeds[int(np.argmax(result.along(1.0)))] == pytest.approx(run.peak_speed["disc"], abs=38.0)


@functools.cache
def run_up() -> hm.RunUp:
    return hm.run_up(jeffcott(), 1.2)


def test_a_run_up_shows_its_resonance_on_the_line_of_order_one_and_free_whirl_above_it() -> None:
    result = hm.waterfall(run_up(), "disc")
    top = int(np.argmax(result.along(1.0)))
    assert result.speeds[top] == pytest.approx(run_up().peak_speed["disc"], abs=25.0)
    assert result.along(-1.0).max() < 0.02 * result.along(1.0).max(), "a symmetric support has no backward whirl"
    # at 500 rad/s and more the free whirl has split from order 1 and stands at the natural frequency
    late = result.amplitude[-1]
    below = result.lines < 400.0
    assert result.lines[below][int(np.argmax(late[below]))] == pytest.approx(CRITICAL, abs=result.resolution)


def test_a_shaft_that_stands_still_at_first_is_followed_from_where_it_turns() -> None:
    t = np.linspace(0.0, 4.0, 8001)
    w = ACCELERATION * np.maximum(t - 1.0, 0.0)
    phi = 0.5 * ACCELERATION * np.maximum(t - 1.0, 0.0) ** 2
    result = hm.waterfall(made(t, phi, w, 1e-6 * np.exp(1j * phi), 1e-6j * w * np.exp(1j * phi)), "disc", axis="order", length=2.0)
    assert result.settings["start"] == pytest.approx(1.0, abs=1e-3)
    np.testing.assert_allclose(result.along(1.0), 1e-6, rtol=1e-3)


# -- over time --------------------------------------------------------------------------------------


def test_a_spectrogram_follows_a_tone_that_comes_and_goes() -> None:
    t = np.linspace(0.0, 4.0, 16001)
    on = (t > 1.0) & (t < 3.0)
    signal = hm.TimeHistory("signal", "m", t, np.where(on, 2.0 * np.sin(TURN * 80.0 * t), 0.0))
    result = hm.spectrogram(signal, length=0.25, overlap=0.5)
    line = int(np.argmin(np.abs(result.frequency - TURN * 80.0)))
    inside = (result.times > 1.2) & (result.times < 2.8)
    np.testing.assert_allclose(result.amplitude[inside, line], 2.0, rtol=1e-2)
    outside = (result.times < 0.8) | (result.times > 3.2)
    assert result.amplitude[outside].max() < 1e-6
    assert np.diff(result.times) == pytest.approx(0.125, rel=1e-9)


def test_a_place_has_both_senses_in_its_spectrogram() -> None:
    result = hm.spectrogram(chirp(end=2.0, start=300.0), "disc", length=0.2)
    assert result.two_sided
    assert result.frequency[0] < 0.0 < result.frequency[-1]
    # the speed is 300 + 50 t: at t = 1 s 350 rad/s, forward 3 um, backward 1 um (and the tone at 400 rad/s within the lobe)
    k = int(np.argmin(np.abs(result.times - 1.0)))
    negative = result.frequency < 0.0
    assert result.amplitude[k, negative].max() == pytest.approx(1e-6, rel=0.02)
    assert result.frequency[negative][int(np.argmax(result.amplitude[k, negative]))] == pytest.approx(-350.0, abs=0.5 * result.resolution)


# -- results and pictures ---------------------------------------------------------------------------


def test_results_are_saved_and_written_as_tables(tmp_path: Path) -> None:
    for kind, result in (
        (hm.Waterfall, hm.waterfall(chirp(), "disc", pieces=5)),
        (hm.Spectrogram, hm.spectrogram(chirp(), "disc.x", length=2.0)),
    ):
        again = kind.load(result.save(tmp_path / "r.npz"))
        np.testing.assert_array_equal(again.amplitude, result.amplitude)
        head, *rows = result.to_csv(tmp_path / "r.csv").read_text().splitlines()
        assert "amplitude 0-peak [m]" in head
        assert len(rows) == result.amplitude.size


PICTURES = {
    "lines": lambda: hm.plot(hm.waterfall(run_up(), "disc")),
    "one-sided lines": lambda: hm.plot(hm.waterfall(run_up(), "disc.x"), orders=(1.0,)),
    "map": lambda: hm.plot(hm.waterfall(run_up(), "disc"), kind="map"),
    "orders": lambda: hm.plot(hm.waterfall(run_up(), "disc", axis="order"), highest=3.0),
    "spectrogram": lambda: hm.plot(hm.spectrogram(run_up(), "disc")),
}


@pytest.mark.parametrize("name", PICTURES)
def test_the_picture_names_quantities_units_and_0_peak_and_cuts_nothing_off(name: str, tmp_path: Path) -> None:
    ax = PICTURES[name]()
    for label in (ax.get_xlabel(), ax.get_ylabel()):
        assert label.endswith("]"), label
    assert any("0-peak" in text for text in written(ax))
    assert_nothing_is_cut_off(ax)
    png, svg = hm.save_figure(ax, tmp_path / "picture")
    assert png.stat().st_size > 5000
    assert svg.stat().st_size < 1_500_000


def test_axes_of_the_caller_are_drawn_on() -> None:
    for result in (hm.waterfall(chirp(), "disc", pieces=5), hm.spectrogram(chirp(), "disc", length=2.0)):
        own = Figure().add_subplot()
        assert hm.plot(result, ax=own) is own
        assert len(figure_of(own).axes) == 1


def test_bad_questions_are_refused_with_the_way_out() -> None:
    run = chirp()
    with pytest.raises(hm.ParameterError, match="axis = 'angle': must be one of frequency, order"):
        hm.waterfall(run, "disc", axis="angle")
    with pytest.raises(hm.ParameterError, match="pieces = 1: must be at least 2"):
        hm.waterfall(run, "disc", pieces=1)
    with pytest.raises(hm.ParameterError, match=r"length = 20 s: must be greater than 0 and at most the span of 10 s"):
        hm.waterfall(run, "disc", length=20.0)
    with pytest.raises(hm.ParameterError, match="overlap = 1"):
        hm.spectrogram(run, "disc", overlap=1.0)
    with pytest.raises(hm.AnalysisError, match="too few for a spectrum"):
        hm.spectrogram(run, "disc", length=1e-3)
    with pytest.raises(hm.ParameterError, match="a single time history has no shaft"):
        hm.waterfall(run["disc.x"])
    with pytest.raises(hm.ParameterError, match="kind = 'fan'"):
        hm.plot(hm.waterfall(run, "disc", pieces=5), kind="fan")


def test_a_history_of_its_own_takes_its_shaft_as_a_history() -> None:
    run = chirp()
    result = hm.waterfall(run["disc.x"], reference=run["disc.angle"], axis="order", pieces=6)
    assert result.along(1.0)[-1] == pytest.approx(4e-6, rel=1e-2)


def test_the_other_way_round_the_run_looks_the_same() -> None:
    back = hm.waterfall(hm.run_up(jeffcott(constant(-5.0)), 1.2), "disc")
    there = hm.waterfall(run_up(), "disc")
    np.testing.assert_allclose(back.along(1.0), there.along(1.0), rtol=1e-6)
