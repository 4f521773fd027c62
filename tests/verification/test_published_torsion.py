"""Torsional modes against published cases, closed forms and an eigenproblem built by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import brentq

import hdrive_mbs as hm
from tests.verification.reference_laws import kloss
from tests.verification.scenes import SENSE, chain, train


def chain_matrices(inertias: list[float], values: list[float]) -> tuple[np.ndarray, np.ndarray]:
    """M and K (or D) of a free chain:  K = sum k_i (e_i - e_i+1)(e_i - e_i+1)^T."""
    n = len(inertias)
    K = np.zeros((n, n))
    for i, k in enumerate(values):
        e = np.zeros(n)
        e[i], e[i + 1] = 1.0, -1.0
        K += k * np.outer(e, e)
    return np.diag(inertias), K


def state_matrix(M: np.ndarray, D: np.ndarray, K: np.ndarray) -> np.ndarray:
    """A of d/dt (q, q') = A (q, q')."""
    n = len(M)
    return np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, D)]])


def oscillating(A: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Im(lambda) > 0 ascending, and -Re/|lambda| of the same."""
    values = np.linalg.eigvals(A)
    values = values[values.imag > 1e-6 * np.abs(values).max()]
    values = values[np.argsort(values.imag)]
    return values.imag, -values.real / np.abs(values)


# -- published ---------------------------------------------------------------------------------------

FRISWELL_STIFFNESS = [12e3, 12e3, 14e3, 10e3]
FRISWELL_HERTZ = [81.21, 141.21, 378.95, 536.36]
"""Friswell, Penny, Garvey, Lees, Dynamics of Rotating Machines (2010): five discs, N m/rad and Hz."""


def test_the_published_inertias_mean_three_small_discs_followed_by_two_large_ones() -> None:
    # "I = 3 x 3.5e-3, .15, .05" with four stiffnesses: five discs; of all orders only this one gives the printed values
    found = []
    for first, second in ((3, 4), (0, 4), (0, 1), (1, 3), (2, 3), (1, 2), (0, 2), (0, 3), (1, 4), (2, 4)):
        for big, small in ((0.15, 0.05), (0.05, 0.15)):
            inertias = [3.5e-3] * 5
            inertias[first], inertias[second] = big, small
            M, K = chain_matrices(inertias, FRISWELL_STIFFNESS)
            hertz = np.sqrt(np.abs(eigh(K, M, eigvals_only=True)[1:])) / (2.0 * math.pi)
            if np.max(np.abs(hertz - FRISWELL_HERTZ)) < 0.005:
                found.append(inertias)
    assert found == [[3.5e-3, 3.5e-3, 3.5e-3, 0.15, 0.05]]


def test_five_discs_of_friswell_have_the_published_frequencies() -> None:
    result = hm.modes(chain([3.5e-3, 3.5e-3, 3.5e-3, 0.15, 0.05], FRISWELL_STIFFNESS))
    assert result.rigid_modes == 1
    # printed to 0.01 Hz: half of the last digit
    np.testing.assert_allclose(result.undamped / (2.0 * math.pi), FRISWELL_HERTZ, rtol=0.0, atol=0.005)
    np.testing.assert_allclose(result.damped, result.undamped, rtol=1e-9)


def test_damped_chain_of_four_has_the_published_frequencies() -> None:
    inertias, stiffnesses, dampings = [0.05, 0.02, 0.03, 0.2], [5e3, 2e3, 1e4], [2.0, 1.0, 3.0]
    result = hm.modes(chain(inertias, stiffnesses, dampings))
    # openTorsion example, printed to 1e-4 rad/s: half of the last digit
    np.testing.assert_allclose(result.undamped, [164.1095, 605.3692, 711.7557], rtol=0.0, atol=0.5e-4)
    np.testing.assert_allclose(result.damped, [164.0049, 602.7842, 703.8490], rtol=0.0, atol=0.5e-4)
    M, K = chain_matrices(inertias, stiffnesses)
    _, D = chain_matrices(inertias, dampings)
    damped, ratio = oscillating(state_matrix(M, D, K))
    np.testing.assert_allclose(result.damped, damped, rtol=1e-9)
    np.testing.assert_allclose(result.damping_ratio, ratio, rtol=1e-9)


# -- closed forms --------------------------------------------------------------------------------------


def test_two_inertias_follow_the_closed_form() -> None:
    i_1, i_2, k, c = 0.013, 0.27, 4321.0, 1.7
    result = hm.modes(chain([i_1, i_2], [k], [c]))
    # relative twist x: mu x'' + c x' + k x = 0 with mu = I1 I2/(I1 + I2)
    mu = i_1 * i_2 / (i_1 + i_2)
    undamped, ratio = math.sqrt(k / mu), 0.5 * c / math.sqrt(k * mu)
    np.testing.assert_allclose(result.undamped, [undamped], rtol=1e-9)
    np.testing.assert_allclose(result.damping_ratio, [ratio], rtol=1e-9)
    np.testing.assert_allclose(result.damped, [undamped * math.sqrt(1.0 - ratio**2)], rtol=1e-9)
    # momentum: I1 q1 + I2 q2 = 0
    np.testing.assert_allclose(result.shapes[:, 0], [1.0, -i_1 / i_2], rtol=1e-9)


def test_three_inertias_follow_the_closed_form() -> None:
    (i_1, i_2, i_3), (k_1, k_2) = (0.02, 0.07, 0.4), (3.1e3, 8.7e3)
    result = hm.modes(chain([i_1, i_2, i_3], [k_1, k_2]))
    # det(K - x M) = -x [I1 I2 I3 x^2 - (k1 I3 (I1 + I2) + k2 I1 (I2 + I3)) x + k1 k2 (I1 + I2 + I3)]
    a, b, c = i_1 * i_2 * i_3, k_1 * i_3 * (i_1 + i_2) + k_2 * i_1 * (i_2 + i_3), k_1 * k_2 * (i_1 + i_2 + i_3)
    root = math.sqrt(b * b - 4.0 * a * c)
    np.testing.assert_allclose(result.undamped, [math.sqrt((b - root) / (2.0 * a)), math.sqrt((b + root) / (2.0 * a))], rtol=1e-9)


@pytest.mark.parametrize(("sense_name", "sense"), [("opposite", -1.0), ("same", 1.0)])
def test_two_inertias_across_the_gear_follow_the_closed_form(sense_name: str, sense: float) -> None:
    i_1, i_2, u, k = 2.3e-4, 0.31, 50.0, 2.7e4
    scene = hm.Scene(
        name="geared pair",
        parts={
            "drive": hm.Inertia(inertia=i_1),
            "gear": hm.HarmonicDrive(ratio=u, stiffness=hm.CubicStiffness(linear=k, cubic=0.0), output_sense=sense_name),
            "arm": hm.Inertia(inertia=i_2),
        },
        connections=[("drive", "gear", "arm")],
    )
    result = hm.modes(scene)
    # x = q1/u - q2 forward: x'' = -k x (1/(u^2 I1) + 1/I2), and the coordinate-wise momentum u I1 q1 + I2 q2 = 0
    np.testing.assert_allclose(result.undamped, [math.sqrt(k * (1.0 / (u * u * i_1) + 1.0 / i_2))], rtol=1e-9)
    drive, arm = (result.bodies.index(name) for name in ("drive", "arm"))
    assert result.shapes[arm, 0] / result.shapes[drive, 0] == pytest.approx(-sense * u * i_1 / i_2, rel=1e-9)


# -- the train of seed F ------------------------------------------------------------------------------------


def train_matrices(mesh_stiffness: float, motor_slope: float, mesh_damping: float = 20.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """M, D, K of (1)-(4), row by row, in forward coordinates (s, WG, FS, MR)."""
    u, k1, k3, b1, b3 = 100.0, 1e4, 5.1913e4, 0.05, 5.0
    M = np.diag([1.5e-3 + 0.5e-5, 1.69e-4 + 0.5e-5, 4e-4 + 0.5 * 2.465e-5, 0.5 + 0.5 * 2.465e-5])

    def rows(k_in: float, k: float, k_out: float) -> np.ndarray:
        return np.array(
            [
                [k_in, -k_in, 0.0, 0.0],
                [-k_in, k_in + k / u**2, -k / u, 0.0],
                [0.0, -k / u, k + k_out, -k_out],
                [0.0, 0.0, -k_out, k_out],
            ]
        )

    D = rows(b1, mesh_damping, b3)
    D[0, 0] -= motor_slope  # M_s(w) on the right of (1)
    return M, D, rows(k1, mesh_stiffness, k3)


@pytest.mark.parametrize(("torque", "mesh_stiffness"), [(20.0, 3.2e4), (50.0, 6.4e4), (120.0, 11e4)])
def test_modes_of_the_train_agree_with_an_eigenproblem_by_hand_on_every_branch_of_the_law(torque: float, mesh_stiffness: float) -> None:
    curve = kloss(power=550.0, speed=1410.0 * math.pi / 30.0, pole_pairs=2, frequency=50.0, breakdown=2.4)

    def motor(speed: float) -> float:
        return curve.torque(0.0, 0.0, speed, (), ())

    # the motor balances T/u on the falling branch, between the rated and the synchronous speed
    speed = brentq(lambda w: motor(w) - torque / 100.0, 130.0, 50.0 * math.pi, xtol=1e-12)
    slope = (motor(speed + 1e-3) - motor(speed - 1e-3)) / 2e-3  # error (1e-3)^2 M'''/6, below 1e-9 of it
    M, D, K = train_matrices(mesh_stiffness, slope)
    damped, ratio = oscillating(state_matrix(M, D, K))

    result = hm.modes(train(load=hm.ConstantTorque(value=torque)))
    assert result.motor_speed == pytest.approx(speed, rel=1e-9)
    assert result.rigid_modes == 1
    values, vectors = eigh(K, M)
    # 1e-6: Exudyn differentiates by differences of about sqrt(eps)
    np.testing.assert_allclose(result.undamped, np.sqrt(values[1:]), rtol=1e-6)
    np.testing.assert_allclose(result.damped, damped, rtol=1e-6)
    np.testing.assert_allclose(result.damping_ratio, ratio, rtol=1e-6)
    order = [result.bodies.index(name) for name in SENSE]
    for k in range(3):
        shape = np.array(list(SENSE.values())) * vectors[:, k + 1]
        np.testing.assert_allclose(result.shapes[order, k], shape / shape[np.argmax(np.abs(shape))], rtol=0.0, atol=1e-6)


def test_an_unloaded_train_in_its_gap_has_two_rigid_motions_and_the_modes_of_its_halves() -> None:
    result = hm.modes(train(load=hm.ConstantTorque(value=0.0)), motor_speed=0.0)
    M, _, K = train_matrices(0.0, 0.0)
    assert result.rigid_modes == 2
    np.testing.assert_allclose(result.undamped, np.sqrt(eigh(K, M, eigvals_only=True)[2:]), rtol=1e-6)
    assert "lost motion" in result.status
