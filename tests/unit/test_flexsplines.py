"""Flexspline laws: parity, monotony, jumps, records, derivatives, inverses, fits, refusals."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize

from hdrive_mbs.conversions import arcmin
from hdrive_mbs.errors import LawError, ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.flexsplines.continuous import ContinuousStiffness
from hdrive_mbs.flexsplines.cubic import CubicStiffness
from hdrive_mbs.flexsplines.jump import JumpStiffness
from hdrive_mbs.flexsplines.jump_secant import JumpSecantStiffness
from hdrive_mbs.flexsplines.jump_torque import JumpTorqueStiffness
from hdrive_mbs.flexsplines.law import StiffnessFunction, StiffnessLaw
from hdrive_mbs.flexsplines.linear import LinearStiffness
from hdrive_mbs.flexsplines.piecewise_linear import PiecewiseLinearStiffness
from hdrive_mbs.flexsplines.table import TableStiffness
from tests.unit.law_checks import assert_derivative_is_exact, assert_records_itself, run_on_engine
from tests.verification.scenes import train

PEAK = 137.0
"""Last torque of Table 1 of seed F [N m]: up to here its law is known."""


def catalogue() -> PiecewiseLinearStiffness:
    """HDUC 32-100, seed F, Table 1."""
    return PiecewiseLinearStiffness(
        lost_motion=arcmin(9), stiffness_1=3.2e4, stiffness_2=6.4e4, stiffness_3=11e4, torque_1=23.5, torque_2=98.0
    )


def two_sided() -> ContinuousStiffness:
    """A drive that is stiffer one way: the coefficients are free choices, all positive."""
    return ContinuousStiffness(
        lost_motion=arcmin(6),
        edge_stiffness=2e4,
        quadratic=1e7,
        cubic=5e8,
        largest_twist=4e-3,
        negative_edge_stiffness=3e4,
        negative_quadratic=2e7,
        negative_cubic=1e8,
    )


LAWS: dict[str, StiffnessLaw] = {
    "catalogue": catalogue(),
    "linear": LinearStiffness(constant=2e4),
    "cubic": CubicStiffness.fitted_to(catalogue(), largest_torque=PEAK),
    "jump, torque": JumpTorqueStiffness.fitted_to(catalogue(), largest_torque=PEAK),
    "jump, all four terms": JumpTorqueStiffness(
        lost_motion=arcmin(9), constant=2.0, linear=5e3, quadratic=4e6, cubic=1e9, largest_twist=4e-3
    ),
    "jump, secant": JumpSecantStiffness.fitted_to(catalogue(), largest_torque=PEAK),
    "jump, secant, all four terms": JumpSecantStiffness(
        lost_motion=arcmin(9), constant=1e3, linear=2e6, quadratic=1e9, cubic=1e11, largest_twist=4e-3
    ),
    "continuous": ContinuousStiffness.fitted_to(catalogue(), largest_torque=PEAK),
    "continuous, two sides": two_sided(),
    "table": TableStiffness.mirrored([0.0, 1e-3, 2e-3, 3e-3], [0.0, 0.0, 30.0, 90.0]),
}
SYMMETRIC = [name for name in LAWS if name != "continuous, two sides"]
NAMES = list(LAWS)


def kinks(law: StiffnessLaw) -> tuple[float, ...]:
    """Twists at which the slope of the law jumps."""
    sizes = {0.0, law.half_gap, getattr(law, "largest_twist", None) or 0.0}
    sizes |= set(getattr(law, "corners", ())) | {abs(x) for x in getattr(law, "twists", ())}
    return tuple(sign * size for size in sizes for sign in (-1.0, 1.0))


def grid() -> np.ndarray:
    """Twists well beyond every fitted range (largest 4e-3 rad), dense enough to fall on both sides of each edge."""
    return np.linspace(-8e-3, 8e-3, 4001)


# -- every law ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SYMMETRIC)
def test_a_law_of_equal_sides_is_odd(name: str) -> None:
    phi = grid()
    one, other = np.asarray(LAWS[name].torque(-phi)), np.asarray(LAWS[name].torque(phi))
    # exact but for the table, whose lines start from different points on the two sides: some roundings
    np.testing.assert_allclose(one, -other, rtol=0.0, atol=1e-15 * np.max(np.abs(one)) if name == "table" else 0.0)


@pytest.mark.parametrize("name", NAMES)
def test_every_law_rises_and_never_pulls_away_from_zero(name: str) -> None:
    torque = np.asarray(LAWS[name].torque(grid()))
    # -1e-12 of the largest torque: rounding of the flat parts
    assert np.all(np.diff(torque) >= -1e-12 * np.max(np.abs(torque)))
    assert np.all(torque * grid() >= 0.0)
    LAWS[name].check_restoring()


@pytest.mark.parametrize("name", NAMES)
def test_every_law_is_zero_inside_its_gap(name: str) -> None:
    law = LAWS[name]
    inside = np.linspace(-1.0, 1.0, 101) * law.half_gap
    assert np.max(np.abs(np.asarray(law.torque(inside)))) <= 1e-14 * PEAK


@pytest.mark.parametrize("name", NAMES)
def test_every_law_jumps_at_its_edges_by_the_stated_torque_only(name: str) -> None:
    law, eps = LAWS[name], 1e-12
    for where in kinks(law):
        step = float(law.torque(where + eps)) - float(law.torque(where - eps))
        at_edge = isinstance(law, JumpStiffness) and abs(where) == law.half_gap and where != 0.0
        expected = law.edge_torque if at_edge and isinstance(law, JumpStiffness) else 0.0
        # between the two points the torque changes by the slope, at most 3e5 N m/rad, times 2e-12 rad
        assert step == pytest.approx(expected, abs=1e-6), f"{name} at {where}"


@pytest.mark.parametrize("name", NAMES)
def test_every_law_records_itself_and_computes_the_same(name: str) -> None:
    rng = np.random.default_rng(1)
    near = rng.uniform(-8e-3, 8e-3, 400)
    assert_records_itself(LAWS[name].torque, near)
    assert_records_itself(LAWS[name].torque, np.concatenate(([0.0], 10.0 ** rng.uniform(-9.0, 1.0, 200))))


@pytest.mark.parametrize("name", NAMES)
def test_the_stiffness_of_every_law_is_its_derivative(name: str) -> None:
    # step h = 1e-7: third derivatives are below 24 * 5.4e11 * 4e-3 = 5e10, so h^2/6 f''' < 1e-4; rounding of M and
    # of the twist 1e-16 * 1e3 / h + 1e-16 * 6e-3 / h * 3e5 < 1e-5; together below 1e-3 of 1e5 N m/rad
    points = np.random.default_rng(2).uniform(-6e-3, 6e-3, 300)
    assert_derivative_is_exact(LAWS[name].torque, points, 1e-7, kinks(LAWS[name]), 1e-3)


@pytest.mark.parametrize("name", [name for name, law in LAWS.items() if hasattr(law, "largest_twist")])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_beyond_its_range_a_law_goes_on_along_its_tangent(name: str, sign: float) -> None:
    law, end = LAWS[name], sign * LAWS[name].largest_twist  # type: ignore[attr-defined]
    step = sign * 1e-9
    before = float(law.torque(end) - law.torque(end - step)) / step
    # the slope changes by M'' * 1e-9 rad, with M'' < 1e9: less than 1 in 1e5 N m/rad; rounding 1e-14 * 1e2 / 1e-9 = 1e-3
    for beyond in (1e-4, 2e-3, 0.5):
        slope = float(law.torque(end + sign * beyond) - law.torque(end)) / (sign * beyond)
        assert slope == pytest.approx(before, abs=1.0)


@pytest.mark.parametrize("name", NAMES)
def test_the_twist_of_every_law_inverts_its_torque(name: str) -> None:
    law = LAWS[name]
    for torque in (-300.0, -50.0, -24.0, 24.0, 137.0, 400.0):  # above each edge torque, which is at most 17.7 N m
        # Brent's bracket is 1e-14 of the twist, the torque then 1e-14 * 1e-2 rad * 3e5 N m/rad
        assert float(law.torque(float(law.twist(torque)))) == pytest.approx(torque, abs=1e-9)
    assert np.shape(law.twist([1.0, 20.0])) == (2,)


@pytest.mark.parametrize("name", NAMES)
def test_every_law_runs_on_the_engine_without_a_python_callback(name: str) -> None:
    result, how = run_on_engine(train(stiffness=LAWS[name]), 0.02)
    assert how["gear"] == ("native" if name == "linear" else "symbolic")
    assert np.isfinite(result.angles["load"][-1])
    assert result.angles["gear.wave_generator"][-1] > 0.0


# -- the cubic (Fig. 6) ------------------------------------------------------------------------------


def least_squares(curve: StiffnessLaw, start: float, powers: Sequence[int]) -> np.ndarray:
    """Free least squares of the torque on [start, twist(PEAK)], evenly over the twist."""
    x = np.linspace(start, float(curve.twist(PEAK)), 5001)
    scale = x[-1]
    solution = np.linalg.lstsq(np.stack([(x / scale) ** k for k in powers], axis=1), curve.torque(x), rcond=None)[0]
    return np.asarray(solution / scale ** np.array(powers, float))


def test_the_free_odd_cubic_of_the_catalogue_curve_would_pull_away_from_zero() -> None:
    linear, _ = least_squares(catalogue(), 0.0, (1, 3))
    assert linear < -500.0


def test_the_fitted_cubic_is_the_best_one_that_does_not() -> None:
    law = LAWS["cubic"]
    assert isinstance(law, CubicStiffness)
    assert law.linear == 0.0
    # with a = 0 the best d is  sum(x^3 M) / sum(x^6)
    x = np.linspace(0.0, float(catalogue().twist(PEAK)), 5001)
    best = np.sum(x**3 * catalogue().torque(x)) / np.sum(x**6)
    # both sums approach their integrals like 1/points: 2001 in the fit, 5001 here
    assert law.cubic == pytest.approx(best, rel=1e-3)


def test_a_cubic_is_found_again_from_its_own_points() -> None:
    twist = np.linspace(-4e-3, 4e-3, 41)
    torque = 2e4 * twist + 1.5e9 * twist**3
    law = CubicStiffness.fitted_to((list(twist), list(torque)))
    assert law.linear == pytest.approx(2e4, rel=1e-9)
    assert law.cubic == pytest.approx(1.5e9, rel=1e-9)
    assert law.largest_twist == pytest.approx(4e-3, rel=1e-15)


def test_a_cubic_that_would_turn_down_is_refused_without_a_range_and_goes_on_straight_with_one() -> None:
    with pytest.raises(ParameterError, match=r"torque falls with rising twist for large twists.*largest_twist"):
        CubicStiffness(linear=2e4, cubic=-1e9)
    # slope 2e4 - 3e9 x^2 vanishes at 2.58e-3 rad
    with pytest.raises(ParameterError, match=r"at a twist of 0\.003 rad"):
        CubicStiffness(linear=2e4, cubic=-1e9, largest_twist=3e-3)
    law = CubicStiffness(linear=2e4, cubic=-1e9, largest_twist=2e-3)
    beyond = 2e4 - 3.0 * 1e9 * 2e-3**2
    edge = 2e4 * 2e-3 - 1e9 * 2e-3**3
    assert float(law.torque(5e-3)) == pytest.approx(edge + beyond * 3e-3, rel=1e-14)
    assert float(law.torque(-5e-3)) == pytest.approx(-(edge + beyond * 3e-3), rel=1e-14)


# -- the jump law, (11)-(14) -------------------------------------------------------------------------


def test_both_readings_of_the_jump_law_follow_their_equation() -> None:
    torque, secant = LAWS["jump, all four terms"], LAWS["jump, secant, all four terms"]
    for phi in (1.5e-3, 2.7e-3, 3.9e-3):
        assert float(torque.torque(phi)) == pytest.approx(2.0 + 5e3 * phi + 4e6 * phi**2 + 1e9 * phi**3, rel=1e-14)
        assert float(secant.torque(phi)) == pytest.approx((1e3 + 2e6 * phi + 1e9 * phi**2 + 1e11 * phi**3) * phi, rel=1e-14)


def test_the_fitted_jump_laws_are_the_free_least_squares_outside_the_gap() -> None:
    for law, powers in ((LAWS["jump, torque"], (1, 3)), (LAWS["jump, secant"], (2, 4))):
        assert isinstance(law, JumpStiffness)
        best = least_squares(catalogue(), catalogue().half_gap, powers)
        x = np.linspace(catalogue().half_gap, float(catalogue().twist(PEAK)), 101)
        expected = best[0] * x ** powers[0] + best[1] * x ** powers[1]
        # 2001 and 5001 points of the same integrals: 1e-3 of 137 N m is a generous bound of the difference
        np.testing.assert_allclose(law.torque(x[1:]), expected[1:], atol=0.05)
        assert law.lost_motion == catalogue().lost_motion


def test_the_edge_torque_of_the_catalogue_drive_is_6_7_newton_metres_as_a_torque_and_9_0_as_a_stiffness() -> None:
    # value of the free least-squares polynomial at the edge of the gap
    for name, powers in (("jump, torque", (1, 3)), ("jump, secant", (2, 4))):
        law = LAWS[name]
        assert isinstance(law, JumpStiffness)
        edge = catalogue().half_gap
        best = least_squares(catalogue(), edge, powers)
        assert law.edge_torque == pytest.approx(best[0] * edge ** powers[0] + best[1] * edge ** powers[1], abs=0.01)
        assert 6.5 < law.edge_torque < 9.5


def test_a_torque_below_the_jump_is_reached_at_the_edge_of_the_gap() -> None:
    law = LAWS["jump, torque"]
    assert float(law.twist(3.0)) == pytest.approx(law.half_gap, rel=1e-12)
    assert float(law.twist(-3.0)) == pytest.approx(-law.half_gap, rel=1e-12)


def test_equation_14_read_literally_is_not_odd_and_is_refused_as_a_restoring_law() -> None:
    b, d = 4.4e6, 5.3e11

    class Printed(StiffnessLaw):
        """K_FS = b phi + d phi^3 times phi, as printed, gap left out."""

        def torque(self, twist: Value) -> Value:
            return (b * twist + d * twist**3) * twist

    law = Printed()
    assert float(law.torque(-3e-3)) == float(law.torque(3e-3))  # even
    with pytest.raises(LawError, match="claims to be restoring"):
        law.check_restoring()


@pytest.mark.parametrize("constant", [0.0, 2.0])
def test_equation_11_read_as_a_torque_is_odd_only_without_its_even_terms(constant: float) -> None:
    def printed(phi: float, c: float) -> float:
        return constant + 5e3 * phi + c * phi**2 + 1e9 * phi**3

    def printed_12(phi: float, c: float) -> float:
        return constant + 5e3 * phi + c * phi**2 * math.copysign(1.0, phi) + 1e9 * phi**3

    for c in (0.0, 4e6):
        assert (printed(-2e-3, c) == -printed(2e-3, c)) == (constant == 0.0 and c == 0.0)
        assert (printed_12(-2e-3, c) == -printed_12(2e-3, c)) == (constant == 0.0)


def test_a_jump_law_that_pulls_away_at_the_edge_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"M_A = -.* N m, pulls away"):
        JumpTorqueStiffness(lost_motion=arcmin(9), linear=-1e4, cubic=3e9, largest_twist=4e-3)


def test_a_jump_law_that_falls_outside_the_gap_is_refused() -> None:
    with pytest.raises(ParameterError, match="falls with rising twist"):
        JumpTorqueStiffness(lost_motion=arcmin(9), linear=3e4, cubic=-1e9, largest_twist=4e-3)
    with pytest.raises(ParameterError, match="inside the gap"):
        JumpTorqueStiffness(lost_motion=arcmin(9), linear=3e4, cubic=0.0, largest_twist=1e-3)


# -- the continuous law, (15)-(17) -------------------------------------------------------------------


def test_the_fitted_continuous_law_is_the_free_least_squares_from_the_edge_of_the_gap() -> None:
    law = LAWS["continuous"]
    edge, end = catalogue().half_gap, float(catalogue().twist(PEAK))
    s = np.linspace(0.0, 1.0, 5001)
    torque = catalogue().torque(edge + s * (end - edge))
    k = np.linalg.lstsq(np.stack([s, s**2, s**3], axis=1), torque, rcond=None)[0]
    np.testing.assert_allclose(law.torque(edge + s * (end - edge)), k[0] * s + k[1] * s**2 + k[2] * s**3, atol=0.05)


def test_the_continuous_law_stays_within_4_newton_metres_of_the_catalogue_up_to_its_largest_torque() -> None:
    # the residual of the free least-squares cubic, found by hand on 5001 points: 3.96 N m, at the upper end
    x = np.linspace(0.0, float(catalogue().twist(PEAK)), 5001)
    worst = float(np.max(np.abs(np.asarray(LAWS["continuous"].torque(x)) - catalogue().torque(x))))
    assert worst == pytest.approx(3.96, abs=0.02)


@pytest.mark.parametrize("name", ["continuous", "continuous, two sides"])
def test_the_continuous_law_is_the_printed_polynomial_on_each_side(name: str) -> None:
    law = LAWS[name]
    assert isinstance(law, ContinuousStiffness)
    assert law.largest_twist is not None
    for sign in (1, -1):
        a, b, c, d = law.polynomial(sign)
        phi = sign * np.linspace(law.half_gap, law.largest_twist, 50)
        # terms of up to 1e3 N m cancel to 0 at the edge: 1e-16 * 1e3
        np.testing.assert_allclose(law.torque(phi), a + b * phi + c * phi**2 + d * phi**3, rtol=0.0, atol=1e-11)


def test_the_printed_coefficients_give_the_law_back() -> None:
    law = two_sided()
    again = ContinuousStiffness.from_polynomial(
        law.polynomial(1), law.polynomial(-1), lost_motion=law.lost_motion, largest_twist=law.largest_twist
    )
    np.testing.assert_allclose(again.torque(grid()), law.torque(grid()), rtol=0.0, atol=1e-10)


@pytest.mark.parametrize("side", [1, -1])
def test_coefficients_that_jump_at_the_edge_of_the_gap_are_refused_with_the_right_constant(side: int) -> None:
    law = two_sided()
    good = {1: law.polynomial(1), -1: law.polynomial(-1)}
    right = good[side][0]
    bad = dict(good) | {side: (right + 0.5, *good[side][1:])}
    with pytest.raises(ParameterError, match=r"give 0\.5 N m at the edge of the gap") as caught:
        ContinuousStiffness.from_polynomial(bad[1], bad[-1], lost_motion=law.lost_motion)
    advised = float(str(caught.value).rpartition("take a = ")[2].removesuffix(" N m."))
    assert advised == pytest.approx(right, rel=1e-8)  # nine printed digits


def test_a_continuous_law_that_falls_is_refused() -> None:
    with pytest.raises(ParameterError, match="falls with rising twist"):
        ContinuousStiffness(lost_motion=arcmin(9), edge_stiffness=1e4, quadratic=-1e7, cubic=0.0, largest_twist=4e-3)
    with pytest.raises(ParameterError, match="give all of negative_edge_stiffness"):
        ContinuousStiffness(lost_motion=arcmin(9), edge_stiffness=1e4, quadratic=0.0, cubic=0.0, negative_cubic=1e8)


def test_a_fit_to_measured_points_that_dip_is_the_best_rising_cubic() -> None:
    # torque 40 N m * (4 s - 3 s^2), s from 0 to 1: rises to s = 2/3 and falls after; the free cubic would follow it
    s = np.linspace(0.0, 1.0, 30)
    torque = 40.0 * (4.0 * s - 3.0 * s**2)
    law = ContinuousStiffness.fitted_to((list(1e-3 + 3e-3 * s), list(torque)), lost_motion=2e-3)
    fitted = np.asarray(law.torque(1e-3 + 3e-3 * s))
    assert np.all(np.diff(np.asarray(law.torque(np.linspace(0.0, 6e-3, 2000)))) >= -1e-12 * torque.max())

    # another way to the same: SLSQP with the slope held above zero at 101 places
    powers, at = np.stack([s, s**2, s**3], axis=1), np.linspace(0.0, 1.0, 101)
    slopes = np.stack([np.ones(101), 2.0 * at, 3.0 * at**2], axis=1)
    best = minimize(
        lambda k: float(np.sum((powers @ k - torque) ** 2)),
        [40.0, 0.0, 0.0],
        method="SLSQP",
        constraints={"type": "ineq", "fun": lambda k: slopes @ k},
        options={"maxiter": 500, "ftol": 1e-14},
    )
    # its last line search may end on rounding; what counts is that the point keeps to the constraint
    assert np.min(slopes @ best.x) >= -1e-9 * 40.0
    # the smallest slope is known to a grid of 0.01 in both: off by 0.005^2/2 times its curvature 6 k3 = 550, so by 0.007,
    # 2e-4 of the mean slope of 40 N m, and the sum of squares by a like share
    assert float(np.sum((fitted - torque) ** 2)) == pytest.approx(best.fun, rel=1e-3)


def test_a_law_of_unequal_sides_is_fitted_on_each_side() -> None:
    law = two_sided()
    again = ContinuousStiffness.fitted_to(law, largest_torque=60.0)
    assert not again.odd
    # the softer, positive side reaches 60 N m last; up to there both are the cubics that they were
    end = float(law.twist(60.0))
    assert again.largest_twist == pytest.approx(end, rel=1e-12)
    inside = np.linspace(-end, end, 200)
    np.testing.assert_allclose(again.torque(inside), law.torque(inside), rtol=0.0, atol=1e-8)


def test_an_odd_law_is_fitted_to_the_mean_of_unequal_sides() -> None:
    # sides 1e4 x + 1e9 x^3 and 3e4 x + 2e9 x^3 (gap 0): the mean is 2e4 x + 1.5e9 x^3
    law = ContinuousStiffness(
        lost_motion=0.0, edge_stiffness=1e4, quadratic=0.0, cubic=1e9,
        negative_edge_stiffness=3e4, negative_quadratic=0.0, negative_cubic=2e9,
    )  # fmt: skip
    fitted = CubicStiffness.fitted_to(law, largest_torque=100.0)
    assert fitted.linear == pytest.approx(2e4, rel=1e-9)
    assert fitted.cubic == pytest.approx(1.5e9, rel=1e-9)


def test_a_fit_needs_to_know_where_it_ends_and_how_wide_the_gap_is() -> None:
    with pytest.raises(ParameterError, match=r"largest_torque .* is missing"):
        ContinuousStiffness.fitted_to(catalogue())
    with pytest.raises(ParameterError, match="give lost_motion"):
        JumpTorqueStiffness.fitted_to(([1e-3, 2e-3], [1.0, 2.0]))
    with pytest.raises(ParameterError, match="at least 4 are needed"):
        CubicStiffness.fitted_to(([1e-3, 2e-3], [1.0, 2.0]))
    with pytest.raises(ParameterError, match="finite"):
        CubicStiffness.fitted_to(([1e-3, 2e-3, 3e-3, 4e-3], [1.0, 2.0, math.nan, 3.0]))
    with pytest.raises(ParameterError, match="greater than 0 N m"):
        CubicStiffness.fitted_to(catalogue(), largest_torque=-5.0)


# -- the table ---------------------------------------------------------------------------------------


def test_the_table_of_the_catalogue_points_is_the_catalogue_law() -> None:
    law = catalogue()
    table = TableStiffness.mirrored([*law.corners, float(law.twist(PEAK))], [0.0, 23.5, 98.0, PEAK])
    np.testing.assert_allclose(table.torque(grid()), law.torque(grid()), rtol=0.0, atol=1e-9)
    assert table.half_gap == law.half_gap


def test_a_table_with_unequal_gaps_reports_the_smaller_one() -> None:
    table = TableStiffness(twists=(-3e-3, -1e-3, 2e-3, 3e-3), torques=(-10.0, 0.0, 0.0, 10.0))
    assert table.half_gap == 1e-3


@pytest.mark.parametrize(
    ("twists", "torques", "message"),
    [
        ((-1e-3, 0.0, 0.0, 1e-3), (-1.0, 0.0, 0.0, 1.0), r"twists\[2\] = 0 rad does not rise above twists\[1\]"),
        ((-1e-3, 1e-3, 0.0), (-1.0, 0.0, 1.0), r"twists\[2\] = 0 rad does not rise .* sort the table"),
        ((-1e-3, 0.0, 1e-3, 2e-3), (-1.0, 0.0, 2.0, 1.5), r"torques\[3\] = 1\.5 N m is below torques\[2\] = 2 N m"),
        ((-1e-3, 0.0, 1e-3), (-1.0, math.nan, 1.0), r"torques\[1\] = nan N m: must be a finite number"),
        ((-1e-3, math.nan, 1e-3), (-1.0, 0.0, 1.0), r"twists\[1\] = nan rad: must be a finite number"),
        ((0.0, 1e-3), (0.0, 1.0), "both sides of zero.*mirrored"),
        ((-1e-3, 1e-3), (-1.0, 3.0), "1 N m at zero twist"),
        ((-1e-3, 1e-3), (-1.0,), "2 twists and 1 torques"),
        ((0.0,), (0.0,), "at least 2"),
    ],
)
def test_a_bad_stiffness_table_is_refused(twists: tuple[float, ...], torques: tuple[float, ...], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        TableStiffness(twists=twists, torques=torques)


def test_only_one_side_can_be_mirrored() -> None:
    with pytest.raises(ParameterError, match="from 0 rad upwards"):
        TableStiffness.mirrored([-1e-3, 1e-3], [-1.0, 1.0])


# -- claims and bad values ---------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class Snap(StiffnessLaw):
    """A law that pulls away between 1 and 2 mrad."""

    def torque(self, twist: Value) -> Value:
        return 1e12 * twist * (np.abs(twist) - 1e-3) * (np.abs(twist) - 2e-3)


@dataclass(frozen=True, kw_only=True)
class OpenSnap(Snap):
    """The same without the claim."""

    restoring = False


def test_a_law_that_is_not_restoring_where_it_claims_to_be_is_refused_by_twist() -> None:
    with pytest.raises(LawError, match=r"Snap\(\) claims to be restoring but gives 3.* N m at a twist of -0\.001.* rad.*restoring = False"):
        Snap().check_restoring()
    OpenSnap().check_restoring()


def test_a_law_that_gives_no_number_is_refused() -> None:
    with pytest.raises(LawError, match="nan N m at a twist of"), np.errstate(invalid="ignore"):
        StiffnessFunction(function=lambda twist: 1e4 * twist * np.sqrt(0.05 - np.abs(twist))).check_restoring()


def test_a_plain_function_that_takes_single_numbers_only_can_be_checked() -> None:
    def hard(twist: Any) -> Any:
        return 1e4 * twist if twist > 0 else 2e4 * twist

    StiffnessFunction(function=hard).check_restoring()


def test_a_law_that_never_reaches_a_torque_says_so() -> None:
    law = StiffnessFunction(function=lambda twist: 10.0 * np.tanh(1e3 * twist))
    with pytest.raises(LawError, match="never reaches 20 N m"):
        law.twist(20.0)


def test_a_second_corner_below_the_first_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"torque_2 = 10 N m is below torque_1 = 23\.5 N m"):
        catalogue().replacing(torque_2=10.0)


@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf])
def test_a_stiffness_that_is_not_positive_and_finite_is_refused(value: float) -> None:
    with pytest.raises(ParameterError, match=r"PiecewiseLinearStiffness\.stiffness_1"):
        catalogue().replacing(stiffness_1=value)


def test_an_unknown_keyword_of_a_law_is_refused_by_name() -> None:
    keywords: dict[str, Any] = {"linear": 1.0, "cubik": 2.0}
    with pytest.raises(TypeError, match="cubik"):
        CubicStiffness(**keywords)
