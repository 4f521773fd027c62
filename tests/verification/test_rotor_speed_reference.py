"""What the benchmark of rotor speed is judged by: its own elements, exact frequencies and run-up, held to other sources."""

from __future__ import annotations

import math
import os
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from benchmarks.rotor_speed import ross, rotor
from benchmarks.rotor_speed.accuracy import element_frequencies, exact_frequencies, frequency_errors
from benchmarks.rotor_speed.beam import AREA, SECOND_MOMENT, matrices
from benchmarks.rotor_speed.run_up import ACCELERATION, run_up

RPM = math.pi / 30.0
FRISWELL_AT_REST = (86.66, 86.66, 274.31, 274.31, 716.78, 716.78)
FRISWELL_AT_4000_RPM = (-85.39, 87.80, -251.78, 294.71, -600.18)
"""Friswell et al., Dynamics of Rotating Machines (2010), example 5.9.1, rad/s; negative: backward."""


def test_discs_have_the_printed_inertias() -> None:
    # Friswell et al., example 5.9.1: to the digits printed
    first, second = rotor.DISCS
    assert (first.mass, first.transverse_inertia, first.polar_inertia) == pytest.approx((32.5897, 0.17809, 0.32956), abs=5.1e-5)
    assert (second.mass, second.transverse_inertia, second.polar_inertia) == pytest.approx((51.5253, 0.42358, 0.80508), abs=5.1e-5)


def test_six_elements_give_the_frequencies_in_the_book() -> None:
    found = element_frequencies(6, np.array([0.0, 4000.0 * RPM]))
    assert np.abs(found[0]) == pytest.approx(FRISWELL_AT_REST, abs=0.0101)  # 716.786 is printed as 716.78
    assert found[1, :5] == pytest.approx(FRISWELL_AT_4000_RPM, abs=0.0051)


def test_elements_approach_the_exact_frequencies_with_the_square_of_their_number() -> None:
    # the shear angle is constant along an element: its energy is wrong by h^2 however fine
    speeds = np.array([0.0, 2000.0 * RPM, 4000.0 * RPM])
    exact = exact_frequencies(speeds)
    errors = [frequency_errors(element_frequencies(elements, speeds), exact)[:, 4:] for elements in (24, 48, 96)]
    orders = np.log2([coarse / fine for coarse, fine in pairwise(errors)])
    assert np.all((orders > 1.95) & (orders < 2.2))
    assert np.max(errors[-1]) < 7e-7
    assert np.array_equal(np.sign(exact), np.sign(element_frequencies(96, speeds)))


def test_matrices_carry_the_mass_and_no_stiffness_against_rigid_motion() -> None:
    plane = matrices(12)
    positions = np.linspace(0.0, rotor.LENGTH, 13)
    shift = np.array([[1.0, 0.0]] * 13).ravel()
    tilt = np.stack([positions, np.ones(13)], axis=1).ravel()
    mass = rotor.DENSITY * AREA * rotor.LENGTH + sum(disc.mass for disc in rotor.DISCS)
    about_start = rotor.DENSITY * (AREA * rotor.LENGTH**3 / 3.0 + SECOND_MOMENT * rotor.LENGTH) + sum(
        disc.mass * disc.position**2 + disc.transverse_inertia for disc in rotor.DISCS
    )
    polar = 2.0 * rotor.DENSITY * SECOND_MOMENT * rotor.LENGTH + sum(disc.polar_inertia for disc in rotor.DISCS)
    assert shift @ plane.mass @ shift == pytest.approx(mass, rel=1e-12)
    assert tilt @ plane.mass @ tilt == pytest.approx(about_start, rel=1e-12)
    assert tilt @ plane.polar @ tilt == pytest.approx(polar, rel=1e-12)
    # only the bearings resist: k at both ends
    assert shift @ plane.stiffness @ shift == pytest.approx(2.0 * rotor.BEARING_STIFFNESS, rel=1e-8)
    assert tilt @ plane.stiffness @ tilt == pytest.approx(rotor.BEARING_STIFFNESS * rotor.LENGTH**2, rel=1e-8)


@pytest.mark.parametrize("transient_term", [0.0, -1.0])
def test_reference_run_up_follows_another_integrator(transient_term: float) -> None:
    # DOP853 with steps set by the fastest mode, 52,000 rad/s, over the first tenth of the ramp
    plane = matrices(rotor.RAMP_ELEMENTS, rotor.BEARING_DAMPING)
    size = len(plane.mass)
    end = 0.1 * rotor.RAMP_DURATION
    disc = 2 * rotor.disc_stations(rotor.RAMP_ELEMENTS)[0]
    by_mass = np.linalg.inv(plane.mass)

    def rates(t: float, state: np.ndarray) -> np.ndarray:
        place, rate = state[:size], state[size:]
        speed = ACCELERATION * t
        forces = 1j * speed * (plane.polar @ rate) - plane.damping @ rate - plane.stiffness @ place
        forces -= transient_term * ACCELERATION * (plane.polar @ place.imag)  # on the plane of x alone
        forces[disc] += rotor.UNBALANCE * (speed**2 - 1j * ACCELERATION) * np.exp(0.5j * ACCELERATION * t**2)
        return np.concatenate([rate, by_mass @ forces])

    times = np.linspace(0.0, end, 501)
    solved = solve_ivp(rates, (0.0, end), np.zeros(2 * size, complex), method="DOP853", rtol=1e-7, atol=1e-12, t_eval=times)
    rows = solved.y[[2 * station for station in rotor.disc_stations(rotor.RAMP_ELEMENTS)]]
    reference = run_up(transient_term)
    # the jump of W' at the start makes the fastest modes ring with up to 1e-7 of the peak; Gauss's steps do not resolve them
    assert reference.error(times, np.stack([rows.real, rows.imag], axis=1)) < 3e-7
    assert reference.agreement < 3e-7


def test_stations_off_the_discs_are_refused() -> None:
    with pytest.raises(ValueError, match="multiple of 3"):
        rotor.disc_stations(8)


def as_ross_writes(frequencies: list[list[float]], whirl: list[list[str]]) -> dict[str, list[list[float]] | list[list[str]]]:
    return {"frequencies": frequencies, "whirl": whirl}


def test_torsional_branches_are_left_out_and_whirl_is_judged_past_rest() -> None:
    reference = np.array([[-10.0, 10.0], [-9.0, 11.0], [-8.0, 12.0]])
    labels = [["mixed", "none", "mixed"], ["forward", "none", "backward"], ["forward", "none", "forward"]]
    run = as_ross_writes([[10.0, 10.5, 10.0], [11.0, 10.5, 9.0], [12.0012, 10.5, 8.0]], labels)
    assert ross.lateral(run).tolist() == [[10.0, 10.0], [11.0, 9.0], [12.0012, 8.0]]
    assert ross.errors(run, reference) == pytest.approx(np.array([[0.0, 0.0], [0.0, 0.0], [0.0, 1e-4]]), abs=1e-12)
    assert ross.wrong_whirl(run, reference) == 0.25  # one of four: the last, 8 rad/s called forward


def test_missing_ross_python_is_named() -> None:
    with pytest.raises(FileNotFoundError, match=r"no/such/python.*README"):
        ross.ross_python(Path("no/such/python"))


@pytest.mark.skipif(not os.environ.get(ross.VARIABLE), reason=f"{ross.VARIABLE} names no Python that has ROSS")
def test_ross_gives_what_its_elements_give(tmp_path: Path) -> None:
    python = ross.ross_python(None)
    assert python is not None
    numbers = ross.measure(python, tmp_path, quick=True)
    speeds = np.array(numbers["speeds"])
    for run in numbers["campbell"]:
        if "frequencies" in run:
            found = ross.lateral(run)
            # the same elements, another eigenvalue solver: rounding only
            assert np.max(frequency_errors(found, element_frequencies(6, speeds, found.shape[1]))) < 1e-9
            assert ross.wrong_whirl(run, exact_frequencies(speeds)) == 0.0
    # ROSS's term from the acceleration is the -1 case of the reference: with it, both runs are off by Newmark's error alone
    with_term, without_term = (run_up(run["transient_term"]).error(*ross.motion(tmp_path, run)) for run in numbers["run_up"][:2])
    assert [run["transient_term"] for run in numbers["run_up"][:2]] == [-1.0, 0.0]
    assert with_term == pytest.approx(without_term, rel=0.01)
