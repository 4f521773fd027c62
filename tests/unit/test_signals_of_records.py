"""Spectra, orders and orbits of measured records: what their columns hold in closed form, and errors for what they lack."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.errors import AnalysisError, ParameterError, PlaceError

SPEED, TURNS, COUNT = 100.0, 12.0, 12 * 200 + 1
FORWARD, BACKWARD = 3e-5 * np.exp(0.4j), 1e-5 * np.exp(1.0j)
TRACKED = (2.0 * np.pi / 200.0) ** 2 / 8.0 * (abs(FORWARD) + abs(BACKWARD))
"""Between two of 200 samples a turn, joined by monotone cubics, which lie no farther from a circle than its chord does."""
EXACT = 1e-9
"""Of sums over whole turns at the samples themselves, with rounding alone."""


def measured(**columns: Any) -> hm.Record:
    """x + i y = 2e-5 + F exp(i phi) + B exp(-i phi) at a constant speed, the probes under names of a bench."""
    times = np.linspace(0.0, 2.0 * np.pi * TURNS / SPEED, COUNT)
    angle = SPEED * times
    z = 2e-5 + FORWARD * np.exp(1j * angle) + BACKWARD * np.exp(-1j * angle)
    held = {"de_x": ("m", z.real), "de_y": ("m", z.imag), "turn": ("rad", angle), "tacho": ("rad/s", np.full(COUNT, SPEED)), **columns}
    channels = {name: hm.Measurement(name=name, unit=unit, values=values) for name, (unit, values) in held.items()}
    return hm.Record(name="bench", times=times, channels=channels)


@pytest.mark.parametrize("plane", ["de", ("de_x", "de_y"), ["de_x", "de_y"]])
def test_whirl_of_two_probes_is_split_into_forward_and_backward(plane: Any) -> None:
    tracked = hm.order_tracking(measured(), plane, reference="turn")
    assert tracked.two_sided
    np.testing.assert_allclose(tracked.track(1.0, "forward"), FORWARD, atol=TRACKED)
    np.testing.assert_allclose(tracked.track(1.0, "backward"), BACKWARD, atol=TRACKED)
    orbit = hm.orbit(measured(), plane, reference="turn", about="mean")
    # at the samples themselves; sums over whole turns are exact
    assert (orbit.forward, orbit.backward) == pytest.approx((abs(FORWARD), abs(BACKWARD)), rel=1e-6)
    assert orbit.precession == "forward"
    np.testing.assert_allclose(orbit.speed, SPEED, rtol=1e-9)


def test_one_column_is_one_signal() -> None:
    """In x the two circles add up to |F + conj B|, in step with the angle."""
    alone = abs(FORWARD + np.conj(BACKWARD))
    record = measured()
    tracked = hm.order_tracking(record, "de_x", reference=record.history("turn"))
    np.testing.assert_allclose(np.abs(tracked.track(1.0)), alone, rtol=0.0, atol=TRACKED)
    [peak] = hm.spectrum(record, "de_x").peaks(1)
    assert (peak.frequency, peak.amplitude) == pytest.approx((SPEED, alone), rel=EXACT)
    [order] = hm.order_spectrum(record, "de_x", against="turn").peaks(1)
    assert (order.order, order.amplitude) == pytest.approx((1.0, alone), rel=EXACT)


def test_a_column_that_measures_a_channel_of_the_scene_goes_by_both_names() -> None:
    record = measured()
    angle = hm.Measurement(name="turn", unit="rad", values=record["turn"].values, quantity="rotor_1.angle")
    mapped = hm.Record(name="bench", times=record.times, channels={**record.channels, "turn": angle})
    tracked = hm.order_tracking(mapped, "de")  # the only angle of the record
    np.testing.assert_allclose(tracked.track(1.0, "forward"), FORWARD, atol=TRACKED)
    assert tracked.reference == "turn"


def test_waterfall_and_spectrogram_have_both_senses() -> None:
    fall = hm.waterfall(measured(), "de", reference="turn", axis="order", pieces=2, length=5.0)
    for line, circle in ((1.0, FORWARD), (-1.0, BACKWARD)):
        assert fall.amplitude[0, np.argmin(np.abs(fall.lines - line))] == pytest.approx(abs(circle), rel=EXACT)
    assert hm.spectrogram(measured(), ("de_x", "de_y")).two_sided


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (lambda r: hm.order_tracking(r, "de"), ParameterError, "no channel that is known to be the angle of a shaft: give reference="),
        (
            lambda r: hm.order_tracking(r, "de", reference="tacho"),
            ParameterError,
            r"tacho is in rad/s, but turns are counted by an angle \[rad\]",
        ),
        (lambda r: hm.order_tracking(r, "nde", reference="turn"), PlaceError, "'nde'"),
        (lambda r: hm.order_tracking(r, ("de_x", "turn"), reference="turn"), ParameterError, "de_x is in m and turn in rad"),
        (lambda r: hm.order_tracking(r, ("de_x",), reference="turn"), ParameterError, "or the two channels of a plane"),
        (lambda r: hm.spectrum(r), ParameterError, "The record has: de_x, de_y, turn, tacho"),
        (lambda r: hm.spectrum([r], "de_x"), ParameterError, "A list has no signals"),
        (lambda r: hm.orbit(r, "de", reference="turn", centre="mass"), AnalysisError, "centre of mass is unknown"),
        (lambda r: hm.orbit(r, "de", reference="turn", about="static"), AnalysisError, "static deflection is unknown"),
        (lambda r: hm.orbit(r.history("de_x"), "de_x"), ParameterError, "single time history has no plane"),
    ],
)
def test_what_a_record_lacks_is_said(call: Any, error: type[Exception], words: str) -> None:
    with pytest.raises(error, match=words):
        call(measured())
