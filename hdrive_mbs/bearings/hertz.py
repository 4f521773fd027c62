"""Hertz's theory of the contact of two curved bodies at a point."""

from __future__ import annotations

import math

from hdrive_mbs.errors import ParameterError

STEEL_MODULUS = 2.08e11
"""Young's modulus of bearing steel (AISI 52100) [Pa]."""
STEEL_POISSON = 0.3


def reduced_modulus(elastic_modulus: float, poisson_ratio: float) -> float:
    """E* = E/(2 (1 - nu^2)) of two bodies of the same material [Pa]."""
    return elastic_modulus / (2.0 * (1.0 - poisson_ratio**2))


def deflection_factor(curvature_difference: float) -> float:
    """delta* of an elliptic contact; 1 for a circular one.

    delta* = (2 K/pi) (pi/(2 kappa^2 E))^(1/3),  F = ((kappa^2 + 1) E - 2 K)/((kappa^2 - 1) E)

    with the axis ratio kappa and the complete elliptic integrals K, E of the parameter 1 - 1/kappa^2.

    Source: Harris, Rolling Bearing Analysis, 4th ed. (2001), ch. 6, whose Table 6.1 it reproduces.
    """
    from scipy.optimize import brentq
    from scipy.special import ellipe, ellipkm1

    if not 0.0 <= curvature_difference < 1.0:
        raise ParameterError(f"curvature difference F = {curvature_difference:g}: must be from 0 (circle) to below 1 (line contact).")

    def parts(log_kappa: float) -> tuple[float, float, float]:
        inverse_square = math.exp(-2.0 * log_kappa)
        return inverse_square, float(ellipkm1(inverse_square)), float(ellipe(1.0 - inverse_square))

    def difference(log_kappa: float) -> float:
        m, first, second = parts(log_kappa)
        return ((1.0 + m) * second - 2.0 * m * first) / ((1.0 - m) * second) - curvature_difference

    if curvature_difference < 1e-6:  # 0/0 below; delta* = 1 - 2/9 F^2 here
        return 1.0
    m, first, second = parts(float(brentq(difference, 1e-6, 20.0, xtol=1e-14)))
    return float(2.0 * first / math.pi * (math.pi * m / (2.0 * second)) ** (1.0 / 3.0))


def point_contact_stiffness(
    curvatures: tuple[float, float, float, float],
    elastic_modulus: float = STEEL_MODULUS,
    poisson_ratio: float = STEEL_POISSON,
) -> float:
    """k [N/m^1.5] of Q = k delta^1.5, delta the approach of the two bodies.

    k = (4 sqrt(2)/3) E* delta*^(-3/2) S^(-1/2),  S the sum of the four curvatures

    curvatures : of body 1 in planes one and two, of body 2 in the same planes [1/m], convex positive;
        the planes are the principal ones of both

    Source: Hertz (1881) in Harris's form.  Leaves out friction, lubricant and edges of the contact.
    """
    first_one, first_two, second_one, second_two = curvatures
    total = sum(curvatures)
    if total <= 0.0:
        raise ParameterError(f"sum of curvatures = {total:g} 1/m: must be greater than 0 1/m (a groove closer than the ball).")
    difference = abs(first_one - first_two + second_one - second_two) / total
    scale = 4.0 * math.sqrt(2.0) / 3.0 * reduced_modulus(elastic_modulus, poisson_ratio)
    return float(scale * deflection_factor(difference) ** -1.5 / math.sqrt(total))


def groove_stiffness(
    ball_diameter: float, pitch_diameter: float, conformity: float, inner: bool, elastic_modulus: float, poisson_ratio: float
) -> float:
    """k [N/m^1.5] of a ball in the groove of a ring, contact angle zero.

    conformity : groove radius over ball diameter, above 0.5; inner : which ring
    """
    radius = 0.5 * ball_diameter
    race = 0.5 * (pitch_diameter - ball_diameter) if inner else -0.5 * (pitch_diameter + ball_diameter)
    return point_contact_stiffness(
        (1.0 / radius, 1.0 / radius, -1.0 / (conformity * ball_diameter), 1.0 / race), elastic_modulus, poisson_ratio
    )


def in_series(first: float, second: float) -> float:
    """k of two contacts in series: their approaches add."""
    return float((first ** (-2.0 / 3.0) + second ** (-2.0 / 3.0)) ** -1.5)
