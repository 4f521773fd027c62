"""Table 1 of Folega et al. 2014 (seed F), HDUC 32-100, to all printed digits."""

from __future__ import annotations

import math

import pytest

from hdrive_mbs.conversions import arcmin
from hdrive_mbs.flexsplines.piecewise_linear import PiecewiseLinearStiffness

# Table 1: phi0 = 9 arcmin, K1, K2, K3 in N m/rad, T1, T2 in N m, and the torque T of each row
PHI0_ARCMIN = 9.0
K1, K2, K3 = 3.2e4, 6.4e4, 11e4
T1, T2 = 23.5, 98.0
ROWS = {0.0: "1.31e-03", 23.5: "2.04e-03", 98.0: "3.21e-03", 137.0: "3.56e-03"}

EDGE = (PHI0_ARCMIN / 2.0) * math.pi / (180.0 * 60.0)
"""(7), as printed."""


def law() -> PiecewiseLinearStiffness:
    return PiecewiseLinearStiffness(
        lost_motion=arcmin(PHI0_ARCMIN), stiffness_1=K1, stiffness_2=K2, stiffness_3=K3, torque_1=T1, torque_2=T2
    )


def test_the_edge_of_the_gap_is_equation_7_as_printed() -> None:
    assert law().half_gap == pytest.approx(EDGE, rel=1e-15)
    assert f"{law().half_gap:.2e}" == ROWS[0.0]


@pytest.mark.parametrize("torque", [23.5, 98.0, 137.0])
def test_the_twist_at_each_torque_of_table_1_has_the_printed_digits(torque: float) -> None:
    assert f"{float(law().twist(torque)):.2e}" == ROWS[torque]


@pytest.mark.parametrize("torque", [23.5, 98.0, 137.0])
def test_the_torque_at_the_twist_of_table_1_comes_back(torque: float) -> None:
    # a torque and its twist are inverse; only rounding remains (twist 3e-3 x stiffness 1e5 x 1e-16)
    assert float(law().torque(float(law().twist(torque)))) == pytest.approx(torque, rel=1e-12)
    assert float(law().torque(-float(law().twist(torque)))) == pytest.approx(-torque, rel=1e-12)


def printed_9(torque: float) -> float:
    """(9) as printed: T/K1 where the table needs T1/K1."""
    return EDGE + torque / K1 + (torque - T1) / K2


def printed_10(torque: float) -> float:
    """(10) as printed: T/K1 and (T - T1)/K2 where the table needs T1/K1 and (T2 - T1)/K2."""
    return EDGE + torque / K1 + (torque - T1) / K2 + (torque - T2) / K3


def test_equation_9_as_printed_does_not_give_table_1() -> None:
    # 1.309e-3 + 98/3.2e4 + 74.5/6.4e4 = 5.54e-3 rad, 73 % more than the table's 3.21e-3
    assert f"{printed_9(98.0):.2e}" == "5.54e-03"
    assert f"{printed_9(98.0):.2e}" != ROWS[98.0]
    # the difference is exactly the misprinted term (T - T1)/K1
    assert printed_9(98.0) - float(law().twist(98.0)) == pytest.approx((98.0 - T1) / K1, rel=1e-12)


def test_equation_10_as_printed_does_not_give_table_1() -> None:
    # 1.309e-3 + 137/3.2e4 + 113.5/6.4e4 + 39/11e4 = 7.72e-3 rad, more than twice the table's 3.56e-3
    assert f"{printed_10(137.0):.2e}" == "7.72e-03"
    assert f"{printed_10(137.0):.2e}" != ROWS[137.0]
    excess = (137.0 - T1) / K1 + (137.0 - T2) / K2
    assert printed_10(137.0) - float(law().twist(137.0)) == pytest.approx(excess, rel=1e-12)


def test_equation_9_as_printed_gets_softer_above_the_first_corner_instead_of_stiffer() -> None:
    # as printed (9) joins (8) at T1 ...
    assert printed_9(T1) == pytest.approx(EDGE + T1 / K1, rel=1e-12)
    # ... but its slope there is 1/K1 + 1/K2: softer above the corner, against Fig. 5 and K2 > K1
    step = 1e-3
    slope = (printed_9(T1 + step) - printed_9(T1)) / step
    assert slope == pytest.approx(1.0 / K1 + 1.0 / K2, rel=1e-9)
    assert slope > 1.0 / K1
    ours = (float(law().twist(T1 + step)) - float(law().twist(T1))) / step
    assert ours == pytest.approx(1.0 / K2, rel=1e-9)
