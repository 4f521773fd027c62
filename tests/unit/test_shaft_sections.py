"""Matrices of shaft sections against statics, closed-form frequencies and each other; condensation against the whole."""

from __future__ import annotations

import itertools
import math

import numpy as np
import numpy.typing as npt
import pytest

from hdrive_mbs.errors import ParameterError, SceneError
from hdrive_mbs.shafts.beam import Beam
from hdrive_mbs.shafts.condensation import craig_bampton, guyan
from hdrive_mbs.shafts.offset import rigid_arm
from hdrive_mbs.shafts.section_geometry import CircularSection, cowper_shear_coefficient, poisson_ratio

Array = npt.NDArray[np.float64]

E, G, RHO = 2.1e11, 8.1e10, 7850.0
NU = E / (2.0 * G) - 1.0
ROUNDING = 1e-12
"""Sums of about a hundred products of numbers with 16 digits, with some cancellation."""

TURN = np.zeros((12, 12))
"""Turns every lateral vector by +90 degrees about z: x to y, y to -x, and the tilts alike."""
for _a, _b in ((0, 1), (3, 4), (6, 7), (9, 10)):
    TURN[_b, _a], TURN[_a, _b] = 1.0, -1.0


def beam(length: float = 0.4, *, shear: bool = True, diameter: float = 0.06, bore: float = 0.02, density: float = RHO) -> Beam:
    return Beam.circular(length=length, diameter=diameter, bore=bore, youngs_modulus=E, shear_modulus=G, density=density, shear=shear)


def rigid_motions(length: float) -> Array:
    """12x6: columns are unit x, y, z, psi, theta, phi about end a, small tilts."""
    return np.vstack([np.eye(6), rigid_arm(length)])


def chain(matrices: list[Array]) -> Array:
    """The matrix of 12x12 sections in a row, over 6 coordinates a station."""
    size = 6 * (len(matrices) + 1)
    total = np.zeros((size, size))
    for k, matrix in enumerate(matrices):
        total[6 * k : 6 * k + 12, 6 * k : 6 * k + 12] += matrix
    return total


def pinned(matrix: Array, directions: tuple[int, ...] = (0, 1, 3, 4)) -> Array:
    """The lateral part of a chain with x and y held at both ends."""
    size = len(matrix)
    free = [k for k in range(size) if k % 6 in directions and k not in (0, 1, size - 6, size - 5)]
    return matrix[np.ix_(free, free)]


def squares(mass: Array, stiffness: Array) -> Array:
    """Squares of the natural frequencies, ascending, of M q'' + K q = 0 with positive M."""
    lower = np.linalg.inv(np.linalg.cholesky(mass))
    return np.linalg.eigvalsh(lower @ stiffness @ lower.T)


def eigenvalues(mass: Array, damping: Array, stiffness: Array) -> npt.NDArray[np.complex128]:
    size = len(mass)
    first = np.block([[np.zeros((size, size)), np.eye(size)], [-np.linalg.solve(mass, stiffness), -np.linalg.solve(mass, damping)]])
    return np.linalg.eigvals(first).astype(complex)


def close(found: Array, wanted: Array, share: float = ROUNDING) -> None:
    """Equal but for a share of the entry's own scale, row and column units apart."""
    wanted = np.asarray(wanted)
    if wanted.ndim == 2 and wanted.shape[0] == wanted.shape[1] and np.any(wanted):
        size = np.sqrt(np.maximum(np.abs(wanted).max(axis=1), 1e-300))
        scale = np.outer(size, size)
    else:
        scale = np.full(wanted.shape, max(float(np.abs(wanted).max()), 1e-300))
    assert np.max(np.abs(found - wanted) / scale) < share


# --- section -----------------------------------------------------------------------------------------------------


def test_moments_of_a_tube_are_the_integrals_over_its_wall() -> None:
    section = CircularSection(diameter=0.08, bore=0.05)
    points, weights = np.polynomial.legendre.leggauss(8)
    radius = 0.0325 + 0.0075 * points  # middle of the wall and half its thickness
    ring = 2.0 * math.pi * radius * 0.0075 * weights
    assert section.area == pytest.approx(ring.sum(), rel=ROUNDING)
    assert section.polar_moment == pytest.approx(ring @ radius**2, rel=ROUNDING)
    assert section.second_moment == pytest.approx(ring @ radius**2 / 2.0, rel=ROUNDING)


@pytest.mark.parametrize("ratio", [0.0, 0.3, 0.7, 0.95])
@pytest.mark.parametrize("poisson", [0.0, 0.296, 0.5])
def test_shear_coefficient_is_cowpers_integral_of_the_flexure_function(ratio: float, poisson: float) -> None:
    # Cowper 1966: kappa = 2 (1 + nu) I / (nu/2 (Ix - Iy) - A/I * integral of x (chi + x y^2)), here with Ix = Iy, and
    # Love's flexure function of a tube with radii 1 and m. It is harmonic, and on both edges, radius r, needs
    #   d chi/dn = -(nu/2 x^2 + (1 - nu/2) y^2) nx - (2 + nu) x y ny,
    # whose cos f part is -(3/4 + nu/2) r^2 and whose cos 3f part is 3/4 r^2.
    m = ratio
    edge = 0.75 + 0.5 * poisson
    points, weights = np.polynomial.legendre.leggauss(12)
    radius = 0.5 * (1.0 + m) + 0.5 * (1.0 - m) * points
    angle = np.arange(16) * math.pi / 8.0  # exact for the few harmonics in the integrand
    r, f = np.meshgrid(radius, angle, indexing="ij")
    x, y = r * np.cos(f), r * np.sin(f)

    def chi_slope(r: float) -> tuple[float, float]:
        return -edge * (1.0 + m**2) + edge * m**2 / r**2, 0.75 * r**2

    for r_edge in {1.0, m} - {0.0}:  # the function used below does fit both edges
        assert chi_slope(r_edge) == pytest.approx((-edge * r_edge**2, 0.75 * r_edge**2), rel=ROUNDING)
    chi = -edge * ((1.0 + m**2) * r + m**2 / r) * np.cos(f) + 0.25 * r**3 * np.cos(3.0 * f)
    element = (0.5 * (1.0 - m) * weights * radius)[:, None] * math.pi / 8.0
    area, second = math.pi * (1.0 - m**2), math.pi / 4.0 * (1.0 - m**4)
    wanted = -2.0 * (1.0 + poisson) * second**2 / (area * np.sum(element * x * (chi + x * y**2)))
    assert cowper_shear_coefficient(poisson, m) == pytest.approx(wanted, rel=ROUNDING)
    section = CircularSection(diameter=2.0, bore=2.0 * m)
    assert section.shear_area(2.0 * (1.0 + poisson) * G, G) == pytest.approx(wanted * area, rel=1e-10)


def test_shear_coefficient_of_a_thin_tube_tends_to_cowpers_own_value() -> None:
    # Cowper 1966, thin-walled round tube: 2 (1 + nu) / (4 + 3 nu); the wall enters with (1 - m)^2
    assert cowper_shear_coefficient(0.3, 0.999) == pytest.approx(2.6 / 4.9, rel=1e-6)


def test_moduli_that_no_isotropic_material_has_are_refused() -> None:
    assert poisson_ratio(2.1e11, 8.1e10) == pytest.approx(0.2963, abs=5e-5)
    assert poisson_ratio(3.0, 1.0) == 0.5
    with pytest.raises(ParameterError, match=r"E = 2.1e\+11 Pa and G = 6e\+10 Pa .* = 0.75: .* at most 0.5"):
        poisson_ratio(2.1e11, 6e10)
    with pytest.raises(ParameterError, match=r"Poisson ratio = 0.6: .* at most 0.5"):
        cowper_shear_coefficient(0.6)
    with pytest.raises(ParameterError, match=r"bore / diameter = 1: .* to leave a wall"):
        cowper_shear_coefficient(0.3, 1.0)


def test_a_bore_needs_a_wall_around_it() -> None:
    with pytest.raises(ParameterError, match=r"CircularSection.bore = 0.05 m: must be smaller than the diameter, 0.05 m"):
        CircularSection(diameter=0.05, bore=0.05)
    with pytest.raises(ParameterError, match=r"Beam.length = 0 m: must be greater than 0"):
        beam(0.0)


# --- stiffness and shapes -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("shear", [False, True])
def test_cantilever_deflects_as_in_the_textbook_in_all_directions(shear: bool) -> None:
    b = beam(shear=shear)
    ei, ga = E * b.second_moment, math.inf if b.shear_area is None else G * b.shear_area
    length, force, moment = b.length, 120.0, 7.0
    bent = force * length**3 / (3.0 * ei) + force * length / ga
    tilted = force * length**2 / (2.0 * ei)
    by_moment, tilt_by_moment = moment * length**2 / (2.0 * ei), moment * length / ei
    wanted = {
        0: [bent, 0, 0, 0, tilted, 0],  # pushed along x it tilts about +y
        1: [0, bent, 0, -tilted, 0, 0],  # pushed along y it tilts about -x
        2: [0, 0, force * length / (E * b.area), 0, 0, 0],
        3: [0, -by_moment, 0, tilt_by_moment, 0, 0],
        4: [by_moment, 0, 0, 0, tilt_by_moment, 0],
        5: [0, 0, 0, 0, 0, moment * length / (G * b.polar_moment)],
    }
    for direction, deflection in wanted.items():
        load = np.zeros(6)
        load[direction] = force if direction < 3 else moment
        close(np.linalg.solve(b.stiffness()[6:, 6:], load), np.array(deflection, dtype=float))


@pytest.mark.parametrize("shear", [False, True])
def test_all_six_rigid_motions_cost_no_force_and_nothing_else_does(shear: bool) -> None:
    b = beam(shear=shear)
    stiffness = b.stiffness()
    assert np.array_equal(stiffness, stiffness.T)
    residual = np.abs(stiffness @ rigid_motions(b.length))
    assert np.all(residual < ROUNDING * (np.abs(stiffness) @ np.abs(rigid_motions(b.length)) + 1e-300))
    scale = 1.0 / np.sqrt(np.diag(stiffness))
    values = np.linalg.eigvalsh(scale[:, None] * stiffness * scale)
    assert np.sum(np.abs(values) < ROUNDING) == 6
    assert np.sum(values > 1e-3) == 6


@pytest.mark.parametrize("shear", [False, True])
def test_shapes_reproduce_ends_and_rigid_motion_exactly(shear: bool) -> None:
    b = beam(shear=shear)
    assert np.array_equal(b.shape(0.0), np.eye(6, 12))
    assert np.array_equal(b.shape(1.0), np.eye(6, 12, 6))
    for xi in (0.1, 0.5, 0.83):
        close(b.shape(xi) @ rigid_motions(b.length), rigid_arm(xi * b.length))
    for xi in (-0.01, 1.01):
        with pytest.raises(ParameterError, match=r"must lie on the beam.*length 0.4 m"):
            b.shape(xi)


@pytest.mark.parametrize("shear", [False, True])
def test_strain_energy_of_the_shapes_is_the_stiffness(shear: bool) -> None:
    # shapes are cubics: polynomials through four samples give their slopes exactly
    b = beam(0.1, shear=shear)
    nodes = np.array([0.0, 0.3, 0.7, 1.0])
    vander = np.vander(nodes, 4, increasing=True)
    coefficients = np.einsum("ij,jkl->ikl", np.linalg.inv(vander), np.array([b.shape(float(xi)) for xi in nodes]))
    points, weights = np.polynomial.legendre.leggauss(4)
    energy = np.zeros((12, 12))
    for point, weight in zip(0.5 + 0.5 * points, 0.5 * weights * b.length):
        here = np.einsum("i,ikl->kl", point ** np.arange(4), coefficients)
        slope = np.einsum("i,ikl->kl", np.array([0.0, 1.0, 2.0 * point, 3.0 * point**2]), coefficients) / b.length
        shear_x, shear_y = slope[0] - here[4], slope[1] + here[3]
        if b.shear_area is None:
            assert np.max(np.abs([shear_x, shear_y])) < ROUNDING  # dx/dz = theta, dy/dz = -psi
        stiffnesses = (E * b.area, E * b.second_moment, E * b.second_moment, G * b.polar_moment, G * (b.shear_area or 0.0))
        for value, row in zip((*stiffnesses, stiffnesses[-1]), (slope[2], slope[3], slope[4], slope[5], shear_x, shear_y)):
            energy += weight * value * np.outer(row, row)
    close(energy, b.stiffness())
    lateral = [0, 1, 3, 4, 6, 7, 9, 10]
    rest = [2, 5, 8, 11]
    bending = b.bending_stiffness()
    assert np.array_equal(bending[np.ix_(lateral, lateral)], b.stiffness()[np.ix_(lateral, lateral)])
    assert not np.any(bending[rest])
    assert not np.any(bending[:, rest])


@pytest.mark.parametrize("shear", [False, True])
@pytest.mark.parametrize("xi", [0.5, 0.17, 0.9])
def test_a_split_section_is_the_whole_one_when_its_middle_follows_statically(shear: bool, xi: float) -> None:
    whole = beam(0.25, shear=shear, density=0.0)
    parts = whole.split(xi)
    assert sum(part.length for part in parts) == pytest.approx(whole.length, rel=ROUNDING)
    stiffness = chain([part.stiffness() for part in parts])
    nothing = np.zeros_like(stiffness)
    condensed = guyan(nothing, nothing, stiffness, [*range(6), *range(12, 18)], range(6, 12))
    close(condensed.stiffness, whole.stiffness())
    close(condensed.transformation[6:12], whole.shape(xi))  # the shapes are the static ones, found without their formula
    assert condensed.neglected == math.inf  # nothing in there has mass


def test_a_beam_is_split_only_between_its_ends() -> None:
    for xi in (0.0, 1.0, -0.2, math.nan):
        with pytest.raises(ParameterError, match=r"A beam of 0.4 m cannot be split at .* use the station there"):
            beam().split(xi)


def test_an_infinite_shear_area_is_euler_bernoulli() -> None:
    thin = beam(shear=False)
    assert thin.shear_area is None
    assert thin.replacing(shear_area=math.inf) == thin
    assert thin.shear_parameter == 0.0
    stiff = thin.replacing(shear_area=1e9)
    assert stiff.shear_parameter < 1e-9
    close(stiff.stiffness(), thin.stiffness(), 1e-9)
    assert beam().shear_parameter == pytest.approx(12.0 * E * thin.second_moment / (G * (beam().shear_area or 0.0) * 0.16), rel=ROUNDING)


def test_a_rigid_arm_moves_the_point_and_carries_its_forces_back() -> None:
    arm = rigid_arm(0.3)
    station = np.array([1.0, 2.0, 3.0, 0.01, 0.02, 0.5])
    close(arm @ station, np.array([1.0 + 0.3 * 0.02, 2.0 - 0.3 * 0.01, 3.0, 0.01, 0.02, 0.5]))
    force, moment = np.array([5.0, -7.0, 11.0]), np.array([0.1, 0.2, 0.3])
    carried = arm.T @ np.concatenate([force, moment])
    close(carried[3:], moment + np.cross([0.0, 0.0, 0.3], force))  # statics: r x F
    close(rigid_arm(0.1) @ rigid_arm(0.2), arm)
    with pytest.raises(ParameterError, match="finite length"):
        rigid_arm(math.inf)


# --- inertia ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("shear", [False, True])
def test_rigid_motions_have_the_inertia_of_a_bar(shear: bool) -> None:
    b = beam(shear=shear)
    total, length = RHO * b.area * b.length, b.length
    wanted = np.diag([total, total, total, 0.0, 0.0, 0.0])
    wanted[3, 3] = wanted[4, 4] = total * length**2 / 3.0 + RHO * b.second_moment * length
    wanted[0, 4] = wanted[4, 0] = total * length / 2.0  # theta about end a moves the centre by +L/2 along x
    wanted[1, 3] = wanted[3, 1] = -total * length / 2.0
    motions = rigid_motions(length)
    close(motions.T @ b.mass() @ motions, wanted)
    assert not np.any(b.mass()[[5, 11]])
    assert np.array_equal(b.mass(), b.mass().T)
    polar = motions.T @ b.polar_mass() @ motions
    close(polar, np.diag([0.0, 0.0, 0.0, 0.0, 0.0, RHO * b.polar_moment * length]))
    assert 2.0 * b.end_polar_inertia() == pytest.approx(polar[5, 5], rel=ROUNDING)


def test_mass_of_a_thin_beam_is_the_printed_one() -> None:
    # Przemieniecki 1968, table 11.1 with Phi = 0: rho A L / 420 [..] + rho I / (30 L) [..]
    b = beam(shear=False)
    length = b.length
    translation = np.array(
        [
            [156.0, 22.0 * length, 54.0, -13.0 * length],
            [22.0 * length, 4.0 * length**2, 13.0 * length, -3.0 * length**2],
            [54.0, 13.0 * length, 156.0, -22.0 * length],
            [-13.0 * length, -3.0 * length**2, -22.0 * length, 4.0 * length**2],
        ]
    )
    rotation = np.array(
        [
            [36.0, 3.0 * length, -36.0, 3.0 * length],
            [3.0 * length, 4.0 * length**2, -3.0 * length, -(length**2)],
            [-36.0, -3.0 * length, 36.0, -3.0 * length],
            [3.0 * length, -(length**2), -3.0 * length, 4.0 * length**2],
        ]
    )
    translation *= RHO * b.area * length / 420.0
    rotation *= RHO * b.second_moment / (30.0 * length)
    flip = np.outer([1, -1, 1, -1], [1, -1, 1, -1])
    x_plane, y_plane = np.ix_([0, 4, 6, 10], [0, 4, 6, 10]), np.ix_([1, 3, 7, 9], [1, 3, 7, 9])
    close(b.mass(rotary_inertia=False)[x_plane], translation)
    close(b.mass()[x_plane], translation + rotation)
    close(b.mass()[y_plane], (translation + rotation) * flip)
    close(b.mass()[np.ix_([2, 8], [2, 8])], RHO * b.area * length / 6.0 * np.array([[2.0, 1.0], [1.0, 2.0]]))
    assert not np.any(b.mass()[np.ix_([0, 4, 6, 10, 2, 8], [1, 3, 7, 9])])


@pytest.mark.parametrize("shear", [False, True])
def test_weight_from_the_mass_matrix_bends_a_cantilever_exactly(shear: bool) -> None:
    # w L^4 / (8 E I) + w L^2 / (2 G A_s): consistent loads are exact at the ends
    b = beam(shear=shear)
    downwards = np.tile([0.0, -9.81, 0.0, 0.0, 0.0, 0.0], 2)
    weight = 9.81 * RHO * b.area
    deflection = np.linalg.solve(b.stiffness()[6:, 6:], (b.mass() @ downwards)[6:])
    sag = weight * b.length**4 / (8.0 * E * b.second_moment)
    sag += weight * b.length**2 / (2.0 * G * b.shear_area) if b.shear_area is not None else 0.0
    assert deflection[1] == pytest.approx(-sag, rel=ROUNDING)
    assert deflection[3] == pytest.approx(weight * b.length**3 / (6.0 * E * b.second_moment), rel=ROUNDING)


def pinned_squares(whole: Beam, elements: int, *, rotary_inertia: bool, modes: int) -> Array:
    """Squares of the bending frequencies of a pinned beam in one plane."""
    part = whole.replacing(length=whole.length / elements)
    mass = pinned(chain([part.mass(rotary_inertia=rotary_inertia)] * elements), (0, 4))
    return squares(mass, pinned(chain([part.stiffness()] * elements), (0, 4)))[:modes]


def test_a_pinned_thin_shaft_converges_with_the_fourth_order() -> None:
    # w_n^2 = (n pi / L)^4 E I / (rho A), exact for Euler-Bernoulli without rotary inertia
    whole = beam(0.9, shear=False)
    exact = (np.arange(1, 4) * math.pi / whole.length) ** 4 * E * whole.second_moment / (RHO * whole.area)
    counts = np.array([4, 8, 16])
    errors = np.array([pinned_squares(whole, int(n), rotary_inertia=False, modes=3) / exact - 1.0 for n in counts])
    assert np.all(errors > 0.0)  # Rayleigh: a mesh can only stiffen
    orders = np.log2(errors[:-1, 0] / errors[1:, 0])
    assert np.all(np.abs(orders - 4.0) < 0.05)
    # leading term (n pi / N)^4 / 720 of cubic elements; the next one is of the relative size (n pi / N)^2
    leading = (np.pi * np.arange(1, 4) / counts[-1]) ** 4 / 720.0
    assert np.all(np.abs(errors[-1] / leading - 1.0) < (np.pi * np.arange(1, 4) / counts[-1]) ** 2)


def test_a_pinned_thick_shaft_converges_to_timoshenkos_frequencies_with_the_second_order() -> None:
    # v = V sin kz, s = S cos kz in  rho A v'' = G A_s (v' - s)',  rho I s'' = E I s'' + G A_s (v' - s):
    #   det [[G A_s k^2 - rho A w^2, -G A_s k], [-G A_s k, E I k^2 + G A_s - rho I w^2]] = 0, lower root
    # Leading error: between its ends an element of length h does not yield to its own inertia loads p = w^2 rho A v (in shear) and
    # m = w^2 rho I s (in bending); that compliance is h^2 / 12 of (p^2 / G A_s + m^2 / E I) per length, over w^2 of the modal mass.
    whole = beam(0.3)  # five diameters long
    assert whole.shear_area is not None
    ga, ei, ra, ri = G * whole.shear_area, E * whole.second_moment, RHO * whole.area, RHO * whole.second_moment
    k = np.arange(1, 4) * math.pi / whole.length
    exact = np.array([np.roots([ra * ri, -(ra * (ei * n**2 + ga) + ri * ga * n**2), ga * ei * n**4]).min() for n in k])
    slope = (ga * k**2 - ra * exact) / (ga * k)  # S / V
    leading = whole.length**2 / 12.0 * exact * (ra**2 / ga + ri**2 / ei * slope**2) / (ra + ri * slope**2)
    counts = np.array([8, 16, 32])
    errors = np.array([pinned_squares(whole, int(n), rotary_inertia=True, modes=3) / exact - 1.0 for n in counts])
    assert np.all(errors > 0.0)
    assert np.all(np.abs(np.log2(errors[:-1] / errors[1:]) - 2.0) < 0.05)
    assert np.all(np.abs(errors[-1] * 32**2 / leading - 1.0) < 0.01)
    thin = (math.pi / whole.length) ** 4 * ei / ra
    assert exact[0] < 0.95 * thin  # shear and rotary inertia do count in this shaft


# --- spin ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("shear", [False, True])
def test_gyroscopic_matrix_is_that_of_a_station_when_the_section_tilts_as_a_whole(shear: bool) -> None:
    b = beam(shear=shear)
    gyroscopic = b.gyroscopic()
    assert np.array_equal(gyroscopic, -gyroscopic.T)
    polar = RHO * b.polar_moment * b.length
    station = np.zeros((6, 6))
    station[3, 4], station[4, 3] = polar, -polar  # Jt psi'' + Jp W theta' = Mx, Jt theta'' - Jp W psi' = My
    motions = rigid_motions(b.length)
    close(motions.T @ gyroscopic @ motions, station)
    assert np.all(gyroscopic[[2, 5, 8, 11]] == 0.0)


def test_gyroscopic_moments_are_the_rate_of_the_angular_momentum_of_the_spin() -> None:
    # the axis of a slice points along (theta, -psi, 1), so its spin momentum Jp W (theta, -psi) changes at Jp W (theta', -psi')
    b = beam()
    rates = np.random.default_rng(3).normal(size=12)
    spin, moments = 70.0, np.zeros(2)
    points, weights = np.polynomial.legendre.leggauss(6)
    for point, weight in zip(0.5 + 0.5 * points, 0.5 * weights):
        slice_rates = b.shape(float(point)) @ rates
        moments += weight * b.length * RHO * b.polar_moment * spin * np.array([slice_rates[4], -slice_rates[3]])
    forces = spin * b.gyroscopic() @ rates
    close((rigid_motions(b.length).T @ forces)[3:5], moments)


def spinning_shaft(elements: int, *, lumped: bool) -> tuple[Array, Array]:
    """Computed and closed-form frequencies [rad/s] of the published pinned shaft at 1e4 rad/s: two modes, backward then forward."""
    radius, length, modulus, density, spin = 0.025, 0.9, 2e11, 7800.0, 1e4
    part = Beam.circular(
        length=length / elements, diameter=2 * radius, youngs_modulus=modulus, shear_modulus=modulus / 2.6, density=density, shear=False
    )
    if lumped:
        gyroscopic = np.zeros((12, 12))
        for psi, theta in ((3, 4), (9, 10)):
            gyroscopic[psi, theta], gyroscopic[theta, psi] = part.end_polar_inertia(), -part.end_polar_inertia()
    else:
        gyroscopic = part.gyroscopic()
    mass, stiffness = chain([part.mass(rotary_inertia=False)] * elements), chain([part.stiffness()] * elements)
    found = eigenvalues(pinned(mass), spin * pinned(chain([gyroscopic] * elements)), pinned(stiffness)).imag
    root = math.sqrt(modulus * part.second_moment * density * part.area)
    ell = spin * density * part.area * (2 * radius) ** 2 / 8.0 / (2.0 * root)
    standing = (np.array([1, 2]) * math.pi / length) ** 2 * root / (density * part.area)
    closed = np.outer(standing, [math.hypot(ell, 1.0) - ell, math.hypot(ell, 1.0) + ell]).ravel()
    return np.sort(found[found > 0.0])[:4], closed


def test_published_spinning_shaft_is_met_within_1e_6_by_34_elements_and_by_64_lumped_ones() -> None:
    # pinned-pinned rotating Euler-Bernoulli shaft: w = w0 (sqrt(l^2 + 1) -+ l), l = W Ix / (2 sqrt(E I rho S)), Ix = rho S D^2/8
    found, closed = spinning_shaft(34, lumped=False)
    assert closed / (2.0 * math.pi) == pytest.approx([119.7548, 125.815, 479.0191, 503.2598], abs=5.1e-5)  # as printed
    assert found == pytest.approx(closed, rel=1e-6)
    # the error of 4th order, not the 1e-6, says that 34 are needed: (2 pi / 34)^4 / 720 / 2 = 0.8e-6
    assert np.max(np.abs(found / closed - 1.0)) > 0.5e-6
    found, closed = spinning_shaft(64, lumped=True)
    assert found == pytest.approx(closed, rel=1e-6)


def test_gyroscopic_terms_lumped_to_the_stations_cost_the_second_order() -> None:
    coarse, fine = (np.abs(found / closed - 1.0)[0] for found, closed in (spinning_shaft(n, lumped=True) for n in (24, 48)))
    assert math.log2(coarse / fine) == pytest.approx(2.0, abs=0.2)
    coarse, fine = (np.abs(found / closed - 1.0)[0] for found, closed in (spinning_shaft(n, lumped=False) for n in (8, 16)))
    assert math.log2(coarse / fine) == pytest.approx(4.0, abs=0.05)


def test_the_stiffer_whirl_of_a_spinning_shaft_is_the_forward_one() -> None:
    part = beam(0.1)
    mass, stiffness = pinned(chain([part.mass()] * 4)), pinned(chain([part.stiffness()] * 4))
    gyroscopic = pinned(chain([part.gyroscopic()] * 4))
    for spin in (800.0, -800.0):
        size = len(mass)
        first = np.block(
            [[np.zeros((size, size)), np.eye(size)], [-np.linalg.solve(mass, stiffness), -spin * np.linalg.solve(mass, gyroscopic)]]
        )
        values, vectors = np.linalg.eig(first)
        low, high = [k for k in np.argsort(values.imag) if values[k].imag > 0.0][:2]
        # rows of the middle station: after 2 tilts of end a and one station of 4 come x, y; turning with +z means y = -i x at exp(+i w t)
        x, y = 6, 7
        ratio = {name: vectors[y, k] / vectors[x, k] for name, k in (("low", low), ("high", high))}
        sense = math.copysign(1.0, spin)
        assert ratio["high"] == pytest.approx(-1j * sense, abs=1e-6)
        assert ratio["low"] == pytest.approx(1j * sense, abs=1e-6)


@pytest.mark.parametrize("shear", [False, True])
def test_circulatory_forces_are_damping_of_the_rates_seen_by_the_spinning_shaft(shear: bool) -> None:
    b = beam(shear=shear)
    rng = np.random.default_rng(7)
    scale = np.tile([1e-4, 1e-4, 0.0, 1e-3, 1e-3, 0.0], 2)
    position, rates = rng.normal(size=12) * scale, rng.normal(size=12) * scale * 100.0
    beta, spin = 2e-5, 310.0
    angle = 0.83  # of the shaft at this moment; must not matter
    laterals = TURN @ TURN  # minus one on lateral places
    into = np.cos(angle) * -laterals - np.sin(angle) * TURN  # fixed to spinning frame: turn by -angle
    into_rate = spin * (-np.sin(angle) * -laterals - np.cos(angle) * TURN)
    strain_rates = into @ rates + into_rate @ position
    force = -beta * into.T @ b.bending_stiffness() @ strain_rates
    circulatory = b.circulatory()
    close(-beta * (b.bending_stiffness() @ rates + spin * circulatory @ position), force)
    assert np.array_equal(circulatory, -circulatory.T)
    assert np.all(circulatory @ rigid_motions(b.length) < 1e-12 * np.abs(circulatory).max())
    # energy: what the laterals and the spin lose together is what the damping of the strain rates dissipates
    torque = beta * (position @ circulatory @ rates - spin * position @ b.bending_stiffness() @ position)
    dissipated = beta * strain_rates @ b.bending_stiffness() @ strain_rates
    assert dissipated > 0.0
    assert force @ rates + torque * spin == pytest.approx(-dissipated, rel=1e-10)


def jeffcott(beta: float, c_external: float, spin: float) -> tuple[npt.NDArray[np.complex128], npt.NDArray[np.complex128], float]:
    """Eigenvalues and shapes over (x, y, x', y') of a disc amid a massless pinned shaft with damping that turns with it; stiffness."""
    half = beam(0.3, density=0.0)
    stiffness = pinned(chain([half.stiffness()] * 2))
    circulating = pinned(chain([half.circulatory()] * 2))
    names = ["a.psi", "a.theta", "x", "y", "psi", "theta", "b.psi", "b.theta"]
    mass, external = np.zeros((8, 8)), np.zeros((8, 8))
    mass[2, 2] = mass[3, 3] = 12.0
    external[2, 2] = external[3, 3] = c_external
    whole = stiffness + beta * spin * circulating
    # all damping is internal and proportional to K, so the static shapes of K are exact here
    reduced = guyan(mass, beta * stiffness, stiffness, [2, 3], [0, 1, 4, 5, 6, 7], names=names)
    shapes = reduced.transformation
    damping = reduced.damping + shapes.T @ external @ shapes
    spring = shapes.T @ whole @ shapes
    inverse = np.linalg.inv(reduced.mass)
    first = np.block([[np.zeros((2, 2)), np.eye(2)], [-inverse @ spring, -inverse @ damping]])
    values, vectors = np.linalg.eig(first)
    return values, vectors, float(reduced.stiffness[0, 0])


@pytest.mark.parametrize("share", [0.0, 0.6, 2.5])
def test_internal_damping_upsets_a_jeffcott_rotor_exactly_above_its_known_speed(share: float) -> None:
    # m z'' + (ci + ce) z' + (k - i ci W) z = 0 with z = x + i y is at its border for W = w_n (1 + ce / ci)
    beta = 4e-6
    stiffness = jeffcott(beta, 0.0, 0.0)[2]
    half = beam(0.3)
    assert half.shear_area is not None
    flexibility = 0.6**3 / (48.0 * E * half.second_moment) + 0.6 / (4.0 * G * half.shear_area)
    assert stiffness == pytest.approx(1.0 / flexibility, rel=ROUNDING)
    natural = math.sqrt(stiffness / 12.0)
    external = share * beta * stiffness
    border = natural * (1.0 + share)
    for sense in (1.0, -1.0):
        at, vectors, _ = jeffcott(beta, external, sense * border)
        worst = int(np.argmax(at.real))
        # both roots of the border are +- i w_n; the spin enters with ci W = (ci + ce) w_n
        assert abs(at[worst].real) < 1e-10 * natural
        assert abs(at[worst].imag) == pytest.approx(natural, rel=1e-10)
        whirl = -1j * sense * math.copysign(1.0, at[worst].imag)  # y/x of a motion that turns with the spin
        assert vectors[1, worst] / vectors[0, worst] == pytest.approx(whirl, abs=1e-9)
        assert np.max(jeffcott(beta, external, sense * border * 0.999)[0].real) < 0.0
        above = jeffcott(beta, external, sense * border * 1.001)[0].real
        assert np.sum(above > 0.0) == 2  # one motion, forward; backward whirl stays damped


# --- condensation -------------------------------------------------------------------------------------------------


def free_shaft(elements: int = 8, length: float = 0.8) -> tuple[Array, Array, Array, list[int], list[int]]:
    """M, zero D, K of a shaft in both planes, with its end stations as boundary."""
    part = beam(length / elements)
    places = [k for k in range(6 * (elements + 1)) if k % 6 in (0, 1, 3, 4)]
    mass, stiffness = (chain([matrix] * elements)[np.ix_(places, places)] for matrix in (part.mass(), part.stiffness()))
    size = len(places)
    boundary = [*range(4), *range(size - 4, size)]
    return mass, np.zeros_like(mass), stiffness, boundary, list(range(4, size - 4))


def on_springs(stiffness: Array, places: list[int]) -> Array:
    held = stiffness.copy()
    for k in places:
        held[k, k] += 2e8
    return held


def test_craig_bampton_converges_to_the_whole_and_guyan_is_its_first_step() -> None:
    mass, damping, stiffness, boundary, interior = free_shaft()
    ends = [0, 1, len(mass) - 4, len(mass) - 3]
    exact = squares(mass, on_springs(stiffness, ends))[:4]
    errors = []
    for modes in (0, 2, 6, 10, 14):  # a pair of planes each; the symmetric ones, 1, 3, 5 and 7, help the lowest mode
        reduced = craig_bampton(mass, damping, stiffness, boundary, interior, modes=modes)
        found = squares(reduced.mass, on_springs(reduced.stiffness, [0, 1, 4, 5]))[:4]
        assert np.all(found > exact * (1.0 - 1e-9))  # Rayleigh: bounds from above
        errors.append(found / exact - 1.0)
        assert reduced.frequencies.shape == (modes,)
    assert all(np.all(later <= earlier + 1e-9) for earlier, later in itertools.pairwise(errors))
    # what mode n (odd) would add falls with its participation squared, n^-2, and (w / w_n)^2, n^-4: at least (5 / 7)^6 = 0.13 a step
    assert all(later[0] < 0.2 * earlier[0] for earlier, later in itertools.pairwise(errors))
    alone = guyan(mass, damping, stiffness, boundary, interior)
    assert np.array_equal(alone.mass, craig_bampton(mass, damping, stiffness, boundary, interior, modes=0).mass)
    assert alone.frequencies.size == 0


def test_frequencies_by_guyan_are_too_high_by_a_share_that_grows_with_their_square() -> None:
    mass, damping, stiffness, boundary, interior = free_shaft()
    reduced = guyan(mass, damping, stiffness, boundary, interior)
    shares, excess = [], []
    for softening in (1e-2, 1e-3):  # the shaft bounces on soft springs
        ends, kept = [0, 1, len(mass) - 4, len(mass) - 3], [0, 1, 4, 5]
        exact = squares(mass, stiffness + softening * (on_springs(stiffness, ends) - stiffness))[0]
        found = squares(reduced.mass, reduced.stiffness + softening * (on_springs(reduced.stiffness, kept) - reduced.stiffness))[0]
        shares.append(exact / reduced.neglected**2)
        excess.append(found / exact - 1.0)
    assert math.log(excess[0] / excess[1]) / math.log(shares[0] / shares[1]) == pytest.approx(1.0, abs=0.1)
    assert 0.0 < excess[0] < shares[0]


def test_craig_bampton_with_all_modes_is_the_whole_system() -> None:
    mass, damping, stiffness, boundary, interior = free_shaft(4)
    stiffness = on_springs(stiffness, [0, 1])
    reduced = craig_bampton(mass, damping, stiffness, boundary, interior, modes=len(interior))
    assert reduced.neglected == math.inf
    assert squares(reduced.mass, reduced.stiffness)[2:] == pytest.approx(squares(mass, stiffness)[2:], rel=1e-7)
    close(reduced.mass[8:, 8:], np.eye(len(interior)), 1e-9)
    close(np.diag(reduced.stiffness)[8:] / reduced.frequencies**2, np.ones(len(interior)), 1e-9)


def test_fixed_interface_frequencies_are_those_of_a_clamped_shaft() -> None:
    # clamped-clamped Euler-Bernoulli: (4.730041)^2 sqrt(E I / rho A) / L^2, Blevins 1979; thin enough that rotary inertia is 1e-5 of it
    part = Beam.circular(length=0.05, diameter=2e-3, youngs_modulus=E, shear_modulus=G, density=RHO, shear=False)
    places = [k for k in range(6 * 17) if k % 6 in (0, 1, 3, 4)]
    mass, stiffness = (chain([m] * 16)[np.ix_(places, places)] for m in (part.mass(), part.stiffness()))
    size = len(places)
    reduced = craig_bampton(mass, 0 * mass, stiffness, [*range(4), *range(size - 4, size)], range(4, size - 4), modes=2)
    wanted = 4.730041**2 * math.sqrt(E * part.second_moment / (RHO * part.area)) / 0.8**2
    assert reduced.frequencies == pytest.approx([wanted, wanted], rel=2e-5)  # mesh: (4.73/16)^4 / 1440 = 0.5e-5
    # one mode a plane, and none in both
    x_rows, y_rows = [k for k in range(size) if k % 4 in (0, 3)], [k for k in range(size) if k % 4 in (1, 2)]
    in_x, in_y = (np.any(reduced.transformation[np.ix_(rows, [8, 9])] != 0.0, axis=0) for rows in (x_rows, y_rows))
    assert sorted(zip(in_x.tolist(), in_y.tolist())) == [(False, True), (True, False)]


def test_a_cut_through_a_pair_of_planes_is_refused() -> None:
    mass, damping, stiffness, boundary, interior = free_shaft(4)
    with pytest.raises(ParameterError, match=r"modes = 3 cuts through modes of equal frequency \(.* rad/s.*one mode fewer or one more"):
        craig_bampton(mass, damping, stiffness, boundary, interior, modes=3)


def random_system(asymmetry: float, damped: bool = False) -> tuple[Array, Array, Array]:
    """Eight coordinates, the last five interior, with skew (circulatory) stiffness between any of them."""
    rng = np.random.default_rng(11)

    def positive(scale: float) -> Array:
        root = rng.normal(size=(8, 8))
        return scale * (root @ root.T / 8.0 + np.eye(8))

    mass, stiffness = positive(1.0), positive(1e4)
    skew = rng.normal(size=(8, 8))
    damping = positive(5.0) if damped else np.zeros((8, 8))
    return mass, damping, stiffness + asymmetry * 1e4 * (skew - skew.T)


BOUNDARY, INTERIOR = (0, 1, 2), (3, 4, 5, 6, 7)


def exact_dynamic_stiffness(mass: Array, damping: Array, stiffness: Array, frequency: float) -> npt.NDArray[np.complex128]:
    """The boundary's, with nothing left out: Schur complement of K + i w D - w^2 M."""
    z = stiffness + 1j * frequency * damping - frequency**2 * mass
    b, i = list(BOUNDARY), list(INTERIOR)
    return z[np.ix_(b, b)] - z[np.ix_(b, i)] @ np.linalg.solve(z[np.ix_(i, i)], z[np.ix_(i, b)])


@pytest.mark.parametrize("modes", [0, 2])
def test_statics_of_an_unsymmetric_system_are_exact(modes: int) -> None:
    mass, damping, stiffness = random_system(0.4)
    reduced = craig_bampton(mass, damping, stiffness, BOUNDARY, INTERIOR, modes=modes)
    close(reduced.stiffness[:3, :3], exact_dynamic_stiffness(mass, damping, stiffness, 0.0).real)
    on_boundary = np.array([3.0, -2.0, 1.0, 0, 0, 0, 0, 0])
    whole = np.linalg.solve(stiffness, on_boundary)
    close(reduced.recover(np.linalg.solve(reduced.stiffness, reduced.reduce_force(on_boundary))), whole)
    close(np.array([reduced.recovery(k) @ np.linalg.solve(reduced.stiffness, reduced.reduce_force(on_boundary)) for k in range(8)]), whole)
    inside = np.array([0, 0, 0, 1.0, 5.0, -2.0, 0.5, 1.0])
    whole = np.linalg.solve(stiffness, inside)
    close(np.linalg.solve(reduced.stiffness, reduced.reduce_force(inside))[:3], whole[:3])
    # projected with T on both sides: forces on the boundary still, forces in the interior no longer
    one_sided = craig_bampton(mass, damping, stiffness, BOUNDARY, INTERIOR, modes=modes, galerkin=True)
    found = np.linalg.solve(one_sided.stiffness, one_sided.reduce_force(on_boundary))
    close(one_sided.recover(found), np.linalg.solve(stiffness, on_boundary))
    found = np.linalg.solve(one_sided.stiffness, one_sided.reduce_force(inside))
    assert np.max(np.abs(found[:3] - whole[:3])) > 0.01 * np.max(np.abs(whole[:3]))
    assert np.array_equal(one_sided.left_transformation, one_sided.transformation)
    close(one_sided.mass, one_sided.mass.T)
    assert np.all(np.linalg.eigvalsh(0.5 * (one_sided.mass + one_sided.mass.T)) > 0.0)


@pytest.mark.parametrize(("damped", "galerkin", "order"), [(False, False, 4), (False, True, 2), (True, False, 2), (True, True, 1)])
def test_left_shapes_of_the_transposed_stiffness_make_the_inertia_exact(damped: bool, galerkin: bool, order: int) -> None:
    # first neglected power of the frequency in the dynamic stiffness of the boundary
    mass, damping, stiffness = random_system(0.4, damped)
    reduced = guyan(mass, damping, stiffness, BOUNDARY, INTERIOR, galerkin=galerkin)

    def error(frequency: float) -> float:
        found = reduced.stiffness + 1j * frequency * reduced.damping - frequency**2 * reduced.mass
        return float(np.max(np.abs(found - exact_dynamic_stiffness(mass, damping, stiffness, frequency))))

    low = (0.002 if damped else 0.01) * reduced.neglected  # far below, and well above rounding
    assert math.log2(error(2.0 * low) / error(low)) == pytest.approx(order, abs=0.1)


def test_symmetric_systems_keep_symmetric_matrices_and_one_transformation() -> None:
    mass, damping, stiffness = random_system(0.0, damped=True)
    reduced = craig_bampton(mass, damping, stiffness, BOUNDARY, INTERIOR, modes=3)
    assert np.array_equal(reduced.transformation, reduced.left_transformation)
    for matrix in (reduced.mass, reduced.damping, reduced.stiffness):
        close(matrix, matrix.T)
    assert np.all(np.diff(reduced.frequencies) > 0.0)
    shapes = reduced.transformation[list(INTERIOR)][:, 3:]
    inner = np.ix_(INTERIOR, INTERIOR)
    close(stiffness[inner] @ shapes, mass[inner] @ shapes * reduced.frequencies**2, 1e-10)


def test_coordinates_without_mass_follow_statically_and_have_no_modes() -> None:
    # two springs of 100 and 300 N/m in series with a massless joint, then 1 kg between springs of 50 N/m
    stiffness = np.array([[100.0, -100, 0], [-100, 400, -300], [0, -300, 350]])
    mass = np.diag([2.0, 0.0, 1.0])
    reduced = craig_bampton(mass, 0 * mass, stiffness, [0], [1, 2], modes=1)
    # with the boundary held the joint has 100 + 300 in series with ... : k = 50 + 300 * 100 / 400 = 125 N/m on 1 kg
    assert reduced.frequencies == pytest.approx([math.sqrt(125.0)], rel=ROUNDING)
    assert reduced.neglected == math.inf
    with pytest.raises(ParameterError, match=r"modes = 2: the interior has mass for 1 only"):
        craig_bampton(mass, 0 * mass, stiffness, [0], [1, 2], modes=2)


def test_a_loose_interior_coordinate_is_named() -> None:
    stiffness = np.array([[5.0, -5, 0, 0], [-5, 5, 0, 0], [0, 0, 7e6, -7e6], [0, 0, -7e6, 7e6]])
    mass = np.eye(4)
    names = ["rotor.x", "ring.x", "housing.x", "foundation.x"]
    with pytest.raises(SceneError, match=r"boundary held, coordinate [23] \('(housing|foundation).x'\) can move without force"):
        guyan(mass, 0 * mass, stiffness, [0], [1, 2, 3], names=names)
    stiffness[2:, 2:] = np.diag([7e6, 0.0])
    with pytest.raises(SceneError, match=r"coordinate 3 can move without force.*Make it a boundary coordinate, or connect it"):
        guyan(mass, 0 * mass, stiffness, [0], [1, 2, 3])


def test_an_interior_that_only_cross_coupling_holds_condenses_but_has_no_modes() -> None:
    # k_xx = k_yy = 0 and k_xy = -k_yx = 1e6 N/m inside a film: solvable, but no undamped modes
    stiffness = np.array([[1e6, 0, 0, 1e6], [0, 1e6, -1e6, 0], [0, 1e6, 0, 1e6], [-1e6, 0, -1e6, 0]])
    reduced = guyan(np.eye(4), np.zeros((4, 4)), stiffness, [0, 1], [2, 3])
    close(reduced.stiffness, np.linalg.inv(np.linalg.inv(stiffness)[:2, :2]))
    assert math.isnan(reduced.neglected)
    with pytest.raises(SceneError, match="symmetric part of its stiffness is not positive"):
        craig_bampton(np.eye(4), np.zeros((4, 4)), stiffness, [0, 1], [2, 3], modes=1)


@pytest.mark.parametrize(
    ("boundary", "interior", "modes", "words"),
    [
        ([0, 1], [1, 2], 0, r"coordinate 1 \('b'\) is given twice"),
        ([0, 0, 1], [2], 0, r"coordinate 0 \('a'\) is given twice"),
        ([0], [2], 0, r"coordinate 1 \('b'\) is in neither set"),
        ([0, 1], [2, 3], 0, r"No coordinate 3: the matrices have 3"),
        ([0, 1, -1], [2], 0, r"No coordinate -1: the matrices have 3"),
        ([0], [1, 2], 3, r"modes = 3: must be from 0 to the 2 interior coordinates"),
    ],
)
def test_sets_that_do_not_share_out_the_coordinates_are_refused(boundary: list[int], interior: list[int], modes: int, words: str) -> None:
    eye = np.eye(3)
    with pytest.raises(ParameterError, match=words):
        craig_bampton(eye, 0 * eye, eye, boundary, interior, modes=modes, names=["a", "b", "c"])


def test_matrices_that_do_not_fit_are_refused() -> None:
    eye = np.eye(3)
    with pytest.raises(ParameterError, match=r"The damping matrix is \(2, 2\): it must be square and of the size of the others, \(3, 3\)"):
        guyan(eye, np.eye(2), eye, [0], [1, 2])
    with pytest.raises(ParameterError, match="The mass matrix has entries that are not finite"):
        guyan(np.diag([1.0, np.nan, 1.0]), eye, eye, [0], [1, 2])
    with pytest.raises(ParameterError, match="2 names for 3 coordinates"):
        guyan(eye, eye, eye, [0], [1, 2], names=["a", "b"])
    with pytest.raises(SceneError, match="mass of the interior coordinates is negative"):
        craig_bampton(np.diag([1.0, 1.0, -1.0]), eye, eye, [0], [1, 2], modes=1)
    with pytest.raises(ParameterError, match="No coordinate 3: the full system has 3"):
        guyan(eye, eye, eye, [0], [1, 2]).recovery(3)


def test_nothing_to_condense_leaves_the_system_as_it_is() -> None:
    mass, damping, stiffness = random_system(0.2, damped=True)
    reduced = guyan(mass, damping, stiffness, range(8), [])
    close(reduced.mass, mass)
    close(reduced.stiffness, stiffness)
    assert reduced.neglected == math.inf
