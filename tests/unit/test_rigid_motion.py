"""Rigid bodies with unbalance: equations of motion and composition against bodies made of point masses.

A cloud of point masses needs neither an inertia tensor nor an angular velocity:  T = sum m_i |d/dt(r + A p_i)|^2 / 2  with
A = Rx(psi) Ry(theta) Rz(phi).  Lagrange's equations of one point mass come from sympy; those of the body are their sum.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import sympy as sp

import hdrive_mbs as hm
from hdrive_mbs.analysis.time_response import channel_of
from hdrive_mbs.network.rigid_mass import NOTHING, RigidMass
from hdrive_mbs.network.rigid_motion import forces_of_motion, kinetic_energy, mass_at_rest, mass_matrix

FloatArray = npt.NDArray[np.float64]
ROUNDING = 1e-12
"""Share of the largest entry; both sides are sums of some hundred products of double precision."""


@functools.cache
def point_mass() -> Callable[..., Any]:
    """M (6x6), h (6) and T of a unit point mass at p in the body: Lagrange's equations M q'' + h = Q, nothing left out.

    T = v.M(q) v/2 with M = B^T B, B = dp/dq;  d/dt dT/dv_k - dT/dq_k = sum M_ki a_i + sum (dM_ki/dq_j - dM_ij/dq_k / 2) v_i v_j
    """
    q, v, p = sp.symbols("x y z psi theta phi"), sp.symbols("v:6"), sp.symbols("p_x p_y p_z")
    place = sp.Matrix(q[:3]) + sp.rot_ccw_axis1(q[3]) * sp.rot_ccw_axis2(q[4]) * sp.rot_ccw_axis3(q[5]) * sp.Matrix(p)
    slopes = place.jacobian(q)
    mass = slopes.T * slopes
    forces = [sum((mass[k, i].diff(q[j]) - mass[i, j].diff(q[k]) / 2) * v[i] * v[j] for i in range(6) for j in range(6)) for k in range(6)]
    velocity = slopes * sp.Matrix(v)
    return sp.lambdify((*p, *q, *v), [*mass, *forces, velocity.dot(velocity) / 2], "numpy", cse=True)  # type: ignore[no-any-return]


@dataclass(frozen=True)
class Cloud:
    """Point masses in the frame of the body."""

    masses: FloatArray
    places: FloatArray

    @classmethod
    def random(cls, seed: int, count: int = 5) -> Cloud:
        rng = np.random.default_rng(seed)
        return cls(rng.uniform(0.2, 2.0, count), rng.normal(0.0, 0.2, (count, 3)))

    def body(self) -> RigidMass:
        """Sums over the points, from the definitions."""
        mass = float(self.masses.sum())
        centre = self.masses @ self.places / mass
        tensor = sum(m * (p @ p * np.eye(3) - np.outer(p, p)) for m, p in zip(self.masses, self.places))
        return RigidMass(mass, tuple(centre), tuple(map(tuple, np.asarray(tensor))))  # type: ignore[arg-type]

    def equations(self, q: FloatArray, v: FloatArray) -> tuple[FloatArray, FloatArray, float]:
        total = sum(m * np.array(point_mass()(*p, *q, *v), float) for m, p in zip(self.masses, self.places))
        assert isinstance(total, np.ndarray)
        return total[:36].reshape(6, 6), total[36:42], float(total[42])


def states(seed: int) -> tuple[FloatArray, FloatArray]:
    """Large tilts, many turns and all speeds at once."""
    rng = np.random.default_rng(seed)
    return rng.uniform(-1.0, 1.0, 6) * [1.0, 1.0, 1.0, 1.2, 1.2, 40.0], rng.uniform(-1.0, 1.0, 6) * [5.0, 5.0, 5.0, 30.0, 30.0, 300.0]


def assert_same(found: object, wanted: object, tolerance: float = ROUNDING) -> None:
    wanted = np.asarray(wanted, float)
    np.testing.assert_allclose(np.asarray(found, float), wanted, rtol=0.0, atol=tolerance * np.max(np.abs(wanted)))


# -- equations of motion ------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(6))
def test_equations_of_motion_are_lagranges_of_the_point_masses(seed: int) -> None:
    cloud, (q, v) = Cloud.random(seed), states(100 + seed)
    matrix, forces, energy = cloud.equations(q, v)
    assert_same(mass_matrix(cloud.body(), list(q)), matrix)
    assert_same(forces_of_motion(cloud.body(), list(q), list(v)), forces)
    assert_same(kinetic_energy(cloud.body(), list(q), list(v)), energy)
    assert energy > 1.0


def test_many_states_at_once_give_what_each_gives_alone() -> None:
    body = Cloud.random(7).body()
    q, v = (np.stack([states(seed)[k] for seed in range(5)]) for k in (0, 1))
    together = mass_matrix(body, list(q.T)), forces_of_motion(body, list(q.T), list(v.T)), kinetic_energy(body, list(q.T), list(v.T))
    assert [item.shape for item in together] == [(5, 6, 6), (5, 6), (5,)]
    for k in range(5):
        alone = mass_matrix(body, list(q[k])), forces_of_motion(body, list(q[k]), list(v[k])), kinetic_energy(body, list(q[k]), list(v[k]))
        for whole, one in zip(together, alone):
            assert_same(whole[k], one, 1e-14)


def test_the_mass_at_rest_is_that_of_the_point_masses_at_coordinates_of_zero() -> None:
    cloud, still = Cloud.random(8), np.zeros(6)
    matrix, _, _ = cloud.equations(still, still)
    assert_same(mass_at_rest(cloud.body()), matrix)
    assert np.count_nonzero(mass_at_rest(cloud.body())) == 24  # 3 masses, 12 couplings and 9 moments of inertia


def test_the_forces_of_motion_do_the_work_that_changes_the_kinetic_energy() -> None:
    # free motion, M q'' = -h:  dT/dt = q'.M q'' + q'.M' q'/2 = 0, with M' by a central difference along q'
    body, (q, v) = Cloud.random(3).body(), states(11)
    step = 1e-6
    growth = (mass_matrix(body, list(q + step * v)) - mass_matrix(body, list(q - step * v))) / (2.0 * step)
    power = v @ -forces_of_motion(body, list(q), list(v)) + 0.5 * v @ growth @ v
    # the difference errs by (step |v|)^2/6 of a term, |v| = 300 rad/s
    assert abs(power) < (step * 300.0) ** 2 * np.sum(np.abs(v) * np.abs(growth) @ np.abs(v))


def test_a_balanced_upright_rotor_feels_the_gyroscopic_moments_of_the_paper() -> None:
    # seed M (8): Jt psi'' + Jp phi' theta' = Mx, Jt theta'' - Jp phi' psi' = My
    polar, transverse, spin = 0.04, 0.0206, 500.0
    body = RigidMass.rotor(8.0, polar, transverse)
    forces = forces_of_motion(body, [0.0] * 6, [0.0, 0.0, 0.0, 0.3, -0.7, spin])
    # psi' theta' terms are left over in the exact third line: Jp psi' theta'
    assert_same(forces, [0.0, 0.0, 0.0, polar * spin * -0.7, -polar * spin * 0.3, polar * 0.3 * -0.7])
    np.testing.assert_allclose(mass_matrix(body, [0.0] * 6), np.diag([8.0, 8.0, 8.0, transverse, transverse, polar]), atol=0.0)


def exudyn_scene(cloud_rotor: hm.Rotor, sense: int) -> hm.Scene:
    """A free rotor alone, or behind a gear that turns it backwards."""
    if sense > 0:
        return hm.Scene(name="free rotor", parts={"rotor": cloud_rotor}, connections=[])
    gear = hm.HarmonicDrive(ratio=3.0, stiffness=hm.CubicStiffness(linear=1e3, cubic=0.0), damping=0.0)
    parts = {"motor": hm.Inertia(inertia=0.1), "gear": gear, "rotor": cloud_rotor}
    return hm.Scene(name="geared rotor", parts=parts, connections=[("motor", "gear", "rotor")])


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("seed", range(3))
def test_accelerations_are_those_of_exudyns_own_rigid_body(seed: int, sense: int) -> None:
    rotor = hm.Rotor(
        mass=2.0, polar_inertia=0.02, transverse_inertia=0.015, eccentricity=0.03, angle=0.4 + seed, tilt=0.09, tilt_angle=1.1 - seed
    )
    scene = exudyn_scene(rotor, sense)
    network = scene.network()
    assert [item.sense for item in network.rotors] == [sense]
    rng = np.random.default_rng(seed)
    initial = {}
    for body in network.bodies:
        initial |= {channel_of(body, "angle"): float(rng.uniform(-0.8, 0.8)), channel_of(body, "speed"): float(rng.uniform(-20.0, 20.0))}
    response = hm.simulate(scene, 1e-3, solver=hm.RungeKutta4(step=1e-4), initial=initial)

    def history(kind: str) -> dict[str, FloatArray]:
        return {body.name: body.sense * response.values[channel_of(body, kind)] for body in network.bodies}

    own = network.accelerations(network.moment(response.times, history("angle"), history("speed"), {}))
    # from the second sample on they are the engine's; an explicit solver of the engine has none at the start
    found = history("acceleration")
    assert_same([found[name][1:] for name in found], [own[name][1:] for name in found])
    assert_same([found[name][0] for name in found], [own[name][0] for name in found])
    assert max(float(np.max(np.abs(values))) for values in found.values()) > 50.0


# -- composition --------------------------------------------------------------------------------------


@pytest.mark.parametrize("axial", [0.0, 0.35, -0.8])
def test_a_body_seen_from_further_back_is_the_same_body(axial: float) -> None:
    cloud = Cloud.random(1)
    moved = Cloud(cloud.masses, cloud.places + np.array([0.0, 0.0, axial]))
    found, wanted = cloud.body().moved(axial), moved.body()
    assert found.mass == wanted.mass
    assert_same(found.centre, wanted.centre)
    assert_same(found.inertia, wanted.inertia)


def test_two_bodies_in_one_are_all_their_points() -> None:
    one, two = Cloud.random(1), Cloud.random(2)
    both = Cloud(np.concatenate([one.masses, two.masses]), np.concatenate([one.places, two.places]))
    found, wanted = one.body() + two.body(), both.body()
    assert found.mass == pytest.approx(wanted.mass, rel=1e-15)
    assert_same(found.centre, wanted.centre)
    assert_same(found.inertia, wanted.inertia)
    assert found + NOTHING == found
    assert NOTHING + NOTHING == NOTHING


def test_two_discs_side_by_side_are_one_disc_of_both_thicknesses() -> None:
    # m (D^2 + d^2)/16 + m h^2/12 with Steiner's m a^2: two halves at h/4 from the middle
    whole = hm.Rotor.disc(diameter=0.3, thickness=0.08, density=7800.0, bore=0.05)
    half = hm.Rotor.disc(diameter=0.3, thickness=0.04, density=7800.0, bore=0.05)
    joined = half.body.moved(0.02) + half.body.moved(-0.02)
    assert joined.mass == pytest.approx(whole.mass, rel=1e-14)
    assert_same(joined.inertia, whole.body.inertia)
    assert_same(np.array(joined.centre) + 1.0, [1.0, 1.0, 1.0])
    assert whole.mass == pytest.approx(math.pi / 4.0 * 7800.0 * 0.08 * (0.3**2 - 0.05**2), rel=1e-14)
    assert whole.polar_inertia == pytest.approx(math.pi / 32.0 * 7800.0 * 0.08 * (0.3**4 - 0.05**4), rel=1e-14)


def test_opposite_eccentricities_in_two_planes_are_a_dynamic_unbalance() -> None:
    # centrifugal forces m e w^2 a distance L apart: the couple m e L w^2
    disc = hm.Rotor(mass=3.0, polar_inertia=0.02, transverse_inertia=0.015, eccentricity=1e-4)
    there, back = disc.body.moved(0.25), disc.replacing(angle=math.pi).body.moved(-0.25)
    joined = there + back
    assert abs(joined.static_unbalance) < 1e-15 * 3.0 * 1e-4 * 10.0
    # J_xz = -sum m x z
    assert joined.product_unbalance == pytest.approx(-3.0 * 1e-4 * 0.5, rel=1e-12)
    spin = 200.0
    forces = forces_of_motion(joined, [0.0] * 6, [0.0] * 5 + [spin])
    # the couple on the bearings is about +y (x forwards at +z), so the forces of motion resist it
    assert forces[4] == pytest.approx(-3.0 * 1e-4 * 0.5 * spin**2, rel=1e-12)


def test_a_leaning_principal_axis_gives_the_moment_of_dynamic_unbalance() -> None:
    # (Jt - Jp) tilt w^2 about the axis at tilt_angle + 90 degrees; exactly with sin cos of the tilt
    polar, transverse, tilt, direction, spin = 0.04, 0.0206, 5e-4, 0.7, 300.0
    body = RigidMass.rotor(8.0, polar, transverse, tilt=tilt, tilt_angle=direction)
    forces = forces_of_motion(body, [0.0] * 6, [0.0] * 5 + [spin])
    size = (transverse - polar) * math.sin(tilt) * math.cos(tilt) * spin**2
    axis = np.array([math.cos(direction + math.pi / 2.0), math.sin(direction + math.pi / 2.0)])
    assert_same(-forces[3:5], size * axis)
    assert np.max(np.abs(forces[:3])) == 0.0


def test_static_unbalance_pulls_where_the_mass_centre_is() -> None:
    body = RigidMass.rotor(8.0, 0.04, 0.0206, eccentricity=20e-6, angle=0.9)
    turned = 2.3
    forces = forces_of_motion(body, [0.0] * 5 + [turned], [0.0] * 5 + [400.0])
    assert_same(-forces[:2], 8.0 * 20e-6 * 400.0**2 * np.array([math.cos(0.9 + turned), math.sin(0.9 + turned)]))


def test_a_balanced_copy_keeps_mass_inertia_and_place() -> None:
    body = Cloud.random(4).body()
    copy = body.balanced()
    assert (copy.mass, copy.polar, copy.centre) == (body.mass, body.polar, (0.0, 0.0, body.centre[2]))
    assert copy.transverse == pytest.approx(body.transverse, rel=1e-15)
    assert copy.static_unbalance == copy.product_unbalance == 0.0


@pytest.mark.parametrize(("psi", "theta"), [(1e-3, 0.0), (0.0, 1e-3), (1e-3, -2e-3)])
def test_a_torque_on_the_spin_acts_about_an_axis_that_leans_with_psi_and_not_with_theta(psi: float, theta: float) -> None:
    # at rest Jt psi'' + Jp phi'' theta = 0 and Jt theta'' = 0 to first order, see docs/analyses/run_up.md; Jp phi'' = T
    torque, transverse = 3.0, 0.0125
    weak = hm.LinearBearing.isotropic(radial=1e-9, damping=0.0, axial=1e-9)
    parts: dict[str, hm.Component] = {
        "rotor": hm.Rotor(mass=1.0, polar_inertia=0.02, transverse_inertia=transverse),
        "bearing": hm.Bearing(law=weak),
        "drive": hm.DriveTorque(characteristic=lambda speed: torque + 0.0 * speed),
    }
    scene = hm.Scene(name="tilted", parts=parts, connections=[("bearing", "rotor"), ("drive", "rotor")])
    network = scene.network()
    still = dict.fromkeys((body.name for body in network.bodies), 0.0)
    found = network.accelerations(network.moment(0.0, still | {"rotor.psi": psi, "rotor.theta": theta}, still, {}))
    assert found["rotor.psi"] == pytest.approx(-torque * theta / transverse, rel=1e-5, abs=1e-9)  # what is left out: tilts squared
    assert found["rotor.theta"] == pytest.approx(0.0, abs=1e-9)
