"""Parts of rotor lines and how they hang together, against statics and closed forms."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices, LineSystem
from hdrive_mbs.engine.assembly import assemble
from hdrive_mbs.engine.linearisation import linearise
from tests.unit.rotor_pieces import (
    DISC,
    ROUNDING,
    STEEL,
    E,
    FloatArray,
    G,
    bearing,
    eigenvalues,
    frequencies,
    line,
    section,
    steady,
)

# -- stations, names, positions ------------------------------------------------------------------------


def test_a_chain_runs_towards_plus_z_and_its_first_place_is_at_zero() -> None:
    parts = {"a": bearing(1e6, mass=0.3), "s": section(0.2), "d": DISC, "t": section(0.5), "b": bearing(1e6, mass=0.3)}
    scene = line("line", parts, ("a", "s", "d", "t", "b"))
    positions = scene.network().positions
    assert {place: positions[place] for place in ("a", "s.a", "s.b", "d", "t.a", "t.b", "b")} == {
        "a": 0.0, "s.a": 0.0, "s.b": 0.2, "d": 0.2, "t.a": 0.2, "t.b": 0.7, "b": 0.7,
    }  # fmt: skip
    # chains in pieces and out of order make the same line, and so do flanges by name
    again = line("pieces", parts, ("d", "t"), ("t.b", "b"), ("s.b", "d"), ("a", "s"))
    assert again.network().positions == pytest.approx(positions)


def test_rotors_name_their_station_and_what_is_joined_rigidly_shares_it() -> None:
    parts = {"a": bearing(1e6, mass=0.3), "short": hm.RigidSection(length=0.04), "d": DISC, "drive": hm.DriveTorque(characteristic=np.sin)}
    network = line("one body", parts, ("drive", "a", "short", "d")).network()
    assert {network.places[place] for place in ("a", "short.a", "short.b", "d", "drive")} == {"d"}
    assert [rotor.coordinates for rotor in network.rotors] == [("d.x", "d.y", "d.z", "d.psi", "d.theta", "d")]
    assert network.rotors[0].body.mass == pytest.approx(8.3)
    # the ring lies 0.04 m before the disc
    assert network.rotors[0].body.centre[2] == pytest.approx(-0.3 * 0.04 / 8.3)


def test_a_place_beside_the_reference_of_its_body_moves_with_the_tilt() -> None:
    # x_b = x_a + L theta, y_b = y_a - L psi: the bearing, 0.25 m after the disc, and its force
    parts = {"d": DISC, "arm": hm.RigidSection(length=0.25), "b": bearing(1e5)}
    scene = line("arm", parts, ("d", "arm", "b"))
    response = hm.simulate(scene, 1e-4, initial={"d.x": 1e-3, "d.y": 2e-3, "d.theta": 3e-3, "d.psi": -4e-3})
    assert response.values["b.x"][0] == pytest.approx(1e-3 + 0.25 * 3e-3, rel=1e-14)
    assert response.values["b.y"][0] == pytest.approx(2e-3 + 0.25 * 4e-3, rel=1e-14)
    assert response.values["b.theta"][0] == 3e-3
    assert response.values["b.force_x"][0] == pytest.approx(1e5 * 1.75e-3, rel=1e-13)
    assert response.values["b.radial"][0] == pytest.approx(math.hypot(1.75e-3, 3e-3), rel=1e-14)
    assert "arm.b.x" not in response, "the ends of a section are the places they are joined to"


def test_two_lines_of_a_gear_have_positions_of_their_own() -> None:
    gear = hm.HarmonicDrive(ratio=50.0, stiffness=hm.CubicStiffness(linear=1e4, cubic=0.0), damping=1.0, flexspline_inertia=1e-3)
    parts = {
        "in": DISC, "s": section(0.2), "in_2": DISC, "motor": hm.Inertia(inertia=0.01), "shaft": hm.Shaft(stiffness=1e4),
        "gear": gear, "out": DISC, "t": section(0.4), "out_2": DISC, "coupling": hm.Shaft(stiffness=1e4),
    }  # fmt: skip
    scene = line(
        "geared", parts, ("motor", "shaft", "in", "s", "in_2", "gear.wave_generator"), ("gear.flexspline", "coupling", "out", "t", "out_2")
    )
    network = scene.network()
    assert [network.positions[place] for place in ("in", "in_2", "out", "out_2")] == [0.0, 0.2, 0.0, 0.4]
    senses = {body.name: body.sense for body in network.bodies if not body.lateral}
    assert senses["in"] == senses["in_2"] == 1
    assert senses["out"] == senses["out_2"] == -1


def test_torsional_parts_on_a_rotor_line_only_turn() -> None:
    parts = {
        "motor": hm.Motor(inertia=0.02, characteristic=lambda w: 1.0 - w),
        "coupling": hm.Shaft(stiffness=900.0),
        "d": DISC,
        "b": bearing(1e5),
    }
    scene = line("coupled", parts, ("motor", "coupling", "d", "b"))
    system = steady(scene)
    assert {body.name for body in scene.network().bodies if not body.lateral} == {"motor", "d"}
    # two discs on a torsional spring: w^2 = k (1/J1 + 1/J2)
    assert frequencies(system, ["motor", "d"])[1] == pytest.approx(math.sqrt(900.0 * (1.0 / 0.02 + 1.0 / 0.04)), rel=ROUNDING)
    row = system.stiffness[system.names.index("motor")]
    assert set(np.flatnonzero(row)) == {system.names.index("motor"), system.names.index("d")}


# a flywheel that only turns, on a rotor and on a ring with small tilts; the spin frequency w^2 = k/J of the torsion spring to the ground
TILTING = hm.LinearBearing.isotropic(radial=2e6, damping=30.0, tilt=4e3)
HUBS = {
    "rotor": hm.Rotor(mass=8.0, polar_inertia=0.04, transverse_inertia=0.0206, eccentricity=1e-4, tilt=1e-3),
    "station": hm.Bearing(law=TILTING, mass=8.0, polar_inertia=0.04, transverse_inertia=0.0206),
}
FLYWHEELS = {
    "inertia": hm.Inertia(inertia=0.05),
    "load": hm.Load(inertia=0.05, torque=hm.ConstantTorque(value=0.0)),
    "motor": hm.Motor(inertia=0.05, characteristic=np.zeros_like),
}


def flywheel_line(hub: hm.Component, flywheel: hm.Component | None, *others: Sequence[str], **parts: hm.Component) -> hm.Scene:
    on = {} if flywheel is None else {"flywheel": flywheel}
    chains = [("flywheel", "hub")] if on else []
    held = bearing(5e6, damping=100.0, tilt=2e3, axial=1e6)
    return line(
        "flywheel", {"hub": hub, "arm": hm.RigidSection(length=0.1), "held": held, **on, **parts}, ("hub", "arm", "held"), *chains, *others
    )


@pytest.mark.parametrize("hub", HUBS)
@pytest.mark.parametrize("flywheel", FLYWHEELS)
def test_inertia_that_only_turns_does_not_tilt(hub: str, flywheel: str) -> None:
    bare, loaded = flywheel_line(HUBS[hub], None), flywheel_line(HUBS[hub], FLYWHEELS[flywheel])
    # its gyroscopic moment would move them by several per cent: Jp from 0.04 to 0.09 kg m^2 with Jt as it is
    before, after = (hm.whirl_modes(scene, 500.0) for scene in (bare, loaded))
    np.testing.assert_allclose(after.frequencies, before.frequencies, rtol=ROUNDING)
    np.testing.assert_allclose(after.damping_ratios, before.damping_ratios, rtol=1e-8)
    # in time a balanced hub keeps its spin, and moves across the axis as it did
    still = HUBS[hub].replacing(eccentricity=0.0, tilt=0.0) if hub == "rotor" else HUBS[hub]
    start = {"hub.psi": 1e-6, "hub.x": 1e-7}
    runs = [
        hm.simulate(
            flywheel_line(still, one), 0.01, initial_speed=500.0, initial=start, solver=hm.Trapezoidal(step=2e-5, newton_tolerance=1e-8)
        )
        for one in (None, FLYWHEELS[flywheel])
    ]
    for name in ("hub.x", "hub.y", "hub.psi", "hub.theta"):
        wanted = runs[0].values[name]
        # the exact rigid body couples the spin with tilt squared, 1e-6 of it
        np.testing.assert_allclose(runs[1].values[name], wanted, rtol=0.0, atol=1e-5 * np.max(np.abs(wanted)), err_msg=name)


@pytest.mark.parametrize("hub", HUBS)
def test_torsion_sees_inertia_that_only_turns(hub: str) -> None:
    spring = {"spring": hm.Shaft(stiffness=900.0)}
    scene = flywheel_line(HUBS[hub], FLYWHEELS["inertia"], ("hub", "spring", "ground"), **spring)
    system = steady(scene)
    exact = {"rotor": 0.04 + 8.0 * 1e-4**2 - 0.0194 * math.sin(1e-3) ** 2, "station": 0.04}[hub] + 0.05
    assert frequencies(system, ["hub"])[0] == pytest.approx(math.sqrt(900.0 / exact), rel=1e-6)
    found = linearise(assemble(scene.network()), angles={}, speeds={}, states={})
    at = found.bodies.index("hub")
    assert found.mass[at, at] == pytest.approx(exact, rel=ROUNDING)
    # a torque T turns it up by T t/J
    driven = flywheel_line(HUBS[hub], FLYWHEELS["inertia"], ("drive", "hub"), drive=hm.DriveTorque(characteristic=lambda w: 9.0 + 0.0 * w))
    run = hm.simulate(driven, 0.002, solver=hm.Trapezoidal(step=1e-5, newton_tolerance=1e-8))
    assert run.values["hub.speed"][-1] == pytest.approx(9.0 * 0.002 / exact, rel=1e-4)


def test_effects_find_the_places_of_a_rotor_line() -> None:
    parts = {"d": DISC, "s": section(0.2), "e": DISC, "b": bearing(1e5)}
    scene = line("effects", parts, ("d", "s", "e", "b"))
    braked = scene.with_effect(hm.ViscousDrag(coefficient=0.5), at="d").with_effect(
        hm.BoucWenHysteresis(torque_limit=1.0, yield_twist=1e-3), at="s"
    )
    response = hm.simulate(braked, 0.05, initial_speed=10.0, solver=hm.Trapezoidal(step=1e-4))
    # 0.5 N m s/rad on 0.08 kg m^2; the hysteresis holds at most 1 N m between the two
    assert response.values["d.speed"][-1] == pytest.approx(10.0 * math.exp(-0.5 / 0.08 * 0.05), rel=1e-2)
    with pytest.raises(hm.PlaceError, match="acts on a connection, but 'd' is a body"):
        scene.with_effect(hm.BoucWenHysteresis(torque_limit=1.0, yield_twist=1e-3), at="d")


# -- rigid sections ------------------------------------------------------------------------------------


@pytest.mark.parametrize("behind", [False, True])
def test_a_disc_on_an_arm_in_a_bearing_swings_like_a_pendulum(behind: bool) -> None:
    # spring k at distance a from the centre, free to tilt: one rigid motion and w^2 = k (1/m + a^2/Jt)
    k, a = 1e5, 0.25
    parts = {"d": DISC, "arm": hm.RigidSection(length=a), "b": bearing(k)}
    scene = line("pendulum", parts, ("b", "arm", "d") if behind else ("d", "arm", "b"))
    system = steady(scene)
    for plane in (["d.x", "d.theta"], ["d.y", "d.psi"]):
        low, high = frequencies(system, plane)
        assert high == pytest.approx(math.sqrt(k * (1.0 / 8.0 + a**2 / 0.0206)), rel=ROUNDING)
        assert low < 1e-5 * high
    # the sign of the coupling: the arm ahead (+z) pulls with +a theta in x and -a psi in y
    sign = -1.0 if behind else 1.0
    x, y, psi, theta = (system.names.index(f"d.{key}") for key in ("x", "y", "psi", "theta"))
    assert system.stiffness[x, theta] == pytest.approx(sign * k * a)
    assert system.stiffness[y, psi] == pytest.approx(-sign * k * a)


def test_a_tilt_spring_at_the_end_of_an_arm_gives_the_pendulum_about_its_pin() -> None:
    # a pin of stiffness 1e12 N/m holds the end; about it Jt + m a^2 against the tilt spring
    a, tilt = 0.25, 5e3
    parts = {"d": DISC, "arm": hm.RigidSection(length=a), "b": bearing(1e12, tilt=tilt)}
    low = frequencies(steady(line("pinned", parts, ("d", "arm", "b"))), ["d.x", "d.theta"])[0]
    # the pin gives way by m w^2/k of the arm, 8e-8 / 1e4 of it
    assert low == pytest.approx(math.sqrt(tilt / (0.0206 + 8.0 * a**2)), rel=1e-7)


@pytest.mark.parametrize("middle", ["disc", "nothing"])
def test_two_rings_on_a_rigid_section_bounce_and_rock(middle: str) -> None:
    # bounce 2 k/(2 m + M), rock 2 k L^2/(2 (Jt + m L^2) + Jt_M) with half length L; with nothing between there is no rotor at all
    k, m, half = 1e4, 1.0, 0.1
    parts: dict[str, hm.Component] = {
        "a": bearing(k, mass=m),
        "b": bearing(k, mass=m),
        "r": hm.RigidSection(length=half),
        "t": hm.RigidSection(length=half),
    }
    disc_mass, disc_tilt, node = 0.0, 0.0, "a"
    if middle == "disc":
        parts["d"] = DISC
        disc_mass, disc_tilt, node = 8.0, 0.0206, "d"
    scene = line("rocking", parts, ("a", "r", "d", "t", "b") if middle == "disc" else ("a", "r", "t", "b"))
    assert bool(scene.network().rotors) == (middle == "disc")
    system = steady(scene)
    bounce = math.sqrt(2.0 * k / (2.0 * m + disc_mass))
    rock = math.sqrt(2.0 * k * half**2 / (2.0 * (1e-3 + m * half**2) + disc_tilt))
    for plane in ("x", "theta"), ("y", "psi"):
        np.testing.assert_allclose(frequencies(system, [f"{node}.{key}" for key in plane]), sorted((bounce, rock)), rtol=ROUNDING)


def test_two_discs_on_a_rigid_section_are_one_disc() -> None:
    whole = hm.Rotor.disc(diameter=0.3, thickness=0.08, density=STEEL)
    half = hm.Rotor.disc(diameter=0.3, thickness=0.04, density=STEEL)
    law = {"tilt": 5e3}
    one = line("one", {"d": whole, "b": bearing(1e6, **law)}, ("b", "d"))
    short = hm.RigidSection(length=0.02)
    parts = {"d": half, "r": short, "b": bearing(1e6, **law), "t": short, "e": half}
    two = line("two", parts, ("d", "r", "b", "t", "e"))
    for speed in (0.0, 300.0):
        wanted, found = eigenvalues(steady(one, speed)), eigenvalues(steady(two, speed))
        np.testing.assert_allclose(np.sort(np.abs(found.imag)), np.sort(np.abs(wanted.imag)), rtol=1e-9, atol=1e-6)


# -- elastic sections ----------------------------------------------------------------------------------


def inner_condensed(system: LineSystem, kept: Sequence[str]) -> FloatArray:
    """Stiffness seen at the kept coordinates when all others follow without load."""
    at = [system.names.index(name) for name in kept]
    rest = [k for k in range(len(system.names)) if k not in at]
    K = system.stiffness
    return K[np.ix_(at, at)] - K[np.ix_(at, rest)] @ np.linalg.solve(K[np.ix_(rest, rest)], K[np.ix_(rest, at)])


@pytest.mark.parametrize("shear", [False, True])
def test_several_elements_in_a_row_are_as_stiff_as_one_massless_one(shear: bool) -> None:
    # exact between the ends for what the ends do; the density gives the inner stations a mass and changes no stiffness
    ends = {"d": DISC, "e": DISC}
    one = steady(line("one", ends | {"s": section(0.4, shear=shear, bore=0.01)}, ("d", "s", "e")))
    five = steady(line("five", ends | {"s": section(0.4, shear=shear, bore=0.01, density=STEEL, elements=5.0)}, ("d", "s", "e")))
    names = [f"{disc}{key}" for disc in "de" for key in (".x", ".y", ".z", ".psi", ".theta", "")]
    at = [one.names.index(name) for name in names]
    wanted = one.stiffness[np.ix_(at, at)]
    np.testing.assert_allclose(inner_condensed(five, names), wanted, rtol=0.0, atol=1e-9 * np.max(np.abs(wanted)))


def test_a_shaft_fixed_in_the_ground_holds_a_disc_like_a_cantilever() -> None:
    # flexibilities at the free end: L^3/3EI, L^2/2EI, L/EI, L/EA, L/G Ip
    L, d = 0.4, 0.03
    bending, tension, torsion = E * math.pi * d**4 / 64.0, E * math.pi * d**2 / 4.0, G * math.pi * d**4 / 32.0
    wanted = {
        ("d.x", "d.x"): L**3 / (3.0 * bending),
        ("d.x", "d.theta"): L**2 / (2.0 * bending),
        ("d.theta", "d.theta"): L / bending,
        ("d.y", "d.psi"): -(L**2) / (2.0 * bending),
        ("d.psi", "d.psi"): L / bending,
        ("d.z", "d.z"): L / tension,
        ("d", "d"): L / torsion,
    }
    system = steady(line("cantilever", {"s": section(L), "d": DISC}, ("ground", "s", "d")))
    flexibility = np.linalg.inv(system.stiffness)
    for (row, column), value in wanted.items():
        assert flexibility[system.names.index(row), system.names.index(column)] == pytest.approx(value, rel=ROUNDING), (row, column)
    # held at its other end, towards which the chain runs, the disc hangs out to -z: signs of the couplings turn
    mirrored = steady(line("mirrored", {"s": section(L), "d": DISC}, ("d", "s", "ground")))
    flexibility = np.linalg.inv(mirrored.stiffness)
    assert flexibility[mirrored.names.index("d.x"), mirrored.names.index("d.theta")] == pytest.approx(
        -(L**2) / (2.0 * bending), rel=ROUNDING
    )
    assert flexibility[mirrored.names.index("d.x"), mirrored.names.index("d.x")] == pytest.approx(L**3 / (3.0 * bending), rel=ROUNDING)


def test_a_bare_shaft_with_a_free_end_converges_to_the_cantilever_of_euler_and_bernoulli() -> None:
    # cos b cosh b = -1: b = 1.8751040687, 4.6940911330; w = b^2 sqrt(E I/(rho A L^4)); consistent elements err by (b h)^4/720 or less
    L, d = 0.8, 0.03
    scale = math.sqrt(E * (d / 4.0) ** 2 / STEEL) / L**2  # I/A = d^2/16
    exact = np.array([1.8751040687, 4.6940911330]) ** 2 * scale

    def found(elements: float) -> FloatArray:
        shaft = section(L, density=STEEL, elements=elements, rotary_inertia=False)
        scene = line("bare", {"s": shaft}, ("ground", "s"))
        names = [body.name for body in scene.network().bodies if body.name.endswith((".x", ".theta"))]
        return frequencies(steady(scene), names)[:2]

    assert line("bare", {"s": section(L, density=STEEL)}, ("ground", "s")).network().places["s.b"] == "s.b"
    coarse, fine = found(4.0) / exact - 1.0, found(8.0) / exact - 1.0
    assert np.all(fine > 0.0)
    assert np.all(fine < (np.array([1.8751, 4.6941]) / 8.0) ** 4 / 1440.0 * 1.5)
    np.testing.assert_allclose(coarse / fine, 16.0, rtol=0.1)


def test_torsion_of_a_long_shaft_converges_to_the_wave_equation() -> None:
    # fixed-free: w = pi/2 sqrt(G/rho)/L; lumped polar inertia errs by -(w h)^2/(24 c^2)
    L = 0.8
    exact = 0.5 * math.pi * math.sqrt(G / STEEL) / L

    def error(elements: int) -> float:
        scene = line("bare", {"s": section(L, density=STEEL, elements=float(elements))}, ("ground", "s"))
        spins = [body.name for body in scene.network().bodies if not body.lateral]
        assert len(spins) == elements
        return frequencies(steady(scene), spins)[0] / exact - 1.0

    assert error(8) == pytest.approx(-((0.5 * math.pi / 8.0) ** 2) / 24.0, rel=0.01)
    assert error(8) / error(16) == pytest.approx(4.0, rel=0.01)


def test_the_linearised_line_is_what_exudyn_differentiates() -> None:
    # offsets, a backward line with unequal bearings, housings, massive shafts: every matrix of a straight, turning line
    housing = hm.Housing.isotropic(mass=2.0, stiffness=3e6, damping=200.0)
    cross = hm.LinearBearing(
        stiffness_xx=2e6,
        stiffness_yy=1e6,
        stiffness_xy=4e5,
        stiffness_yx=-6e5,
        damping_xx=300.0,
        damping_yy=200.0,
        damping_xy=50.0,
        damping_yx=20.0,
    )
    ring = {"mass": 0.3, "polar_inertia": 3e-4, "transverse_inertia": 2e-4}
    gear = hm.HarmonicDrive(ratio=3.0, stiffness=hm.CubicStiffness(linear=1e4, cubic=0.0), damping=1.0)
    parts = {
        "motor": hm.Inertia(inertia=0.1), "gear": gear, "d": DISC, "s": section(0.3, density=STEEL, elements=2.0, damping=1e-5, shear=True),
        "b": hm.Bearing(law=cross, housing=housing, **ring), "arm": hm.RigidSection(length=0.1), "t": section(0.2), "e": DISC,
        "arm_2": hm.RigidSection(length=0.05), "c": bearing(1e6, damping=100.0, tilt=100.0, axial=1e5),
    }  # fmt: skip
    scene = line("messy", parts, ("motor", "gear", "d", "s", "b", "arm", "t", "e", "arm_2", "c"))
    network = scene.network()
    speed = 240.0
    speeds = {body.name: body.sense * body.ratio * speed for body in network.bodies}
    assert speeds["d"] == pytest.approx(80.0)
    assert [rotor.sense for rotor in network.rotors] == [-1, -1]
    # twist of the gear at rest is zero, so any angles with motor = -3 d will do
    system = LineMatrices(network).at(dict.fromkeys(speeds, 0.0), speeds)
    found = linearise(assemble(network), angles={}, speeds=speeds, states={})
    assert found.bodies == system.names
    for name in ("mass", "damping", "stiffness"):
        own, engine = getattr(system, name), getattr(found, name)
        # numerical differentiation in the engine: relative steps of 1e-8 leave about 1e-7 of the largest entry
        np.testing.assert_allclose(own, engine, rtol=0.0, atol=2e-7 * np.max(np.abs(engine)), err_msg=name)
    np.testing.assert_allclose(system.mass, found.mass, rtol=0.0, atol=1e-13 * np.max(found.mass))


def test_the_displacement_across_a_bearing_under_a_rotor_is_only_another_way_to_count() -> None:
    # a law beyond matrices makes it a coordinate, one with a power term of nothing must move as the linear one
    linear = {"radial": 5e6, "damping": 200.0, "axial": 1e6, "axial_damping": 100.0, "tilt": 2e3, "tilt_damping": 1.0}
    housing = hm.Housing.isotropic(mass=2.0, stiffness=3e6, damping=300.0)
    rotor = DISC.replacing(eccentricity=1e-4, tilt=1e-3)
    found = []
    for law in (hm.LinearBearing.isotropic(**linear), hm.PowerBearing.isotropic(power_radial=1e-9, **linear)):
        parts = {"b": hm.Bearing(law=law, housing=housing), "arm": hm.RigidSection(length=0.1), "d": rotor, "gravity": hm.Gravity()}
        found.append(hm.simulate(line("across", parts, ("b", "arm", "d")), 0.02, initial_speed=300.0, solver=hm.Trapezoidal(step=2e-5)))
    assert "b.across_x" in found[1]
    for name in ("d.x", "d.y", "d.psi", "b.x", "b.housing.x", "b.housing.y", "b.housing.y_rate", "b.force_x", "b.force_y"):
        wanted = found[0].values[name]
        np.testing.assert_allclose(found[1].values[name], wanted, rtol=0.0, atol=1e-7 * np.max(np.abs(wanted)), err_msg=name)


def test_the_readable_scene_lists_what_turns_and_not_every_coordinate() -> None:
    text = str(line("plain", {"d": DISC, "s": section(0.1), "e": DISC}, ("d", "s", "e")))
    assert "+1  d, e" in text
    assert "d.x" not in text


def test_two_sections_side_by_side_of_one_length_are_twice_as_stiff() -> None:
    ends = {"d": DISC, "e": DISC}
    one = steady(line("one", ends | {"s": section(0.1)}, ("d", "s", "e")))
    two = steady(line("two", ends | {"s": section(0.1), "t": section(0.1)}, ("d", "s", "e"), ("d", "t", "e")))
    np.testing.assert_allclose(two.stiffness, 2.0 * one.stiffness, rtol=1e-12)
