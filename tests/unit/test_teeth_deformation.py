"""Laws of the neutral fibre: what follows from w, what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.errors import LawError, ParameterError
from hdrive_mbs.teeth.fibre import fibre

W0, R0 = 0.30e-3, 29.3e-3
S = np.linspace(0.0, 2.0 * np.pi, 1001)


def table_of(law: hm.DeformationLaw, count: int = 181) -> hm.TableDeformation:
    angles = np.linspace(0.0, np.pi, count)
    return hm.TableDeformation(angles=tuple(angles), displacements=tuple(law.radial(angles)))


LAWS = {
    "cosine": hm.CosineDeformation(amplitude=W0),
    "three waves": hm.CosineDeformation(amplitude=W0, number_of_waves=3),
    "two rollers": hm.TwoRollerDeformation(amplitude=W0),
    "four forces": hm.FourForceDeformation(amplitude=W0, force_angle=hm.degrees(30.0)),
    "function": hm.FunctionDeformation(function=lambda s: W0 * (np.cos(2.0 * s) + 0.1 * np.sin(4.0 * s) + 0.05 * np.cos(3.0 * s))),
    "table": table_of(hm.FourForceDeformation(amplitude=W0, force_angle=hm.degrees(25.0))),
}


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_the_exact_fibre_keeps_its_length_everywhere(law: hm.DeformationLaw) -> None:
    # rounding of sums over up to 1000 harmonics
    assert np.max(np.abs(fibre(law, R0).stretch(S))) < 1e-12


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_the_first_order_fibre_keeps_its_length_to_second_order(law: hm.DeformationLaw) -> None:
    full, half = (np.max(np.abs(fibre(law.scaled(size), R0, exact=False).stretch(S))) for size in (W0, 0.5 * W0))
    assert full / half == pytest.approx(4.0, rel=1e-3)  # (w' - v)^2/(2 r0^2): four times for twice the w0


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
@pytest.mark.parametrize("exact", [True, False])
def test_the_fibre_closes_after_a_turn(law: hm.DeformationLaw, exact: bool) -> None:
    line = fibre(law, R0, exact)
    for value in (line.radial, line.tangential, line.rotation):
        np.testing.assert_allclose(value(S + 2.0 * np.pi), value(S), rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_rates_are_the_derivatives(law: hm.DeformationLaw) -> None:
    line, h = fibre(law, R0), 1e-4
    for value, rate in (
        (line.radial, lambda s: line.radial(s, 1)),
        (line.tangential, lambda s: line.tangential(s, 1)),
        (line.rotation, line.rotation_rate),
    ):
        differences = (value(S + h) - value(S - h)) / (2.0 * h)
        # h^2/6 f''' for smooth laws; the curvature of a roller law has a corner, its third derivative a jump: error up to h f''/2
        np.testing.assert_allclose(differences, rate(S), rtol=0.0, atol=5e-4 * np.max(np.abs(rate(S))))


def test_the_cosine_law_gives_the_triple_of_the_paper() -> None:
    line = fibre(LAWS["cosine"], R0, exact=False)
    np.testing.assert_allclose(line.radial(S), W0 * np.cos(2.0 * S), atol=1e-17)
    np.testing.assert_allclose(line.tangential(S), -W0 / 2.0 * np.sin(2.0 * S), atol=1e-17)
    np.testing.assert_allclose(line.rotation(S), 1.5 * W0 / R0 * np.sin(2.0 * S), atol=1e-15)


def test_the_closed_fibre_of_the_cosine_law_contracts_by_nine_sixteenths_of_w0_squared_over_r0() -> None:
    contraction = fibre(LAWS["cosine"], R0).w[0].real
    assert contraction == pytest.approx(-9.0 / 16.0 * W0**2 / R0, rel=(W0 / R0) * 2.0)


def test_the_two_roller_law_has_the_series_of_a_thin_ring_under_two_forces() -> None:
    # virtual work with U = EI/(2 r^3) int (w + w'')^2 ds: a_n ~ 1/(n^2 - 1)^2 for even n
    terms = LAWS["two rollers"].harmonics().real
    n = np.arange(2, 41, 2)
    np.testing.assert_allclose(terms[n] / terms[2], 9.0 / (n**2 - 1.0) ** 2, rtol=1e-6)
    assert not np.any(np.abs(terms[1:40:2]) > 1e-12 * W0)
    # Timoshenko: 0.0744 P r^3/EI outwards at the force, 0.0683 inwards beside it
    inwards = LAWS["two rollers"].radial(np.array([np.pi / 2.0]))[0]
    assert inwards / W0 == pytest.approx(-(4.0 / np.pi - 1.0) / (np.pi / 2.0 - 4.0 / np.pi), rel=1e-12)
    assert inwards / W0 == pytest.approx(-0.0683 / 0.0744, abs=1e-3)


@pytest.mark.parametrize("degrees", [0.0, 20.0, 30.0, 40.0])
def test_the_four_force_law_is_the_sum_of_two_pairs_of_forces(degrees: float) -> None:
    b = np.radians(degrees)
    law = hm.FourForceDeformation(amplitude=W0, force_angle=b)
    n = np.arange(2, 41, 2)
    wanted = np.cos(n * b) / (n**2 - 1.0) ** 2
    terms = law.harmonics().real
    np.testing.assert_allclose(terms[n], wanted * terms[2] / wanted[0], atol=1e-9 * W0)
    assert law.on_major_axis == pytest.approx(W0, rel=1e-12)
    assert np.max(law.radial(S)) <= W0 * (1.0 + 1e-9)  # w0 is the largest displacement up to 40.7 degrees
    # between the forces: the form printed in the books
    s = np.linspace(0.0, b, 20)
    A = np.sin(b) + (np.pi / 2.0 - b) * np.cos(b)
    np.testing.assert_allclose(
        law.radial(s), W0 * (A * np.cos(s) + s * np.sin(s) * np.sin(b) - 4.0 / np.pi) / (A - 4.0 / np.pi), atol=1e-15
    )


def test_a_fine_table_of_a_law_gives_the_fibre_of_the_law() -> None:
    law = LAWS["cosine"]
    # cubic spline through 181 points over pi: (pi/180)^4 w''''/384 = 4e-9 w0, its slope (pi/180)^3 w''''/24 = 4e-6 w0
    line, exact = fibre(table_of(law), R0), fibre(law, R0)
    np.testing.assert_allclose(line.radial(S), exact.radial(S), atol=1e-8 * W0)
    np.testing.assert_allclose(line.rotation(S), exact.rotation(S), atol=1e-5 * W0 / R0)


def test_waves_are_counted() -> None:
    assert [law.waves for law in LAWS.values()] == [2, 3, 2, 2, 2, 2]


def test_scaled_laws_have_the_new_displacement_on_the_major_axis() -> None:
    for law in LAWS.values():
        assert law.scaled(0.2e-3).on_major_axis == pytest.approx(0.2e-3, rel=1e-12)


def test_an_unsorted_table_is_refused() -> None:
    angles = np.linspace(0.0, np.pi, 19)
    angles[[5, 6]] = angles[[6, 5]]
    with pytest.raises(ParameterError, match=r"TableDeformation.angles\[6\] = .* does not rise .* sort the table"):
        hm.TableDeformation(angles=tuple(angles), displacements=tuple(W0 * np.cos(2.0 * angles)))


def test_a_table_that_does_not_cover_a_period_is_refused() -> None:
    angles = np.linspace(0.0, 3.0, 19)
    with pytest.raises(ParameterError, match="must run from 0 to pi"):
        hm.TableDeformation(angles=tuple(angles), displacements=tuple(W0 * np.cos(2.0 * angles)))


def test_a_table_that_does_not_end_as_it_began_is_refused() -> None:
    angles = np.linspace(0.0, np.pi, 19)
    with pytest.raises(ParameterError, match="after a period w must be what it was"):
        hm.TableDeformation(angles=tuple(angles), displacements=tuple(W0 * np.cos(1.9 * angles)))


@pytest.mark.parametrize(
    ("function", "words"),
    [
        (lambda s: W0 * np.cos(2.0 * s) + 0.05e-3, "the mean of w over a turn is 0.05 mm"),
        (lambda s: W0 * np.cos(1.5 * s), "not the same after a turn"),
        (lambda s: 0.0 * s, "zero everywhere"),
        (lambda s: W0 / np.cos(2.0 * s - np.pi / 2.0 + np.pi / 2.0) * np.where(s == 0.0, np.nan, 1.0), "finite"),
        (lambda s: 1.0, "array"),
        (lambda s: W0 * math.cos(2.0 * s), "Use numpy functions: np.cos"),
        (lambda s: W0 * np.cos(s), "one wave around the circumference"),
        (lambda s: -W0 * np.cos(2.0 * s), "highest 90 deg .* s counts from the major axis"),
        (lambda s: W0 * np.cos(2.0 * s - 0.3), "highest 8.59 deg after s = 0"),
    ],
)
def test_a_function_that_a_fibre_cannot_follow_is_refused(function: object, words: str) -> None:
    with pytest.raises(LawError, match=words):
        hm.FunctionDeformation(function=function)  # type: ignore[arg-type]


def test_half_a_wave_is_refused() -> None:
    with pytest.raises(ParameterError, match="whole number"):
        hm.CosineDeformation(amplitude=W0, number_of_waves=2.5)  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match="at most"):
        hm.FourForceDeformation(amplitude=W0, force_angle=hm.degrees(44.0))


def test_a_law_that_is_not_positive_on_the_major_axis_is_not_scaled() -> None:
    law = hm.FunctionDeformation(function=lambda s: W0 * (np.cos(2.0 * s) - 0.6 * np.cos(4.0 * s) - 0.5 * np.cos(6.0 * s)))
    with pytest.raises(ParameterError, match="must be positive there"):
        law.scaled(0.2e-3)


def test_a_law_whose_wave_is_a_little_off_the_axis_is_taken() -> None:
    assert hm.FunctionDeformation(function=lambda s: W0 * np.cos(2.0 * (s - np.radians(4.0)))).waves == 2


def test_a_fibre_that_would_have_to_fold_is_refused() -> None:
    # dw/ds - v reaches about 100 w0 = 30 mm, more than r0
    law = hm.FunctionDeformation(function=lambda s: W0 * (np.cos(2.0 * s) + 0.99 * np.sin(100.0 * s)))
    with pytest.raises(LawError, match=r"r0 = 29.3 mm.* stand upright or fold"):
        fibre(law, R0)
