"""Energy, momentum and angular momentum of rotor lines, and the misprint of seed M (8) that breaks the balance.

Matyja 2015; equation numbers are the paper's.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
import sympy as sp
from scipy.spatial.transform import Rotation

import hdrive_mbs as hm
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Rotor
from models.two_rotor_line import build

FloatArray = npt.NDArray[np.float64]
TOLERANCE = 1e-10
TIGHT = hm.DormandPrince(relative_tolerance=TOLERANCE, absolute_tolerance=1e-13)


def allowed(response: hm.Response) -> float:
    """What an adaptive solver may err by, relative: its tolerance in every step, twice for a square."""
    return 2.0 * response.steps * TOLERANCE


def section(length: float, **fields: float) -> hm.ShaftSection:
    return hm.ShaftSection(length=length, diameter=0.022, youngs_modulus=2.1e11, shear_modulus=8.1e10, **fields)


ROTOR_1 = hm.Rotor(mass=8.0, polar_inertia=0.04, transverse_inertia=0.0206, eccentricity=2e-4, angle=0.3, tilt=2e-3, tilt_angle=1.0)
ROTOR_2 = hm.Rotor(mass=3.0, polar_inertia=0.00735, transverse_inertia=0.00383, eccentricity=3e-4, angle=2.0)


def free_line(**fields: float) -> hm.Scene:
    """Two unbalanced rotors on a massless shaft that nothing holds."""
    parts = {"rotor_1": ROTOR_1, "shaft": section(0.3, **fields), "rotor_2": ROTOR_2}
    return hm.Scene(name="free line", parts=parts, connections=[("rotor_1", "shaft", "rotor_2")])


STIRRED = {"rotor_2.speed": 290.0, "rotor_1.psi": 1e-3, "rotor_2.x_rate": 0.2}


# -- energy ------------------------------------------------------------------------------------------------


def undamped_reference_line() -> hm.Scene:
    """M-REF without any damping and with more torque: to 585 rad/s, through both criticals, in 0.28 s."""
    scene = build(torque=100.0)
    changes: dict[str, object] = {f"section_{k}.damping": 0.0 for k in (1, 2, 3, 4)}
    changes |= {f"bearing_{b}.housing.damping_{key}": 0.0 for b in "ab" for key in "xy"}
    changes |= {f"bearing_{b}.law.damping_{key}": 0.0 for b in "ab" for key in ("xx", "yy", "zz")}
    changes |= {f"bearing_{b}.law.damping_{key}": 0.0 for b in "ab" for key in ("psi", "theta")}
    return scene.replacing(changes)


def test_the_motor_s_work_is_kinetic_and_elastic_energy_on_the_undamped_reference_line() -> None:
    errors = []
    for step in (1e-4, 5e-5):
        response = hm.simulate(undamped_reference_line(), 0.28, solver=hm.Trapezoidal(step=step, newton_tolerance=1e-10))
        balance = hm.energy_balance(response)
        given = -balance.work["drive.torque"]
        assert given[-1] > 8000.0
        imbalance = given - (balance.total - balance.total[0])
        errors.append(float(np.max(np.abs(imbalance))) / balance.energy_scale)
        vibration = max(float(np.max(values)) for name, values in balance.stored.items() if name.endswith(".beam"))
        # not only within 1e-6 of the energy, which is nearly all in the spin, but within 1e-2 of what bends the shaft
        assert errors[-1] < min(1e-6, 1e-2 * vibration / balance.energy_scale)
        assert balance.energy_error < 1e-6
        for heat in balance.dissipated.values():
            assert np.max(np.abs(heat)) < 1e-8 * balance.energy_scale
    # the trapezoidal rule is of order 2
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)


def test_on_the_reference_line_every_damper_makes_heat_and_nothing_is_missing() -> None:
    response = hm.simulate(build(torque=100.0), 0.28, solver=hm.Trapezoidal(step=5e-5, newton_tolerance=1e-8))
    balance = hm.energy_balance(response)
    assert balance.energy_error < 1e-6
    dampers = ["section_2.beam", "section_3.beam", "bearing_a.coefficients", "bearing_b.foundation_x", "section_2"]
    for name in dampers:
        assert balance.dissipated[name][-1] > 1e-3, name
        assert np.all(np.diff(balance.dissipated[name]) > -1e-12 * balance.energy_scale), name
    given = -balance.work["drive.torque"][-1]
    heat = sum(values[-1] for values in balance.dissipated.values())
    kept = balance.total[-1] - balance.total[0]
    assert given == pytest.approx(kept + heat, abs=1e-6 * balance.energy_scale)


def test_a_free_undamped_line_keeps_its_energy() -> None:
    response = hm.simulate(free_line(), 0.05, solver=TIGHT, initial_speed=300.0, initial=STIRRED)
    balance = hm.energy_balance(response)
    assert np.ptp(balance.total) < allowed(response) * balance.total[0] < 1e-5 * balance.total[0]
    assert balance.energy_error < allowed(response)
    # bending and torsion take part
    assert np.ptp(balance.stored["shaft"]) > 1e-4 * balance.total[0]
    assert np.ptp(balance.stored["shaft.beam"]) > 1e-5 * balance.total[0]


def test_kinetic_energy_is_that_of_a_mass_centre_that_moves_and_a_body_that_turns_about_it() -> None:
    response = hm.simulate(free_line(), 0.02, solver=TIGHT, initial_speed=300.0, initial=STIRRED)
    balance = hm.energy_balance(response)
    by_vectors = sum(motion.energy for motion in motions(response))
    np.testing.assert_allclose(balance.kinetic, by_vectors, rtol=1e-13)


def test_a_wrong_history_does_not_balance() -> None:
    response = hm.simulate(free_line(), 0.02, solver=TIGHT, initial_speed=300.0, initial=STIRRED)
    values = {**response.values, "rotor_1.x_rate": 1.01 * response.values["rotor_1.x_rate"]}
    wrong = hm.energy_balance(dataclasses.replace(response, values=values))
    right = hm.energy_balance(response)
    # the kinetic energy of this motion, wrong by 2 percent
    lateral = 0.5 * 8.0 * np.max(response.values["rotor_1.x_rate"]) ** 2
    assert np.max(np.abs(wrong.energy_residual)) > 0.01 * lateral
    assert np.max(np.abs(right.energy_residual)) < 1e-6 * lateral


LAW = {"axial": 1e6, "tilt": 2e3}
HOUSING = hm.Housing.isotropic(mass=1.0, stiffness=2e6, power_stiffness=1e14)


@pytest.mark.parametrize(
    "law",
    [
        hm.PowerBearing.isotropic(power_radial=1e14, radial=1e6, damping=0.0, **LAW),
        hm.BallBearing(
            balls=7.0,
            contact_stiffness=5e9,
            ball_diameter=0.01,
            pitch_diameter=0.05,
            radial_clearance=2e-6,
            axial_stiffness=1e6,
            tilt_stiffness=2e3,
        ),
    ],
    ids=lambda law: type(law).__name__,
)
@pytest.mark.parametrize("housing", [None, HOUSING], ids=["fixed", "housed"])
def test_nonlinear_bearings_and_housings_give_back_what_they_take(law: hm.BearingLaw, housing: hm.Housing | None) -> None:
    parts = {"rotor_1": ROTOR_1, "bearing": hm.Bearing(law=law, housing=housing), "gravity": hm.Gravity()}
    scene = hm.Scene(name="nonlinear", parts=parts, connections=[("bearing", "rotor_1")])
    response = hm.simulate(scene, 0.03, solver=TIGHT, initial_speed=200.0, initial={"rotor_1.x": 3e-5, "rotor_1.y": -5e-5})
    balance = hm.energy_balance(response)
    elastic = balance.stored["bearing.force"]
    assert np.ptp(elastic) > 1e-3
    # potential by the way straight from zero, heat by the power along the true way: with 32 panels a contact errs by 1e-6
    assert np.max(np.abs(balance.dissipated["bearing.force"])) < 1e-6 * np.max(elastic) + 1e-9
    assert np.ptp(balance.total) < 1e-6 * np.max(elastic) + allowed(response) * balance.energy_scale


def test_an_inertia_that_only_turns_keeps_its_share_of_the_energy() -> None:
    # an unbalanced rotor pulls at its own spin; the flywheel has J w^2/2 and no more, J = 0.05 kg m^2
    law = hm.LinearBearing.isotropic(radial=1e6, damping=0.0, **LAW)
    parts = {"r": ROTOR_1, "b": hm.Bearing(law=law), "flywheel": hm.Inertia(inertia=0.05)}
    scene = hm.Scene(name="flywheel", parts=parts, connections=[("b", "r"), ("flywheel", "r")])
    response = hm.simulate(scene, 0.02, solver=TIGHT, initial_speed=300.0, initial={"r.x": 1e-3, "r.psi": 2e-3})
    balance = hm.energy_balance(response)
    assert np.ptp(balance.total) < allowed(response) * balance.energy_scale
    (rotor,) = (motion for motion in motions(response))
    np.testing.assert_allclose(balance.kinetic, rotor.energy + 0.5 * 0.05 * response.values["r.speed"] ** 2, rtol=1e-13)
    assert np.ptp(response.values["r.speed"]) > 1e-3


def test_weight_holds_energy_of_height() -> None:
    rotor = ROTOR_1.replacing(eccentricity=0.01, tilt=0.0)
    law = hm.LinearBearing.isotropic(radial=1e7, damping=0.0, **LAW)
    scene = hm.Scene(name="pendulum", parts={"r": rotor, "b": hm.Bearing(law=law), "g": hm.Gravity()}, connections=[("b", "r")])
    response = hm.simulate(scene, 0.3, solver=TIGHT, initial={"r.angle": 1.0})
    balance = hm.energy_balance(response)
    height = 0.01 * np.sin(0.3 + response.values["r.angle"])
    np.testing.assert_allclose(balance.stored["r.weight"], 8.0 * 9.80665 * height, rtol=1e-12)
    np.testing.assert_allclose(balance.stored["r.y.weight"], 8.0 * 9.80665 * response.values["r.y"], rtol=1e-12, atol=1e-18)
    assert np.ptp(balance.total) < allowed(response) * balance.energy_scale
    # from 1.3 rad above the horizontal it has fallen by some 1 mm
    assert np.ptp(balance.kinetic) > 0.05


@pytest.mark.filterwarnings("ignore::hdrive_mbs.engine.assembly.LoweringWarning")
def test_what_rotating_damping_gives_to_whirl_it_takes_from_the_spin() -> None:
    # far above the critical speed whirl grows by beta w0^2 (w/w0 - 1)/2 = 35/s; heat is what is felt in the turning shaft: never negative
    ring = hm.Bearing(
        law=hm.LinearBearing.isotropic(radial=1e7, damping=0.0, axial=1e7), mass=0.3, polar_inertia=1e-4, transverse_inertia=1e-4
    )
    half = section(0.3, rotating_damping=1e-4)
    disc = hm.Rotor(mass=8.0, polar_inertia=0.04, transverse_inertia=0.0206)
    parts = {"a": ring, "s": half, "d": disc, "t": half, "b": ring}
    scene = hm.Scene(name="whirling", parts=parts, connections=[("a", "s", "d", "t", "b")])
    solver = hm.Trapezoidal(step=5e-5, newton_tolerance=1e-11)
    response = hm.simulate(scene, 0.06, solver=solver, initial_speed=3000.0, initial={"d.x": 1e-4, "d.y_rate": 0.026})
    balance = hm.energy_balance(response)
    bent = balance.stored["s.beam"] + balance.stored["t.beam"]
    start, end = (float(np.max(bent[part])) for part in (response.times < 0.01, response.times > 0.05))
    assert end > 5.0 * start
    # what whirl has won (half of it kinetic) and the heat, the spin has lost
    heat = sum(balance.dissipated[f"{k}.beam"] + balance.work[f"{k}.rotating_damping"] for k in "st")
    assert np.all(np.diff(heat) > 0.0)
    lost = 0.5 * 0.0402 * (3000.0**2 - response.values["d.speed"][-1] ** 2)
    assert lost == pytest.approx(heat[-1] + 2.0 * (bent[-1] - bent[0]), rel=0.1)
    assert heat[-1] > 5.0 * (bent[-1] - bent[0])
    # but for the first steps, over-damped and stiff: there the rings jump to where the disc wants them
    assert np.ptp(balance.energy_residual[response.times > 2e-3]) < 1e-4 * lost


def test_cross_coupled_stiffness_delivers_energy_and_the_balance_shows_it() -> None:
    cross = hm.LinearBearing(
        stiffness_xx=1e6, stiffness_yy=1e6, stiffness_xy=1e5, stiffness_yx=-1e5, stiffness_zz=1e6, stiffness_psi=2e3, stiffness_theta=2e3
    )
    scene = hm.Scene(name="film", parts={"r": ROTOR_1, "b": hm.Bearing(law=cross)}, connections=[("b", "r")])
    response = hm.simulate(scene, 0.1, solver=TIGHT, initial_speed=50.0)
    balance = hm.energy_balance(response)
    assert balance.energy_error < allowed(response)
    # forward whirl, which the unbalance starts, is fed: with k_xy > k_yx the force on the ring turns from x towards y
    assert balance.dissipated["b.coefficients"][-1] < -0.1 * np.max(balance.stored["b.coefficients"])
    # what is stored is that of the symmetric part alone
    x, y, z, psi, theta = (response.values[f"r.{key}"] for key in ("x", "y", "z", "psi", "theta"))
    np.testing.assert_allclose(balance.stored["b.coefficients"], 0.5e6 * (x**2 + y**2 + z**2) + 1e3 * (psi**2 + theta**2), rtol=1e-12)


def test_the_work_on_a_prescribed_rotor_is_counted() -> None:
    drive = hm.DriveTorque(characteristic=hm.IdealSpeedMotor(motion=lambda time: 100.0 * time**2))
    law = hm.LinearBearing.isotropic(radial=1e6, damping=50.0, **LAW)
    parts = {"drive": drive, "r": ROTOR_1, "s": section(0.2), "q": ROTOR_2, "b": hm.Bearing(law=law)}
    scene = hm.Scene(name="driven", parts=parts, connections=[("drive", "r", "s", "q"), ("b", "r")])
    response = hm.simulate(scene, 0.3, solver=TIGHT)
    balance = hm.energy_balance(response)
    assert balance.energy_error < allowed(response)
    # the drive accelerates the free second rotor: J w^2/2 at 60 rad/s, and feeds the whirl of the first by its unbalance
    assert balance.driven["r"][-1] == pytest.approx(0.5 * 0.00735 * 60.0**2, rel=0.05)
    assert sum(balance.work[f"r.unbalance_{key}"][-1] for key in ("x", "y", "psi", "theta")) < 0.0


# -- momentum -----------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class BodyMotion:
    """Kinetics of one rotor from vectors in the fixed frame, over all samples."""

    momentum: FloatArray
    angular_momentum: FloatArray
    """About the origin."""
    energy: FloatArray


def motions(response: hm.Response) -> list[BodyMotion]:
    """From rotation matrices and vectors, without mass matrices or generalised coordinates."""
    assert response.scene is not None
    return [_motion(response, rotor) for rotor in response.scene.network().rotors]


def _motion(response: hm.Response, rotor: Rotor) -> BodyMotion:
    body, values = rotor.body, response.values
    *lateral, spin = rotor.coordinates
    place = np.stack([values[name] for name in lateral[:3]], axis=-1)
    velocity = np.stack([values[f"{name}_rate"] for name in lateral[:3]], axis=-1)
    psi, theta, phi = (values[name] for name in (*lateral[3:], f"{spin}.angle"))
    rates = (values[f"{lateral[3]}_rate"], values[f"{lateral[4]}_rate"], values[f"{spin}.speed"])
    turned = Rotation.from_euler("XYZ", np.stack([psi, theta, phi], axis=-1)).as_matrix()
    zero, one = np.zeros_like(psi), np.ones_like(psi)
    # rate of psi about x, of theta about the y axis tilted by psi, of phi about the body's z axis
    axes = [
        np.stack([one, zero, zero], axis=-1),
        np.stack([zero, np.cos(psi), np.sin(psi)], axis=-1),
        np.stack([np.sin(theta), -np.sin(psi) * np.cos(theta), np.cos(psi) * np.cos(theta)], axis=-1),
    ]
    omega = sum(rate[:, None] * axis for rate, axis in zip(rates, axes))
    assert isinstance(omega, np.ndarray)
    centre = np.array(body.centre)
    arm = turned @ centre
    about_centre = np.array(body.inertia) - body.mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
    spin_momentum = np.einsum("nij,jk,nlk,nl->ni", turned, about_centre, turned, omega)
    of_centre = velocity + np.cross(omega, arm)
    momentum = body.mass * of_centre
    return BodyMotion(
        momentum,
        np.cross(place + arm, momentum) + spin_momentum,
        0.5 * np.sum(momentum * of_centre + spin_momentum * omega, axis=-1),
    )


def test_a_single_free_rotor_keeps_momentum_and_angular_momentum_in_all_directions() -> None:
    scene = hm.Scene(name="thrown", parts={"r": ROTOR_1.replacing(eccentricity=0.02, tilt=0.09)}, connections=[])
    start = {"r.speed": 100.0, "r.theta": 0.4, "r.psi_rate": 30.0, "r.x_rate": 2.0, "r.z_rate": -1.0, "r.y": 0.3}
    response = hm.simulate(scene, 0.3, solver=TIGHT, initial=start)
    (motion,) = motions(response)
    for vector in (motion.momentum, motion.angular_momentum):
        assert np.max(np.ptp(vector, axis=0)) < allowed(response) * np.max(np.linalg.norm(vector, axis=1))
    assert np.ptp(motion.energy) < allowed(response) * motion.energy[0]
    # it tumbles: tilts of the order of 1 rad
    assert np.max(np.abs(response.values["r.theta"])) > 0.5


def test_a_free_line_keeps_its_momentum() -> None:
    response = hm.simulate(free_line(), 0.05, solver=TIGHT, initial_speed=300.0, initial=STIRRED)
    both = motions(response)
    total = sum(motion.momentum for motion in both)
    assert isinstance(total, np.ndarray)
    size = max(float(np.max(np.abs(motion.momentum))) for motion in both)
    assert np.max(np.ptp(total, axis=0)) < allowed(response) * size
    assert np.max(np.ptp(both[0].momentum, axis=0)) > 0.1 * size, "the two exchange it"


def test_a_free_line_keeps_its_angular_momentum_but_for_the_linear_shaft() -> None:
    # a turn of everything about z by d moves the coordinates by
    #     x: -y d, y: x d, psi: -cos psi tan theta d, theta: sin psi d, phi: cos psi / cos theta d,
    # so dLz/dt = sum Q dq/d.  A linear shaft is blind to a turn only to first order of its tilts, here 1e-2: the rest must be
    # all that changes Lz
    response = hm.simulate(free_line(), 0.05, solver=TIGHT, initial_speed=300.0, initial=STIRRED)
    total = sum(motion.angular_momentum[:, 2] for motion in motions(response))
    assert isinstance(total, np.ndarray)
    assert response.scene is not None
    network, values = response.scene.network(), response.values
    names = [body.name for body in network.bodies]
    angles = {name: values[name if "." in name else f"{name}.angle"] for name in names}
    speeds = {name: values[f"{name}_rate" if "." in name else f"{name}.speed"] for name in names}
    forces = network.torques(network.moment(response.times, angles, speeds, {}))
    about_axis = np.zeros_like(response.times)
    for rotor in network.rotors:
        x, y, _, psi, theta, _ = (angles[name] for name in rotor.coordinates)
        moved = (-y, x, 0.0 * x, -np.cos(psi) * np.tan(theta), np.sin(psi), np.cos(psi) / np.cos(theta))
        about_axis = about_axis + sum(forces[name] * share for name, share in zip(rotor.coordinates, moved))
    steps = np.diff(response.times)
    impulse = np.concatenate([[0.0], np.cumsum(0.5 * steps * (about_axis[1:] + about_axis[:-1]))])
    change = total - total[0]
    tilt = max(float(np.max(np.abs(values[f"rotor_{k}.{key}"]))) for k in (1, 2) for key in ("psi", "theta"))
    assert np.max(np.abs(change)) < tilt**2 * total[0]
    # the trapezoids over some 6000 steps leave a few parts in 1e5 of the impulse
    assert np.max(np.abs(change - impulse)) < 1e-4 * np.max(np.abs(change))


# -- the third line of (8) --------------------------------------------------------------------------------------


def test_the_printed_spin_equation_makes_energy_and_the_other_two_lines_do_not() -> None:
    Jp, Jt, t = sp.symbols("J_p J_t t", positive=True)
    psi, theta, phi = (sp.Function(name)(t) for name in ("psi", "theta", "phi"))
    energy = Jt * (psi.diff(t) ** 2 + theta.diff(t) ** 2) / 2 + Jp * phi.diff(t) ** 2 / 2
    tilting = {
        psi.diff(t, 2): -Jp * phi.diff(t) * theta.diff(t) / Jt,
        theta.diff(t, 2): Jp * phi.diff(t) * psi.diff(t) / Jt,
    }
    as_printed = tilting | {phi.diff(t, 2): -psi.diff(t) * theta.diff(t)}
    # no moments: energy must stay
    assert sp.simplify(energy.diff(t).subs(as_printed) + Jp * phi.diff(t) * psi.diff(t) * theta.diff(t)) == 0
    assert sp.simplify(energy.diff(t).subs(tilting | {phi.diff(t, 2): 0})) == 0


def test_the_exact_spin_equation_has_the_printed_term_and_another_that_pays_for_it() -> None:
    # T = Jt (psi'^2 cos^2 theta + theta'^2)/2 + Jp (phi' + psi' sin theta)^2/2; its third line to second order of the tilts
    Jp, Jt, t = sp.symbols("J_p J_t t", positive=True)
    psi, theta, phi = (sp.Function(name)(t) for name in ("psi", "theta", "phi"))
    spin = phi.diff(t) + psi.diff(t) * sp.sin(theta)
    energy = Jt * (psi.diff(t) ** 2 * sp.cos(theta) ** 2 + theta.diff(t) ** 2) / 2 + Jp * spin**2 / 2
    third = sp.diff(energy.diff(phi.diff(t)), t) - energy.diff(phi)
    size = sp.Symbol("epsilon")
    small = third.subs({psi: size * psi, theta: size * theta}).doit()
    second_order = sp.series(small, size, 0, 3).removeO().subs(size, 1)
    wanted = Jp * (phi.diff(t, 2) + psi.diff(t) * theta.diff(t) + theta * psi.diff(t, 2))
    assert sp.simplify(second_order - wanted) == 0


@dataclass(frozen=True, kw_only=True)
class PrintedSpinTerm(hm.Component):
    """Puts the term Jp psi' theta' of (8), third line, on a place as it is printed."""

    place: str = hm.option("the ring")
    polar_inertia: float = hm.parameter("kg m^2", "Jp", above=0.0)

    def build(self, name: str, draft: Draft) -> None:
        station = draft.station(self.place)
        psi, theta, spin = station.names[3], station.names[4], station.names[5]

        def torque(moment: Moment) -> Value:
            return -self.polar_inertia * moment.speed(psi) * moment.speed(theta)

        draft.add_torque(f"{name}.torque", spin, torque)


def rocking_ring(printed: bool) -> hm.Scene:
    """A ring in springs against tilt."""
    law = hm.LinearBearing.isotropic(radial=1e6, damping=0.0, axial=1e6, tilt=200.0)
    parts: dict[str, hm.Component] = {"ring": hm.Bearing(law=law, mass=0.35, polar_inertia=3e-4, transverse_inertia=2e-4)}
    if printed:
        parts["term"] = PrintedSpinTerm(place="ring", polar_inertia=3e-4)
    return hm.Scene(name="rocking ring", parts=parts, connections=[])


ROCKED = {"ring.psi": 0.02, "ring.theta": 0.02}
"""Let go in a plane between the axes, without spin: psi and theta swing together, w^2 = k/Jt = 1e6."""


def test_the_printed_term_spins_a_ring_up_from_nothing() -> None:
    # psi = theta = a cos wt: psi' theta' = a^2 w^2 sin^2 wt, so the printed line asks for phi'' = -a^2 w^2/2 on average,
    # for ever: 200 rad/s^2 from a ring that only rocks
    response = hm.simulate(rocking_ring(printed=True), 0.02, solver=TIGHT, initial=ROCKED)
    balance = hm.energy_balance(response)
    assert response.values["ring.speed"][-1] == pytest.approx(-(0.02**2) * 1e6 / 2.0 * 0.02, rel=0.02)
    # nothing outside does work, yet the energy grows by that of the spin, all of it "work" of the misprint
    grown = balance.total[-1] - balance.total[0]
    assert grown == pytest.approx(0.5 * 3e-4 * 4.0**2, rel=0.05)
    assert -balance.work["term.torque"][-1] == pytest.approx(grown, rel=1e-6)
    longer = hm.energy_balance(hm.simulate(rocking_ring(printed=True), 0.04, solver=TIGHT, initial=ROCKED))
    assert longer.total[-1] - longer.total[0] > 3.0 * grown


def test_without_the_printed_term_the_ring_keeps_its_energy_and_its_spin() -> None:
    response = hm.simulate(rocking_ring(printed=False), 0.02, solver=TIGHT, initial=ROCKED | {"ring.speed": 5.0})
    balance = hm.energy_balance(response)
    assert np.ptp(balance.total) < allowed(response) * balance.total[0]
    assert np.ptp(response.values["ring.speed"]) == 0.0


def test_the_exact_rotor_keeps_both_terms_and_its_energy() -> None:
    # phi' + psi' sin theta is conserved: phi' swings by psi' theta = a^2 w sin(2 wt)/2 and goes nowhere
    law = hm.LinearBearing.isotropic(radial=1e6, damping=0.0, axial=1e6, tilt=200.0)
    rotor = hm.Rotor(mass=0.35, polar_inertia=3e-4, transverse_inertia=2e-4)
    scene = hm.Scene(name="rocking rotor", parts={"ring": rotor, "b": hm.Bearing(law=law)}, connections=[("b", "ring")])
    response = hm.simulate(scene, 0.02, solver=TIGHT, initial=ROCKED)
    balance = hm.energy_balance(response)
    assert np.ptp(balance.total) < allowed(response) * balance.total[0]
    speed, rate = response.values["ring.speed"], response.values["ring.psi_rate"]
    assert np.max(np.abs(speed + rate * np.sin(response.values["ring.theta"]))) < allowed(response) * np.max(np.abs(rate))
    assert np.max(np.abs(speed)) == pytest.approx(0.02**2 * 1000.0 / 2.0, rel=0.01)


# -- the result -------------------------------------------------------------------------------------------------


def test_a_rotor_line_s_balance_says_that_it_has_no_angular_momentum(tmp_path: Path) -> None:
    balance = hm.energy_balance(hm.simulate(free_line(), 0.01, solver=TIGHT, initial_speed=300.0))
    with pytest.raises(hm.AnalysisError, match="Angular momentum is not balanced for rotor lines"):
        _ = balance.momentum_error
    columns = balance.columns()
    assert not any("momentum" in name or "impulse" in name for name in columns)
    assert {len(column) for column in columns.values()} == {len(balance.times)}
    copy = hm.load(balance.save(tmp_path / "energy.npz"))
    assert isinstance(copy, type(balance))
    assert copy.energy_error == balance.energy_error
    assert not len(copy.momentum)
    assert hm.plot(copy).figure is not None
