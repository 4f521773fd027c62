"""Simplified and improved sections and the change of bearing models in a scene: against formulas, the full model and each other."""

from __future__ import annotations

import math
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import hdrive_mbs as hm
from hdrive_mbs.analysis.whirl.bearing_models import BearingModelWarning, with_bearings
from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices
from hdrive_mbs.analysis.whirl.mode_shifts import mode_shifts
from hdrive_mbs.analysis.whirl.rotor_point import rotor_point
from hdrive_mbs.bearings.law import BearingLaw, RelativeMotion
from hdrive_mbs.bearings.looked_at import directions_looked_at
from hdrive_mbs.components.improved_section import ImprovedSection
from hdrive_mbs.components.simplified_section import SimplifiedSection
from hdrive_mbs.engine.assembly import assemble
from hdrive_mbs.engine.linearisation import linearise
from hdrive_mbs.network.network import Network
from models.two_rotor_line import build
from tests.verification.reference_rotors import reference_line, simplified

Array = npt.NDArray[np.float64]

ROUNDING = 1e-10
"""Sums and inverses of matrices whose entries span some six orders of magnitude."""

RADIAL = {"radial": 1.2e8, "damping": 400.0, "axial": 1e8, "axial_damping": 100.0, "tilt": 5e3, "tilt_damping": 0.5}
LINEAR = hm.LinearBearing.isotropic(**RADIAL)
NAMES = tuple(RelativeMotion.__dataclass_fields__)


def quiet(scene: hm.Scene, model: str, **options: Any) -> hm.Scene:
    """The model, where its warnings are not the subject."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", BearingModelWarning)
        return with_bearings(scene, model, **options)


def remarks(scene: hm.Scene, model: str, **options: Any) -> list[str]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        with_bearings(scene, model, **options)
    return [str(item.message) for item in caught if issubclass(item.category, BearingModelWarning)]


def with_parts(scene: hm.Scene, **parts: hm.Component) -> hm.Scene:
    return hm.Scene(name=scene.name, parts={**scene.parts, **parts}, connections=scene.connections)


def every_section(**fields: Any) -> dict[str, Any]:
    return {f"section_{k}.{name}": value for k in range(1, 5) for name, value in fields.items()}


def both_bearings(**fields: Any) -> dict[str, Any]:
    return {f"bearing_{k}.{name}": value for k in "ab" for name, value in fields.items()}


def readings(scene: hm.Scene, speed: float) -> dict[str, float]:
    """Every channel at the static deflection."""
    point, network = rotor_point(scene, speed), scene.network()
    moment = network.moment(np.float64(0.0), point.angles, point.speeds, point.states)
    return {channel.name: float(np.asarray(channel.read(moment))) for channel in network.channels}


def roots(scene: hm.Scene, speed: float) -> npt.NDArray[np.complex128]:
    """Oscillating roots about steady rotation, slowest first."""
    network = scene.network()
    lines = LineMatrices(network)
    point = rotor_point(scene, speed, lines=lines)
    system = lines.at(point.angles, point.speeds, point.states)
    n = len(system.names)
    lower = -np.linalg.solve(system.mass, np.hstack([system.stiffness, system.damping]))
    values = np.linalg.eigvals(np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), lower]))
    values = values[values.imag > 1.0]
    return np.asarray(values[np.argsort(np.abs(values))])


def apart(scene: hm.Scene, other: hm.Scene, speed: float, below: float = 1000.0) -> float:
    """Largest relative difference of the roots below a frequency [rad/s]."""
    a, b = roots(scene, speed), roots(other, speed)
    count = int(np.sum(np.abs(a) < below))
    assert count >= 3
    return float(np.max(np.abs(b[:count] - a[:count]) / np.abs(a[:count])))


def matrices(network: Network) -> tuple[Array, Array, Array]:
    """Mass (rotors undeflected, with their unbalance left out), damping and stiffness at rest."""
    system = LineMatrices(network).at({b.name: 0.0 for b in network.bodies}, {b.name: 0.0 for b in network.bodies}, {})
    return system.mass, system.damping, system.stiffness


# -- the simplified bearing ---------------------------------------------------------------------------


@pytest.mark.parametrize(("damped", "variant"), [(False, "reference"), (True, "damped_bearings")])
def test_the_simplified_line_has_the_matrices_of_the_independent_section_5_model(damped: bool, variant: str) -> None:
    # reference_rotors.py derives N1, N2 from powers of z and adds (15) in both planes; it has no axial mass of the ring
    reference = simplified(reference_line(damped_in_bearing=damped), spin_inertia=True)
    names = [label.replace("drive", "drive_disc").removesuffix(".phi") for label in reference.labels]
    mass = reference.nominal
    for ends, share in ((("drive_disc.z", "rotor_1.z"), 0.06 / 0.31), (("rotor_1.z", "rotor_2.z"), 0.25 / 0.32)):
        at = [names.index(end) for end in ends]
        mass[np.ix_(at, at)] += 0.35 * np.outer([1.0 - share, share], [1.0 - share, share])
    network = quiet(build(variant=variant), "simplified").network()
    order = [[body.name for body in network.bodies].index(name) for name in names]
    for own, theirs in zip(matrices(network), (mass, reference.damping, reference.stiffness), strict=True):
        size = np.sqrt(np.where(np.diag(theirs) > 0.0, np.diag(theirs), 1.0))
        # tilt 5e-4 and eccentricity 20e-6 change the mean moments of inertia of rotor 1 by (1 - Jp/Jt) tilt^2 / 2 = 1.2e-7 and less
        assert np.max(np.abs(own[np.ix_(order, order)] - theirs) / np.outer(size, size)) < 2e-7


def test_simplified_bearings_under_a_rigid_shaft_carry_it_on_the_foundation_alone() -> None:
    # two foundations 2 k_h below the weight of everything; with the sign of (13) the shaft would be pushed away
    stiff = build().replacing(every_section(youngs_modulus=2.1e17))
    scene = with_parts(quiet(stiff, "simplified"), gravity=hm.Gravity(y=-9.81))
    weight = 9.81 * (0.8 + 8.0 + 3.0 + 2 * (0.35 + 2.5))
    lever = 0.8 * 0.0 + 8.0 * 0.31 + 3.0 * 0.63 + 2.85 * (0.06 + 0.56)  # moments about the drive disc
    right = (9.81 * lever - weight * 0.06) / 0.5  # on bearing B, less what the tilt springs take: 5e3 against 6e6 * 0.5^2 / 2
    found = readings(scene, 0.0)
    assert found["bearing_a.y"] + found["bearing_b.y"] == pytest.approx(-weight / 6e6, rel=1e-5)
    assert found["bearing_b.y"] == pytest.approx(-right / 6e6, rel=2 * 2 * 5e3 / (6e6 * 0.5**2))
    assert found["bearing_b.housing.y"] == found["bearing_b.y"]


def test_a_simplified_bearing_without_housing_stands_on_its_own_stiffness() -> None:
    held = hm.Bearing(law=LINEAR, mass=0.35, polar_inertia=6e-5, transverse_inertia=5e-5)
    part = SimplifiedSection(left=build().parts["section_1"], bearing=held, right=build().parts["section_2"])  # type: ignore[arg-type]
    mass, damping, stiffness = part.at_bearing()
    np.testing.assert_array_equal(np.diag(mass), [0.35, 0.35, 0.35, 5e-5, 5e-5, 0.0])
    np.testing.assert_array_equal(np.diag(stiffness), [1.2e8, 1.2e8, 1e8, 5e3, 5e3, 0.0])
    np.testing.assert_array_equal(np.diag(damping), [400.0, 400.0, 100.0, 0.5, 0.5, 0.0])


def test_a_simplified_bearing_that_it_cannot_take_is_refused() -> None:
    parts = build().parts
    left, bearing, right = (parts[name] for name in ("section_1", "bearing_a", "section_2"))
    with pytest.raises(hm.ParameterError, match=r"left.diameter = 0.022 and right.diameter = 0.03 differ.*ImprovedSection"):
        SimplifiedSection(left=left, bearing=bearing, right=right.replacing(diameter=0.03))  # type: ignore[arg-type]
    cubic = hm.PowerBearing.isotropic(power_radial=1e17, **RADIAL)
    with pytest.raises(hm.ParameterError, match=r"without a housing has nothing but its law.*PowerBearing.*linearised"):
        SimplifiedSection(left=left, bearing=bearing.replacing(law=cubic, housing=None), right=right)  # type: ignore[arg-type]
    with pytest.raises(hm.ParameterError, match=r"ImprovedSection.bearing = .*must be a Bearing"):
        ImprovedSection(left=left, bearing=left, right=right)  # type: ignore[arg-type]


# -- the improved bearing -----------------------------------------------------------------------------


@pytest.mark.parametrize("cubic", [0.0, 3e19])
@pytest.mark.parametrize("highest_speed", [None, 1000.0, 9000.0])
def test_static_motion_of_the_improved_line_is_exact_everywhere(highest_speed: float | None, cubic: float) -> None:
    full = with_parts(build(cubic=cubic), gravity=hm.Gravity(x=3.0, y=-9.81, z=2.0))
    wanted, found = readings(full, 0.0), readings(quiet(full, "improved", highest_speed=highest_speed), 0.0)
    shared = [name for name in wanted if name in found and not name.endswith(("_rate", ".speed", ".angle"))]
    assert {"bearing_a.x", "bearing_b.psi", "bearing_a.z", "bearing_b.housing.y", "bearing_a.force_y", "rotor_2.radial"} <= set(shared)
    for name in shared:
        # rotor_point balances forces to 1e-10 of the weight of 175 N; foundation 6e6 N/m: 3e-15 m, here with a lever of the line
        assert found[name] == pytest.approx(wanted[name], rel=1e-8, abs=1e-13 if "force" not in name else 1e-6), name


def test_with_all_its_modes_the_improved_line_at_rest_is_the_full_one() -> None:
    # a complete set of fixed-interface modes spans all motion; only the spin of the ring stays condensed
    full = build()
    whole = quiet(full, "improved", highest_speed=1e6)
    lateral = sum(body.lateral for body in full.network().bodies)
    assert sum(body.lateral for body in whole.network().bodies) == lateral
    shift = mode_shifts(full, whole, 5e4)[0]
    assert len(shift.frequency) >= 20
    assert np.max(np.abs(shift.frequency)) < 1e-9
    assert np.max(np.abs(shift.damping)) < 1e-7


def test_bearing_and_foundation_of_the_improved_section_act_in_series() -> None:
    # a shaft without bending at the bearing: one long stiff section, so that 1/k = 1/k_b + 1/k_h at each end
    stiff = build(variant="damped_bearings").replacing(every_section(youngs_modulus=2.1e17))
    scene = with_parts(quiet(stiff, "improved"), gravity=hm.Gravity(y=-9.81))
    found = readings(scene, 0.0)
    on_shaft = 9.81 * (0.8 + 8.0 + 3.0 + 2 * 0.35)
    assert found["bearing_a.force_y"] + found["bearing_b.force_y"] == pytest.approx(-on_shaft, rel=1e-6)
    for name in ("bearing_a", "bearing_b"):
        force = found[f"{name}.force_y"]
        assert found[f"{name}.housing.y"] == pytest.approx((force - 9.81 * 2.5) / 6e6, rel=1e-6)
        assert found[f"{name}.y"] - found[f"{name}.housing.y"] == pytest.approx(force / 3e7, rel=1e-4)


def test_the_improved_section_keeps_what_its_law_and_its_damping_ask_for() -> None:
    def own(scene: hm.Scene) -> list[str]:
        return [body.name for body in scene.network().bodies if body.name.startswith("bearing_a")]

    housing = ["bearing_a.housing.x", "bearing_a.housing.y"]
    across = ["bearing_a.across_x", "bearing_a.across_y"]
    assert own(quiet(build(), "improved", highest_speed=1000.0)) == housing
    # lag of the ring d/(k_b + k_shaft) = 2e4/(3e7 + some 5e7): (1000 * 2.1e-4)^2 = 0.04, above 0.01; not at 300 rad/s
    damped = build(variant="damped_bearings")
    assert own(quiet(damped, "improved", highest_speed=1000.0)) == [*housing, *across]
    assert own(quiet(damped, "improved", highest_speed=300.0)) == housing
    assert own(quiet(build(cubic=1e18), "improved", highest_speed=1000.0)) == [*housing, *across]
    unsymmetric = hm.LinearBearing.from_matrices(
        stiffness=np.diag([1e8, 1e8, 1e8, 5e3, 5e3, 0.0]) + 1e6 * np.eye(6, k=1) * np.array([1, 0, 0, 0, 0, 0])[:, None],
        damping=np.zeros((6, 6)),
    )
    assert own(quiet(build().replacing(both_bearings(law=unsymmetric)), "improved")) == [*housing, *across]
    friction = hm.WithFriction(law=LINEAR, bore=0.022, friction=0.1, turning_friction=0.05)
    assert own(quiet(build().replacing(both_bearings(law=friction)), "improved")) == ["bearing_a.ring", *housing, *across, "bearing_a.z"]
    heavy = build().replacing({"bearing_a.mass": 20.0})  # sqrt((1.2e8 + 5e7)/20) = 2.9e3 rad/s, below 5 * 1000
    assert own(quiet(heavy, "improved", highest_speed=1000.0)) == [*housing, "bearing_a.mode_1", "bearing_a.mode_2"]


def test_a_law_is_asked_which_directions_it_looks_at() -> None:
    def looked_at(law: BearingLaw) -> tuple[str, ...]:
        return directions_looked_at(law)

    class Unrecorded(BearingLaw):
        def forces(self, motion: RelativeMotion) -> dict[str, float]:
            return {"x": math.sin(motion.x)}  # type: ignore[arg-type]

    assert looked_at(LINEAR) == ()
    assert looked_at(hm.PowerBearing.isotropic(power_radial=1e17, **RADIAL)) == ("x", "y")
    assert looked_at(hm.WithFriction(law=LINEAR, bore=0.022, friction=0.1)) == ("x", "y", "z", "phi")
    assert looked_at(Unrecorded()) == ("x", "y", "z", "psi", "theta", "phi")


SHARED_RING = 2e-4
"""The gyroscopic moment of the ring, J_p = 6e-5 kg m^2, acts on the tilt of the ends: without it roots move by 2e-4 at 300 rad/s."""


@pytest.mark.parametrize("case", ["friction", "table", "journal", "coupled", "power of the foundation", "no housing"])
def test_roots_of_the_improved_line_are_those_of_the_full_one_for_every_kind_of_law(case: str) -> None:
    stiffness, damping = np.diag([3e7, 4e7, 1e7, 5e3, 6e3, 0.0]), np.diag([4e2, 3e2, 1e2, 0.5, 0.5, 0.0])
    stiffness[0, 1], stiffness[1, 0], stiffness[0, 4], stiffness[4, 0] = 8e6, -3e6, 2e4, 3e4
    film = {"viscosity": 0.02, "diameter": 0.03, "length": 0.02, "radial_clearance": 3e-5}
    ends = {"axial_stiffness": 1e7, "axial_damping": 100.0, "tilt_stiffness": 100.0, "tilt_damping": 0.1}
    table: dict[str, Any] = {"speeds": (0.0, 1000.0), "stiffness_xx": (3e7, 5e7), "stiffness_yy": (4e7, 5e7)}
    laws: dict[str, BearingLaw] = {
        "friction": hm.WithFriction(law=LINEAR, bore=0.022, friction=0.1, turning_friction=0.05),
        "table": hm.TableBearing(**table, damping_xx=(2e3, 1e3), damping_yy=(2e3, 1e3), **ends),
        "journal": hm.JournalBearing(**film, **ends),
        "coupled": hm.LinearBearing.from_matrices(stiffness=stiffness, damping=damping),
    }
    changes: dict[str, Any] = both_bearings(law=laws.get(case, LINEAR))
    if case == "power of the foundation":
        changes |= both_bearings(**{"housing.power_stiffness_x": 1e16, "housing.power_stiffness_y": 2e16})
    if case == "no housing":
        changes = both_bearings(law=LINEAR, housing=None)
    full = with_parts(build().replacing(changes), gravity=hm.Gravity())
    assert apart(full, quiet(full, "improved", highest_speed=1000.0), 300.0) < SHARED_RING


@pytest.mark.parametrize("fields", [{"density": 7850.0, "elements": 3.0}, {"shear": True}, {"rotating_damping": 1e-5}])
def test_a_shaft_with_mass_shear_or_damping_that_turns_condenses_too(fields: dict[str, Any]) -> None:
    full = build().replacing(every_section(**fields))
    assert apart(full, quiet(full, "improved", highest_speed=3000.0), 900.0) < 5 * SHARED_RING  # at three times the speed


def test_the_ring_turns_with_the_ends_so_that_torsional_roots_agree() -> None:
    # static condensation: relative error of w^2 below J_ring / J_end (w / w_ring)^2, w_ring = sqrt((k1 + k2)/J_ring)
    full, improved = build(), quiet(build(), "improved")
    rigidity = 8.1e10 * math.pi * 0.022**4 / 32.0
    ring = math.sqrt((rigidity / 0.06 + rigidity / 0.25) / 6e-5)

    def torsional(scene: hm.Scene) -> Array:
        network = scene.network()
        mass, _, stiffness = matrices(network)
        spins = [k for k, body in enumerate(network.bodies) if not body.lateral]
        values = np.linalg.eigvals(np.linalg.solve(mass[np.ix_(spins, spins)], stiffness[np.ix_(spins, spins)]))
        return np.sqrt(np.sort(values.real)[1:3])

    wanted, found = torsional(full), torsional(improved)
    np.testing.assert_allclose(found[0], wanted[0], rtol=6e-5 / 0.007 * (wanted[0] / ring) ** 2)
    np.testing.assert_allclose(found[1], wanted[1], rtol=6e-5 / 4e-4 * (wanted[1] / ring) ** 2)
    shares = improved.parts["bearing_a"].torsion.shares  # type: ignore[attr-defined]
    assert sum(shares) == pytest.approx(6e-5, rel=ROUNDING)
    assert shares[0] == pytest.approx(6e-5 * 0.25 / 0.31, rel=ROUNDING)  # the stiffer, shorter side takes more


@pytest.mark.parametrize("spins", [False, True])
def test_the_engine_has_the_mass_of_a_line_that_turns_backwards(spins: bool) -> None:
    # next to an improved section the ring of a bearing that stays full: its spin counts forward, that of a rotor in the true sense
    table = hm.TableBearing(speeds=(0.0, 10.0), stiffness_xx=(3e7, 5e7), stiffness_yy=(4e7, 5e7), axial_stiffness=1e7)
    law = table if spins else LINEAR
    bearing = hm.Bearing(law=law, mass=0.35, polar_inertia=6e-5, transverse_inertia=5e-5)
    section = build().parts["section_2"]
    rotor = hm.Rotor(mass=8.0, polar_inertia=0.04, transverse_inertia=0.0206)
    parts: dict[str, hm.Component] = {
        "motor": hm.Motor(characteristic=hm.TorqueSpeedTable(speeds=(0.0, 100.0), torques=(1.0, 0.0)), inertia=1e-3),
        "shaft": hm.Shaft(stiffness=1e4),
        "gear": hm.HarmonicDrive(
            ratio=50.0, stiffness=hm.CubicStiffness(linear=1e4, cubic=0.0), wave_generator_inertia=1e-4, flexspline_inertia=1e-4
        ),
        **dict.fromkeys(("s1", "s2", "s3", "s4"), section),
        **dict.fromkeys(("first", "second"), bearing),
        **dict.fromkeys(("left", "right"), rotor),
    }
    chain = ("motor", "shaft", "gear", "left", "s1", "first", "s2", "second", "s3", "right")
    parts.pop("s4")
    full = hm.Scene(name="backwards", parts=parts, connections=[chain])
    scene = quiet(full, "improved", bearings=["first"])
    network = scene.network()
    assert {body.name: body.sense for body in network.bodies}["left"] == -1
    still = {body.name: 0.0 for body in network.bodies}
    engine = linearise(assemble(network), angles=still, speeds=still, states={})
    system = LineMatrices(network).at(still, still, {})
    assert engine.bodies == system.names
    for own, theirs in ((engine.mass, system.mass), (engine.stiffness, system.stiffness)):
        np.testing.assert_allclose(own, theirs, rtol=1e-6, atol=1e-9 * np.max(np.abs(theirs)))  # the engine differentiates numerically
    assert abs(system.mass[system.names.index("left"), system.names.index("second")]) > 0.0 or spins
    assert apart(full, scene, 0.0) < 1e-4


def test_coordinates_that_share_a_node_of_the_engine_come_out_by_name() -> None:
    # trapezoidal rule on the linear line at rest, done again with its matrices
    rotor = {"rotor_1.eccentricity": 0.0, "rotor_1.tilt": 0.0}
    full = build(variant="damped_bearings").replacing(rotor).without("drive")
    scene = quiet(full, "improved", highest_speed=1000.0)
    network = scene.network()
    groups = {body.group for body in network.bodies} - {""}
    assert groups == {"bearing_a", "bearing_b"}
    names = [body.name for body in network.bodies]
    starts = {"bearing_a.housing.x": 1e-6, "bearing_b.across_y": -2e-6, "bearing_b.housing.y_rate": 1e-3}
    step, steps = 1e-5, 200
    found = hm.simulate(scene, step * steps, solver=hm.Trapezoidal(step=step, newton_tolerance=1e-12), initial=starts, progress=False)
    mass, damping, stiffness = matrices(network)
    q, v = np.zeros(len(names)), np.zeros(len(names))
    q[names.index("bearing_a.housing.x")], q[names.index("bearing_b.across_y")] = 1e-6, -2e-6
    v[names.index("bearing_b.housing.y")] = 1e-3
    a = np.linalg.solve(mass, -(damping @ v) - stiffness @ q)
    left = mass + 0.5 * step * damping + 0.25 * step**2 * stiffness
    for _ in range(steps):
        half_v, half_q = v + 0.5 * step * a, q + step * v + 0.25 * step**2 * a
        a = np.linalg.solve(left, -(damping @ half_v) - stiffness @ half_q)
        v, q = half_v + 0.5 * step * a, half_q + 0.25 * step**2 * a
    for name in ("bearing_a.housing.x", "bearing_a.across_x", "bearing_b.housing.y", "bearing_b.across_y", "rotor_2.y"):
        # second order of the tilts, some 1e-6 rad, and Newton's tolerance
        assert found[name].values[-1] == pytest.approx(q[names.index(name)], rel=1e-6, abs=1e-14), name


def test_an_improved_line_on_a_prescribed_motion_follows_the_full_one() -> None:
    motor = hm.Motor(characteristic=hm.IdealSpeedMotor(motion=hm.SpeedRamp(start=0.0, end=300.0, duration=0.1)), inertia=1e-4)
    full = with_parts(build(), drive=motor)
    solver = hm.Trapezoidal(step=1e-4, newton_tolerance=1e-8)
    wanted, found = (hm.simulate(s, 0.1, solver=solver, progress=False) for s in (full, quiet(full, "improved", highest_speed=1000.0)))
    for name in ("rotor_1.x", "rotor_2.y", "bearing_a.housing.x"):
        size = np.max(np.abs(wanted[name].values))
        np.testing.assert_allclose(found[name].values, wanted[name].values, rtol=0.0, atol=2e-3 * size, err_msg=name)


def test_weights_of_a_condensed_bearing_add_up() -> None:
    scene = with_parts(quiet(build(), "improved", highest_speed=9000.0), gravity=hm.Gravity(y=-9.81))
    found = readings(scene, 0.0)
    mass = 0.8 + 8.0 + 3.0 + 2 * (0.35 + 2.5)
    assert 6e6 * (found["bearing_a.housing.y"] + found["bearing_b.housing.y"]) == pytest.approx(-9.81 * mass, rel=1e-9)


# -- changing the model of a scene --------------------------------------------------------------------


def test_a_line_reads_the_same_after_its_bearings_change() -> None:
    scene = quiet(build(), "improved", highest_speed=1000.0)
    assert scene.connections == (("drive", "drive_disc", "bearing_a", "rotor_1", "bearing_b", "rotor_2"),)
    assert isinstance(scene.parts["bearing_a"], ImprovedSection)
    assert scene.network().positions["rotor_2"] == pytest.approx(0.63)
    assert "bearing_a.bearing.housing.stiffness_x" in scene.parameters()
    stiffer = scene.replacing({"bearing_a.bearing.housing.stiffness_x": 7e6})
    assert stiffer.parts["bearing_a"].condensed is not scene.parts["bearing_a"].condensed  # type: ignore[attr-defined]


def test_back_in_the_full_model_nothing_is_lost() -> None:
    full = build()
    for model in ("simplified", "improved"):
        again = with_bearings(quiet(full, model), "full")
        assert list(again.parts) == [
            name.replace("section_1", "bearing_a_left")
            .replace("section_2", "bearing_a_right")
            .replace("section_3", "bearing_b_left")
            .replace("section_4", "bearing_b_right")
            for name in full.parts
        ] or set(again.parts.values()) >= {full.parts["section_1"], full.parts["bearing_b"]}
        np.testing.assert_array_equal(roots(again, 300.0), roots(full, 300.0))
    assert with_bearings(full, "full") is full
    other = quiet(quiet(full, "simplified"), "improved", highest_speed=1000.0)
    assert other.parts == quiet(full, "improved", highest_speed=1000.0).parts


def test_only_the_bearings_that_are_named_change() -> None:
    scene = quiet(build(), "simplified", bearings=["bearing_b"])
    assert isinstance(scene.parts["bearing_b"], SimplifiedSection)
    assert isinstance(scene.parts["bearing_a"], hm.Bearing)
    assert scene.connections == (("drive", "drive_disc", "section_1", "bearing_a", "section_2", "rotor_1", "bearing_b", "rotor_2"),)
    mixed = quiet(scene, "improved", bearings=["bearing_a"])
    assert [type(mixed.parts[name]) for name in ("bearing_a", "bearing_b")] == [ImprovedSection, SimplifiedSection]


def test_chains_may_be_written_in_pieces_and_with_named_flanges() -> None:
    full = build()
    pieces = [("drive", "drive_disc", "section_1.a"), ("section_1.b", "bearing_a"), ("bearing_a", "section_2", "rotor_1")]
    pieces += [("section_3.b", "bearing_b"), ("rotor_1", "section_3.a"), ("bearing_b", "section_4.a"), ("rotor_2", "section_4.b")]
    written = hm.Scene(name="pieces", parts=full.parts, connections=pieces)
    np.testing.assert_array_equal(roots(quiet(written, "improved"), 300.0), roots(quiet(full, "improved"), 300.0))


def test_a_merged_bearing_is_one_body_with_the_rotor_next_to_it() -> None:
    scene = quiet(build(), "merged", bearings=["bearing_b"])
    arm = scene.parts["section_4"]  # rotor 2 is nearer than rotor 1 at 0.25 m
    assert isinstance(arm, hm.RigidSection)
    assert arm.length == pytest.approx(0.07)
    rotor = next(rotor for rotor in scene.network().rotors if rotor.name == "rotor_2")
    assert rotor.body.mass == pytest.approx(3.35)
    assert rotor.body.centre[2] == pytest.approx(-0.07 * 0.35 / 3.35)
    assert rotor.body.transverse == pytest.approx(0.00383 + 5e-5 + 0.35 * 0.07**2, rel=1e-6)
    heavy = build().replacing({"section_4.density": 7850.0})
    with pytest.raises(hm.SceneError, match=r"'section_4' between 'bearing_b' and its rotor has mass \(density = 7850"):
        with_bearings(heavy, "merged", ["bearing_b"])


def test_a_bearing_that_cannot_change_stays_with_a_warning_and_is_refused_by_name() -> None:
    full = build()
    lost = ("drive", "drive_disc", "section_1")
    parts = {name: part for name, part in full.parts.items() if name not in lost}
    cut = hm.Scene(name="cut", parts=parts, connections=[full.connections[0][3:]])
    assert cut.connections[0][0] == "bearing_a"
    with pytest.raises(hm.SceneError, match=r"replaces a section of shaft on both sides, and 'bearing_a' has one on one side only"):
        with_bearings(cut, "improved", ["bearing_a"])
    said = remarks(cut, "improved")
    assert any("bearing_a stays as it is" in text for text in said)
    kept = quiet(cut, "improved")
    assert [type(kept.parts[name]) for name in ("bearing_a", "bearing_b")] == [hm.Bearing, ImprovedSection]

    crowded = hm.Scene(
        name="crowded",
        parts={**full.parts, "disc": hm.Rotor(mass=0.1, polar_inertia=1e-5, transverse_inertia=1e-5)},
        connections=[*full.connections, ("disc", "bearing_a")],
    )
    with pytest.raises(hm.SceneError, match="at 'bearing_a' sits 'disc' too"):
        with_bearings(crowded, "simplified", ["bearing_a"])
    pair = hm.Scene(
        name="pair",
        parts={**full.parts, "bearing_c": full.parts["bearing_b"], "section_5": full.parts["section_4"]},
        connections=[
            tuple("bearing_c" if place == "rotor_1" else place for place in full.connections[0]),
            ("rotor_2", "section_5", "rotor_1"),
        ],
    )
    assert any(
        "bearing_c stays as it is: the section between 'bearing_a' and 'bearing_c' belongs to 'bearing_a'" in t
        for t in remarks(pair, "improved")
    )
    with pytest.raises(hm.PlaceError, match=r"No bearing 'bearing_c'. This scene has: bearing_a, bearing_b"):
        with_bearings(full, "improved", ["bearing_c"])
    with pytest.raises(hm.ParameterError, match="model = 'best': must be one of full, merged, simplified, improved"):
        with_bearings(full, "best")


def test_data_that_the_simplified_section_cannot_hold_are_refused_with_the_name_of_the_bearing() -> None:
    stepped = build().replacing({"section_1.diameter": 0.03})
    with pytest.raises(hm.SceneError, match=r"'bearing_a': SimplifiedSection: left\.diameter = 0\.03 and right\.diameter"):
        with_bearings(stepped, "simplified", ["bearing_a"])
    assert any("bearing_a stays as it is: 'bearing_a': SimplifiedSection" in text for text in remarks(stepped, "simplified"))
    kept = quiet(stepped, "simplified")
    assert [type(kept.parts[name]) for name in ("bearing_a", "bearing_b")] == [hm.Bearing, SimplifiedSection]


def test_an_effect_that_loses_its_place_is_named() -> None:
    scene = build().with_effect(hm.ViscousDrag(coefficient=1e-3), at="bearing_a", name="seal")
    with pytest.raises(hm.PlaceError, match="The effect 'seal' at 'bearing_a' has no place in this model of the bearings; remove it"):
        quiet(scene, "improved")
    kept = quiet(scene, "improved", bearings=["bearing_b"])
    assert [effect.name for effect in kept.effects] == ["seal"]


@pytest.mark.parametrize("model", ["merged", "simplified", "improved"])
def test_scenes_with_other_bearing_models_go_through_files(model: str, tmp_path: Path) -> None:
    scene = quiet(build(cubic=1e18), model, highest_speed=1000.0).without("drive")
    for name in ("line.toml", "line.json"):
        again = hm.load_scene(hm.save_scene(scene, tmp_path / name))
        assert again.parts == scene.parts
        assert again.connections == scene.connections


# -- warnings -----------------------------------------------------------------------------------------


def test_the_simplified_model_says_what_it_leaves_out_of_the_data() -> None:
    powered = build(cubic=1e18).replacing({"bearing_b.housing.power_stiffness_y": 1e16})
    said = remarks(powered, "simplified")
    assert sum("leaves out all forces of PowerBearing" in text for text in said) == 2
    assert sum("leaves out the power term of the foundation" in text for text in said) == 1
    assert not any("leaves out" in text for text in remarks(build(), "simplified"))


def test_the_simplified_model_warns_where_its_modes_part_from_the_full_ones() -> None:
    # damping in the bearing is left out: 69 % of that of the second pair of M-REF2 (independent model: 0.0213 and 0.0065)
    said = remarks(build(variant="damped_bearings"), "simplified")
    assert any("damping ratio of lateral mode" in text and "by -69." in text for text in said)


def test_one_cubic_over_a_stiff_bearing_is_too_stiff_by_the_factor_of_beam_theory() -> None:
    # clamped shaft of length L, held rigidly at L/2, mass at its end.  Exact compliance: overhang c = L/2 behind a clamped-propped
    # span l = L/2, c^3/3EI + c^2 l/4EI = 7 L^3/96 EI.  A cubic v = a (x^2 - 2 x^3/L) with v(0) = v'(0) = v(L/2) = 0 gives 28 E I/L^3.
    factor = math.sqrt(28.0 * 7.0 / 96.0)
    half = hm.ShaftSection(length=0.3, diameter=0.02, youngs_modulus=2.1e11, shear_modulus=8.1e10)
    rigid = hm.LinearBearing.isotropic(radial=1e13, damping=0.0)
    bearing = hm.Bearing(
        law=rigid, mass=0.1, polar_inertia=1e-6, transverse_inertia=1e-6, housing=hm.Housing.isotropic(mass=1.0, stiffness=1e13)
    )
    tip = hm.Rotor(mass=5.0, polar_inertia=1e-6, transverse_inertia=1e-6)
    full = hm.Scene(
        name="clamped", parts={"s1": half, "b": bearing, "s2": half, "tip": tip}, connections=[("ground", "s1", "b", "s2", "tip")]
    )
    exact = math.sqrt(96.0 / 7.0 * 2.1e11 * math.pi * 0.02**4 / 64.0 / (5.0 * 0.6**3))
    assert abs(roots(full, 0.0)[0]) == pytest.approx(exact, rel=1e-5)
    assert abs(roots(quiet(full, "simplified"), 0.0)[0]) / exact == pytest.approx(factor, rel=1e-5)
    assert abs(roots(quiet(full, "improved"), 0.0)[0]) == pytest.approx(exact, rel=1e-5)
    assert any("frequency of lateral mode" in text for text in remarks(full, "simplified", highest_speed=200.0))


def test_the_improved_model_is_silent_where_it_is_right_and_warns_where_it_is_not() -> None:
    for options in ({}, {"variant": "damped_bearings"}, {"diameter": 0.03}, {"foundation_stiffness": 1e6}, {"cubic": 3e19}):
        assert remarks(build(**options), "improved", highest_speed=1000.0) == []  # type: ignore[arg-type]
    # a ring with a hundred times the polar inertia: its gyroscopic moment is not that of the ends
    wheel = build().replacing(both_bearings(transverse_inertia=5e-3)).replacing(both_bearings(polar_inertia=6e-3))
    said = remarks(wheel, "improved", highest_speed=1000.0)
    assert said
    assert all("1000 rad/s" in text and "full model" in text for text in said)


def test_mode_shifts_count_the_modes_up_to_the_speed_and_name_the_missing() -> None:
    full = build()
    at_rest, turning = mode_shifts(full, quiet(full, "simplified"), 1000.0)
    assert (at_rest.speed, turning.speed) == (0.0, 1000.0)
    assert len(at_rest.frequency) == 4  # two bending modes in two planes below 1000 rad/s: 366 and 760 rad/s
    np.testing.assert_allclose(at_rest.frequency[::2], at_rest.frequency[1::2], rtol=1e-6)
    # the full line has 26 lateral modes without z, the simplified one 12
    missing = mode_shifts(full, quiet(full, "simplified"), 1e5)[0]
    assert np.isinf(missing.frequency).sum() == len(missing.frequency) - 12
