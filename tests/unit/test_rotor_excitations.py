"""Effects that shake a rotor line and faults of its probes, against closed forms."""

from __future__ import annotations

import cmath
import dataclasses
import math
import warnings
from collections.abc import Mapping

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import hdrive_mbs as hm
from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices
from hdrive_mbs.analysis.whirl.rotor_point import rotor_point
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.engine.assembly import LoweringWarning, assemble
from hdrive_mbs.errors import ParameterError, PlaceError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.coupling import Coupling
from hdrive_mbs.network.elements import Connection
from hdrive_mbs.network.excitation import Excitation
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network
from models import rotor_bench, two_rotor_line
from tests.unit.rotor_scenes import CRITICAL, ECCENTRICITY, MASS, POLAR, STIFFNESS, constant, damped_disc, holding, jeffcott, support, z_of

TRANSVERSE = 0.006
STEP = hm.RungeKutta4(step=1e-4)


def amplitude(response: hm.Response, values: np.ndarray, order: float, place: str, turns: float) -> complex:
    """Z in Z exp(i n f) over the last turns, by least squares on the steady record."""
    angle = response[f"{place}.angle"].values
    last = angle >= angle[-1] - 2.0 * np.pi * turns
    return complex(np.mean(values[last] * np.exp(-1j * order * angle[last])))


def mid_shaft(damping: float = 2e-3) -> hm.Scene:
    """A disc in the middle of a massless shaft whose bearings and rings hardly move."""
    stiff = np.diag([1e9, 1e9, 1e7, 0.0, 0.0, 0.0])
    damped = np.diag([1e5, 1e5, 1e4, 0.0, 0.0, 0.0])
    law = hm.LinearBearing.from_matrices(stiffness=stiff, damping=damped)
    bearing = hm.Bearing(law=law, mass=1.0, polar_inertia=1e-3, transverse_inertia=1e-3)
    section = hm.ShaftSection(length=0.4, diameter=0.03, youngs_modulus=2e11, shear_modulus=8e10, damping=damping)
    parts: dict[str, hm.Component] = {
        "left": bearing,
        "first": section,
        "disc": hm.Rotor(mass=10.0, polar_inertia=0.05, transverse_inertia=0.03),
        "second": section,
        "right": bearing,
        "drive": hm.DriveTorque(characteristic=constant(0.0)),
    }
    return hm.Scene(name="mid shaft", parts=parts, connections=[("drive", "left", "first", "disc", "second", "right")])


# simply supported beam of span 0.8 m with a force in the middle: k = 48 E I/L^3
MID_STIFFNESS = 48.0 * 2e11 * (math.pi * 0.03**4 / 64.0) / 0.8**3
MID_CRITICAL = math.sqrt(MID_STIFFNESS / 10.0)


def random_moment(network: Network, seed: int = 3) -> Moment:
    rng = np.random.default_rng(seed)
    lateral = {body.name: body.lateral for body in network.bodies}
    return network.moment(
        np.float64(rng.uniform(0.0, 1.0)),
        {name: np.float64(rng.normal(0.0, 1e-4 if is_lateral else 3.0)) for name, is_lateral in lateral.items()},
        {name: np.float64(rng.normal(0.0, 1e-2 if is_lateral else 300.0)) for name, is_lateral in lateral.items()},
        {state.name: np.float64(0.0) for state in network.states},
    )


def added_forces(scene: hm.Scene, effect: Effect, at: str, moment: Moment | None = None) -> tuple[dict[str, float], Moment]:
    """What an effect adds to the generalised forces of a scene."""
    bare, changed = scene.network(), scene.with_effect(effect, at=at, name="it").network()
    here = random_moment(bare) if moment is None else moment
    states = {state.name: state.initial for state in changed.states} | dict(here.states)
    old, new = bare.torques(here), changed.torques(dataclasses.replace(here, states=states))
    return {name: float(new[name] - old[name]) for name in old}, here


# -- unbalance -----------------------------------------------------------------------------------------


def test_added_unbalance_runs_up_like_the_eccentricity_of_the_rotor() -> None:
    # 5 N m on 0.01 kg m^2: through the critical speed of 316 rad/s after 0.6 s with full angular acceleration
    known = jeffcott(angle=0.7)
    added = jeffcott(eccentricity=0.0).with_effect(hm.RotorUnbalance(unbalance=MASS * ECCENTRICITY, phase=0.7), at="disc")
    a, b = (hm.simulate(scene, 1.0, solver=STEP) for scene in (known, added))
    assert a["disc.speed"].values[-1] > 1.2 * CRITICAL
    for name in ("disc.x", "disc.y", "disc.angle", "disc.speed"):
        np.testing.assert_allclose(b[name].values, a[name].values, rtol=0.0, atol=1e-9 * np.max(np.abs(a[name].values)))


def test_added_unbalance_and_that_of_the_rotor_add_as_vectors() -> None:
    own, more = cmath.rect(ECCENTRICITY, 0.7), cmath.rect(3e-5, -1.9)
    added = jeffcott(angle=0.7).with_effect(hm.RotorUnbalance(unbalance=MASS * abs(more), phase=cmath.phase(more)), at="disc")
    whole = jeffcott(eccentricity=abs(own + more), angle=cmath.phase(own + more))
    (body,), (expected,) = added.network().rotors, whole.network().rotors
    np.testing.assert_allclose(body.body.centre, expected.body.centre, rtol=1e-12, atol=1e-20)
    np.testing.assert_allclose(body.body.inertia, expected.body.inertia, rtol=1e-12, atol=1e-18)


def test_unbalance_beside_the_rotor_is_that_of_a_small_mass_there() -> None:
    # a point mass of 1 g at radius 30 mm, 50 mm beyond the disc: U = m r, J_xz = -m r l cos(p), J_yz = -m r l sin(p)
    mass, radius, lever, phase = 1e-3, 0.03, 0.05, 0.4
    effect = hm.RotorUnbalance(unbalance=mass * radius, phase=phase, lever=lever)
    (rotor,) = jeffcott(eccentricity=0.0).with_effect(effect, at="disc").network().rotors
    assert rotor.body.static_unbalance == pytest.approx(cmath.rect(mass * radius, phase), rel=1e-12)
    # what the shift of the whole body adds is of second order: m e^2 of no product of inertia in a plane body
    assert rotor.body.product_unbalance == pytest.approx(-cmath.rect(mass * radius * lever, phase), rel=1e-9)


def test_unbalance_at_a_far_end_of_a_rigid_part_makes_a_couple_about_the_node() -> None:
    parts: dict[str, hm.Component] = {
        "drive": hm.DriveTorque(characteristic=constant(0.0)),
        "disc": hm.Rotor(mass=MASS, polar_inertia=POLAR, transverse_inertia=TRANSVERSE),
        "arm": hm.RigidSection(length=0.1),
        "bearing": hm.Bearing(law=support()),
    }
    scene = hm.Scene(name="arm", parts=parts, connections=[("drive", "disc", "arm", "bearing")])
    network = scene.with_effect(hm.RotorUnbalance(unbalance=1e-4), at="bearing").network()
    (rotor,) = network.rotors
    offset = network.positions["bearing"] - network.positions[rotor.name]
    assert abs(offset) == pytest.approx(0.1)
    assert rotor.body.product_unbalance == pytest.approx(-1e-4 * offset, rel=1e-9)


def test_couple_unbalance_is_the_lean_of_the_principal_axis() -> None:
    tilt, at = 2e-4, -1.1
    leaning = jeffcott(eccentricity=0.0, tilt=tilt, tilt_angle=at)
    # the couple is (Jt - Jp) tilt; here Jp > Jt, so its heavy end at +z lies on the other side
    couple = (TRANSVERSE - POLAR) * tilt
    effect = hm.DynamicUnbalance(couple=abs(couple), phase=at + math.pi)
    added = jeffcott(eccentricity=0.0).with_effect(effect, at="disc")
    (a,), (b,) = leaning.network().rotors, added.network().rotors
    # sin(tilt) cos(tilt) = tilt (1 - 2 tilt^2/3): 3e-8
    assert b.body.product_unbalance == pytest.approx(a.body.product_unbalance, rel=1e-7)
    np.testing.assert_allclose(b.body.inertia, a.body.inertia, rtol=0.0, atol=1.1 * abs(couple) * tilt)


def test_couple_unbalance_pushes_the_tilts_by_its_law() -> None:
    couple, phase, speed = 1e-6, 0.9, 300.0
    scene = jeffcott(constant(0.0), eccentricity=0.0)
    with_it = scene.with_effect(hm.DynamicUnbalance(couple=couple, phase=phase), at="disc").network()
    zero = dict.fromkeys((body.name for body in with_it.bodies), 0.0)
    moment = with_it.moment(0.0, zero | {"disc": 0.5}, zero | {"disc": speed}, {})
    found = with_it.accelerations(moment)
    # at rest in tilt and without torque: M_y - i M_x = C w^2 exp(i (f + p)), to first order in C/Jt = 2e-4
    tilting = TRANSVERSE * (found["disc.theta"] - 1j * found["disc.psi"])
    assert tilting == pytest.approx(couple * speed**2 * cmath.exp(1j * (0.5 + phase)), rel=1e-3)


def test_unbalance_acts_at_a_prescribed_spin_too() -> None:
    ramp = hm.IdealSpeedMotor(motion=hm.SpeedRamp(start=0.0, end=400.0, duration=1.0))
    shaken = jeffcott(eccentricity=0.0).with_effect(hm.RotorUnbalance(unbalance=MASS * ECCENTRICITY), at="disc")
    known, added = (scene.replacing({"drive.characteristic": ramp}).network() for scene in (jeffcott(), shaken))
    zero = dict.fromkeys((body.name for body in known.bodies), 0.0)
    for time in (0.2, 0.7):
        a, b = (network.torques(network.moment(time, zero, zero, {})) for network in (known, added))
        assert b["disc.x"] == pytest.approx(a["disc.x"], rel=1e-12)
        assert b["disc.y"] == pytest.approx(a["disc.y"], rel=1e-12)
        assert math.hypot(a["disc.x"], a["disc.y"]) > 1.0


def test_unbalance_of_a_ring_and_an_impossible_couple_are_refused() -> None:
    with pytest.raises(PlaceError, match=r"RotorUnbalance acts on a rotor, but 'left' is none"):
        mid_shaft().with_effect(hm.RotorUnbalance(unbalance=1e-4), at="left").network()
    with pytest.raises(ParameterError, match=r"couple.*at 'disc' gives the rotor a principal moment of inertia of -.* kg m\^2"):
        jeffcott().with_effect(hm.DynamicUnbalance(couple=0.1), at="disc").network()
    with pytest.raises(ParameterError, match=r"RotorUnbalance\.unbalance = -1"):
        hm.RotorUnbalance(unbalance=-1.0)


# -- bow -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("share", [0.3, 0.9, 2.0])
def test_a_bowed_shaft_whirls_as_nicholas_and_gunter_say(share: float) -> None:
    speed, bow, damping = share * MID_CRITICAL, 1e-4, 2e-3
    scene = mid_shaft(damping).replacing({"drive.characteristic": holding(speed, 10.0)})
    scene = scene.with_effect(hm.ShaftBow(amplitude=bow, phase=0.6), at="disc")
    response = hm.simulate(scene, 0.4, solver=hm.Trapezoidal(step=1e-4), initial_speed=speed)
    found = amplitude(response, z_of(response, "disc"), 1.0, "disc", turns=2.0)
    # m z'' + d k z' + k z = k a exp(i (w t + p)); damping d k of the shaft does not turn.  The bearings are 1e3 times
    # stiffer than the shaft and their share of the bow's forces 1e-3 of it; the transient has decayed by exp(-d k t/2 m)
    wanted = bow * cmath.exp(0.6j) / (1.0 - share**2 + 1j * speed * damping)
    assert abs(found - wanted) < 3e-3 * abs(wanted)


def test_the_load_of_a_bow_is_that_of_the_beam_on_pins() -> None:
    bow = 1e-4
    still = {body.name: np.float64(0.0) for body in mid_shaft().network().bodies}
    network = mid_shaft().network()
    moment = network.moment(np.float64(0.0), still, still, {})
    forces, _ = added_forces(mid_shaft(), hm.ShaftBow(amplitude=bow, phase=0.5 * math.pi), "disc", moment)
    # along y at spin angle 0: k a on the disc, half of it back on each bearing, no moments, nothing in x
    assert forces["disc.y"] == pytest.approx(MID_STIFFNESS * bow, rel=1e-9)
    for ring in ("left", "right"):
        assert forces[f"{ring}.y"] == pytest.approx(-0.5 * MID_STIFFNESS * bow, rel=1e-9)
    rest = {name: value for name, value in forces.items() if name not in ("disc.y", "left.y", "right.y")}
    assert max(map(abs, rest.values())) < 1e-9 * MID_STIFFNESS * bow


@pytest.mark.parametrize(
    ("effect", "at"),
    [
        (hm.ShaftBow(amplitude=1e-5, phase=0.3), "rotor_1"),
        (hm.ShaftBow(amplitude=1e-5, phase=0.3), "rotor_2"),
        (hm.ShaftBow(amplitude=1e-5, phase=0.3, shape="sine"), "rotor_1"),
        (hm.ShaftKink(angle=1e-4, phase=-2.0, share=0.7), "section_1"),
        (hm.ShaftKink(angle=1e-4, share=0.0), "section_3"),
    ],
)
def test_the_forces_of_a_bow_are_in_balance(effect: Effect, at: str) -> None:
    scene = rotor_bench.undriven("run_up")
    forces, _ = added_forces(scene, effect, at)
    size = max(abs(value) for value in forces.values())
    place = rotor_bench.POSITIONS
    for force, tilt, sign in (("x", "theta", 1.0), ("y", "psi", -1.0)):
        total = sum(forces[f"{name}.{force}"] for name in place)
        about = sum(z * forces[f"{name}.{force}"] + sign * forces[f"{name}.{tilt}"] for name, z in place.items())
        assert abs(total) < 1e-9 * size
        assert abs(about) < 1e-9 * size


@pytest.mark.parametrize(("shape", "at"), [("load", "rotor_1"), ("load", "rotor_2"), ("sine", "rotor_1")])
def test_a_free_shaft_takes_the_shape_of_its_bow(shape: str, at: str) -> None:
    scene = rotor_bench.undriven("run_up").without("gravity")
    network = scene.network()
    zero = {body.name: np.float64(0.0) for body in network.bodies}
    moment = network.moment(np.float64(0.0), zero, zero, {})
    forces, _ = added_forces(scene, hm.ShaftBow(amplitude=1e-5, shape=shape), at, moment)
    shaft = [element for element in network.matrices if element.name.endswith(".beam")]
    names = list(dict.fromkeys(c for element in shaft for c in element.coordinates if c.rpartition(".")[2] in ("x", "theta")))
    stiffness = np.zeros((len(names), len(names)))
    for element in shaft:
        for i, a in enumerate(element.coordinates):
            for j, b in enumerate(element.coordinates):
                if a in names and b in names:
                    stiffness[names.index(a), names.index(b)] += element.stiffness[i, j]
    free = np.linalg.lstsq(stiffness, np.array([forces[name] for name in names]), rcond=1e-12)[0]
    # a rigid motion is free: take the line through the bearings off
    shift = {name: free[names.index(f"{name}.x")] for name in rotor_bench.POSITIONS}
    z1, z2 = rotor_bench.POSITIONS["bearing_1"], rotor_bench.POSITIONS["bearing_2"]
    lean = (shift["bearing_2"] - shift["bearing_1"]) / (z2 - z1)
    bow = {name: value - shift["bearing_1"] - lean * (rotor_bench.POSITIONS[name] - z1) for name, value in shift.items()}
    assert bow[at] == pytest.approx(1e-5, rel=1e-6)
    if shape == "sine":
        # beyond the bearing straight along the slope -pi/span of sin(pi z/span)
        expected = -math.pi / 0.78 * 0.17 / math.sin(math.pi * 0.42 / 0.78) * 1e-5
        assert bow["rotor_2"] == pytest.approx(expected, rel=1e-6)


def test_a_kink_holds_the_beam_like_a_turned_end() -> None:
    scene, angle = rotor_bench.undriven("run_up"), 1e-4
    network = scene.network()
    zero = {body.name: np.float64(0.0) for body in network.bodies}
    forces, _ = added_forces(scene, hm.ShaftKink(angle=angle, share=1.0), "section_2", network.moment(np.float64(0.0), zero, zero, {}))
    # a beam whose end b is turned by A: 4 E I/L and -6 E I/L^2 there, 2 E I/L and 6 E I/L^2 at the held end
    length = 0.36
    ei = 2.06e11 * math.pi * 0.045**4 / 64.0
    assert forces["bearing_2.theta"] == pytest.approx(4.0 * ei / length * angle, rel=1e-9)
    assert forces["bearing_2.x"] == pytest.approx(-6.0 * ei / length**2 * angle, rel=1e-9)
    assert forces["rotor_1.theta"] == pytest.approx(2.0 * ei / length * angle, rel=1e-9)
    assert forces["rotor_1.x"] == pytest.approx(6.0 * ei / length**2 * angle, rel=1e-9)


def test_a_bow_makes_no_energy() -> None:
    # undamped, free, started off the axis while turning: kinetic plus elastic energy, the bow's part being
    # -q.(K q_0 turned).  The classical Runge-Kutta method loses (w h)^6/72 of a mode per step: bearings of 1e9 N/m on
    # rings of 1 kg at h = 5e-6 have w h = 0.16 and lose what little energy they hold
    bare = mid_shaft(0.0).replacing(
        {f"{side}.law": hm.LinearBearing.isotropic(radial=1e7, damping=0.0, axial=1e6) for side in ("left", "right")}
    )
    scene = bare.with_effect(hm.ShaftBow(amplitude=5e-4, phase=1.0), at="disc", name="bow")
    start = {"disc.x": 3e-4, "disc.y": -2e-4}
    response = hm.simulate(scene, 0.1, solver=hm.RungeKutta4(step=1e-5), initial=start, initial_speed=0.7 * MID_CRITICAL)
    network = scene.network()
    plain = {body.name for body in network.bodies}
    angles = {n: response[f"{n}.angle" if f"{n}.angle" in response.values else n].values for n in plain}
    speeds = {n: response[f"{n}.speed" if f"{n}.angle" in response.values else f"{n}_rate"].values for n in plain}
    moment = network.moment(response.times, angles, speeds, {})
    elastic = sum(element.stored(moment) for element in network.matrices)
    for connection in bare.network().elements:
        if isinstance(connection, Connection) and connection.flanges:
            twist = connection.stretch(moment)
            elastic = elastic + 0.5 * twist * connection.torque(moment, twist, 0.0 * twist)
    bow = [element for element in network.elements if isinstance(element, Excitation)]
    potential = 0.0
    for element in bow:
        values = element.values(moment)
        potential = potential + sum(values[key] * moment.angle(key) for key in values if key != "phi")
    kinetic = network.kinetic_energy(moment)
    total = kinetic + elastic + potential
    exchanged = np.ptp(elastic + potential)
    assert exchanged > 0.1
    assert np.ptp(total) < 1e-5 * exchanged


def test_a_bow_needs_a_shaft_between_bearings() -> None:
    with pytest.raises(PlaceError, match=r"ShaftBow at 'disc' bends a shaft .* there are 0 on it: none"):
        jeffcott().with_effect(hm.ShaftBow(amplitude=1e-5), at="disc").network()
    with pytest.raises(PlaceError, match=r"ShaftBow at 'left': a force there does not bend the shaft"):
        mid_shaft().with_effect(hm.ShaftBow(amplitude=1e-5), at="left").network()
    with pytest.raises(PlaceError, match=r"\"sine\" needs a bearing on both sides of the place"):
        rotor_bench.undriven("run_up").with_effect(hm.ShaftBow(amplitude=1e-5, shape="sine"), at="rotor_2").network()
    with pytest.raises(ParameterError, match=r"ShaftBow\.shape = 'bent': must be one of load, sine"):
        hm.ShaftBow(amplitude=1e-5, shape="bent")
    with pytest.raises(PlaceError, match=r"ShaftKink acts on a piece of shaft that bends, and 'disc' is none\. Such pieces: first, second"):
        mid_shaft().with_effect(hm.ShaftKink(angle=1e-5), at="disc").network()


# -- misalignment, whirl, balls ----------------------------------------------------------------------


def test_misalignment_resonates_at_half_the_critical_speed() -> None:
    damping, force = 200.0, 30.0
    sizes = {}
    for share in (0.35, 0.5, 0.7):
        speed = share * CRITICAL
        scene = damped_disc(damping).with_effect(hm.Misalignment(twice=force, twice_phase=0.8), at="bearing")
        response = hm.simulate(scene, 0.8, solver=hm.RungeKutta4(step=2e-4), initial_speed=speed)
        found = amplitude(response, z_of(response, "disc"), 2.0, "disc", turns=5.0)
        # m z'' + c z' + k z = A exp(i (2 w t + p)); the transient is exp(-c t/2 m) = 4e-18, the fourth-order step leaves 1e-6
        wanted = force * cmath.exp(0.8j) / complex(STIFFNESS - MASS * (2.0 * speed) ** 2, 2.0 * damping * speed)
        assert abs(found - wanted) < 1e-4 * abs(wanted)
        sizes[share] = abs(found)
    assert max(sizes, key=lambda share: sizes[share]) == 0.5


def test_misalignment_draws_the_ellipses_of_its_law() -> None:
    law = hm.Misalignment(once=3.0, once_phase=0.2, twice=2.0, twice_phase=-1.0, thrice=1.0, thrice_phase=2.0, roundness=0.4, direction=0.5)
    f = np.linspace(0.0, 2.0 * np.pi, 65)[:-1]
    x, y = law.force(0.0, f, 100.0, 0.0, 0.0, 0.0, 0.0)
    lines = np.fft.fft((x + 1j * y) * np.exp(-0.5j)) / len(f)
    # A (cos a + i e sin a) = A ((1 + e) exp(i a) + (1 - e) exp(-i a))/2
    for order, size, phase in law.parts:
        assert lines[order] == pytest.approx(0.7 * size * cmath.exp(1j * phase), abs=1e-12)
        assert lines[-order] == pytest.approx(0.3 * size * cmath.exp(-1j * phase), abs=1e-12)
    assert abs(lines[0]) < 1e-12
    same = law.force(0.0, f, 900.0, 0.0, 0.0, 0.0, 0.0)
    np.testing.assert_array_equal(np.array(same), np.array((x, y)))  # no growth with speed


def test_a_loaded_misalignment_grows_with_the_torque_that_the_shafts_carry_away() -> None:
    scene, plain = mid_shaft(), hm.Misalignment(twice=5.0, once=2.0, lever=0.07)
    loaded = hm.LoadedMisalignment(twice=5.0, once=2.0, lever=0.07, growth=0.02)
    turning = scene.network()
    shafts = [item for item in turning.elements if isinstance(item, Connection)]
    for place, ends in (("left", {"first": 1.0}), ("disc", {"first": -1.0, "second": 1.0})):
        base, here = added_forces(scene, plain, place)
        found, _ = added_forces(scene, loaded, place, here)
        carried = sum(ends[item.name] * item.value(here) for item in shafts if item.name in ends)
        assert abs(carried) > 1.0
        for name, value in base.items():
            assert found[name] == pytest.approx((1.0 + 0.02 * abs(carried)) * value, rel=1e-9), name


def test_a_loaded_misalignment_needs_a_shaft() -> None:
    alone = hm.Scene(name="disc", parts={"disc": hm.Rotor(mass=1.0, polar_inertia=0.1, transverse_inertia=0.1)}, connections=[])
    with pytest.raises(PlaceError, match=r"carries away from 'disc', where none ends\. Places where one does: none"):
        alone.with_effect(hm.LoadedMisalignment(twice=1.0, growth=0.1), at="disc").network()


def test_a_lever_makes_the_moments_of_the_same_force_further_along() -> None:
    scene = mid_shaft()
    at_place, moment = added_forces(scene, hm.Misalignment(twice=5.0, once=2.0), "right")
    beyond, _ = added_forces(scene, hm.Misalignment(twice=5.0, once=2.0, lever=0.07), "right", moment)
    assert beyond["right.x"] == at_place["right.x"]
    # by virtual work of x + l theta and y - l psi
    assert beyond["right.theta"] == pytest.approx(0.07 * at_place["right.x"], rel=1e-9)
    assert beyond["right.psi"] == pytest.approx(-0.07 * at_place["right.y"], rel=1e-9)
    assert at_place["right.theta"] == 0.0


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_oil_whirl_turns_with_its_share_of_the_spin(sense: float) -> None:
    speed, damping = 0.8 * CRITICAL * sense, 200.0
    scene = damped_disc(damping).with_effect(hm.OilWhirl(amplitude=10.0, phase=0.3, ratio=0.45), at="bearing")
    response = hm.simulate(scene, 0.9, solver=hm.RungeKutta4(step=2e-4), initial_speed=speed)
    z, angle = z_of(response, "disc")[-500:], response["disc.angle"].values[-500:]
    # the support has no housing: the reaction goes into the ground
    nu = 0.45 * speed
    wanted = 10.0 * np.exp(1j * (0.45 * angle + 0.3)) / complex(STIFFNESS - MASS * nu**2, damping * nu)
    np.testing.assert_allclose(z, wanted, rtol=0.0, atol=1e-4 * np.abs(wanted[0]))


def test_oil_whirl_grows_with_speed_and_sets_in() -> None:
    law = hm.OilWhirl(amplitude=8.0, growth=2.0, reference_speed=400.0, onset=300.0, onset_width=10.0)

    def size(speed: float) -> float:
        return math.hypot(*(float(part) for part in law.force(0.0, 5.0, speed, 0.0, 0.0, 0.0, 0.0)))

    # (1 + tanh(u))/2 = 1 - exp(-2 u), 1/2 and exp(-2 u) away from the onset
    assert size(600.0) == pytest.approx(8.0 * (600.0 / 400.0) ** 2, rel=1e-12)
    assert size(300.0) == pytest.approx(0.5 * 8.0 * 0.75**2, rel=1e-12)
    assert size(250.0) == pytest.approx(8.0 * (250.0 / 400.0) ** 2 * math.exp(-10.0), rel=1e-3)
    assert size(0.0) < 1e-12


def test_a_whirl_that_sets_in_is_one_that_is_always_there_far_above_its_threshold() -> None:
    law, plain = hm.OilWhirlOnset(amplitude=8.0, phase=0.7, onset=300.0, onset_width=10.0), hm.OilWhirl(amplitude=8.0, phase=0.7)
    at = (0.0, 5.0, 600.0, 0.0, 0.0, 0.0, 0.0)
    np.testing.assert_allclose(law.force(*at), plain.force(*at), rtol=1e-12)
    at = (0.0, 5.0, -300.0, 0.0, 0.0, 0.0, 0.0)
    np.testing.assert_allclose(law.force(*at), 0.5 * np.array(plain.force(*at)), rtol=1e-12)
    assert math.hypot(*(float(part) for part in law.force(0.0, 5.0, 250.0, 0.0, 0.0, 0.0, 0.0))) == pytest.approx(
        8.0 * math.exp(-10.0), rel=1e-3
    )


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_whirl_of_varying_share_turns_with_the_share_of_its_speed(sense: float) -> None:
    speed, damping = 0.8 * CRITICAL * sense, 200.0
    law = hm.VaryingOilWhirl(amplitude=10.0, phase=0.3, ratio=0.45, slope=0.06, reference_speed=100.0, onset=50.0, onset_width=10.0)
    response = hm.simulate(damped_disc(damping).with_effect(law, at="bearing"), 0.9, solver=hm.RungeKutta4(step=2e-4), initial_speed=speed)
    times, z = response.times[-500:], z_of(response, "disc")[-500:]
    share = 0.45 + 0.06 * (abs(speed) / 100.0 - 1.0)
    nu = share * speed  # far above the onset: all of the amplitude
    wanted = 10.0 * np.exp(1j * (nu * times + 0.3)) / complex(STIFFNESS - MASS * nu**2, damping * nu)
    np.testing.assert_allclose(z, wanted, rtol=0.0, atol=1e-4 * np.abs(wanted[0]))


def test_the_angle_of_a_whirl_of_varying_share_is_the_integral_over_the_run() -> None:
    # w = b t:  d = s (b^2 t^3/(3 w_0) - b t^2/2)
    law = hm.VaryingOilWhirl(amplitude=0.0, slope=0.03, reference_speed=150.0, onset=50.0)
    scene = jeffcott(constant(3.0), support(damping=100.0), eccentricity=0.0).with_effect(law, at="bearing", name="film")
    response = hm.simulate(scene, 1.0, solver=hm.RungeKutta4(step=1e-3))
    t, speed = response.times, response["disc.speed"].values
    b = float(speed[-1] / t[-1])
    np.testing.assert_allclose(speed, b * t, rtol=1e-9, atol=1e-9)
    wanted = 0.03 * (b**2 * t**3 / (3.0 * 150.0) - 0.5 * b * t**2)
    assert np.max(np.abs(wanted)) > 1.0
    np.testing.assert_allclose(response["film.drift"].values, wanted, rtol=0.0, atol=1e-9 * np.max(np.abs(wanted)))


def test_a_whirl_comes_to_the_size_of_its_limit_cycle() -> None:
    # r' = 0 with c = m tanh((w/w_1 - 1)/m):  r^3 - c r = e; from a small r_0 on, r^2 = c/(1 + (c/r_0^2 - 1) exp(-2 g c t)) for e = 0
    speed, damping = 260.0, 200.0
    law = hm.OilWhirlCycle(amplitude=10.0, phase=0.3, ratio=0.45, onset=200.0, rate=40.0, bound=0.5, seed=1e-3)
    response = hm.simulate(
        damped_disc(damping).with_effect(law, at="bearing", name="film"),
        1.5,
        solver=hm.RungeKutta4(step=2e-4),
        initial_speed=speed,
        initial={"film.size": 0.02},
    )
    c = 0.5 * math.tanh((speed / 200.0 - 1.0) / 0.5)
    last = max(np.roots([1.0, 0.0, -c, -1e-3]).real)
    size, times = response["film.size"].values, response.times
    assert size[-1] == pytest.approx(last, rel=1e-6)
    logistic = np.sqrt(c / (1.0 + (c / 0.02**2 - 1.0) * np.exp(-80.0 * c * times)))
    # e adds e g t to r while it is small, and e/(2 c) to where it ends: e/r_0/c = 0.18 of it in the middle at most
    assert np.max(np.abs(size / logistic - 1.0)) < 1e-3 / (0.02 * c)
    nu = 0.45 * speed
    wanted = last * 10.0 * np.exp(1j * (nu * times[-500:] + 0.3)) / complex(STIFFNESS - MASS * nu**2, damping * nu)
    np.testing.assert_allclose(z_of(response, "disc")[-500:], wanted, rtol=0.0, atol=1e-4 * np.abs(wanted[0]))


def test_a_limit_cycle_follows_a_run_up_as_another_integrator_says() -> None:
    # w = b t; r' = g (r (c - r^2) + e) of the same speed by scipy's Radau
    law = hm.OilWhirlCycle(amplitude=0.0, slope=0.03, reference_speed=150.0, onset=120.0, rate=30.0, bound=0.8, seed=2e-3)
    scene = jeffcott(constant(3.0), support(damping=100.0), eccentricity=0.0).with_effect(law, at="bearing", name="film")
    response = hm.simulate(scene, 1.0, solver=hm.RungeKutta4(step=5e-4))
    b = float(response["disc.speed"].values[-1] / response.times[-1])
    assert b > 240.0

    def rate(t: float, r: np.ndarray) -> np.ndarray:
        return 30.0 * (r * (0.8 * math.tanh((b * t / 120.0 - 1.0) / 0.8) - r**2) + 2e-3)

    wanted = solve_ivp(rate, (0.0, 1.0), [0.0], method="Radau", t_eval=response.times, rtol=1e-10, atol=1e-12).y[0]
    np.testing.assert_allclose(response["film.size"].values, wanted, rtol=0.0, atol=1e-8)
    drift = 0.03 * (b**2 * response.times**3 / (3.0 * 150.0) - 0.5 * b * response.times**2)
    np.testing.assert_allclose(response["film.drift"].values, drift, rtol=0.0, atol=1e-9 * np.max(np.abs(drift)))


def test_a_whirl_whose_share_does_not_vary_is_one_that_sets_in() -> None:
    scene, same = damped_disc(100.0), {"amplitude": 10.0, "phase": 0.3, "ratio": 0.46, "onset": 150.0, "onset_width": 30.0}
    laws = (hm.OilWhirlOnset(**same), hm.VaryingOilWhirl(**same))
    runs = [hm.simulate(scene.with_effect(law, at="bearing"), 0.3, solver=hm.RungeKutta4(step=5e-4), initial_speed=200.0) for law in laws]
    np.testing.assert_allclose(z_of(runs[1], "disc"), z_of(runs[0], "disc"), rtol=0.0, atol=1e-12 * np.max(np.abs(z_of(runs[0], "disc"))))


@pytest.mark.parametrize(
    "effect",
    [
        hm.OilWhirl(amplitude=10.0),
        hm.OilWhirlOnset(amplitude=10.0, onset=200.0),
        hm.VaryingOilWhirl(amplitude=10.0, onset=200.0, slope=0.02),
        hm.BallPass(amplitude=10.0, order=3.57, direction=0.3),
        hm.InnerRacePass(amplitude=10.0, order=5.4, direction=0.3),
        hm.InnerRacePulses(amplitude=10.0, order=5.4, direction=0.3),
    ],
)
def test_what_acts_in_a_bearing_pushes_ring_and_housing_apart(effect: Effect) -> None:
    forces, moment = added_forces(rotor_bench.undriven("run_up"), effect, "bearing_2")
    angle, speed = moment.angle("bearing_2"), moment.speed("bearing_2")
    wanted = effect.force(0.0, angle, speed, 0.0, 0.0, 0.0, 0.0)  # type: ignore[attr-defined]
    for key, value in zip("xy", wanted, strict=True):
        assert forces[f"bearing_2.{key}"] == pytest.approx(float(value), rel=1e-9)
        assert forces[f"bearing_2.housing.{key}"] == pytest.approx(-float(value), rel=1e-9)
    touched = {name for name, value in forces.items() if value != 0.0}
    assert touched == {f"bearing_2{part}.{key}" for part in ("", ".housing") for key in "xy"}


def test_pulses_of_balls_have_falling_harmonics() -> None:
    law = hm.BallPass(amplitude=4.0, phase=0.6, order=3.0, sharpness=0.6)
    f = np.linspace(0.0, 2.0 * np.pi, 513)[:-1]
    lines = np.fft.rfft(law.pulse(f, 100.0)) / len(f) * 2.0
    # sum of A r^(k-1) cos(k (n f + p)); what lies beyond 256 lines, r^85, folds back
    for k in range(1, 6):
        assert lines[3 * k] == pytest.approx(4.0 * 0.6 ** (k - 1) * cmath.exp(1j * k * 0.6), abs=1e-12)
    assert abs(lines[0]) < 1e-12
    others = np.delete(lines, np.arange(0, len(lines), 3))
    assert np.max(np.abs(others)) < 1e-12


def test_three_harmonics_are_those_of_the_pulse() -> None:
    pulse = hm.BallPass(amplitude=4.0, phase=0.6, order=3.57, sharpness=0.02, direction=0.9, growth=1.5)
    # cos(k a) = sin(k n f + k p + pi/2); the fourth harmonic is 0.02^3 of the first
    size = {f"{name}amplitude": 4.0 * 0.02**k for k, name in enumerate(("", "second_", "third_"))}
    phases = {f"{name}phase": k * 0.6 + 0.5 * math.pi for k, name in enumerate(("", "second_", "third_"), start=1)}
    series = hm.BallPassHarmonics(order=3.57, direction=0.9, growth=1.5, **size, **phases)
    f = np.linspace(0.0, 30.0, 100)
    for a, b in zip(pulse.force(0.0, f, 300.0, 0.0, 0.0, 0.0, 0.0), series.force(0.0, f, 300.0, 0.0, 0.0, 0.0, 0.0), strict=True):
        np.testing.assert_allclose(b, a, rtol=0.0, atol=4.0 * 0.02**3 * 1.05)


def test_a_flaw_of_the_outer_race_keeps_its_direction_and_one_of_the_inner_race_turns() -> None:
    f = np.linspace(0.0, 20.0, 200)
    x, y = hm.BallPass(amplitude=4.0, order=3.57, direction=1.0).force(0.0, f, 100.0, 0.0, 0.0, 0.0, 0.0)
    np.testing.assert_allclose(y * math.cos(1.0), x * math.sin(1.0), atol=1e-14)
    inner = hm.InnerRacePass(amplitude=4.0, order=5.4, direction=1.0, load_direction=-1.5)
    x, y = inner.force(0.0, f, 100.0, 0.0, 0.0, 0.0, 0.0)
    np.testing.assert_allclose((x + 1j * y) * np.exp(-1j * (f + 1.0)), inner.pulse(f, 100.0) * 0.5 * (1.0 + np.cos(f + 2.5)), atol=1e-12)


def test_pulses_of_an_inner_race_push_only_and_have_the_harmonics_of_the_other_law() -> None:
    fields = {"amplitude": 4.0, "phase": 0.6, "order": 5.0, "sharpness": 0.6, "growth": 1.5}
    pulses, plain = hm.InnerRacePulses(**fields, mean=4.0 / 1.2), hm.InnerRacePass(**fields)
    f = np.linspace(0.0, 20.0, 4001)
    np.testing.assert_allclose(pulses.pulse(f, 250.0), plain.pulse(f, 250.0) + 4.0 * 0.5**1.5 / 1.2, rtol=1e-12)
    assert np.min(pulses.pulse(f, 250.0)) > 0.0


@pytest.mark.parametrize(("zone", "loaded"), [(0.5, 0.5), (0.25, 1.0 / 3.0), (1.0, 1.0)])
def test_the_loaded_zone_is_as_wide_as_stribeck_says(zone: float, loaded: float) -> None:
    """Loaded where cos(u) > 1 - 2 e: half of the race for e = 1/2, acos(1/2)/pi = 1/3 of it for e = 1/4, all of it for e = 1."""
    law = hm.InnerRacePulses(amplitude=4.0, mean=10.0, order=5.4, load_zone=zone, unloaded=0.0, direction=0.3, load_direction=-1.2)
    f = (np.arange(20000) + 0.5) * np.pi / 1e4
    x, y = law.force(0.0, f, 500.0, 0.0, 0.0, 0.0, 0.0)
    share = (x + 1j * y) * np.exp(-1j * (f + 0.3)) / law.pulse(f, 500.0)
    assert np.mean(np.abs(share) > 0.0) == pytest.approx(loaded, abs=2e-4)
    largest = int(np.argmax(share.real))
    assert math.cos(f[largest] + 0.3 + 1.2) == pytest.approx(1.0, abs=1e-6)
    assert share[largest] == pytest.approx(1.0, abs=1e-5)


# -- from outside ---------------------------------------------------------------------------------------


def test_a_shock_gives_a_housing_its_impulse() -> None:
    law = hm.ExternalShock(amplitude=500.0, start=0.02, length=4e-3, direction=2.0)
    t = np.linspace(0.0, 0.05, 50001)
    x, y = law.force(t, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    # integral of a half sine: 2 A b/pi; the trapezoidal rule leaves (pi dt/b)^2/12 = 5e-8
    assert np.trapezoid(x, t) == pytest.approx(2.0 * 500.0 * 4e-3 / math.pi * math.cos(2.0), rel=1e-6)
    assert np.trapezoid(y, t) == pytest.approx(2.0 * 500.0 * 4e-3 / math.pi * math.sin(2.0), rel=1e-6)
    assert np.all(np.abs(x[(t < 0.02) | (t > 0.0241)]) < 1e-10)
    scene = rotor_bench.undriven("bump", hammer={}).without("gravity").with_effect(law, at="bearing_2", name="knock")
    response = hm.simulate(scene, 0.0204, solver=hm.RungeKutta4(step=2e-5))
    assert not np.any(response["bearing_2.housing.x"].values[response.times < 0.0199])
    housing = z_of(response, "bearing_2.housing")[-1]
    # the foundations differ by 0.9e7 N/m on 9 kg: after 0.4 ms x and y differ by (0.9e7/9) t^2/20 = 0.8 %
    assert cmath.phase(housing) == pytest.approx(2.0, abs=0.01)


def test_the_ground_shakes_a_housing_at_its_own_frequency() -> None:
    # a force at two fifths of the frequency of a housing on its foundation, everything else hanging on it: against the
    # linear response of the whole line, (K - f^2 M + i f D) q = F
    frequency, force = 300.0, 20.0
    scene = rotor_bench.undriven("run_up").without("gravity")
    shaken = scene.with_effect(hm.GroundVibration(amplitude=force, frequency=frequency, phase=0.5, direction=0.4), at="bearing_1")
    system = LineMatrices(scene.network()).at(*({body.name: 0.0 for body in scene.network().bodies} for _ in "qv"))
    load = np.zeros(len(system.names), complex)
    for key, part in (("x", math.cos(0.4)), ("y", math.sin(0.4))):
        load[system.names.index(f"bearing_1.housing.{key}")] = force * part * cmath.exp(1j * (0.5 - 0.5 * math.pi))
    lateral = [k for k, name in enumerate(system.names) if name not in rotor_bench.POSITIONS]
    at = np.ix_(lateral, lateral)
    dynamic = system.stiffness - frequency**2 * system.mass + 1j * frequency * system.damping
    q = dict(zip((system.names[k] for k in lateral), np.linalg.solve(dynamic[at], load[lateral]), strict=True))
    start = {name: value.real for name, value in q.items()} | {f"{name}_rate": (1j * frequency * value).real for name, value in q.items()}
    response = hm.simulate(shaken, 0.05, solver=hm.RungeKutta4(step=5e-5), initial=start)
    for place in ("bearing_1.housing.x", "bearing_1.housing.y", "rotor_1.x", "rotor_2.y"):
        wanted = (q[place] * np.exp(1j * frequency * response.times)).real
        np.testing.assert_allclose(response[place].values, wanted, rtol=0.0, atol=1e-5 * abs(q[place]))


def test_what_acts_on_a_support_needs_a_housing() -> None:
    with pytest.raises(PlaceError, match=r"GroundVibration acts on a bearing with a housing, and 'left' is none"):
        mid_shaft().with_effect(hm.GroundVibration(amplitude=1.0, frequency=100.0), at="left").network()
    with pytest.raises(PlaceError, match=r"OilWhirl acts on a bearing, and 'disc' is none\. Bearings: left, right"):
        mid_shaft().with_effect(hm.OilWhirl(amplitude=1.0), at="disc").network()


# -- all excitations -----------------------------------------------------------------------------------


EXCITATIONS: Mapping[str, tuple[Effect, str]] = {
    type(effect).__name__: (effect, at)
    for effect, at in (
        (hm.ShaftBow(amplitude=1e-4), "rotor_1"),
        (hm.ShaftKink(angle=1e-3), "section_2"),
        (hm.Misalignment(once=50.0, twice=100.0, thrice=20.0, lever=0.05), "bearing_1"),
        (hm.OilWhirl(amplitude=100.0, growth=1.5, onset=200.0), "bearing_1"),
        (hm.OilWhirlOnset(amplitude=100.0, onset=100.0), "bearing_1"),
        (hm.OilWhirlCycle(amplitude=100.0, onset=100.0, slope=0.02), "bearing_1"),
        (hm.VaryingOilWhirl(amplitude=100.0, onset=100.0, slope=0.02), "bearing_1"),
        (hm.BallPass(amplitude=50.0, order=3.57, growth=1.5), "bearing_2"),
        (hm.InnerRacePass(amplitude=50.0, order=5.43), "bearing_2"),
        (hm.InnerRacePulses(amplitude=50.0, order=5.43), "bearing_2"),
        (hm.ExternalShock(amplitude=500.0, start=0.0), "bearing_2"),
        (hm.GroundVibration(amplitude=50.0, frequency=300.0, phase=1.0), "bearing_2"),
    )
}


@pytest.mark.parametrize("name", EXCITATIONS)
def test_an_excitation_leaves_static_deflection_and_whirl_alone(name: str) -> None:
    effect, at = EXCITATIONS[name]
    scene = rotor_bench.undriven("run_up")
    shaken = scene.with_effect(effect, at=at)
    a, b = rotor_point(scene, 400.0), rotor_point(shaken, 400.0)
    assert a.angles == b.angles
    lines = [LineMatrices(item.network()).at(point.angles, point.speeds) for item, point in ((scene, a), (shaken, b))]
    np.testing.assert_array_equal(lines[0].stiffness, lines[1].stiffness)
    np.testing.assert_array_equal(lines[0].damping, lines[1].damping)


@pytest.mark.parametrize("name", EXCITATIONS)
def test_an_excitation_runs_without_a_python_callback(name: str) -> None:
    effect, at = EXCITATIONS[name]
    for bearing in (
        {},
        {"bearing_1.law": hm.PowerBearing(stiffness_xx=1e7, stiffness_yy=1e7, power_stiffness_xx=1e17, power_stiffness_yy=1e17)},
    ):
        scene = rotor_bench.undriven("run_up").replacing(bearing).with_effect(effect, at=at)
        with warnings.catch_warnings():
            warnings.simplefilter("error", LoweringWarning)
            lowered = assemble(scene.network()).lowered
        assert {item.how for item in lowered} <= {"native", "symbolic"}


def test_every_place_that_a_rotor_effect_lists_takes_it() -> None:
    scene = two_rotor_line.build()
    network = scene.network()
    effects = [*(effect for effect, _ in EXCITATIONS.values()), hm.RotorUnbalance(unbalance=1e-5), hm.DynamicUnbalance(couple=1e-6)]
    for effect in effects:
        places = type(effect).places(network)
        assert len(places) == len(set(places)) > 0
        for place in places:
            assert len(scene.with_effect(effect, at=place).network().elements) >= len(network.elements)


# -- ripple of the motor -------------------------------------------------------------------------------


def test_ripple_of_a_sampled_controller_is_not_in_its_command() -> None:
    # torque of the held controller times (1 + c sin(n f + p)) on the drive end, c and p of the ripple
    scene = rotor_bench.build("run_up")
    ripple = hm.TorqueRipple(amplitude=0.5, relative=0.2, order=6.0, phase=0.4)
    forces, moment = added_forces(scene, ripple, "drive")
    command = float(next(c for c in scene.network().channels if c.name == "drive.torque").read(moment))
    wanted = (0.5 + 0.2 * command) * math.sin(6.0 * moment.angle("bearing_1") + 0.4)
    assert command != 0.0
    # a difference of two sums of torques: rounding of the largest one, a few times
    largest = max(abs(float(element.contribution(moment).get("bearing_1", 0.0))) for element in scene.network().elements)
    assert forces["bearing_1"] == pytest.approx(wanted, abs=8.0 * np.finfo(float).eps * largest)
    assert {name for name, value in forces.items() if value != 0.0} == {"bearing_1"}
    with_it = scene.with_effect(ripple, at="drive").network()
    assert float(next(c for c in with_it.channels if c.name == "drive.torque").read(moment)) == command


# -- probes --------------------------------------------------------------------------------------------


def probed(effect: Effect, at: str) -> hm.Scene:
    scene = jeffcott(
        holding(200.0, 1.0), parts={"probe_x": hm.Sensor(quantity="disc.x"), "probe_y": hm.Sensor(quantity="disc.y", gain=-2.0)}
    )
    return scene.with_effect(effect, at=at, name="fault")


def test_runout_adds_the_surface_to_both_probes_and_moves_nothing() -> None:
    effect = hm.ProbeRunout(once=2e-6, once_phase=0.3, twice=1e-6, twice_phase=-1.0, thrice=5e-7)
    bare = hm.simulate(jeffcott(holding(200.0, 1.0)), 0.1, solver=STEP, initial_speed=200.0)
    response = hm.simulate(probed(effect, "disc"), 0.1, solver=STEP, initial_speed=200.0)
    np.testing.assert_array_equal(response["disc.x"].values, bare["disc.x"].values)
    f = response["disc.angle"].values

    def surface(a: np.ndarray) -> np.ndarray:
        return 2e-6 * np.cos(a + 0.3) + 1e-6 * np.cos(2.0 * a - 1.0) + 5e-7 * np.cos(3.0 * a)

    np.testing.assert_allclose(response["probe_x"].values, bare["disc.x"].values + surface(f), rtol=0.0, atol=1e-18)
    # a quarter of a turn later, and through the gain of the sensor
    wanted = -2.0 * (bare["disc.y"].values + surface(f - 0.5 * np.pi))
    np.testing.assert_allclose(response["probe_y"].values, wanted, rtol=0.0, atol=1e-18)
    np.testing.assert_array_equal(response["probe_x.true"].values, bare["disc.x"].values)


def test_an_eccentric_surface_looks_like_a_shift_of_the_centre() -> None:
    # the centre of a round surface e off the axis goes e (cos(f + p), sin(f + p)): what order 1 must read
    law = hm.ProbeRunout(once=3e-6, once_phase=0.7)
    f = np.linspace(0.0, 7.0, 50)
    seen = law.runout(f) + 1j * law.runout(f - 0.5 * np.pi)
    np.testing.assert_allclose(seen, 3e-6 * np.exp(1j * (f + 0.7)), rtol=1e-12)


def test_gain_and_cross_talk_of_a_probe() -> None:
    moment = random_moment(jeffcott().network())
    x, y = float(moment.angle("disc.x")), float(moment.angle("disc.y"))

    def reading(effect: Effect, at: str) -> float:
        network = probed(effect, at).network()
        return float(next(channel for channel in network.channels if channel.name == at).read(moment))

    assert reading(hm.ProbeGain(error=0.05), "probe_x") == pytest.approx(1.05 * x, rel=1e-12)
    assert reading(hm.ProbeGain(error=0.05, curvature=100.0), "probe_x") == pytest.approx((1.05 + 100.0 * x) * x, rel=1e-12)
    assert reading(hm.SensorGain(error=0.05), "probe_y") == pytest.approx(-2.0 * 1.05 * y, rel=1e-12)
    assert reading(hm.ProbeCrossTalk(share=0.1), "probe_x") == pytest.approx(x + 0.1 * y, rel=1e-12)
    assert reading(hm.ProbeCrossTalk(share=0.1), "probe_y") == pytest.approx(-2.0 * (y + 0.1 * x), rel=1e-12)
    drift = hm.SensorDrift(offset=1e-5, time_constant=0.3)
    assert reading(drift, "probe_x") == pytest.approx(x + 1e-5 * (1.0 - math.exp(-float(moment.time) / 0.3)), rel=1e-12)


def test_probe_faults_need_a_probe() -> None:
    scene = probed(hm.SensorGain(error=0.1), "probe_x")
    with pytest.raises(
        PlaceError,
        match=r"ProbeRunout at 'bearing' needs a Sensor that reads bearing\.x or bearing\.y, or a Probe there\. Places with one: disc",
    ):
        scene.with_effect(hm.ProbeRunout(once=1e-6), at="bearing").network()
    encoder = jeffcott(parts={"encoder": hm.Sensor(quantity="disc.angle")})
    with pytest.raises(PlaceError, match=r"ProbeCrossTalk needs a sensor that reads the displacement .* 'encoder' reads 'disc\.angle'"):
        encoder.with_effect(hm.ProbeCrossTalk(share=0.1), at="encoder").network()
    assert hm.ProbeGain.places(encoder.network()) == ()
    assert hm.ProbeRunout.places(scene.network()) == ("disc",)
    assert hm.ProbeGain.places(scene.network()) == ("probe_x", "probe_y")


# -- an effect of a user's own ----------------------------------------------------------------------------


@dataclasses.dataclass(frozen=True, kw_only=True)
class RubbingBrush(hm.LateralEffect):
    """A brush on a shaft: it drags across the axis and brakes the spin."""

    drag: float = hm.parameter("N s/m", "drag", low=0.0, typical=(1.0, 100.0))
    brake: float = hm.parameter("N m s/rad", "brake", low=0.0, typical=(1e-3, 1.0))
    dissipative = True

    def force(self, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> tuple[Value, Value]:
        return -self.drag * x_rate, -self.drag * y_rate

    def torque(self, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> Value | None:
        return -self.brake * speed


def test_an_effect_of_a_users_own_may_push_and_brake() -> None:
    forces, moment = added_forces(mid_shaft(), RubbingBrush(drag=30.0, brake=0.2), "disc")
    assert forces["disc.x"] == pytest.approx(-30.0 * float(moment.speed("disc.x")), rel=1e-9)
    assert forces["disc"] == pytest.approx(-0.2 * float(moment.speed("disc")), rel=1e-9)
    element = next(
        e for e in mid_shaft().with_effect(RubbingBrush(drag=1.0, brake=1.0), at="disc", name="it").network().elements if e.name == "it"
    )
    assert isinstance(element, Coupling)
    assert not isinstance(element, Excitation)  # it damps, so whirl has to know it
