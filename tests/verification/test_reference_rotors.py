"""The reference rotor line checked against closed forms, a second derivation and a second integrator."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import sympy as sp

from tests.verification import derive_rotor_body as derivation
from tests.verification import reference_rotor_values as values
from tests.verification import rotor_body_equations as generated
from tests.verification.reference_rotors import (
    Body,
    Line,
    System,
    full,
    reference_line,
    section_shapes,
    section_stiffness,
    simplified,
)
from tests.verification.reference_run_up import exponential, radau, start
from tests.verification.reference_sommerfeld import UnbalancedDisc, spin_up
from tests.verification.reference_whirl import critical_speeds, modes, unbalance_response, undamped_frequencies

ROTOR = Body(mass=8.0, polar=0.03, transverse=0.0206, eccentricity=0.01, eccentricity_direction=0.7, tilt=0.2, tilt_direction=-1.1)
"""A violent unbalance, so that every term shows."""
BEAM = {"diameter": 0.022, "youngs_modulus": 2.1e11, "shear_modulus": 8.1e10}
COORDINATES = ("x", "y", "z", "psi", "theta", "phi")


def rotation(psi: float, theta: float, phi: float) -> np.ndarray:
    cx, sx, cy, sy, cz, sz = (f(angle) for angle in (psi, theta, phi) for f in (math.cos, math.sin))
    about_x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_z = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    return np.asarray(about_x @ about_y @ about_z)


def point_masses(body: Body) -> list[tuple[float, np.ndarray]]:
    """Six point masses in the body's frame with its mass, mass centre and principal inertias.

    Pairs at +-r on the principal axes, sum m r^2 of the pairs: i, i, k with i + k = Jt, 2 i = Jp.
    """
    b, d = body.tilt_direction, body.tilt
    axis = np.array([math.sin(d) * math.cos(b), math.sin(d) * math.sin(b), math.cos(d)])
    first = np.cross([0.3, -0.2, 0.9], axis)
    first /= np.linalg.norm(first)
    a = body.eccentricity_direction
    centre = body.eccentricity * np.array([math.cos(a), math.sin(a), 0.0])
    i = body.polar / 2
    reaches = [math.sqrt(3 * value / body.mass) for value in (i, i, body.transverse - i)]
    return [
        (body.mass / 6, centre + side * reach * direction)
        for reach, direction in zip(reaches, (first, np.cross(axis, first), axis))
        for side in (1, -1)
    ]


def test_generated_equations_are_newtons_for_a_cloud_of_point_masses() -> None:
    # Q_j = sum m_i a_i . dr_i/dq_j along q(t) = q + v t + a t^2/2; a_i by seven-point differences (h^6 / 90 x eighth derivative).
    rng = np.random.default_rng(5)
    q, v, a = rng.normal(size=(3, 6))
    h = 4e-3
    weights = np.array([2, -27, 270, -490, 270, -27, 2]) / (180 * h**2)
    expected = np.zeros(6)
    for mass, place in point_masses(ROTOR):

        def position(coordinates: np.ndarray, place: np.ndarray = place) -> np.ndarray:
            return np.asarray(coordinates[:3] + rotation(*coordinates[3:]) @ place)

        path = np.array([position(q + v * t + 0.5 * a * t**2) for t in h * np.arange(-3, 4)])
        acceleration = weights @ path
        for j, direction in enumerate(np.eye(6)):
            slope = sum(w * (position(q + k * h * direction) - position(q - k * h * direction)) for k, w in ((1, 45), (2, -9), (3, 1)))
            expected[j] += mass * acceleration @ slope / (60 * h)
    M, force = generated.inertia(*ROTOR.numbers, *q[3:], *v[3:])
    assert np.array(M) @ a + np.array(force) == pytest.approx(expected, rel=1e-7, abs=1e-9)


def test_checked_in_equations_are_those_that_lagrange_gives_from_the_kinetic_energy() -> None:
    T = derivation.kinetic_energy()
    Q, V = derivation.POSITIONS, derivation.VELOCITIES
    momentum = sp.Matrix([sp.diff(T, w) for w in V])
    M = momentum.jacobian(V)
    force = momentum.jacobian(Q) * sp.Matrix(V) - sp.Matrix([sp.diff(T, q) for q in Q])
    evaluate = sp.lambdify((*derivation.PARAMETERS, *Q, *V), (M, force, T), cse=True)
    rng = np.random.default_rng(7)
    for body in (ROTOR, replace(ROTOR, eccentricity=0.0, tilt=0.0)):
        q, v = rng.normal(size=(2, 6))
        matrix, vector, energy = evaluate(*body.numbers, *q, *v)
        found_matrix, found_vector = body.inertia(q, v)
        assert np.array(found_matrix) == pytest.approx(np.array(matrix, float), rel=1e-12, abs=1e-14)
        assert np.array(found_vector) == pytest.approx(np.array(vector, float).ravel(), rel=1e-12, abs=1e-14)
        assert body.kinetic_energy(q, v) == pytest.approx(float(energy), rel=1e-13)


def test_steady_rotor_pulls_along_its_eccentricity_and_tips_ahead_of_its_tilt() -> None:
    # On the shaft: force m e W^2 at angle a, moment (Jt - Jp) d W^2 about the axis at b + 90 degrees (sin d cos d for large d).
    W, a, b = 300.0, ROTOR.eccentricity_direction, ROTOR.tilt_direction
    _, h = ROTOR.inertia(np.zeros(6), np.array([0, 0, 0, 0, 0, W]))
    force = ROTOR.mass * ROTOR.eccentricity * W**2
    moment = (ROTOR.transverse - ROTOR.polar) * math.sin(ROTOR.tilt) * math.cos(ROTOR.tilt) * W**2
    on_shaft = [force * math.cos(a), force * math.sin(a), 0.0, -moment * math.sin(b), moment * math.cos(b), 0.0]
    assert -np.array(h) == pytest.approx(on_shaft, rel=1e-12, abs=1e-9)


def test_linear_tilts_are_the_first_order_of_the_exact_equations_at_constant_speed() -> None:
    # Left out: unbalance x tilt, 1e-6 m e W^2 a term, and less.  A few terms and random tilts up to 3e-6: 10 of them.
    rng = np.random.default_rng(11)
    q, v = 1e-6 * rng.normal(size=(2, 6))
    v[3:5] *= 300.0
    q[5], v[5] = 0.4, 300.0
    light = replace(ROTOR, eccentricity=2e-5, tilt=5e-4)
    _, exact = light.inertia(q, v)
    _, linear = replace(light, exact=False).inertia(q, v)
    assert np.array(linear)[:5] == pytest.approx(np.array(exact)[:5], abs=1e-5 * light.mass * light.eccentricity * 300.0**2)
    assert abs(exact[3] - generated.inertia(*light.numbers, 0, 0, q[5], 0, 0, v[5])[1][3]) > 1e-3, "the gyroscopic moment shows"


def test_section_bends_like_a_cantilever_and_does_not_resist_rigid_motion() -> None:
    L, second, area = 0.3, math.pi * 0.022**4 / 64, math.pi * 0.022**2 / 4
    K = section_stiffness(L, **BEAM)
    tip = np.linalg.solve(K[6:, 6:], np.diag([100.0, 100.0, 100.0, 1.0, 1.0, 1.0]))
    deflection = 100.0 * L**3 / (3 * 2.1e11 * second)
    slope = 100.0 * L**2 / (2 * 2.1e11 * second)
    assert (tip[0, 0], tip[4, 0]) == pytest.approx((deflection, slope)), "x with +theta"
    assert (tip[1, 1], tip[3, 1]) == pytest.approx((deflection, -slope)), "y with -psi"
    assert tip[2, 2] == pytest.approx(100.0 * L / (2.1e11 * area))
    assert tip[5, 5] == pytest.approx(L / (8.1e10 * 2 * second))
    rigid = np.zeros((12, 6))
    rigid[:6], rigid[6:] = np.eye(6), np.eye(6)
    rigid[6, 4], rigid[7, 3] = L, -L
    assert np.abs(K @ rigid).max() < 1e-12 * np.abs(K).max()
    assert pytest.approx(K.T) == K


def test_shape_functions_carry_cubics_exactly() -> None:
    def cubic(s: float) -> tuple[float, float]:
        return 2 - 3 * s + 5 * s**2 - 7 * s**3, -3 + 10 * s - 21 * s**2

    deflection, slope = section_shapes(0.31, 0.06)
    ends = np.array([*cubic(0.0), *cubic(0.31)])
    assert (deflection @ ends, slope @ ends) == pytest.approx(cubic(0.06), rel=1e-13)


def test_overhung_disc_whirls_at_the_closed_form_in_the_fixed_frame() -> None:
    # Massless cantilever d = 20 mm, L = 0.4 m, E = 2.1e11; disc m = 5, Id = .02, Ip = .04; 100 rad/s; r = x + i y, s = theta - i psi:
    # (12 EI/L^3 - m w^2)(4 EI/L - Id w^2 + Ip W w) = (6 EI/L^2)^2, negative roots backward.
    disc = Body(mass=5.0, polar=0.04, transverse=0.02)
    L, EI = 0.4, 2.1e11 * math.pi * 0.02**4 / 64
    product = np.polymul([-5.0, 0.0, 12 * EI / L**3], [-0.02, 0.04 * 100.0, 4 * EI / L])
    roots = sorted(np.roots(np.polysub(product, [(6 * EI / L**2) ** 2])).real)
    assert roots == pytest.approx([-845.1467, -115.4136, 126.4118, 1034.1485], abs=1e-4)
    K = section_stiffness(L, 0.02, 2.1e11, 8.1e10)[6:, 6:]
    labels = tuple(f"disc.{c}" for c in COORDINATES)
    system = System(Line(stations=()), labels, ((0, disc),), np.zeros((6, 6)), K, np.zeros((6, 6)), (), ())
    found = sorted(w if whirl == "forward" else -w for w, whirl in undamped_frequencies(system, 100.0) if whirl in ("forward", "backward"))
    assert found == pytest.approx(roots, rel=1e-9)


def test_critical_speeds_are_where_the_whirl_frequency_meets_the_speed() -> None:
    system = full(reference_line())
    for speed, whirl in critical_speeds(system, 1300.0):
        nearest = min((w for w, kind in undamped_frequencies(system, speed) if kind == whirl), key=lambda w: abs(w - speed))
        assert nearest == pytest.approx(speed, rel=1e-9)


def test_simplified_bearing_is_a_ritz_bound_of_the_full_one_with_locked_ring() -> None:
    # Section 5 locks ring and housing and allows the shaft one cubic across the bearing: a constraint raises every frequency at rest.
    line = reference_line()
    locked = full(line.with_bearings(stiffness=1e13))
    bending = [
        [w for w, kind in undamped_frequencies(s, 0.0) if kind not in ("axial", "torsional")][:6] for s in (locked, simplified(line))
    ]
    assert all(b > a for a, b in zip(*bending))
    assert bending[1][0] == pytest.approx(bending[0][0], rel=0.02)


def test_simplified_bearing_carries_the_whole_mass_in_rigid_translation() -> None:
    line = reference_line()
    system = simplified(line)
    for axis in "xy":
        rigid = np.array([1.0 if label.endswith(f".{axis}") else 0.0 for label in system.labels])
        masses = sum(s.body.mass + (s.bearing.housing_mass if s.bearing else 0.0) for s in line.stations)
        assert rigid @ system.nominal @ rigid == pytest.approx(masses)
        assert rigid @ system.stiffness @ rigid == pytest.approx(2 * 6e6)


def test_nonlinear_line_started_in_its_steady_whirl_stays_there() -> None:
    line = reference_line(drive=lambda _: 0.0)
    system = full(line)
    n, speed = len(system.labels), 300.0
    Q = unbalance_response(system, speed)
    state = start(system, speed)
    state[:n] += Q.real
    state[n:] += (1j * speed * Q).real
    run = exponential(system, end=0.05, step=1e-4, state=state)
    for rotor in values.ROTORS:
        steady = abs(Q[system.index(f"{rotor}.x")])
        # the drag of the whirl slows the line by 7e-8 of its speed in that time, and terms of second order are left out
        assert run.distance(rotor) == pytest.approx(steady, rel=5e-6)
    start_angle = np.angle(Q[system.index("rotor_1.x")])
    turned = np.unwrap(np.arctan2(run.history("rotor_1.y"), run.history("rotor_1.x")))
    assert turned[-1] == pytest.approx(start_angle + run.history("rotor_1.phi")[-1], abs=1e-5), "forward, with the spin"


NONLINEAR = reference_line(gravity=True).with_bearings(stiffness=1.2e7, cubic=1e18)


def test_two_integrators_agree_through_a_critical_speed_with_gravity_and_cubic_bearings() -> None:
    system = full(NONLINEAR)
    state = start(system, 360.0)
    smooth = exponential(system, end=0.03, step=2.5e-5, state=state, keep=4)
    adaptive = radau(system, end=0.03, step=1e-4, state=state, tolerance=1e-9)
    for label in ("rotor_1.x", "rotor_2.y", "A.housing.y", "B.theta"):
        scale = np.abs(adaptive.history(label)).max()
        assert np.abs(smooth.history(label) - adaptive.history(label)).max() < 1e-8 * scale
    assert smooth.rate("rotor_1.phi")[-1] == pytest.approx(adaptive.rate("rotor_1.phi")[-1], rel=1e-9)


def test_exponential_integrator_has_order_four() -> None:
    system = full(reference_line())
    state = start(system, 350.0)
    ends = [exponential(system, end=0.04, step=h, state=state).states[-1] for h in (4e-4, 2e-4, 1e-4)]
    i = system.index("rotor_1.x")
    ratio = abs(ends[0][i] - ends[1][i]) / abs(ends[1][i] - ends[2][i])
    assert math.log2(ratio) == pytest.approx(4.0, abs=0.6)


@pytest.mark.parametrize("model", [full, simplified])
def test_undamped_line_keeps_all_the_work_of_the_drive(model: Any) -> None:
    line = reference_line().with_bearings(damping=0.0, tilt_damping=0.0, housing_damping=0.0, axial_damping=0.0)
    run = exponential(model(replace(line, damping=0.0)), end=0.25, step=5e-5, keep=10)
    assert run.dissipated[-1] == 0.0
    assert abs(run.energy_error) < 1e-8


def test_stored_run_up_comes_out_again_within_the_error_of_a_double_step() -> None:
    stored = values.load()["m_ref full"]
    run = exponential(full(reference_line()), end=values.END, step=2 * stored["step"])
    for rotor in values.ROTORS:
        found, kept = run.peak(rotor), stored["peaks"][rotor]
        assert found.amplitude == pytest.approx(kept["amplitude"], rel=1e-5)
        assert found.speed == pytest.approx(kept["speed"], rel=1e-5)
    assert run.rate("rotor_1.phi")[-1] == pytest.approx(stored["final_speed"], rel=1e-8)
    assert run.work[-1] == pytest.approx(stored["work"], rel=1e-8)


def test_every_stored_case_is_converged_to_a_hundredth_of_the_required_tenth_of_a_percent() -> None:
    for name, case in values.load().items():
        assert name in values.CASES
        assert max(case["uncertainty"][key] for key in ("amplitude", "speed", "final_speed", "work")) < 1e-5
        assert abs(case["energy_error"]) < 1e-6


@pytest.mark.parametrize("name", list(values.CASES))
def test_stored_critical_speeds_and_modes_are_those_of_the_data(name: str) -> None:
    model, line, _ = values.CASES[name]
    stored, system = values.load()[name], model(line)
    found = critical_speeds(system, 1500.0)
    assert [w for w, _ in found] == pytest.approx([c["undamped"] for c in stored["critical_speeds"]], rel=1e-9)
    assert [kind for _, kind in found] == [c["whirl"] for c in stored["critical_speeds"]]
    now = [mode.frequency for mode in modes(system, 500.0) if mode.frequency < 4000.0]
    assert now == pytest.approx([m["frequency"] for m in stored["modes"]["500"]], rel=1e-7)


def test_accelerating_torque_at_the_lever_of_a_tilt_is_the_tenth_of_a_percent_that_linear_tilts_lose() -> None:
    # (8) leaves out Jp phi'' theta.  Smaller than the tolerance of a comparison with a measurement, larger than of one between programs.
    exact, linear = (values.load()[name]["peaks"]["rotor_1"] for name in ("m_ref full", "m_ref full, linear tilts"))
    assert 5e-4 < abs(linear["amplitude"] / exact["amplitude"] - 1) < 2e-3
    assert 1e-4 < abs(linear["speed"] / exact["speed"] - 1) < 1e-3


def test_simplified_bearing_refuses_what_section_5_does_not_have() -> None:
    with pytest.raises(ValueError, match="section 5"):
        simplified(reference_line(gravity=True))


DISC = UnbalancedDisc()


def test_equations_about_the_centre_and_about_the_mass_centre_give_one_motion() -> None:
    rng = np.random.default_rng(3)
    violent = replace(DISC, eccentricity=0.2)
    about_centre = replace(violent, inertia=violent.inertia + violent.mass * 0.2**2, about_centre=True)
    for _ in range(3):
        u = rng.normal(size=6)
        assert violent.slope(0.3, u) == pytest.approx(violent.slope_about_centre(0.3, u), rel=1e-11)
        assert about_centre.slope(0.3, u) == pytest.approx(violent.slope(0.3, u), rel=1e-11)


def test_disc_without_damping_keeps_the_work_of_the_torque() -> None:
    run = spin_up(replace(DISC, damping=0.0), 0.4, end=60.0, tolerance=1e-10)
    work = 0.4 * run.states[:, 2]
    assert DISC.energy(run.states.T) == pytest.approx(work, rel=1e-8, abs=1e-8)


def test_strong_torque_passes_the_critical_speed_and_a_weak_one_is_captured_at_its_steady_torque() -> None:
    # Threshold from rest by bisection: 0.19712 N m, far below the top of the resonance, 0.4381 N m.
    passing = spin_up(DISC, 0.1973, end=300.0, tolerance=1e-8)
    captured = spin_up(DISC, 0.1970, end=400.0, tolerance=1e-8)
    assert passing.passed
    assert not captured.passed
    assert DISC.largest_steady_torque()[1] == pytest.approx(0.4381, abs=1e-4)
    late = captured.times > 380.0
    assert captured.speed[late].max() < DISC.critical_speed
    assert DISC.steady_torque(float(captured.speed[late].mean())) == pytest.approx(0.1970, rel=0.02)
