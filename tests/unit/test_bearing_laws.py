"""Bearing laws one by one: against closed forms, published numbers and integrals done another way."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import beta

from hdrive_mbs.bearings.ball import BallBearing
from hdrive_mbs.bearings.friction import WithFriction
from hdrive_mbs.bearings.hertz import deflection_factor, groove_stiffness, in_series, point_contact_stiffness, reduced_modulus
from hdrive_mbs.bearings.journal import JournalBearing
from hdrive_mbs.bearings.law import BearingLaw, RelativeMotion
from hdrive_mbs.bearings.linear import LinearBearing
from hdrive_mbs.bearings.power import PowerBearing
from hdrive_mbs.bearings.speed_table import TableBearing
from hdrive_mbs.conversions import rpm
from hdrive_mbs.errors import AnalysisError, KeywordError, LawError, ParameterError
from hdrive_mbs.expression import Value, derivative, evaluate, record, variable
from hdrive_mbs.quantities import parameter

NAMES = [field.name for field in fields(RelativeMotion)]


def motion(**values: Value) -> RelativeMotion:
    return RelativeMotion(**(dict.fromkeys(NAMES, 0.0) | values))


def forces(law: BearingLaw, *directions: str, **values: Value) -> np.ndarray:
    total = law.total_forces(motion(**values))
    return np.array([total[name] for name in directions or ("x", "y")])


# -- linear ---------------------------------------------------------------------------------------


def test_a_linear_bearing_is_its_matrices() -> None:
    rng = np.random.default_rng(1)
    stiffness, damping = np.zeros((2, 6, 6))
    stiffness[:5, :5], damping[:5, :5] = rng.normal(size=(5, 5)), rng.normal(size=(5, 5))
    law = LinearBearing.from_matrices(stiffness=stiffness, damping=damping)
    np.testing.assert_array_equal(law.stiffness_matrix(), stiffness)
    np.testing.assert_array_equal(law.damping_matrix(), damping)
    place, rate = rng.normal(size=(2, 5))
    names = ("x", "y", "z", "psi", "theta")
    values = dict(zip((*names, "vx", "vy", "vz", "psi_rate", "theta_rate"), (*place, *rate), strict=True))
    np.testing.assert_allclose(forces(law, *names, **values), stiffness[:5, :5] @ place + damping[:5, :5] @ rate, rtol=1e-13)


def test_fields_and_matrices_make_the_same_bearing() -> None:
    law = LinearBearing(
        stiffness_xx=1e7, stiffness_yy=2e7, stiffness_xy=3e6, stiffness_yx=-3e6, stiffness_zz=4e6, stiffness_psi=5e3, stiffness_theta=6e3
    )
    same = LinearBearing.from_matrices(stiffness=law.stiffness_matrix(), damping=np.zeros((6, 6)))
    assert same.replacing(damping_xx=None, damping_yy=None) == law
    isotropic = LinearBearing.isotropic(radial=1e7, damping=100.0, axial=2e6, axial_damping=3.0, tilt=4e3, tilt_damping=5.0)
    np.testing.assert_array_equal(np.diag(isotropic.stiffness_matrix()), [1e7, 1e7, 2e6, 4e3, 4e3, 0.0])
    np.testing.assert_array_equal(np.diag(isotropic.damping_matrix()), [100.0, 100.0, 3.0, 5.0, 5.0, 0.0])


@pytest.mark.parametrize("prefix", ["stiffness", "damping"])
@pytest.mark.parametrize(("given", "missing"), [("xy", "yx"), ("yx", "xy"), ("psi", "theta")])
def test_half_of_a_pair_of_coefficients_is_refused(prefix: str, given: str, missing: str) -> None:
    with pytest.raises(ParameterError, match=rf"LinearBearing\.{prefix}_{given} is given without {prefix}_{missing}.*Give both"):
        LinearBearing(stiffness_xx=1e7, stiffness_yy=1e7, **{f"{prefix}_{given}": 1e3})


def test_cross_stiffness_alone_names_the_ways_out() -> None:
    with pytest.raises(ParameterError, match=r"stiffness_yx = -stiffness_xy.*0 where the other direction does not couple"):
        LinearBearing(stiffness_xx=1e7, stiffness_yy=1e7, stiffness_xy=1e6)
    one_way = LinearBearing(stiffness_xx=1e7, stiffness_yy=1e7, stiffness_xy=1e6, stiffness_yx=0.0)
    assert one_way.stiffness_matrix()[0, 1] == 1e6
    with pytest.raises(ParameterError, match="damping_xx is given without damping_yy"):
        LinearBearing(stiffness_xx=1e7, stiffness_yy=1e7, damping_xx=1e3)


def test_matrices_of_another_shape_or_that_hold_the_spin_are_refused() -> None:
    zero = np.zeros((6, 6))
    holds_spin = np.diag([1.0, 1.0, 1.0, 1.0, 1.0, 1.0])
    for bad, text in (
        (np.zeros((5, 5)), r"shape \(5, 5\); it must be \(6, 6\)"),
        (np.full((6, 6), np.nan), "not finite"),
        (holds_spin, "phi .* must be zero"),
        ("stiff", "must be a 6x6 matrix"),
    ):
        with pytest.raises(ParameterError, match=f"LinearBearing.from_matrices: stiffness.*{text}"):
            LinearBearing.from_matrices(stiffness=bad, damping=zero)  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match=r"stiffness_couplings has 4 values; it must have 36"):
        LinearBearing(stiffness_xx=1.0, stiffness_yy=1.0, stiffness_couplings=(1.0, 0.0, 0.0, 1.0))
    with pytest.raises(ParameterError, match=r"row 0, column 0: this entry belongs in stiffness_xx"):
        LinearBearing(stiffness_xx=1.0, stiffness_yy=1.0, stiffness_couplings=(1.0,) + 35 * (0.0,))
    with pytest.raises(KeywordError, match="No field 'kxx'"):
        LinearBearing(kxx=1.0)


# -- power ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("exponent", [3, 5, 7])
def test_the_power_part_is_odd_and_takes_each_displacement_by_itself(exponent: int) -> None:
    rng = np.random.default_rng(2)
    power = np.zeros((6, 6))
    power[:5, :5] = rng.normal(size=(5, 5))
    linear = np.diag([2.0, 3.0, 4.0, 5.0, 6.0, 0.0])
    law = PowerBearing.from_matrices(stiffness=linear, damping=np.zeros((6, 6)), power_stiffness=power, exponent=exponent)
    place = rng.uniform(-2.0, 2.0, (5, 30))
    names = ("x", "y", "z", "psi", "theta")
    moved = dict(zip(names, place, strict=True))
    # sign(d) |d|^n is d^n for odd n and needs no power of a negative number
    expected = linear[:5, :5] @ place + power[:5, :5] @ (np.sign(place) * np.abs(place) ** exponent)
    np.testing.assert_allclose(forces(law, *names, **moved), expected, rtol=1e-12, atol=1e-11)


def test_a_cubic_bearing_in_numbers() -> None:
    law = PowerBearing.isotropic(radial=1e7, damping=50.0, power_radial=1e17)
    # 1e7 * (-2e-5) + 1e17 * (-2e-5)^3 + 50 * 0.1 = -200 - 800 + 5 N
    np.testing.assert_allclose(forces(law, "x", "y", x=-2e-5, vx=0.1), [-995.0, 0.0], rtol=1e-12)
    # where it carries 1000 N, K = k + 3 k_n d^2 = 1e7 + 3e17 * 4e-10
    np.testing.assert_allclose(law.static_position(load=(-1000.0, 0.0), speed=0.0)[:2], [-2e-5, 0.0], rtol=1e-12, atol=1e-20)
    assert law.linearised(load=(-1000.0, 0.0), speed=0.0).stiffness_xx == pytest.approx(1.3e8, rel=1e-12)


@pytest.mark.parametrize(("exponent", "text"), [(4.0, "is even"), (3.5, "not a whole number"), (1.0, "at least 3"), (2.0, "at least 3")])
def test_a_power_that_is_not_odd_is_refused(exponent: float, text: str) -> None:
    with pytest.raises(ParameterError, match=rf"PowerBearing\.exponent = {exponent:g}.*{text}"):
        PowerBearing.isotropic(radial=1e7, damping=0.0, power_radial=1e17, exponent=exponent)


def test_cross_coupled_power_stiffness_alone_is_refused() -> None:
    with pytest.raises(ParameterError, match="power_stiffness_xy is given without power_stiffness_yx"):
        PowerBearing(stiffness_xx=1.0, stiffness_yy=1.0, power_stiffness_xx=1.0, power_stiffness_yy=1.0, power_stiffness_xy=1.0)


# -- speed table ----------------------------------------------------------------------------------

TABLE = TableBearing(
    speeds=(100.0, 200.0, 400.0),
    stiffness_xx=(1e7, 2e7, 6e7),
    stiffness_yy=(3e7, 3e7, 3e7),
    stiffness_xy=(1e6, 2e6, 4e6),
    stiffness_yx=(-2e6, -4e6, -8e6),
    damping_xx=(100.0, 200.0, 400.0),
    damping_yy=(300.0, 300.0, 300.0),
    damping_xy=(10.0, 20.0, 40.0),
    damping_yx=(10.0, 20.0, 40.0),
)


def test_the_table_is_straight_between_its_points_and_constant_beyond() -> None:
    # at 300 rad/s half way between 200 and 400
    np.testing.assert_allclose(forces(TABLE, x=1e-6, speed=300.0), [40.0, -6.0], rtol=1e-12)
    np.testing.assert_allclose(forces(TABLE, vy=0.1, speed=300.0), [3.0, 30.0], rtol=1e-12)
    np.testing.assert_allclose(forces(TABLE, x=1e-6, speed=np.array([0.0, 50.0, 100.0]))[0], 10.0, rtol=1e-12)
    np.testing.assert_allclose(forces(TABLE, x=1e-6, speed=np.array([400.0, 1e4]))[0], 60.0, rtol=1e-12)


def test_turning_the_other_way_the_table_bearing_is_its_mirror_image() -> None:
    rng = np.random.default_rng(3)
    x, y, vx, vy = rng.normal(size=(4, 20))
    fx, fy = forces(TABLE, x=x, y=y, vx=vx, vy=vy, speed=250.0)
    # seen in a mirror in which x changes sign
    np.testing.assert_allclose(forces(TABLE, x=-x, y=y, vx=-vx, vy=vy, speed=-250.0), [-fx, fy], rtol=1e-12)


def test_a_film_bearing_can_be_tabulated_over_speed() -> None:
    film = JournalBearing(diameter=0.1, length=0.03, radial_clearance=1e-4, viscosity=0.1)
    law = TableBearing.tabulated(film, load=(0.0, -525.0), speeds=(50.0, 100.0, 200.0), axial_stiffness=1e6)
    linear = film.linearised(load=(0.0, -525.0), speed=100.0)
    for name, value in (("x", 1e-6), ("y", 1e-6), ("vx", 1e-3), ("vy", 1e-3)):
        np.testing.assert_allclose(forces(law, speed=100.0, **{name: value}), forces(linear, **{name: value}), rtol=1e-12)
    assert law.stiffness_matrix()[2, 2] == 1e6


def test_bad_tables_are_refused() -> None:
    good = {"speeds": (0.0, 1.0, 2.0), "stiffness_xx": (1.0, 1.0, 1.0), "stiffness_yy": (1.0, 1.0, 1.0)}
    for change, text in (
        ({"speeds": (0.0, 2.0, 2.0)}, r"speeds\[2\] = 2 rad/s does not rise above"),
        ({"speeds": (-1.0, 1.0, 2.0)}, r"speeds\[0\] = -1 rad/s: must be at least 0"),
        ({"speeds": (0.0, 1.0)}, "has 2 speeds and 3 stiffness_xx; it needs the same number"),
        ({"speeds": (1.0,), "stiffness_xx": (1.0,), "stiffness_yy": (1.0,)}, "at least 2"),
        ({"stiffness_xy": (1.0, 1.0, 1.0)}, "stiffness_xy is given without stiffness_yx"),
        ({"damping_xx": (1.0, 1.0, 1.0)}, "damping_xx is given without damping_yy"),
        ({"damping_xx": (1.0, 1.0), "damping_yy": (1.0, 1.0, 1.0)}, "3 speeds and 2 damping_xx"),
    ):
        with pytest.raises(ParameterError, match=f"TableBearing.*{text}"):
            TableBearing(**{**good, **change})


# -- Hertz ----------------------------------------------------------------------------------------


def test_balls_and_planes_have_the_stiffness_of_the_closed_form() -> None:
    modulus = reduced_modulus(2.08e11, 0.3)
    plane = point_contact_stiffness((200.0, 200.0, 0.0, 0.0))
    assert plane == pytest.approx(4.0 / 3.0 * modulus * math.sqrt(1.0 / 200.0), rel=1e-14)
    spheres = point_contact_stiffness((200.0, 200.0, 300.0, 300.0))
    assert spheres == pytest.approx(4.0 / 3.0 * modulus * math.sqrt(1.0 / 500.0), rel=1e-14)


@pytest.mark.parametrize(
    ("difference", "factor"),
    [(0.1075, 0.9974), (0.5916, 0.9077), (0.7948, 0.7961), (0.90999, 0.6636), (0.95738, 0.5551), (0.990902, 0.3745), (0.9989156, 0.2106)],
)
def test_elliptic_contacts_have_the_deflection_of_the_published_table(difference: float, factor: float) -> None:
    # Harris, Rolling Bearing Analysis, 4th ed., Table 6.1 (F(rho), delta*), printed to 4 digits: 1e-4 is the rounding of both columns
    assert deflection_factor(difference) == pytest.approx(factor, abs=1e-4)


@pytest.mark.parametrize("curvatures", [(210.0, 210.0, -150.0, 60.0), (210.0, 210.0, -202.0, 110.0), (100.0, 300.0, 50.0, 80.0)])
def test_elliptic_contacts_agree_with_the_integrals_of_the_potential(curvatures: tuple[float, float, float, float]) -> None:
    """delta = q I_0, A = q I_a, B = q I_b with q = 3 Q/(4 pi E*), I_0 = int ds/D, I_a = int ds/((a^2 + s) D) and
    D = sqrt((a^2 + s)(b^2 + s) s): the potential of an ellipsoidal pressure (Hertz 1881), with A, B half the sums of curvatures."""
    first, second = sorted((0.5 * (curvatures[0] + curvatures[2]), 0.5 * (curvatures[1] + curvatures[3])))

    def integral(a: float, b: float, extra: float) -> float:
        # s = a b tan(t)^2, ds/sqrt(s) = 2 sqrt(a b) dt/cos(t)^2
        def of(t: float) -> float:
            s = a * b * math.tan(t) ** 2
            return 2.0 * math.sqrt(a * b) / math.cos(t) ** 2 / math.sqrt((a * a + s) * (b * b + s)) / (1.0 if extra == 0.0 else extra + s)

        return float(quad(of, 0.0, math.pi / 2.0, epsabs=0.0, epsrel=1e-12, limit=200)[0])

    def mismatch(ratio: float) -> float:
        return integral(ratio, 1.0, ratio**2) / integral(ratio, 1.0, 1.0) - first / second

    ratio = float(brentq(mismatch, 1.0 + 1e-9, 100.0, xtol=1e-13))
    # with b = 1 m the load parameter follows from A; lengths scale with 1/curvature
    per_curvature = first / integral(ratio, 1.0, ratio**2)
    deflection = per_curvature * integral(ratio, 1.0, 0.0)
    load = per_curvature * 4.0 * math.pi * reduced_modulus(2.08e11, 0.3) / 3.0
    assert point_contact_stiffness(curvatures) == pytest.approx(load / deflection**1.5, rel=1e-9)


def test_the_groove_of_a_published_bearing_has_its_curvatures() -> None:
    """Harris's 209 bearing: d = 12.7 mm, D = 65 mm, f = 0.52; sums of curvatures 0.202 and 0.138 1/mm, differences 0.9399 and 0.9120."""
    modulus = reduced_modulus(2.08e11, 0.3)
    for inner, total, difference in ((True, 202.0, 0.9399), (False, 138.0, 0.9120)):
        expected = 4.0 * math.sqrt(2.0) / 3.0 * modulus * deflection_factor(difference) ** -1.5 / math.sqrt(total)
        # the printed sums are good to 0.5 in 138
        assert groove_stiffness(12.7e-3, 65e-3, 0.52, inner, 2.08e11, 0.3) == pytest.approx(expected, rel=2e-3)


def test_contacts_in_series_add_their_deflections() -> None:
    both = in_series(2e10, 3e10)
    deflection = (500.0 / 2e10) ** (2 / 3) + (500.0 / 3e10) ** (2 / 3)
    assert both * deflection**1.5 == pytest.approx(500.0, rel=1e-13)


def test_contacts_that_are_none_are_refused() -> None:
    with pytest.raises(ParameterError, match=r"sum of curvatures = -10 1/m: must be greater than 0"):
        point_contact_stiffness((100.0, 100.0, -210.0, 0.0))
    with pytest.raises(ParameterError, match=r"curvature difference F = 1: .*line contact"):
        deflection_factor(1.0)


# -- ball bearing ---------------------------------------------------------------------------------

SKF_6205 = BallBearing.from_geometry(
    balls=9, ball_diameter=7.94e-3, pitch_diameter=39.04e-3, inner_conformity=0.52, outer_conformity=0.52, radial_clearance=5e-6
)
LOADED = {"x": 1.3e-5, "y": -9e-6}


def test_ball_pass_frequencies_of_a_measured_bearing() -> None:
    # Case Western Reserve University, Bearing Data Center, SKF 6205-2RS: 3.5848, 5.4152 and 0.39828 times the speed
    # (the third is not quite a ninth of the first: they were rounded on the way)
    assert SKF_6205.ball_pass_outer(1.0) == pytest.approx(3.5848, abs=1e-4)
    assert SKF_6205.ball_pass_inner(1.0) == pytest.approx(5.4152, abs=1e-4)
    assert SKF_6205.cage_frequency(1.0) == pytest.approx(0.39828, abs=5e-5)


def test_the_ball_pass_frequency_is_the_one_seen_in_the_force() -> None:
    speed, periods = 200.0, 16
    time = np.arange(4096) / 4096 * periods * 2.0 * np.pi / SKF_6205.ball_pass_outer(speed)
    force = forces(SKF_6205, **LOADED, angle=speed * time, speed=speed)
    for series in force:
        spectrum = np.abs(np.fft.rfft(series - series.mean()))
        assert np.argmax(spectrum) == periods
        assert np.max(np.delete(spectrum, np.arange(periods, 2049, periods))) < 1e-9 * spectrum[periods]


def test_inside_the_clearance_no_ball_pushes_and_outside_none_pulls() -> None:
    turn = np.linspace(0.0, 2.0 * np.pi, 200)
    assert not forces(SKF_6205, "x", "y", "phi", x=4.99e-6 * np.cos(turn), y=4.99e-6 * np.sin(turn)).any()
    fast = SKF_6205.replacing(contact_damping=100.0)
    rng = np.random.default_rng(4)
    x, y, vx, vy = rng.normal(size=(4, 500)) * np.array([[2e-5], [2e-5], [0.05], [0.05]])
    pushes = np.array(fast.ball_forces(motion(x=x, y=y, vx=vx, vy=vy)))
    assert pushes.min() == 0.0
    assert pushes.max() > 100.0


def test_without_clearance_the_heaviest_ball_carries_what_stribeck_says() -> None:
    """Q_max Z/F = 1/J, J = (1/2 pi) int cos(a)^2.5 da over the loaded half = B(7/4, 1/2)/(2 pi), so 4.37 (Stribeck; Harris ch. 7)."""
    law = BallBearing(balls=300, contact_stiffness=1e10, ball_diameter=1e-4, pitch_diameter=40e-3)
    position = law.static_position(load=(1000.0, 0.0), speed=0.0)
    heaviest = max(law.ball_forces(motion(x=position[0], y=position[1])))
    stribeck = 2.0 * math.pi / float(beta(1.75, 0.5))
    assert stribeck == pytest.approx(4.37, abs=5e-3)
    # a sum over 300 balls in place of the integral, (2 pi/300)^3.5 at the ends of the loaded half
    assert heaviest * 300 / 1000.0 == pytest.approx(stribeck, rel=1e-5)


def test_the_elastic_forces_are_the_slopes_of_their_energy_also_about_the_axis() -> None:
    law = SKF_6205
    moved = {"x": variable("x"), "y": variable("y"), "angle": variable("angle")}
    energy = record(law.elastic_energy(motion(**moved)))
    values = {**LOADED, "angle": 0.7}
    slopes = [evaluate(derivative(energy, name), values) for name in ("x", "y", "angle")]
    np.testing.assert_allclose(slopes, forces(law, "x", "y", "phi", **values), rtol=1e-10)


def test_round_a_closed_path_the_contacts_make_no_work() -> None:
    """A path through x, y and the spin angle; the forces have bounded second derivatives, so the sum errs like 1/n^2.5."""
    t = np.arange(20000) * (2.0 * np.pi / 20000)
    x, y, angle = 8e-6 + 6e-6 * np.cos(t), 4e-6 * np.sin(t), 0.8 * np.sin(t + 0.3)
    rates = (-6e-6 * np.sin(t), 4e-6 * np.cos(t), 0.8 * np.cos(t + 0.3))
    powers = [force * rate for force, rate in zip(forces(SKF_6205, "x", "y", "phi", x=x, y=y, angle=angle), rates, strict=True)]
    passed = np.mean(np.abs(np.sum(powers, axis=0)))
    assert abs(np.mean(np.sum(powers, axis=0))) < 1e-9 * passed
    assert abs(np.mean(powers[0] + powers[1])) > 1e-3 * passed  # without the moment about the axis they would


def test_contact_damping_takes_power_and_the_film_is_linear() -> None:
    law = SKF_6205.replacing(contact_damping=3.0, damping=200.0)
    velocity = {"vx": 0.01, "vy": 0.02}
    push = forces(law, **LOADED, **velocity) - forces(law, **LOADED)
    assert push @ [0.01, 0.02] > 200.0 * (0.01**2 + 0.02**2)
    np.testing.assert_allclose(forces(law, **velocity), [2.0, 4.0], rtol=1e-14)  # in the clearance only the film


def test_a_preload_makes_the_middle_stiff() -> None:
    """Z balls pressed in by p: K = Z/2 * 1.5 k p^0.5 in every direction."""
    law = SKF_6205.replacing(radial_clearance=0.0, preload=4e-6)
    linear = law.linearised(load=(0.0, 0.0), speed=0.0)
    expected = 4.5 * 1.5 * law.contact_stiffness * math.sqrt(4e-6)
    np.testing.assert_allclose(linear.stiffness_matrix()[:2, :2], expected * np.eye(2), rtol=1e-12, atol=1e-9 * expected)


def test_the_stiffness_depends_on_where_the_balls_are() -> None:
    """Two places, half a ball spacing apart; the load lies on a ball or between two."""
    spacing = 2.0 * math.pi / 9 / SKF_6205.cage_ratio
    on, between = (SKF_6205.linearised(load=(10.0, 0.0), speed=0.0, angle=angle) for angle in (0.0, 0.5 * spacing))
    again = SKF_6205.linearised(load=(10.0, 0.0), speed=0.0, angle=spacing)
    assert again.stiffness_xx == pytest.approx(on.stiffness_xx, rel=1e-9)
    # 10 N press one ball by 1 um, the next would need 1.5 um.
    # One: F = k d^1.5; two at 20 degrees: F = 2 cos k d^1.5, d along each, x = d/cos
    k, c = SKF_6205.contact_stiffness, math.cos(math.pi / 9)
    assert on.stiffness_xx == pytest.approx(1.5 * k ** (2 / 3) * 10.0 ** (1 / 3), rel=1e-9)
    assert between.stiffness_xx == pytest.approx(1.5 * (2.0 * c * k) ** (2 / 3) * 10.0 ** (1 / 3) * c, rel=1e-9)


@pytest.mark.parametrize("load", [1e-3, 1.0, 1e3, 1e5])
def test_loads_of_every_size_and_direction_find_their_place(load: float) -> None:
    for turn in np.linspace(0.0, 2.0, 5):
        wanted = (load * math.cos(turn), load * math.sin(turn))
        position = SKF_6205.static_position(load=wanted, speed=0.0)
        np.testing.assert_allclose(forces(SKF_6205, x=position[0], y=position[1]), wanted, rtol=0.0, atol=1e-9 * load)


def test_bad_ball_bearings_are_refused() -> None:
    for change, text in (
        ({"radial_clearance": -1e-6}, r"radial_clearance = -1e-06 m: must be at least 0.*given as preload"),
        ({"preload": 1e-6}, r"radial_clearance = 5e-06 m and preload = 1e-06 m; give one"),
        ({"balls": 8.5}, r"balls = 8.5: must be a whole number"),
        ({"balls": 2}, "must be at least 3"),
        ({"balls": 40}, "40 balls .* overlap"),
        ({"ball_diameter": 0.05}, "overlap"),
        ({"contact_stiffness": 0.0}, "must be greater than 0"),
    ):
        with pytest.raises(ParameterError, match=f"BallBearing.*{text}"):
            SKF_6205.replacing(**change)
    for bad, text in (({"inner_conformity": 0.5}, "inner_conformity = 0.5"), ({"ball_diameter": 0.1}, "ball_diameter = 0.1 m")):
        geometry = {"ball_diameter": 8e-3, "pitch_diameter": 39e-3, "inner_conformity": 0.52, "outer_conformity": 0.52, "balls": 9}
        with pytest.raises(ParameterError, match=text):
            BallBearing.from_geometry(**{**geometry, **bad})


# -- journal bearing ------------------------------------------------------------------------------

FRISWELL = JournalBearing(diameter=0.1, length=0.03, radial_clearance=1e-4, viscosity=0.1)
"""Friswell et al., Dynamics of Rotating Machines (2010), example 5.5.1, with 525 N at 1500 rpm."""


def reynolds(law: JournalBearing, x: float, y: float, vx: float, vy: float, speed: float) -> np.ndarray:
    """Force on the housing, by integrating the short-bearing pressure where it is positive.

    d/dz(h^3 dp/dz) = 6 mu (W dh/da + 2 dh/dt), h = c - x cos a - y sin a, p = 0 at z = +-L/2
    gives int p dz = -mu L^3/2 (W dh/da + 2 dh/dt)/h^3.
    """

    def pressure(a: float) -> float:
        h = law.radial_clearance - x * math.cos(a) - y * math.sin(a)
        wedge = speed * (x * math.sin(a) - y * math.cos(a))
        squeeze = -2.0 * (vx * math.cos(a) + vy * math.sin(a))
        return max(-0.5 * law.viscosity * law.length**3 * (wedge + squeeze) / h**3, 0.0)

    # the pressure is zero at two opposite places; integrate from one to the other
    zero = math.atan2(2.0 * vy - speed * x, 2.0 * vx + speed * y) - 0.5 * math.pi

    def component(part: Callable[[float], float]) -> float:
        area = quad(lambda a: pressure(a) * part(a), zero, zero + math.pi, epsabs=1e-7, epsrel=1e-11, limit=200)
        return 0.5 * law.diameter * float(area[0])

    return np.array([component(math.cos), component(math.sin)])


def test_the_film_is_the_integral_of_the_positive_pressure_in_any_motion() -> None:
    rng = np.random.default_rng(5)
    for _ in range(12):
        e, turn = rng.uniform(0.0, 0.95e-4), rng.uniform(0.0, 2.0 * math.pi)
        x, y = e * math.cos(turn), e * math.sin(turn)
        vx, vy, speed = rng.normal(size=3) * [5e-3, 5e-3, 100.0]
        expected = reynolds(FRISWELL, x, y, vx, vy, speed)
        np.testing.assert_allclose(
            forces(FRISWELL, x=x, y=y, vx=vx, vy=vy, speed=speed), expected, rtol=0.0, atol=1e-9 * np.hypot(*expected)
        )


@pytest.mark.parametrize("velocity", [5e-3, -5e-3])
def test_pure_squeeze_towards_and_away_from_the_wall_is_right_too(velocity: float) -> None:
    expected = reynolds(FRISWELL, 6e-5, 0.0, velocity, 0.0, 0.0)
    assert expected[0] * velocity > 0.0
    np.testing.assert_allclose(forces(FRISWELL, x=6e-5, vx=velocity), expected, rtol=0.0, atol=1e-9 * abs(expected[0]))


def test_in_the_middle_the_film_is_smooth_and_has_its_known_coefficients() -> None:
    """F = C pi/2 s at e = 0: D = pi C on the diagonal, k_xy = -k_yx = pi C W/2; with C = mu R L^3/(2 c^3)."""
    constant = 0.1 * 0.05 * 0.03**3 / (2.0 * 1e-4**3)
    linear = FRISWELL.linearised(load=(0.0, 0.0), speed=100.0)
    np.testing.assert_allclose(linear.damping_matrix()[:2, :2], math.pi * constant * np.eye(2), rtol=1e-9, atol=1e-9 * constant)
    cross = 50.0 * math.pi * constant
    np.testing.assert_allclose(linear.stiffness_matrix()[:2, :2], [[0.0, cross], [-cross, 0.0]], rtol=1e-9, atol=1e-9 * cross)


def test_published_coefficients_of_a_short_bearing() -> None:
    # Friswell et al., example 5.5.1: eccentricity 0.2663, K in MN/m and C in kN s/m, printed to 4 digits
    position = FRISWELL.static_position(load=(0.0, -525.0), speed=rpm(1500.0))
    assert np.hypot(*position[:2]) / 1e-4 == pytest.approx(0.2663, abs=5e-5)
    linear = FRISWELL.linearised(load=(0.0, -525.0), speed=rpm(1500.0))
    np.testing.assert_allclose(linear.stiffness_matrix()[:2, :2] / 1e6, [[12.81, 16.39], [-25.06, 8.815]], atol=5e-3)
    np.testing.assert_allclose(linear.damping_matrix()[:2, :2] / 1e3, [[232.9, -81.92], [-81.92, 294.9]], atol=5e-2)


@pytest.mark.parametrize("eccentricity", [0.02, 0.2663, 0.5, 0.8, 0.95])
def test_eccentricity_and_coefficients_follow_the_closed_forms(eccentricity: float) -> None:
    """Friswell et al. (2010), section 5.5: with S_s = mu D W L^3/(8 F c^2),
    e^8 - 4 e^6 + (6 - S_s^2 (16 - pi^2)) e^4 - (4 + pi^2 S_s^2) e^2 + 1 = 0, K = F/c a, C = F/(c W) b, load along -y."""
    e, pi = eccentricity, math.pi
    gap = 1.0 - e * e
    number = gap**2 / (e * math.sqrt(16.0 * e * e + pi**2 * gap))
    speed, c = 100.0, FRISWELL.radial_clearance
    load = FRISWELL.load_number(1.0, speed) / number
    assert e**8 - 4.0 * e**6 + (6.0 - number**2 * (16.0 - pi**2)) * e**4 - (4.0 + pi**2 * number**2) * e**2 + 1.0 == pytest.approx(
        0.0, abs=1e-13 * (1.0 + number**2)
    )
    position = FRISWELL.static_position(load=(0.0, -load), speed=speed)
    assert np.hypot(*position[:2]) / c == pytest.approx(e, rel=1e-9)
    # the journal runs ahead of the load, in the sense of the spin: tan(attitude) = pi sqrt(1 - e^2)/(4 e)
    assert math.atan2(position[0], -position[1]) == pytest.approx(math.atan(pi * math.sqrt(gap) / (4.0 * e)), rel=1e-9)

    h0 = (pi**2 * gap + 16.0 * e**2) ** -1.5
    root = e * math.sqrt(gap)
    a = h0 * np.array(
        [
            [4.0 * (pi**2 * (2.0 - e**2) + 16.0 * e**2), pi * (pi**2 * gap**2 - 16.0 * e**4) / root],
            [
                -pi * (pi**2 * gap * (1.0 + 2.0 * e**2) + 32.0 * e**2 * (1.0 + e**2)) / root,
                4.0 * (pi**2 * (1.0 + 2.0 * e**2) + 32.0 * e**2 * (1.0 + e**2) / gap),
            ],
        ]
    )
    across = -8.0 * (pi**2 * (1.0 + 2.0 * e**2) - 16.0 * e**2)
    b = h0 * np.array(
        [
            [2.0 * pi * math.sqrt(gap) * (pi**2 * (1.0 + 2.0 * e**2) - 16.0 * e**2) / e, across],
            [across, 2.0 * pi * (pi**2 * gap**2 + 48.0 * e**2) / root],
        ]
    )
    linear = FRISWELL.linearised(load=(0.0, -load), speed=speed)
    for found, expected in ((linear.stiffness_matrix(), load / c * a), (linear.damping_matrix(), load / (c * speed) * b)):
        np.testing.assert_allclose(found[:2, :2], expected, rtol=0.0, atol=1e-8 * np.max(np.abs(expected)))


def test_whirling_at_half_the_spin_the_film_carries_nothing() -> None:
    """No pressure: wedge and squeeze cancel (the cause of oil whirl)."""
    speed, e = 100.0, 5e-5
    whirl = forces(FRISWELL, x=e, vy=0.5 * speed * e, speed=speed)
    assert np.max(np.abs(whirl)) < 1e-6 * np.max(np.abs(forces(FRISWELL, x=e, speed=speed)))


def test_the_film_drives_the_journal_round_with_the_spin() -> None:
    # force on the ring is the opposite: displaced to +x and turning from x to y it is pushed to +y
    assert -forces(FRISWELL, x=3e-5, speed=100.0)[1] > 0.0
    assert -forces(FRISWELL, x=3e-5, speed=-100.0)[1] < 0.0


def test_beyond_the_film_the_wall_carries() -> None:
    hard = FRISWELL.replacing(wall_stiffness=1e9)
    # at standstill: F = k (e - 0.99 c)
    position = hard.static_position(load=(0.0, -525.0), speed=0.0)
    np.testing.assert_allclose(position[:2], [0.0, -(0.99e-4 + 525.0 / 1e9)], rtol=1e-12, atol=1e-15)
    beyond = forces(FRISWELL, x=np.array([0.99e-4, 1.5e-4, 1e-3]), speed=100.0)
    np.testing.assert_allclose(beyond, beyond[:, :1] * np.ones(3), rtol=1e-12)


def test_loads_that_a_film_cannot_carry_are_refused() -> None:
    with pytest.raises(AnalysisError, match=r"No static position of JournalBearing.*\(0, -525\) N at 0 rad/s.*standstill"):
        FRISWELL.static_position(load=(0.0, -525.0), speed=0.0)
    with pytest.raises(AnalysisError, match="largest eccentricity"):
        FRISWELL.linearised(load=(0.0, -1e8), speed=100.0)


def test_bad_journal_bearings_are_refused() -> None:
    for field, bad in (("radial_clearance", -1e-4), ("radial_clearance", 0.0), ("diameter", 0.0), ("length", -1.0), ("viscosity", 0.0)):
        with pytest.raises(ParameterError, match=rf"JournalBearing\.{field} = {bad:g} .*must be greater than 0"):
            FRISWELL.replacing(**{field: bad})
    with pytest.raises(ParameterError, match=r"largest_eccentricity = 1: must be at most 0\.9999"):
        FRISWELL.replacing(largest_eccentricity=1.0)


# -- friction -------------------------------------------------------------------------------------


def test_friction_has_the_size_of_the_radial_load_and_resists() -> None:
    """F_z = mu N, M = mu_t d_B/2 N with N = sqrt(Fx^2 + Fy^2), matrices included (seed M (7))."""
    inner = LinearBearing.isotropic(radial=1e7, damping=1e3, axial=1e6)
    law = WithFriction(law=inner, bore=0.03, friction=0.1, turning_friction=0.002)
    at = {"x": 3e-5, "y": 1e-5, "vy": 0.3}  # Fx = 300, Fy = 100 + 300 N: N = 500 N
    for sense in (1.0, -1.0):
        friction = forces(law, "z", "phi", **at, vz=sense * 0.01, speed=sense * 10.0)
        np.testing.assert_allclose(friction, sense * np.array([50.0, 0.002 * 0.015 * 500.0]), rtol=1e-12)
    np.testing.assert_allclose(forces(law, **at, vz=1.0, speed=1.0), forces(inner, **at), rtol=1e-15)
    # half of it at v = v_0 atanh(1/2)
    slow = law.smoothing_speed * math.atanh(0.5)
    np.testing.assert_allclose(forces(law, "z", "phi", **at, vz=slow, speed=slow / 0.015), [25.0, 0.0075], rtol=1e-12)


def test_friction_keeps_axial_forces_of_the_law_inside() -> None:
    inner = PowerBearing(
        stiffness_xx=1e7, stiffness_yy=1e7, stiffness_zz=1e6, power_stiffness_xx=0.0, power_stiffness_yy=0.0, power_stiffness_zz=1e15
    )
    law = WithFriction(law=inner, bore=0.03, friction=0.1)
    # 1e6 * 1e-5 + 1e15 * 1e-15 + 0.1 * 100
    assert forces(law, "z", x=1e-5, z=1e-5, vz=1.0)[0] == pytest.approx(10.0 + 1.0 + 10.0, rel=1e-12)


def test_bad_friction_is_refused() -> None:
    inner = LinearBearing.isotropic(radial=1e7, damping=0.0)
    for change, text in (
        ({"friction": -0.1}, "friction = -0.1: must be at least 0"),
        ({"turning_friction": -0.1}, "turning_friction = -0.1"),
        ({"bore": 0.0}, "bore = 0 m: must be greater than 0"),
        ({"smoothing_speed": 0.0}, "smoothing_speed = 0 m/s"),
        ({"law": 3.0}, "must be a bearing law"),
    ):
        with pytest.raises(ParameterError, match=f"WithFriction.*{text}"):
            WithFriction(**{"law": inner, "bore": 0.03, "friction": 0.1, **change})


# -- laws of a user's own -------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class StepBearing(BearingLaw):
    """A law for plain numbers: it decides with ``if``, so it can neither be recorded nor take arrays."""

    stiffness: float = parameter("N/m", "stiffness inside")
    border: float = parameter("m", "where it becomes ten times as stiff")

    def forces(self, motion: RelativeMotion) -> Mapping[str, Value]:
        def spring(d: float) -> float:
            return self.stiffness * (d if abs(d) < self.border else 10.0 * d - math.copysign(9.0 * self.border, d))

        return {"x": spring(motion.x) + 20.0 * motion.vx, "y": spring(motion.y) + 30.0 * motion.vy}


def test_a_law_that_cannot_be_recorded_is_linearised_by_differences() -> None:
    law = StepBearing(stiffness=1e7, border=1e-5)
    linear = law.linearised(load=(50.0, -300.0), speed=0.0)
    # rounding of forces of 300 N over 1 nm
    np.testing.assert_allclose(np.diag(linear.stiffness_matrix())[:2], [1e7, 1e8], rtol=1e-4)
    np.testing.assert_allclose(np.diag(linear.damping_matrix())[:2], [20.0, 30.0], rtol=1e-4)
    np.testing.assert_allclose(law.static_position(load=(50.0, -300.0), speed=0.0)[:2], [5e-6, -1.2e-5], rtol=1e-8)


@dataclass(frozen=True, kw_only=True)
class WrongName(BearingLaw):
    """Gives a force under a name that is no direction."""

    def forces(self, motion: RelativeMotion) -> Mapping[str, Value]:
        return {"X": motion.x}


def test_a_force_in_an_unknown_direction_is_refused() -> None:
    with pytest.raises(LawError, match=r"WrongName\.forces gives X; directions are x, y, z, psi, theta, phi"):
        WrongName().total_forces(motion())


def test_loads_that_are_no_two_finite_forces_are_refused() -> None:
    law = LinearBearing.isotropic(radial=1e7, damping=0.0)
    for load, speed in (((1.0,), 0.0), ((1.0, 2.0, 3.0), 0.0), ((1.0, math.nan), 0.0), (5.0, 0.0), ((1.0, 2.0), math.inf), ("load", 0.0)):
        with pytest.raises(ParameterError, match="must be two forces"):
            law.static_position(load=load, speed=speed)  # type: ignore[arg-type]


def test_a_direction_without_stiffness_carries_no_load() -> None:
    law = LinearBearing(stiffness_xx=1e7, stiffness_yy=0.0)
    assert law.static_position(load=(10.0, 0.0), speed=0.0)[0] == pytest.approx(1e-6, rel=1e-12)
    with pytest.raises(AnalysisError, match="no load in it"):
        law.static_position(load=(10.0, -5.0), speed=0.0)
