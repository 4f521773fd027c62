"""Unbalance, sense of rotation and rotating damping: what whirls, where to and how far."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.network.circulation import Circulation
from hdrive_mbs.network.matrix_element import MatrixElement
from tests.unit.rotor_pieces import (
    DISC,
    E,
    bearing,
    eigenvalues,
    line,
    section,
    steady,
    system_matrix,
)

UNBALANCED = DISC.replacing(eccentricity=2e-5, angle=0.4, tilt=5e-4, tilt_angle=1.9)
OFFSET = {"arm": hm.RigidSection(length=0.1), "b": bearing(2e6, damping=300.0, tilt=3e3, tilt_damping=2.0, axial=1e6, axial_damping=50.0)}


def forced_whirl(scene: hm.Scene, speed: float) -> dict[str, complex]:
    """Steady response x = Re(X exp(i w t)) of the linearised line to its unbalance, by d'Alembert:

    forces m w^2 (cx, cy) turning with the spin, moments w^2 (J_yz, -J_xz) turning with it.
    """
    network, system = scene.network(), steady(scene, speed)
    force = np.zeros(len(system.names), complex)
    for rotor in network.rotors:
        body, w = rotor.body, speed
        tensor, (cx, cy, _) = np.array(body.inertia), body.centre
        # a vector (u, v) of the turning frame is Re[(u + i v) exp(i w t)] in x and Re[-i (u + i v) exp(i w t)] in y
        for keys, vector in (("x", "y"), complex(cx, cy) * body.mass), (("psi", "theta"), complex(tensor[1, 2], -tensor[0, 2])):
            for key, factor in zip(keys, (1.0, -1j)):
                force[system.names.index(f"{rotor.name}.{key}")] += w**2 * factor * vector
    matrix = system.stiffness - speed**2 * system.mass + 1j * speed * system.damping
    spins = [k for k, name in enumerate(system.names) if "." not in name or name.split(".")[1].isdigit()]
    rest = [k for k in range(len(system.names)) if k not in spins]
    found = np.linalg.solve(matrix[np.ix_(rest, rest)], force[rest])
    return {system.names[k]: complex(value) for k, value in zip(rest, found)}


def whirling(wanted: Mapping[str, complex], speed: float) -> dict[str, float]:
    """Initial values of a steady whirl at spin angle zero."""
    return {name: value.real for name, value in wanted.items()} | {
        f"{name}_rate": (1j * speed * value).real for name, value in wanted.items()
    }


def test_unbalance_of_both_kinds_drives_the_whirl_of_the_linearised_line() -> None:
    speed = 250.0
    scene = line("unbalanced", {"d": UNBALANCED, **OFFSET}, ("d", "arm", "b"))
    wanted = forced_whirl(scene, speed)
    response = hm.simulate(scene, 0.1, initial_speed=speed, initial=whirling(wanted, speed), solver=hm.RungeKutta4(step=1e-4))
    angle = response.values["d.angle"]
    assert angle[-1] > 20.0
    for key in ("x", "y", "psi", "theta"):
        exact = (wanted[f"d.{key}"] * np.exp(1j * angle)).real
        # damping takes some 0.1 W of 1250 J of spin: it slows down by 4e-6 in this time
        np.testing.assert_allclose(response.values[f"d.{key}"], exact, rtol=0.0, atol=2e-5 * np.max(np.abs(exact)), err_msg=key)


def driven(motion: Any) -> hm.Scene:
    drive = hm.DriveTorque(characteristic=hm.IdealSpeedMotor(motion=motion))
    return line("driven", {"drive": drive, "d": UNBALANCED, **OFFSET}, ("drive", "d", "arm", "b"))


def test_a_prescribed_spin_whirls_as_a_free_rotor_of_huge_inertia() -> None:
    # the free one is turned by a flywheel of 1e6 kg m^2 on a torsional spring; unbalance cannot slow that down
    speed = 180.0
    fast = {"wheel": hm.Inertia(inertia=1e6), "spring": hm.Shaft(stiffness=1e6, damping=50.0), "d": UNBALANCED, **OFFSET}
    free = hm.simulate(line("free", fast, ("wheel", "spring", "d", "arm", "b")), 0.1, initial_speed=speed, solver=hm.RungeKutta4(step=2e-5))
    held = hm.simulate(driven(lambda time: speed * time), 0.1, initial_speed=speed, solver=hm.RungeKutta4(step=2e-5))
    for key in ("x", "y", "psi", "theta"):
        wanted = free.values[f"d.{key}"]
        # a prescribed rotor leaves out squares of its tilts, 1e-3 rad
        np.testing.assert_allclose(held.values[f"d.{key}"], wanted, rtol=0.0, atol=1e-6 * np.max(np.abs(wanted)), err_msg=key)
    assert not held.scene.network().rotors  # type: ignore[union-attr]


def test_a_prescribed_ramp_gives_the_forces_of_angular_acceleration_too() -> None:
    # x'' = (w^2 cos phi + a sin phi) m e/m for a body held by nothing: its centre of mass stays where it is
    alpha = 400.0
    motor = hm.Motor(inertia=0.1, characteristic=hm.IdealSpeedMotor(motion=lambda time: 0.5 * alpha * time**2))
    e, direction = 2e-5, 0.4
    rotor = DISC.replacing(eccentricity=e, angle=direction)
    scene = line("ramp", {"motor": motor, "d": rotor}, ("motor", "d"))
    response = hm.simulate(scene, 0.5, solver=hm.DormandPrince(relative_tolerance=1e-10, absolute_tolerance=1e-15))
    t = response.times
    turned = direction + 0.5 * alpha * t**2
    # centre of mass at rest at e (cos, sin)(direction): x = e (cos direction - cos turned)
    np.testing.assert_allclose(response.values["d.x"], e * (np.cos(direction) - np.cos(turned)), rtol=0.0, atol=1e-6 * e)
    np.testing.assert_allclose(response.values["d.y"], e * (np.sin(direction) - np.sin(turned)), rtol=0.0, atol=1e-6 * e)


def test_the_mass_centre_channel_follows_the_mass_centre() -> None:
    rotor = DISC.replacing(eccentricity=3e-4, angle=0.7)
    scene = line("free", {"d": rotor})
    response = hm.simulate(
        scene, 0.05, initial={"d.x": 1e-3, "d.angle": 0.2}, initial_speed=300.0, solver=hm.DormandPrince(relative_tolerance=1e-11)
    )
    # starts with its geometric centre at rest and flies off: the mass centre with 300 e across, in a straight line
    start = 1e-3 + 3e-4 * np.exp(1j * (0.7 + 0.2))
    path = start + 1j * 300.0 * 3e-4 * np.exp(1j * (0.7 + 0.2)) * response.times
    np.testing.assert_allclose(response.values["d.mass_centre_radial"], np.abs(path), rtol=1e-8)


def test_the_mass_centre_of_two_joined_bodies_lies_between_them() -> None:
    # a heavy ring at 0.2 m behind: the common centre is 0.1 m from the disc, e/2 off the axis, and follows the tilts
    rotor = DISC.replacing(eccentricity=3e-4, angle=0.7)
    scene = line("joined", {"d": rotor, "arm": hm.RigidSection(length=0.2), "ring": bearing(0.0, mass=8.0)}, ("d", "arm", "ring"))
    start = {"d.x": 1e-3, "d.y": 2e-3, "d.theta": 3e-3, "d.psi": 4e-3}
    response = hm.simulate(scene, 1e-4, initial=start)
    x, y = 1e-3 + 0.1 * 3e-3 + 1.5e-4 * math.cos(0.7), 2e-3 - 0.1 * 4e-3 + 1.5e-4 * math.sin(0.7)
    assert response.values["d.mass_centre_radial"][0] == pytest.approx(math.hypot(x, y), rel=1e-12)


# -- behind a gear that turns backwards ----------------------------------------------------------------


def mirrored(rotor: hm.Rotor) -> hm.Rotor:
    """The image in the xz plane."""
    return rotor.replacing(angle=-rotor.angle, tilt_angle=-rotor.tilt_angle)


def geared(rotor: hm.Rotor) -> hm.Scene:
    """A heavy motor turns the rotor at -1/2 of its speed through a stiff gear."""
    gear = hm.HarmonicDrive(ratio=2.0, stiffness=hm.CubicStiffness(linear=1e6, cubic=0.0), damping=50.0)
    parts = {"motor": hm.Inertia(inertia=1e4), "gear": gear, "d": rotor, **OFFSET}
    return line("geared", parts, ("motor", "gear", "d", "arm", "b"))


def direct(rotor: hm.Rotor) -> hm.Scene:
    parts = {"motor": hm.Inertia(inertia=1e4), "spring": hm.Shaft(stiffness=1e6, damping=50.0), "d": rotor, **OFFSET}
    return line("direct", parts, ("motor", "spring", "d", "arm", "b"))


def test_behind_a_gear_that_turns_backwards_everything_happens_in_the_mirror() -> None:
    # a mirror in the xz plane keeps x, theta (y axis is normal to it: tilt about y survives) and turns y, psi and the spin
    speed = 180.0
    how = {"solver": hm.RungeKutta4(step=2e-5)}
    backward = hm.simulate(geared(UNBALANCED), 0.1, initial_speed=2.0 * speed, **how)
    turned = hm.simulate(direct(UNBALANCED), 0.1, initial_speed=-speed, **how)
    image = hm.simulate(direct(mirrored(UNBALANCED)), 0.1, initial_speed=speed, **how)
    assert backward.values["d.speed"][0] == pytest.approx(-speed)
    signs = {"x": 1.0, "theta": 1.0, "y": -1.0, "psi": -1.0}
    for key, sign in signs.items():
        size = np.max(np.abs(image.values[f"d.{key}"]))
        # the three are twisted by different springs, by less than 1e-6 rad
        np.testing.assert_allclose(backward.values[f"d.{key}"], turned.values[f"d.{key}"], rtol=0.0, atol=1e-6 * size, err_msg=key)
        np.testing.assert_allclose(turned.values[f"d.{key}"], sign * image.values[f"d.{key}"], rtol=0.0, atol=1e-6 * size, err_msg=key)


def test_a_rotor_behind_such_a_gear_whirls_in_its_own_sense() -> None:
    speed = 180.0
    wanted = forced_whirl(line("alone", {"d": UNBALANCED, **OFFSET}, ("d", "arm", "b")), speed)
    image = forced_whirl(line("alone", {"d": mirrored(UNBALANCED), **OFFSET}, ("d", "arm", "b")), speed)
    mirror = {"d.x": 1.0, "d.theta": 1.0, "d.y": -1.0, "d.psi": -1.0, "d.z": 1.0}
    starts = (whirling(wanted, speed), whirling({name: mirror[name] * value for name, value in image.items()}, speed))
    for scene, motor, start, sense in ((direct(UNBALANCED), speed, starts[0], 1.0), (geared(UNBALANCED), 2.0 * speed, starts[1], -1.0)):
        response = hm.simulate(scene, 0.1, initial_speed=motor, initial=start, solver=hm.RungeKutta4(step=2e-5))
        orbit = response.values["d.x"] + 1j * response.values["d.y"]
        place = np.unwrap(np.angle(orbit))
        # the orbit is a circle that turns with the spin, in its sense
        assert (place[-1] - place[0]) / 0.1 == pytest.approx(sense * speed, rel=1e-4)
        np.testing.assert_allclose(np.abs(orbit), np.abs(orbit[0]), rtol=1e-3)


def test_gyroscopic_splitting_does_not_ask_for_the_sense_but_whirl_directions_turn_with_it() -> None:
    # mirror images have the same frequencies, with forward and backward exchanged in space
    speed = 400.0
    wanted, found = steady(direct(DISC), -speed), steady(geared(DISC), 2.0 * speed)
    lateral = ["d.x", "d.y", "d.psi", "d.theta"]
    for system in (wanted, found):
        at = [system.names.index(name) for name in lateral]
        gyroscopic = system.damping[np.ix_(at, at)]
        # Jt psi'' + Jp phi' theta' with phi' = -400 in both
        assert gyroscopic[2, 3] - gyroscopic[3, 2] == pytest.approx(2.0 * 0.04 * -speed, rel=1e-9)
    np.testing.assert_allclose(
        np.sort_complex(eigenvalues(found, lateral)), np.sort_complex(eigenvalues(wanted, lateral)), rtol=1e-9, atol=1e-6
    )


# -- damping that turns with the shaft -----------------------------------------------------------------


def disc_between_walls(internal: float, external: float) -> hm.Scene:
    """A disc in the middle of a shaft fixed at both ends; external damping on the disc itself."""
    half = section(0.3, rotating_damping=internal)
    parts = {"s": half, "d": DISC, "t": half, "damper": bearing(0.0, damping=external)}
    return line("walls", parts, ("ground", "s", "d", "t", "ground"), ("damper", "d"))


def test_rotating_damping_destabilises_forward_whirl_above_the_threshold() -> None:
    # x, y plane: m r'' + (c_e + c_i) r' + (k - i c_i w) r = 0, c_i = beta k:  stable below w_0 (1 + c_e/c_i).  The tilts have
    # a threshold of their own above it: theirs is not damped from outside, but lies at the higher tilt frequency
    beta, external = 2e-5, 400.0
    k = 2.0 * 12.0 * E * math.pi * 0.03**4 / 64.0 / 0.3**3
    w_0 = math.sqrt(k / 8.0)
    threshold = w_0 * (1.0 + external / (beta * k))

    def worst(speed: float) -> complex:
        system = steady(disc_between_walls(beta, external), speed)
        found = eigenvalues(system, ["d.x", "d.y"])
        return complex(found[np.argmax(found.real)])

    assert worst(threshold * (1.0 - 1e-6)).real < 0.0 < worst(threshold * (1.0 + 1e-6)).real
    # on the threshold it whirls at w_0
    assert abs(worst(threshold)) == pytest.approx(w_0, rel=1e-8)
    system, n = steady(disc_between_walls(beta, external), 2.0 * threshold), ["d.x", "d.y"]
    values, vectors = np.linalg.eig(system_matrix(system, n))
    shape = vectors[:2, np.argmax(values.real)]
    growing = values[np.argmax(values.real)]
    # x = Re(X exp(st)): forward (x towards y) where Y = -i X for positive imaginary part
    assert shape[1] / shape[0] == pytest.approx(-1j * np.sign(growing.imag), abs=1e-9)


def test_damping_at_rest_in_the_frame_never_destabilises() -> None:
    half = section(0.3, damping=2e-5)
    scene = line("walls", {"s": half, "d": DISC, "t": half}, ("ground", "s", "d", "t", "ground"))
    for speed in (0.0, 500.0, 5000.0, 50000.0):
        assert np.max(eigenvalues(steady(scene, speed), ["d.x", "d.y", "d.psi", "d.theta"]).real) < 0.0


def test_rotating_damping_takes_what_the_material_feels() -> None:
    # the power it takes is (q' - w J q).B (q' - w J q), J the turn by +90 degrees: rates in the frame of the shaft
    scene = line("free", {"d": DISC, "s": section(0.4, rotating_damping=1e-4), "e": DISC}, ("d", "s", "e"))
    network = scene.network()
    circulation = next(item for item in network.elements if isinstance(item, Circulation))
    beam = next(item for item in network.elements if isinstance(item, MatrixElement))
    rng = np.random.default_rng(2)
    q, v = ({body.name: float(rng.normal()) for body in network.bodies} for _ in range(2))
    moment = network.moment(0.0, q, v, {})
    still = MatrixElement("damping", beam.coordinates, beam.mass, beam.damping, 0.0 * beam.stiffness)
    taken = circulation.power(moment) + still.power(moment)
    spin = 0.5 * (v["d"] + v["e"])
    rates = np.array([v[name] for name in beam.coordinates])
    for k, name in enumerate(beam.coordinates):
        node, _, key = name.rpartition(".")
        partner, sign = {"x": ("y", 1.0), "y": ("x", -1.0), "psi": ("theta", 1.0), "theta": ("psi", -1.0), "z": ("z", 0.0)}[key]
        rates[k] += sign * spin * q[f"{node}.{partner}"]
    assert taken == pytest.approx(rates @ beam.damping @ rates, rel=1e-12)
    assert taken > 0.0
