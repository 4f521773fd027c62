"""Laws of the drive effects against closed forms, statics, and scenes in which the effect is built from parts."""

from __future__ import annotations

import math

import numpy as np
import pytest
import scipy.linalg
import scipy.optimize
import scipy.special
from scipy.integrate import solve_ivp

import hdrive_mbs as hm
from hdrive_mbs.effects.dead_zone import contact_share, dead_zone
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.errors import ParameterError, PlaceError
from hdrive_mbs.expression import Value, gradient
from hdrive_mbs.network.network import Network
from models import drive_bench, rotor_bench

TIGHT = hm.DormandPrince(relative_tolerance=1e-10, absolute_tolerance=1e-12, max_step=1e-3)


def wheel(inertia: float = 0.2, torque: object = 0.0) -> hm.Scene:
    """One inertia, driven by a motor with a torque law."""
    law = torque if callable(torque) else lambda time, speed: torque + 0.0 * time
    return hm.Scene(name="wheel", parts={"wheel": hm.Motor(inertia=inertia, characteristic=law)}, connections=[])


def spring_to_ground(stiffness: float = 1e3, damping: float = 0.0, inertia: float = 0.1) -> hm.Scene:
    """A disc on a shaft whose other end is held."""
    parts = {"disc": hm.Inertia(inertia=inertia), "shaft": hm.Shaft(stiffness=stiffness, damping=damping)}
    return hm.Scene(name="spring", parts=parts, connections=[("disc", "shaft", "ground")])


def drive(stiffness: object = lambda twist: 1e4 * twist, *, damping: float = 0.0, motor: object = lambda speed: 0.0 * speed) -> hm.Scene:
    """Motor, gear 50:1, load: no shafts, no losses."""
    parts = {
        "motor": hm.Motor(inertia=1e-3, characteristic=motor),
        "gear": hm.HarmonicDrive(ratio=50.0, stiffness=stiffness, damping=damping),
        "load": hm.Inertia(inertia=0.5),
    }
    return hm.Scene(name="drive", parts=parts, connections=[("motor", "gear", "load")])


# -- friction and hysteresis ---------------------------------------------------------------------------


@pytest.mark.parametrize("exponent", [0.5, 1.0, 2.0])
def test_dahl_friction_builds_up_as_its_equation_integrates(exponent: float) -> None:
    law = hm.DahlFriction(coulomb=5.0, presliding=2e-3, exponent=exponent)
    path = np.linspace(0.0, 3e-3, 40)
    turned = solve_ivp(
        lambda t, y: [law.state_rate("z", t, 0.0, 1.0, {"z": y[0]})], (0.0, path[-1]), [0.0], t_eval=path, rtol=1e-10, atol=1e-12
    ).y[0]
    # du/ds = (1 - u)^n with s = angle/x_p:  1 - exp(-s) for n = 1, else  1 - (1 + (n - 1) s)^(1/(1 - n)), full at s = 1/(1 - n) if n < 1
    s = path / 2e-3
    n = exponent
    expected = 1.0 - np.exp(-s) if n == 1.0 else 1.0 - np.maximum(1.0 + (n - 1.0) * s, 0.0) ** (1.0 / (1.0 - n))
    np.testing.assert_allclose(turned, expected, atol=1e-6)


def test_dahl_friction_slides_at_its_torque_and_turns_over_after_a_reversal() -> None:
    response = hm.simulate(
        wheel(1e3).with_effect(hm.DahlFriction(coulomb=5.0, presliding=1e-3), at="wheel", name="it"), 0.1, solver=TIGHT, initial_speed=1.0
    )
    # 100 presliding angles; the heavy wheel goes on turning
    assert response["it.torque"].values[-1] == pytest.approx(-5.0, rel=1e-9)
    back = hm.simulate(
        wheel(1e3).with_effect(hm.DahlFriction(coulomb=5.0, presliding=1e-3), at="wheel", name="it"),
        0.1,
        solver=TIGHT,
        initial={"wheel.speed": -1.0, "it.z": 1.0},
    )
    # dz/ds = -(1 + z) from z = 1 on
    turned = -back["wheel.angle"].values / 1e-3
    np.testing.assert_allclose(back["it.z"].values, 2.0 * np.exp(-turned) - 1.0, atol=1e-6)


def test_iwan_hysteresis_follows_its_parabola_and_slips_at_its_limit() -> None:
    law = hm.IwanHysteresis(torque_limit=8.0, slip_twist=1e-3, rounding=0.0)
    path = np.arange(0, 1025) / 1024.0  # of the slip twist; powers of two reach every limit exactly
    state, torque = dict.fromkeys(law.states(), 0.0), [0.0]
    for step in np.diff(path) * 1e-3:
        rates = {name: law.state_rate(name, 0.0, 0.0, step, state) for name in state}
        state = {name: state[name] + float(rates[name]) for name in state}
        torque.append(float(law.torque(0.0, 0.0, step, state)))
    # straight pieces around the parabola: the corners at s = 1/8, 3/8, 5/8, 7/8 lie 1/64 above it
    away = np.array(torque) / 8.0 - (2.0 * path - path**2)
    assert away.min() + 1e-12 >= 0.0
    assert away.max() == pytest.approx(1.0 / 64.0, rel=1e-6)
    np.testing.assert_allclose(np.array(torque)[path >= 0.875], 8.0, rtol=1e-12)


# -- changed laws -----------------------------------------------------------------------------------------


def straight_law(twist: Value, rate: Value) -> Value:
    return 200.0 * twist + 0.5 * rate


def test_asymmetry_scales_the_elastic_torque_and_leaves_the_damping() -> None:
    torque = hm.StiffnessAsymmetry(asymmetry=0.3, smoothing_twist=1e-5).changed(straight_law)
    # tanh(100) = 1
    assert torque(1e-3, 0.0) == pytest.approx(0.2 * 1.3, rel=1e-12)
    assert torque(-1e-3, 0.0) == pytest.approx(-0.2 * 0.7, rel=1e-12)
    for twist in (-1e-3, 0.0, 1e-6, 1e-3):
        assert torque(twist, 4.0) - torque(twist, 0.0) == pytest.approx(2.0, rel=1e-12)


@pytest.mark.parametrize("asymmetry", [-0.8, 0.8])
def test_the_largest_asymmetry_still_lets_a_law_rise(asymmetry: float) -> None:
    torque = hm.StiffnessAsymmetry(asymmetry=asymmetry, smoothing_twist=1e-5).changed(straight_law)
    slope = gradient(lambda twist: torque(twist, 0.0))(np.linspace(-1e-4, 1e-4, 4001))
    # 1 + a (tanh u + u sech^2 u), whose bracket is at most 1.1997 (at u = 1.2)
    assert slope.min() > 0.0
    assert slope.min() == pytest.approx(200.0 * (1.0 - 0.8 * 1.19968), rel=1e-3)


def test_an_asymmetric_spring_swings_with_two_half_periods_and_keeps_its_energy() -> None:
    scene = spring_to_ground().with_effect(hm.StiffnessAsymmetry(asymmetry=0.4, smoothing_twist=1e-7), at="shaft")
    response = hm.simulate(scene, 0.3, solver=TIGHT, initial={"disc.speed": 1.0})
    # half periods pi sqrt(J/k) with k (1 + a) and k (1 - a)
    period = math.pi * math.sqrt(0.1 / 1e3) * (1.0 / math.sqrt(1.4) + 1.0 / math.sqrt(0.6))
    angle = response["disc.angle"]
    rising = [t for t, before, after in zip(response.times[1:], angle.values[:-1], angle.values[1:], strict=True) if before < 0.0 <= after]
    assert np.diff(rising) == pytest.approx(period, abs=2e-3)
    assert rising[-1] / len(rising) == pytest.approx(period, rel=1e-2)
    assert np.max(np.abs(response["disc.speed"].values)) == pytest.approx(1.0, rel=1e-6)


def test_a_rounded_dead_zone_lies_within_half_its_rounding_of_the_sharp_one() -> None:
    twist = np.linspace(-0.03, 0.03, 6001)
    sharp, smooth = dead_zone(twist, 0.02, 0.0), dead_zone(twist, 0.02, 1e-3)
    np.testing.assert_allclose(sharp, np.sign(twist) * np.maximum(np.abs(twist) - 0.01, 0.0), atol=1e-17)
    # at an edge the sharp zone is 0 and the rounded one (e + h' - h')/2 = e/2 to the order of e^2/b
    assert np.max(np.abs(smooth - sharp)) == pytest.approx(0.5e-3, rel=0.05)
    np.testing.assert_allclose(smooth, -smooth[::-1], atol=1e-17)


@pytest.mark.parametrize("rounding", [0.0, 1e-3])
def test_the_share_of_contact_is_the_slope_of_the_dead_zone(rounding: float) -> None:
    twist = np.array([-0.02, -0.0101, -0.004, 0.0, 0.003, 0.0099, 0.012, 0.03])
    slope = gradient(lambda x: dead_zone(x, 0.02, rounding))(twist) + 0.0 * twist
    np.testing.assert_allclose(contact_share(twist, 0.02, rounding), slope, atol=1e-12)


def test_lost_motion_takes_the_torque_and_leaves_the_damping_in_its_gap() -> None:
    torque = hm.LostMotion(width=0.02).changed(straight_law)
    assert torque(0.009, 3.0) == pytest.approx(1.5)
    assert torque(0.012, 3.0) == pytest.approx(0.4 + 1.5)
    assert torque(-0.012, 3.0) == pytest.approx(-0.4 + 1.5)


def test_lost_motion_adds_to_that_of_the_gear() -> None:
    law = hm.PiecewiseLinearStiffness(lost_motion=3e-4, stiffness_1=3e4, stiffness_2=6e4, stiffness_3=1e5, torque_1=20.0, torque_2=90.0)
    wider = law.replacing(lost_motion=5e-4)
    twists = np.linspace(-4e-3, 4e-3, 201)
    changed = drive(law).with_effect(hm.LostMotion(width=2e-4), at="gear").network().connection("gear")
    plain = drive(wider).network().connection("gear")
    moment = drive().network().moment(0.0, {}, {}, {})
    np.testing.assert_allclose(changed.torque(moment, twists, 0.0), plain.torque(moment, twists, 0.0), atol=1e-9)


@pytest.mark.parametrize("effect", [hm.LostMotion(width=2e-4, film=6e-5), hm.FilmBacklash(backlash=2e-4, film=6e-5)])
def test_a_film_rounds_the_edges_of_the_whole_gap_of_a_gear(effect: hm.LawEffect) -> None:
    law = hm.PiecewiseLinearStiffness(lost_motion=3e-4, stiffness_1=3e4, stiffness_2=6e4, stiffness_3=1e5, torque_1=20.0, torque_2=90.0)
    changed = drive(law).with_effect(effect, at="gear").network().connection("gear")
    moment = drive().network().moment(0.0, {}, {}, {})
    twists = np.linspace(-4e-3, 4e-3, 201)
    inside = dead_zone(twists, 5e-4, 6e-5)  # of the law without a gap
    np.testing.assert_allclose(changed.torque(moment, twists, 0.0), law.replacing(lost_motion=0.0).torque(inside), atol=1e-9)


@pytest.mark.parametrize("film", [0.0, 6e-5])
def test_lost_motion_leaves_the_damping_of_a_gear_out_of_its_whole_gap_where_the_gear_does(film: float) -> None:
    law = hm.PiecewiseLinearStiffness(lost_motion=3e-4, stiffness_1=3e4, stiffness_2=6e4, stiffness_3=1e5, torque_1=20.0, torque_2=90.0)
    moment = drive().network().moment(0.0, {}, {}, {})
    twists = np.array([-3e-4, -2.4e-4, 0.0, 1e-4, 2.4e-4, 2.6e-4, 1e-3])  # the whole gap ends at 2.5e-4 rad
    for inside, expected in ((False, [4.0, 0.0, 0.0, 0.0, 0.0, 4.0, 4.0]), (True, [4.0] * 7)):
        gear = drive(law).replacing({"gear.damping": 2.0, "gear.damping_in_gap": inside})
        connection = gear.with_effect(hm.LostMotion(width=2e-4, film=film), at="gear").network().connection("gear")
        damping = connection.torque(moment, twists, 2.0) - connection.torque(moment, twists, 0.0)
        np.testing.assert_allclose(damping, expected, atol=1e-12)


def test_film_backlash_damps_by_the_film_inside_and_by_the_law_in_contact() -> None:
    torque = hm.FilmBacklash(backlash=0.02, film=1e-5, film_damping=0.1).changed(straight_law)
    # e/h = 1e-3: what is left of the other part is (e/h)^2/2
    assert torque(0.0, 3.0) == pytest.approx(0.3, abs=1e-5)
    assert torque(0.05, 3.0) == pytest.approx(200.0 * 0.04 + 1.5, abs=1e-5)
    assert torque(-0.05, 3.0) == pytest.approx(-200.0 * 0.04 + 1.5, abs=1e-5)
    # at the edge itself half of both
    assert torque(0.01, 3.0) - torque(0.01, 0.0) == pytest.approx(0.5 * 0.3 + 0.5 * 1.5, rel=1e-3)


def test_a_soft_windup_has_no_torque_in_the_gap_and_lags_by_its_soft_twist_far_beyond() -> None:
    torque = hm.SoftWindup(width=0.02, soft_twist=1e-3).changed(straight_law)
    assert torque(0.01, 3.0) == pytest.approx(1.5)
    # sqrt(4^2 + 1) - 1 of a thousandth
    assert torque(0.014, 0.0) == pytest.approx(200.0 * 1e-3 * (math.sqrt(17.0) - 1.0))
    assert torque(-0.014, 0.0) == pytest.approx(-200.0 * 1e-3 * (math.sqrt(17.0) - 1.0))
    # e^2/(2 d) is left of the lag e at d beyond the edge
    assert torque(0.11, 0.0) == pytest.approx(200.0 * (0.1 - 1e-3 + 1e-6 / 0.2), rel=1e-6)


def test_a_soft_windup_goes_in_front_of_the_whole_gap_of_a_gear() -> None:
    law = hm.PiecewiseLinearStiffness(lost_motion=3e-4, stiffness_1=3e4, stiffness_2=6e4, stiffness_3=1e5, torque_1=20.0, torque_2=90.0)
    changed = drive(law).with_effect(hm.SoftWindup(width=2e-4, soft_twist=6e-5), at="gear").network().connection("gear")
    moment = drive().network().moment(0.0, {}, {}, {})
    twists = np.linspace(-4e-3, 4e-3, 201)
    past = np.sign(twists) * np.maximum(np.abs(twists) - 2.5e-4, 0.0)
    wound = np.sign(past) * (np.hypot(past, 6e-5) - 6e-5)
    np.testing.assert_allclose(changed.torque(moment, twists, 0.0), law.replacing(lost_motion=0.0).torque(wound), atol=1e-9)


@pytest.mark.parametrize(
    "effect",
    [hm.LostMotion(width=0.0, film=1e-3), hm.FilmBacklash(backlash=0.0, film=1e-3), hm.SoftWindup(width=0.0, soft_twist=1e-3)],
)
def test_a_gap_of_zero_is_the_law_itself(effect: hm.LawEffect) -> None:
    assert effect.changed(straight_law) is straight_law


@pytest.mark.parametrize(
    "effect",
    [
        hm.LostMotion(width=0.01, film=1e-3),
        hm.FilmBacklash(backlash=0.01, film=1e-3),
        hm.SoftWindup(width=0.01, soft_twist=1e-3),
        hm.StiffnessAsymmetry(asymmetry=0.5),
        hm.OneSidedStiffness(change=0.5, onset_twist=5e-3),
    ],
)
def test_changed_laws_make_no_energy_without_damping(effect: Effect) -> None:
    response = hm.simulate(spring_to_ground().with_effect(effect, at="shaft"), 0.3, solver=TIGHT, initial={"disc.speed": 2.0})
    balance = hm.energy_balance(response)
    np.testing.assert_allclose(balance.total, balance.total[0], rtol=1e-6)
    assert np.ptp(balance.kinetic) > 0.9 * balance.total[0]


# -- stiffness over the angle ------------------------------------------------------------------------------


def energy_over(scene: hm.Scene, effect: hm.StiffnessVariation, potential: object) -> np.ndarray:
    """Kinetic energy and (1 + r) U of a free train [J]."""
    response = hm.simulate(
        scene.with_effect(effect, at="gear", name="it"), 0.2, solver=TIGHT, initial={"motor.speed": 40.0, "load.speed": 0.4}
    )
    kinetic = 0.5 * 1e-3 * response["motor.speed"].values ** 2 + 0.5 * 0.5 * response["load.speed"].values ** 2
    return kinetic + (1.0 + response["it.share"].values) * potential(response["gear.twist"].values)


@pytest.mark.parametrize("follows", ["wave_generator", "flexspline"])
def test_a_stiffness_that_varies_with_the_angle_makes_no_energy(follows: str) -> None:
    effect = hm.StiffnessVariation(variation=0.5, order=2.0 if follows == "wave_generator" else 100.0, phase=0.3, follows=follows)
    for law, potential in (
        (lambda twist: 1e4 * twist, lambda x: 0.5e4 * x**2),
        (lambda twist: 1e4 * twist + 1e9 * twist**3, lambda x: 0.5e4 * x**2 + 0.25e9 * x**4),
    ):
        total = energy_over(drive(law), effect, potential)
        np.testing.assert_allclose(total, total[0], rtol=1e-8)


def test_torques_of_a_varying_stiffness_are_the_slopes_of_its_potential() -> None:
    network = drive().with_effect(hm.StiffnessVariation(variation=0.4, order=3.0, phase=0.3), at="gear").network()

    def potential(motor: float, load: float) -> float:
        # forward angles; the wave generator is the motor:  twist = motor/50 - load
        return (1.0 + 0.4 * math.sin(3.0 * motor + 0.3)) * 0.5e4 * (motor / 50.0 - load) ** 2

    motor, load, step = 0.8, -0.03, 1e-5
    torques = network.torques(network.moment(0.0, {"motor": motor, "load": load}, {"motor": 0.0, "load": 0.0}, {}))
    # central differences: error of the order of step^2 * 27 of the torque
    on_motor = -(potential(motor + step, load) - potential(motor - step, load)) / (2.0 * step)
    on_load = -(potential(motor, load + step) - potential(motor, load - step)) / (2.0 * step)
    assert torques["motor"] == pytest.approx(on_motor, rel=1e-7)
    assert torques["load"] == pytest.approx(on_load, rel=1e-7)
    ideal = -torques["load"] / 50.0
    assert abs(torques["motor"] - ideal) > 0.1 * abs(ideal)


def test_a_stiffness_that_varies_keeps_its_reaction_with_lost_motion_and_asymmetry() -> None:
    # whatever changes the law later, the reaction is that of the whole potential: energy of a run without losses stays
    scene = drive().with_effect(hm.StiffnessVariation(variation=0.3), at="gear", name="it")
    scene = scene.with_effect(hm.LostMotion(width=1e-3, film=1e-3), at="gear")
    response = hm.simulate(scene, 0.2, solver=TIGHT, initial={"motor.speed": 40.0, "load.speed": 0.4})
    kinetic = 0.5 * 1e-3 * response["motor.speed"].values ** 2 + 0.5 * 0.5 * response["load.speed"].values ** 2
    inside = dead_zone(response["gear.twist"].values, 1e-3, 1e-3)
    grid = np.linspace(-0.05, 0.05, 200001)
    torque = 1e4 * dead_zone(grid, 1e-3, 1e-3)
    area = np.concatenate([[0.0], np.cumsum(0.5 * (torque[1:] + torque[:-1]) * np.diff(grid))])
    potential = np.interp(response["gear.twist"].values, grid, area - np.interp(0.0, grid, area))
    total = kinetic + (1.0 + response["it.share"].values) * potential
    assert np.max(np.abs(inside)) > 1e-3
    # four Gauss points on a rounded corner: the reaction is good to a per cent of itself
    np.testing.assert_allclose(total, total[0], rtol=1e-3)


@pytest.mark.parametrize("gap", [0.0, 4e-4])
def test_a_stiffness_beside_the_law_varies_by_as_much_at_each_torque_and_makes_no_energy(gap: float) -> None:
    """Of a law that hardens, with a gap of its own; potential  T's + A sin(n a + p) k d^2/2."""
    law = hm.PiecewiseLinearStiffness(lost_motion=gap, stiffness_1=1e4, stiffness_2=2e4, stiffness_3=3e4, torque_1=5.0, torque_2=15.0)
    effect = hm.ParallelStiffnessVariation(variation=0.5, order=2.0, phase=0.3)
    scene = drive(law).with_effect(effect, at="gear", name="it")
    network, plain = scene.network(), drive(law).network()

    def on_load(of: Network, motor: float, load: float) -> float:
        torques = of.torques(of.moment(0.0, {"motor": motor, "load": load}, {"motor": 0.0, "load": 0.0}, {}))
        return float(torques["load"])

    for twist in (-3e-3, -1e-4, 1e-4, 8e-4, 3e-3):
        motor = 0.8
        beyond = math.copysign(max(abs(twist) - 0.5 * gap, 0.0), twist)
        more = on_load(network, motor, motor / 50.0 - twist) - on_load(plain, motor, motor / 50.0 - twist)
        assert more == pytest.approx(0.5 * math.sin(2.0 * motor + 0.3) * 1e4 * beyond, rel=1e-6, abs=1e-9)
    response = hm.simulate(scene, 0.2, solver=TIGHT, initial={"motor.speed": 40.0, "load.speed": 0.4})
    grid = np.linspace(-0.05, 0.05, 400001)
    torque = law.torque(grid)
    area = np.concatenate([[0.0], np.cumsum(0.5 * (torque[1:] + torque[:-1]) * np.diff(grid))])
    twist = response["gear.twist"].values
    beyond = twist - np.clip(twist, -0.5 * gap, 0.5 * gap)
    potential = np.interp(twist, grid, area - np.interp(0.0, grid, area)) + response["it.share"].values * 0.5e4 * beyond**2
    kinetic = 0.5 * 1e-3 * response["motor.speed"].values ** 2 + 0.5 * 0.5 * response["load.speed"].values ** 2
    assert np.max(np.abs(twist)) > 1.5e-3  # where the law has hardened twice
    np.testing.assert_allclose(kinetic + potential, (kinetic + potential)[0], rtol=1e-6)


@pytest.mark.parametrize("first", ["it", "lost"])
@pytest.mark.parametrize("gap", [0.0, 4e-4])
def test_a_stiffness_beside_the_law_varies_beyond_lost_motion_whichever_comes_first(gap: float, first: str) -> None:
    """d is what is left of the twist by the gear's own gap and the lost motion; torques on both sides are slopes of r k d^2/2."""
    width, shift = 1e-3, {"motor": 0.8, "load": 0.8 / 50.0 - 3e-3}
    law = hm.PiecewiseLinearStiffness(lost_motion=gap, stiffness_1=1e4, stiffness_2=2e4, stiffness_3=3e4, torque_1=5.0, torque_2=15.0)
    effects = {"it": hm.ParallelStiffnessVariation(variation=0.5, phase=0.3), "lost": hm.LostMotion(width=width)}
    order = sorted(effects, key=lambda name: name != first)

    def torques(*names: str) -> tuple[float, float]:
        scene = drive(law)
        for name in names:
            scene = scene.with_effect(effects[name], at="gear", name=name)
        network = scene.network()
        found = network.torques(network.moment(0.0, shift, dict.fromkeys(shift, 0.0), {}))
        return float(found["motor"]), float(found["load"])

    (motor, load), (bare_motor, bare_load) = torques(*order), torques("lost")
    beyond, angle = 3e-3 - 0.5 * gap - 0.5 * width, 2.0 * 0.8 + 0.3
    assert load - bare_load == pytest.approx(0.5 * math.sin(angle) * 1e4 * beyond, rel=1e-6)
    reaction = -0.5 * 2.0 * math.cos(angle) * 0.5e4 * beyond**2
    assert motor - bare_motor == pytest.approx(reaction - (load - bare_load) / 50.0, rel=1e-6)


def test_stiffness_at_twice_a_mode_makes_it_grow_as_mathieu_says() -> None:
    inertia, stiffness, variation = 0.5, 1e4, 0.1
    frequency = math.sqrt(stiffness / inertia)
    # two periods of stiffness per turn of the wave generator: at its speed w the stiffness swings with 2 w = 2 f
    motor = hm.IdealSpeedMotor(motion=hm.SpeedRamp(start=frequency, end=frequency, duration=1.0))
    scene = drive(motor=motor).with_effect(hm.StiffnessVariation(variation=variation, order=2.0), at="gear")
    duration = 1.5
    response = hm.simulate(scene, duration, solver=TIGHT, initial={"load.speed": -frequency / 50.0 - 1e-3})
    twist, rate = response["gear.twist"].values, response["gear.twist_rate"].values
    size = np.hypot(twist * frequency, rate)
    late = response.times > 0.5 * duration
    growth = np.polyfit(response.times[late], np.log(size[late]), 1)[0]
    # principal parametric resonance: growth rate A f/4, to first order in A (Nayfeh, Mook, Nonlinear Oscillations, 5.3)
    assert growth == pytest.approx(variation * frequency / 4.0, rel=0.03)


def test_a_stiffness_variation_of_a_shaft_is_refused() -> None:
    with pytest.raises(PlaceError, match="flanges wave_generator, circular_spline"):
        spring_to_ground().with_effect(hm.StiffnessVariation(variation=0.1), at="shaft")
    with pytest.raises(ParameterError, match="must be 'wave_generator' or 'flexspline'"):
        hm.StiffnessVariation(variation=0.1, follows="output")


# -- orders ----------------------------------------------------------------------------------------------------


def test_cogging_is_the_sum_of_its_harmonics_and_gives_its_energy_back() -> None:
    effect = hm.Cogging(amplitude=0.3, order=6.0, phase=0.4, second_amplitude=0.2, second_phase=1.0, third_amplitude=0.1)
    response = hm.simulate(wheel(0.02).with_effect(effect, at="wheel", name="it"), 1.0, solver=TIGHT, initial_speed=8.0)
    angle = response["wheel.angle"].values
    expected = 0.3 * np.sin(6.0 * angle + 0.4) + 0.2 * np.sin(12.0 * angle + 1.0) + 0.1 * np.sin(18.0 * angle)
    np.testing.assert_allclose(response["it.torque"].values, expected, atol=1e-12)
    balance = hm.energy_balance(response)
    np.testing.assert_allclose(balance.total, balance.total[0], rtol=1e-8)
    assert np.ptp(balance.kinetic) > 0.05 * balance.total[0]


def test_cogging_of_a_body_that_turns_backwards_counts_its_true_angle() -> None:
    scene = drive().with_effect(hm.Cogging(amplitude=2.0, order=3.0, phase=0.5), at="load", name="it")
    response = hm.simulate(scene, 0.05, solver=TIGHT, initial_speed=60.0)
    np.testing.assert_allclose(response["it.torque"].values, 2.0 * np.sin(3.0 * response["load.angle"].values + 0.5), atol=1e-12)
    balance = hm.energy_balance(response)
    np.testing.assert_allclose(balance.total, balance.total[0], rtol=1e-8)


def test_a_kinematic_error_with_harmonics_is_the_sum_of_three() -> None:
    orders = ((1e-4, 2.0, 0.3), (5e-5, 4.0, -1.0), (2e-5, 6.0, 2.0))
    whole = hm.HarmonicKinematicError(
        amplitude=1e-4, order=2.0, phase=0.3, second_amplitude=5e-5, second_phase=-1.0, third_amplitude=2e-5, third_phase=2.0
    )
    apart = drive()
    for amplitude, order, phase in orders:
        apart = apart.with_effect(hm.KinematicError(amplitude=amplitude, order=order, phase=phase), at="gear")
    networks = [scene.network() for scene in (drive().with_effect(whole, at="gear"), apart)]
    for angle in (0.0, 0.7, 4.0):
        given = [network.moment(0.0, {"motor": angle, "load": 0.01}, {"motor": 9.0, "load": 0.2}, {}) for network in networks]
        first, second = (network.torques(moment) for network, moment in zip(networks, given, strict=True))
        for name in first:
            assert first[name] == pytest.approx(second[name], rel=1e-12)


@pytest.mark.parametrize("sense", ["same", "opposite"])
def test_a_beating_kinematic_error_is_the_sum_of_its_orders_and_their_side_bands(sense: str) -> None:
    """(1 + m sin(a/u + q)) sin(n a + p) = sin(n a + p) + m/2 [cos((n - 1/u) a + p - q) - cos((n + 1/u) a + p + q)]."""
    plain = drive().replacing({"gear.output_sense": sense})
    ratio = abs(plain.parts["gear"].signed_ratio)
    phase, shift, share = 0.3, 0.8, 0.2
    beating = hm.BeatingKinematicError(amplitude=1e-4, order=2.0, phase=phase, modulation=share, modulation_phase=shift)
    apart = plain
    for amplitude, order, own in (
        (1e-4, 2.0, phase),
        (0.5 * share * 1e-4, 2.0 - 1.0 / ratio, phase - shift + np.pi / 2.0),
        (0.5 * share * 1e-4, 2.0 + 1.0 / ratio, phase + shift - np.pi / 2.0),
    ):
        apart = apart.with_effect(hm.KinematicError(amplitude=amplitude, order=order, phase=own), at="gear")
    networks = [scene.network() for scene in (plain.with_effect(beating, at="gear"), apart)]
    for angle in (0.0, 0.7, 4.0, 60.0):
        given = [network.moment(0.0, {"motor": angle, "load": 0.01}, {"motor": 9.0, "load": 0.2}, {}) for network in networks]
        first, second = (network.torques(moment) for network, moment in zip(networks, given, strict=True))
        for name in first:
            assert first[name] == pytest.approx(second[name], rel=1e-10)


def test_an_error_that_follows_the_output_does_not_beat_with_its_own_turn() -> None:
    with pytest.raises(ParameterError, match="must be 'wave_generator'"):
        hm.BeatingKinematicError(amplitude=1e-4, follows="flexspline")


# -- motors ------------------------------------------------------------------------------------------------------


def test_a_lagging_motor_delivers_a_step_exponentially_and_reports_it_whole() -> None:
    response = hm.simulate(wheel(0.2, 4.0).with_effect(hm.ActuatorLag(time_constant=0.02), at="wheel", name="it"), 0.2, solver=TIGHT)
    t = response.times
    np.testing.assert_allclose(response["wheel.torque"].values, 4.0)
    np.testing.assert_allclose(response["it.torque"].values, 4.0 * (1.0 - np.exp(-t / 0.02)), atol=1e-9)
    np.testing.assert_allclose(response["wheel.speed"].values, 20.0 * (t - 0.02 * (1.0 - np.exp(-t / 0.02))), atol=1e-9)


def test_a_sagging_supply_lets_the_motor_creep_up_to_its_last_speed() -> None:
    scene = wheel(0.2, 8.0).with_effect(hm.SupplySag(sag=0.5, torque_limit=5.0), at="wheel", name="it")
    response = hm.simulate(scene, 2.0, solver=TIGHT)
    # below its command from the start:  J dw/dt = T_L - s w
    np.testing.assert_allclose(response["wheel.speed"].values, 10.0 * (1.0 - np.exp(-0.5 * response.times / 0.2)), atol=1e-8)
    law = hm.SupplySag(sag=0.5, torque_limit=5.0)
    assert law.delivered(0.0, 4.0, -8.0) == -5.0  # braking: the supply does not give way
    assert law.delivered(0.0, -4.0, -8.0) == -3.0
    assert law.delivered(0.0, 40.0, 8.0) == 0.0
    assert law.delivered(0.0, 4.0, 1.0) == 1.0


def test_a_saturated_motor_gives_a_share_less_that_grows_with_the_square_and_never_more_than_its_most() -> None:
    response = hm.simulate(wheel(0.2, 4.0).with_effect(hm.MotorSaturation(saturation=0.02), at="wheel", name="it"), 0.5, solver=TIGHT)
    most = 1.0 / np.sqrt(3.0 * 0.02)
    np.testing.assert_allclose(response["wheel.torque"].values, 4.0)
    np.testing.assert_allclose(response["wheel.speed"].values, most * np.tanh(4.0 / most) / 0.2 * response.times, atol=1e-8)
    law = hm.MotorSaturation(saturation=0.02)
    for torque in (0.1, -0.1, 0.3):
        missing = 1.0 - law.delivered(0.0, 5.0, torque) / torque
        assert missing == pytest.approx(0.02 * torque**2, rel=0.02 * torque**2 * 2.0)  # next term of the series: 6/5 of it
    assert law.delivered(0.0, 5.0, 1e3) == pytest.approx(most)
    assert hm.MotorSaturation(saturation=0.0).delivered(0.0, 5.0, 7.0) == 7.0


def test_effects_of_a_motor_follow_one_another() -> None:
    scene = wheel(0.2, 4.0).with_effect(hm.MotorScale(error=0.5), at="wheel", name="first")
    scene = scene.with_effect(hm.SupplySag(sag=1e-12, torque_limit=5.0), at="wheel", name="second")
    response = hm.simulate(scene, 0.1, solver=TIGHT)
    assert (response["first.torque"].values[0], response["second.torque"].values[0]) == (6.0, 5.0)
    np.testing.assert_allclose(response["wheel.speed"].values, 25.0 * response.times, atol=1e-9)
    other = (
        wheel(0.2, 4.0).with_effect(hm.SupplySag(sag=1e-12, torque_limit=5.0), at="wheel").with_effect(hm.MotorScale(error=0.5), at="wheel")
    )
    assert hm.simulate(other, 0.1, solver=TIGHT)["wheel.speed"].values[-1] == pytest.approx(3.0)


def test_a_ripple_in_proportion_follows_what_the_motor_delivers() -> None:
    scene = wheel(0.2, 4.0).with_effect(hm.MotorScale(error=1.0), at="wheel")
    response = hm.simulate(scene.with_effect(hm.TorqueRipple(relative=0.1, order=3.0), at="wheel", name="ripple"), 1.0)
    np.testing.assert_allclose(response["ripple.torque"].values, 0.8 * np.sin(3.0 * response["wheel.angle"].values), atol=1e-12)


@pytest.mark.parametrize(
    "effect",
    [
        hm.ActuatorLag(time_constant=0.1),
        hm.SupplySag(sag=0.1, torque_limit=1.0),
        hm.MotorScale(error=0.1),
        hm.MotorSaturation(saturation=0.1),
    ],
)
def test_effects_of_a_motor_refuse_a_load_and_a_prescribed_motion(effect: Effect) -> None:
    loaded = drive(motor=lambda speed: 1.0 + 0.0 * speed).replacing(load=hm.Load(inertia=0.5, torque=hm.ConstantTorque(value=1.0)))
    with pytest.raises(PlaceError, match=r"needs a motor with a torque law, but 'load' is none\. Motors: motor\."):
        loaded.with_effect(effect, at="load")
    assert effect.places(loaded.network()) == ("motor",)
    given = drive(motor=hm.IdealSpeedMotor(motion=hm.SpeedRamp(start=0.0, end=1.0, duration=1.0)))
    with pytest.raises(PlaceError, match=r"Motors: none\."):
        given.with_effect(effect, at="motor")


# -- dynamics of their own ---------------------------------------------------------------------------------------


def chain(first: float, second: float, stiffness: float, damping: float) -> hm.Scene:
    """Two discs on a shaft, the first on a spring to the ground."""
    parts = {
        "disc": hm.Inertia(inertia=first),
        "spring": hm.Shaft(stiffness=300.0, damping=0.2),
        "link": hm.Shaft(stiffness=stiffness, damping=damping),
        "second": hm.Inertia(inertia=second),
    }
    return hm.Scene(name="chain", parts=parts, connections=[("disc", "spring", "ground"), ("disc", "link", "second")])


@pytest.mark.parametrize("shared", [False, True], ids=["attached", "share"])
def test_a_hidden_mode_is_a_second_disc_on_a_shaft(shared: bool) -> None:
    inertia, frequency, ratio = 0.04, 60.0, 0.05
    stiffness, damping = inertia * frequency**2, 2.0 * ratio * inertia * frequency
    kept = 0.1 - inertia if shared else 0.1
    built = chain(kept, inertia, stiffness, damping)
    effect = (
        hm.FlexibleInertia(share=0.4, natural_frequency=frequency, damping_ratio=ratio)
        if shared
        else hm.HiddenMode(inertia=inertia, natural_frequency=frequency, damping_ratio=ratio)
    )
    hidden = spring_to_ground(300.0, 0.2, 0.1).with_effect(effect, at="disc", name="it")
    start = {"disc.angle": 0.1, "second.angle": 0.1, "disc.speed": -1.0, "second.speed": -1.0}
    plain = hm.simulate(built, 0.5, solver=TIGHT, initial=start)
    response = hm.simulate(hidden, 0.5, solver=TIGHT, initial={"disc.angle": 0.1, "disc.speed": -1.0, "it.inertia_speed": -1.0})
    times = np.linspace(0.0, 0.5, 301)
    np.testing.assert_allclose(response.at("disc.angle", times), plain.at("disc.angle", times), atol=1e-8)
    second = plain.at("second.angle", times) - plain.at("disc.angle", times)
    np.testing.assert_allclose(response.at("it.deflection", times), second, atol=1e-8)
    np.testing.assert_allclose(hm.modes(hidden).damped, hm.modes(built).damped, rtol=1e-9)
    assert hm.energy_balance(response).energy_error < 1e-7


def test_a_share_of_an_inertia_leaves_the_whole_as_it_was_in_slow_motion() -> None:
    scene = wheel(0.2, lambda time, speed: 1.0 - np.exp(-time / 0.2) + 0.0 * speed)
    rigid = hm.simulate(scene, 2.0, solver=TIGHT)
    parted = hm.simulate(
        scene.with_effect(hm.FlexibleInertia(share=0.6, natural_frequency=500.0, damping_ratio=0.5), at="wheel"), 2.0, solver=TIGHT
    )
    # the deflection follows the torque, of which 1/(0.2 s) is the fastest part: (1/(500 * 0.2))^2 = 1e-4 of the motion
    assert parted["wheel.angle"].values[-1] == pytest.approx(rigid["wheel.angle"].values[-1], rel=1e-4)


def test_a_share_of_a_rotor_with_lateral_motion_is_refused() -> None:
    from models.two_rotor_line import build

    effect = hm.FlexibleInertia(share=0.3, natural_frequency=100.0)
    with pytest.raises(PlaceError, match=r"FlexibleInertia changes the inertia of 'rotor_1'"):
        build().with_effect(effect, at="rotor_1")
    assert effect.places(build().network()) == ()
    assert "rotor_1" in hm.HiddenMode.places(build().network())


def test_compliance_in_series_adds_to_the_twist_of_any_law() -> None:
    compliance = 2e-4

    def law(twist: Value) -> Value:
        return 1e3 * twist + 1e6 * twist**3

    gear = hm.HarmonicDrive(ratio=50.0, stiffness=law, damping=5.0)
    motor = hm.Motor(inertia=1e-3, characteristic=lambda time, speed: 0.2 + 0.0 * time, viscous=0.05)
    parts = {"motor": motor, "gear": gear, "arm": hm.Inertia(inertia=0.01, viscous=2.0), "stop": hm.Shaft(stiffness=1e6)}
    scene = hm.Scene(name="pushed", parts=parts, connections=[("motor", "gear", "arm", "stop", "ground")])
    response = hm.simulate(scene.with_effect(hm.SeriesCompliance(compliance=compliance), at="gear", name="it"), 2.0, solver=TIGHT)
    torque, twist = response["gear.torque"].values[-1], response["gear.twist"].values[-1]
    assert torque == pytest.approx(50.0 * 0.2, rel=1e-6)  # at rest the gear carries u times the motor's torque
    assert response["it.deflection"].values[-1] == pytest.approx(compliance * torque, rel=1e-6)
    assert law(twist - compliance * torque) == pytest.approx(torque, rel=1e-6)


def test_compliance_in_series_with_a_shaft_lowers_its_frequency_as_springs_in_series() -> None:
    scene = spring_to_ground(1e3, 0.0, 0.1).with_effect(hm.SeriesCompliance(compliance=1e-3, relaxation_time=1e-6), at="shaft")
    # 1/k' = 1/k + C: half as stiff; the damper of 1e-6 s gives a damping ratio of about 70 * 1e-6/4
    found = hm.modes(scene)
    assert found.damped[0] == pytest.approx(math.sqrt(500.0 / 0.1), rel=1e-6)
    assert found.damping_ratio[0] == pytest.approx(math.sqrt(500.0 / 0.1) * 1e-6 / 4.0, rel=1e-3)


def test_compliance_in_series_is_a_light_disc_between_two_shafts() -> None:
    # the same with the mass that was left out: 1e-6 kg m^2 between the two springs
    first, second = {"stiffness": 1e3, "damping": 0.5}, {"stiffness": 2e3, "damping": 2e3 * 1e-3}
    parts = {"disc": hm.Inertia(inertia=0.1), "first": hm.Shaft(**first), "middle": hm.Inertia(inertia=1e-6), "second": hm.Shaft(**second)}
    built = hm.Scene(name="two", parts=parts, connections=[("disc", "first", "middle", "second", "ground")])
    hidden = spring_to_ground(1e3, 0.5, 0.1).with_effect(hm.SeriesCompliance(compliance=5e-4, relaxation_time=1e-3), at="shaft", name="it")
    start = {"disc.speed": 1.0}
    stiff = hm.DormandPrince(relative_tolerance=1e-9, absolute_tolerance=1e-12)
    plain, response = hm.simulate(built, 0.1, solver=stiff, initial=start), hm.simulate(hidden, 0.1, solver=TIGHT, initial=start)
    times = np.linspace(0.0, 0.1, 101)
    # the light disc takes 1e-6 * (80 rad/s)^2 = 6e-3 N m/rad of 3e3 of the springs: 2e-6, and settles in 1e-6/2.5 s at the start
    size = np.max(np.abs(plain.at("disc.angle", times)))
    np.testing.assert_allclose(response.at("disc.angle", times), plain.at("disc.angle", times), atol=1e-5 * size)
    middle = plain.at("middle.angle", times[1:])
    np.testing.assert_allclose(response.at("it.deflection", times[1:]), middle, atol=1e-4 * np.max(np.abs(middle)))


def test_hysteresis_in_line_with_a_compliance_sees_its_own_twist() -> None:
    scene = spring_to_ground(1e3, 0.0, 0.1).with_effect(hm.BoucWenHysteresis(torque_limit=2.0, yield_twist=1e-3), at="shaft", name="loop")
    scene = scene.with_effect(hm.SeriesCompliance(compliance=5e-4), at="shaft", name="soft")
    response = hm.simulate(scene, 0.1, solver=TIGHT, initial={"disc.speed": 1.0})
    inside = response["shaft.twist"].values - response["soft.deflection"].values
    # on first loading  dz/dx = (1 - z)/x_y  with n = 1, b = 1/2:  z = 1 - exp(-x/x_y) of the twist inside
    rising = response.times < 0.01
    assert np.all(np.diff(inside[rising]) > 0.0)
    np.testing.assert_allclose(response["loop.z"].values[rising], 1.0 - np.exp(-inside[rising] / 1e-3), atol=1e-7)
    assert hm.energy_balance(response).energy_error < 1e-6


def test_two_compliances_in_line_are_three_springs_one_behind_the_other() -> None:
    # a chain of k, C_1 with t_1 and C_2 with t_2, held at a twist: three linear equations, solved with the matrix exponential
    stiffness, damping = 1e3, 0.5
    chain = ((4e-4, 0.02), (7e-4, 0.3))
    scene = spring_to_ground(stiffness, damping, 1e9)  # a disc that nothing turns
    for k, (compliance, time) in enumerate(chain):
        kind = (
            hm.Creep(compliance=compliance, relaxation_time=time) if k else hm.SeriesCompliance(compliance=compliance, relaxation_time=time)
        )
        scene = scene.with_effect(kind, at="shaft", name=f"element_{k}")
    held = 0.01
    response = hm.simulate(scene, 1.0, solver=TIGHT, initial={"disc.angle": held})
    # tau = k (x - y_1 - y_2) - d (y_1' + y_2'),  y_i + t_i y_i' = C_i tau
    (c_1, t_1), (c_2, t_2) = chain
    left = np.array([[t_1 + c_1 * damping, c_1 * damping], [c_2 * damping, t_2 + c_2 * damping]])
    right = -np.array([[1.0 + c_1 * stiffness, c_1 * stiffness], [c_2 * stiffness, 1.0 + c_2 * stiffness]])
    matrix, end = np.linalg.solve(left, right), -np.linalg.solve(right, stiffness * held * np.array([c_1, c_2]))
    times = np.linspace(0.0, 1.0, 21)
    wanted = np.array([end - scipy.linalg.expm(matrix * t) @ end for t in times])
    for k in range(2):
        np.testing.assert_allclose(response.at(f"element_{k}.deflection", times), wanted[:, k], rtol=0.0, atol=1e-6 * held)


def test_a_creeping_spring_is_the_standard_linear_solid() -> None:
    stiffness, compliance, time, held = 1e3, 1e-3, 0.2, 0.01
    scene = spring_to_ground(stiffness, 0.0, 1e9).with_effect(hm.Creep(compliance=compliance, relaxation_time=time), at="shaft", name="it")
    response = hm.simulate(scene, 1.0, solver=TIGHT, initial={"disc.angle": held})
    slow = stiffness / (1.0 + stiffness * compliance)
    torque = held * (slow + (stiffness - slow) * np.exp(-response.times * (1.0 + stiffness * compliance) / time))
    # the disc of 1e9 kg m^2 moves by torque t^2/2J = 5e-7 of the twist
    np.testing.assert_allclose(response["shaft.torque"].values, torque, rtol=1e-5)


def test_the_loss_factor_of_a_creeping_spring_is_largest_at_the_frequency_of_its_text() -> None:
    # complex stiffness k (1 + i w t)/(1 + k C + i w t): its phase is largest at w t = sqrt(1 + k C), with tan = k C/(2 sqrt(1 + k C))
    stiffness, compliance, time = 1e3, 3e-3, 0.05
    lag = []
    for factor in (0.7, 1.0, 1.4):
        omega = factor * math.sqrt(1.0 + stiffness * compliance) / time
        motor = hm.Motor(inertia=1e-3, viscous=1.0, characteristic=lambda time, speed, w=omega: np.sin(w * time) + 0.0 * speed)
        parts = {"motor": motor, "shaft": hm.Shaft(stiffness=stiffness)}
        scene = hm.Scene(name="shaken", parts=parts, connections=[("motor", "shaft", "ground")])
        scene = scene.with_effect(hm.Creep(compliance=compliance, relaxation_time=time), at="shaft")
        response = hm.simulate(scene, 12 * 2 * math.pi / omega, solver=TIGHT)
        times = np.linspace(10 * 2 * math.pi / omega, 12 * 2 * math.pi / omega, 400, endpoint=False)
        wave = np.exp(-1j * omega * times)
        lag.append(np.angle((response.at("shaft.torque", times) @ wave) / (response.at("shaft.twist", times) @ wave)))
    assert lag[1] > max(lag[0], lag[2])
    assert math.tan(lag[1]) == pytest.approx(stiffness * compliance / (2.0 * math.sqrt(1.0 + stiffness * compliance)), rel=1e-3)


def test_a_joint_under_a_steady_torque_slips_at_its_rate_and_keeps_the_twist() -> None:
    pushed = hm.Motor(inertia=0.1, viscous=3.0, characteristic=lambda time, speed: np.where(time < 1.0, 12.0, 4.0) + 0.0 * speed)
    parts = {"shaft": hm.Shaft(stiffness=1e3, damping=0.5), "disc": pushed}
    scene = hm.Scene(name="clamp", parts=parts, connections=[("disc", "shaft", "ground")])
    scene = scene.with_effect(hm.JointSlip(slip_torque=8.0, slip_rate=0.2), at="shaft", name="it")
    response = hm.simulate(scene, 2.0, solver=TIGHT)
    slipped = response.at("it.deflection", np.array([0.5, 0.9, 1.2, 2.0]))
    # steady creep: the shaft's torque is 12 N m less the drag 3 w at w = r (tau/T_s - 1)
    rate = 0.2 * (12.0 / 8.0 - 1.0) / (1.0 + 3.0 * 0.2 / 8.0)
    assert abs(slipped[1] - slipped[0]) == pytest.approx(0.4 * rate, rel=1e-6)
    assert slipped[3] == pytest.approx(slipped[2], abs=1e-12)  # 4 N m hold
    assert hm.energy_balance(response).energy_error < 1e-6


def slipping_and_creeping(*kinds: str, damping: float = 5.0) -> hm.Response:
    effects = {"slip": hm.JointSlip(slip_torque=8.0, slip_rate=10.0), "creep": hm.Creep(compliance=5e-4, relaxation_time=0.05)}
    disc = hm.Motor(inertia=0.1, viscous=1.0, characteristic=lambda time, speed: 14.0 * np.sin(60.0 * time) + 0.0 * speed)
    parts = {"shaft": hm.Shaft(stiffness=1e3, damping=damping), "disc": disc}
    scene = hm.Scene(name="line", parts=parts, connections=[("disc", "shaft", "ground")])
    for kind in kinds:
        scene = scene.with_effect(effects[kind], at="shaft", name=kind)
    return hm.simulate(scene, 0.5, solver=TIGHT)


def test_elements_in_line_commute_as_massless_ones_do() -> None:
    one, other = slipping_and_creeping("slip", "creep"), slipping_and_creeping("creep", "slip")
    assert np.max(np.abs(one["slip.deflection"].values)) > 1e-3  # it does slip
    times = np.linspace(0.0, 0.5, 201)
    for channel in ("shaft.torque", "slip.deflection", "creep.deflection"):
        scale = np.max(np.abs(one[channel].values))
        np.testing.assert_allclose(one.at(channel, times), other.at(channel, times), rtol=0.0, atol=1e-6 * scale)


def test_a_joint_that_slips_beyond_a_creeping_spring_follows_equations_solved_for_the_torque() -> None:
    # tau = k (x - y - s) + d (v - y' - s'),  y' = (C tau - y)/t,  s' = r max(|tau| - T_s, 0) sign(tau)/T_s: a root of tau at every instant
    k, d, c, t, yield_, r = 1e3, 5.0, 5e-4, 0.05, 8.0, 10.0

    def torque(x: float, v: float, y: float, s: float) -> float:
        def left(tau: float) -> float:
            slip = r * math.copysign(max(abs(tau) - yield_, 0.0), tau) / yield_
            return k * (x - y - s) + d * (v - (c * tau - y) / t - slip) - tau

        return float(scipy.optimize.brentq(left, -1e6, 1e6, xtol=1e-13, rtol=1e-14))

    def motion(time: float, q: np.ndarray) -> list[float]:
        x, v, y, s = q
        tau = torque(x, v, y, s)
        slip = r * math.copysign(max(abs(tau) - yield_, 0.0), tau) / yield_
        return [v, (14.0 * math.sin(60.0 * time) - v - tau) / 0.1, (c * tau - y) / t, slip]

    response = slipping_and_creeping("slip", "creep")
    times = np.linspace(0.0, 0.5, 51)
    wanted = solve_ivp(motion, (0.0, 0.5), [0.0] * 4, t_eval=times, rtol=1e-9, atol=1e-12, max_step=1e-3).y
    for row, channel in enumerate(("disc.angle", "disc.speed", "creep.deflection", "slip.deflection")):
        np.testing.assert_allclose(response.at(channel, times), wanted[row], rtol=0.0, atol=1e-6 * np.max(np.abs(wanted[row])))


def test_a_second_joint_that_yields_in_line_is_refused() -> None:
    scene = spring_to_ground().with_effect(hm.JointSlip(slip_torque=8.0, slip_rate=0.2), at="shaft")
    with pytest.raises(PlaceError, match="yields in line with that connection already"):
        scene.with_effect(hm.JointSlip(slip_torque=5.0, slip_rate=0.2), at="shaft", name="other").network()


def test_a_joint_that_slips_fast_is_a_safety_clutch() -> None:
    pushed = hm.Motor(inertia=0.1, characteristic=lambda time, speed: 20.0 + 0.0 * time)
    parts = {"shaft": hm.Shaft(stiffness=1e3, damping=0.5), "disc": pushed}
    scene = hm.Scene(name="clutch", parts=parts, connections=[("disc", "shaft", "ground")])
    scene = scene.with_effect(hm.JointSlip(slip_torque=8.0, slip_rate=1e4), at="shaft", name="it")
    response = hm.simulate(scene, 0.3, solver=TIGHT)
    # the clutch carries T_s (1 + w/r), so J w' = 20 - 8 - 8 w/r, of which 15,000 rad/s would be the end
    speed = response.at("disc.speed", np.array([0.1, 0.3]))
    end = 12.0 * 1e4 / 8.0
    assert speed[1] == pytest.approx(end + (speed[0] - end) * math.exp(-8.0 * 0.2 / (1e4 * 0.1)), rel=1e-5)
    assert response["shaft.torque"].values[-1] == pytest.approx(8.0 * (1.0 + speed[1] / 1e4), rel=1e-5)


# -- time ----------------------------------------------------------------------------------------------------------


def test_drag_that_grows_as_a_machine_warms_slows_it_as_the_integral_says() -> None:
    scene = wheel(0.2).with_effect(hm.ThermalDrift(viscous_change=0.5, time_constant=0.7), at="wheel")
    response = hm.simulate(scene, 2.0, solver=TIGHT, initial_speed=10.0)
    t = response.times
    # J dw/dt = -c (1 - exp(-t/h)) w
    expected = 10.0 * np.exp(-0.5 / 0.2 * (t - 0.7 * (1.0 - np.exp(-t / 0.7))))
    np.testing.assert_allclose(response["wheel.speed"].values, expected, rtol=1e-7)


def test_friction_that_fades_as_a_machine_warms_drives_against_that_of_the_model() -> None:
    law = hm.ThermalDrift(friction_change=-3.0, time_constant=0.5, smoothing_speed=0.01)
    assert law.torque(0.0, 0.0, 5.0) == 0.0
    assert law.torque(0.5, 0.0, 5.0) == pytest.approx(3.0 * (1.0 - math.exp(-1.0)), rel=1e-12)
    assert law.torque(50.0, 0.0, -5.0) == pytest.approx(-3.0, rel=1e-12)


# -- loads, neighbours, and friction by sense and angle ---------------------------------------------------


def braked(torque: object, inertia: float = 0.2) -> hm.Scene:
    """A load on its own."""
    return hm.Scene(name="braked", parts={"load": hm.Load(inertia=inertia, torque=torque)}, connections=[])


@pytest.mark.parametrize("lag", [0.02, 1e-4], ids=["followed", "too fast to be followed"])
def test_a_load_that_lags_brakes_late_by_its_time(lag: float) -> None:
    """J dw/dt = -M (1 - exp(-t/T)):  w = -(M/J) (t - T (1 - exp(-t/T))), in the end as if the load came T later."""
    response = hm.simulate(
        braked(lambda time: 5.0 + 0.0 * time).with_effect(hm.LoadLag(time_constant=lag), at="load", name="it"), 0.2, solver=TIGHT
    )
    times = response.times
    share = min(1.0, lag * 5e3)
    followed = lag / share
    wanted = -5.0 / 0.2 * (times - share * followed * (1.0 - np.exp(-times / followed)))
    np.testing.assert_allclose(response["load.speed"].values, wanted, rtol=0.0, atol=1e-8)
    assert response["load.speed"].values[-1] == pytest.approx(-5.0 / 0.2 * (0.2 - lag), rel=1e-4)
    np.testing.assert_allclose(response["load.torque"].values, 5.0, rtol=1e-12)  # what is asked of it
    assert response["it.torque"].values[-1] == pytest.approx(5.0, rel=1e-4)


def test_a_lag_of_the_load_needs_a_load() -> None:
    with pytest.raises(PlaceError, match=r"LoadLag needs a load with a torque law, but 'wheel' is none. Loads: none"):
        wheel().with_effect(hm.LoadLag(time_constant=1e-3), at="wheel").network()


def test_a_torque_from_outside_swings_a_free_body_at_its_own_frequency() -> None:
    amplitude, frequency, phase, inertia = 3.0, 40.0, 0.7, 0.2
    effect = hm.ExternalTorque(amplitude=amplitude, frequency=frequency, phase=phase)
    response = hm.simulate(wheel(inertia).with_effect(effect, at="wheel"), 0.5, solver=TIGHT, initial_speed=2.0)
    wanted = 2.0 + amplitude / (inertia * frequency) * (math.cos(phase) - np.cos(frequency * response.times + phase))
    np.testing.assert_allclose(response["wheel.speed"].values, wanted, rtol=0.0, atol=1e-7)


@pytest.mark.parametrize("speed", [-3.0, 3.0])
def test_drag_in_one_sense_is_the_mean_and_the_difference(speed: float) -> None:
    """c w forward and nothing backward: coasting down is exp(-c t/J) forward, and backward the speed stays."""
    drag, inertia = 0.1, 0.2
    scene = wheel(inertia).with_effect(hm.ViscousDrag(coefficient=0.5 * drag), at="wheel")
    scene = scene.with_effect(hm.UnequalDrag(viscous=drag), at="wheel")
    response = hm.simulate(scene, 2.0, solver=TIGHT, initial_speed=speed)
    wanted = speed * np.exp(-drag / inertia * response.times) if speed > 0.0 else speed + 0.0 * response.times
    np.testing.assert_allclose(response["wheel.speed"].values, wanted, rtol=0.0, atol=1e-8)


def test_unequal_friction_takes_its_half_forward_and_gives_it_backward() -> None:
    law = hm.UnequalDrag(friction=0.8, smoothing_speed=1e-3)
    assert [float(law.torque(0.0, 0.0, speed)) for speed in (1.0, -1.0, 0.0)] == pytest.approx([-0.4, -0.4, 0.0], abs=1e-15)


def torque_over_a_turn(effect: Effect, speed: float) -> tuple[np.ndarray, np.ndarray]:
    """True angles of one turn and what the effect does to a body there."""
    network = wheel().with_effect(effect, at="wheel", name="it").network()
    angles = np.linspace(0.0, 2.0 * np.pi, 720, endpoint=False)
    read = next(channel.read for channel in network.channels if channel.name == "it.torque")
    moments = (network.moment(0.0, {"wheel": angle}, {"wheel": speed}, {}) for angle in angles)
    return angles, np.array([float(read(moment)) for moment in moments])


@pytest.mark.parametrize("speed", [5.0, -5.0])
def test_a_rub_at_an_angle_takes_the_work_of_its_bell(speed: float) -> None:
    """Over a turn T times the integral of exp(k (cos a - 1)), 2 pi exp(-k) I_0(k), in both senses; all of it at the angle."""
    effect = hm.RubAtAngle(friction=2.0, angle=1.3, sharpness=12.0)
    angles, torque = torque_over_a_turn(effect, speed)
    # the trapezoidal rule is exact to rounding for a periodic function as smooth as this
    assert np.mean(torque) * 2.0 * np.pi == pytest.approx(-math.copysign(2.0 * 2.0 * np.pi * scipy.special.ive(0, 12.0), speed), rel=1e-12)
    assert angles[np.argmax(np.abs(torque))] == pytest.approx(1.3, abs=np.pi / 720)


@pytest.mark.parametrize("speed", [5.0, -5.0])
def test_friction_by_angle_has_its_harmonics_and_turns_over_with_the_sense(speed: float) -> None:
    effect = hm.FrictionByAngle(mean=4.0, once=1.0, once_phase=0.3, twice=0.5, twice_phase=-1.0, thrice=0.2, thrice_phase=2.0)
    angles, torque = torque_over_a_turn(effect, speed)
    spectrum = np.fft.rfft(torque) / len(angles)
    # A sin(k a + p) = Re(-i A exp(i p) exp(i k a)), half of it in the one-sided spectrum
    wanted = [4.0] + [-0.5j * size * np.exp(1j * phase) for size, phase in ((1.0, 0.3), (0.5, -1.0), (0.2, 2.0))]
    np.testing.assert_allclose(spectrum[:4], -np.sign(speed) * np.array(wanted), atol=1e-12)
    assert np.max(np.abs(spectrum[4:])) < 1e-12


def test_friction_by_sense_and_angle_is_looked_for_at_bodies_that_only_turn() -> None:
    for kind in (hm.UnequalDrag, hm.FrictionByAngle, hm.RubAtAngle, hm.ExternalTorque):
        assert kind.places(drive_bench.build().network()) == ("motor", "wave_generator", "gear.flexspline", "load")
        assert kind.places(rotor_bench.build().network()) == ()
    assert hm.LoadLag.places(drive_bench.build().network()) == ("load",)


def test_an_error_whose_harmonic_leads_is_looked_for_with_that_as_its_order() -> None:
    """c24 of our own twenty-second drive set: order 6 with harmonics of its own, found as the third harmonic of order 2."""
    found = hm.HarmonicKinematicError(
        amplitude=1e-6,
        order=2.0,
        phase=1.2,
        second_amplitude=1.5e-6,
        second_phase=0.5,
        third_amplitude=2.2e-5,
        third_phase=-0.97,
        offset=3e-5,
    )
    [other] = found.elsewhere()
    assert (other.order, other.amplitude, other.phase, other.offset) == (6.0, 2.2e-5, -0.97, 3e-5)
    assert (other.second_amplitude, other.third_amplitude) == (0.0, 0.0)
    angles = np.linspace(0.0, 7.0, 50)
    assert np.abs(other.error(angles) - found.error(angles)).max() < 2.6e-6  # what the two smaller ones make
    orders = [
        item.order for item in hm.HarmonicKinematicError(amplitude=1e-6, order=2.0, second_amplitude=3e-6, third_amplitude=3e-6).elsewhere()
    ]
    assert orders == [4.0, 6.0]
    assert found.replacing(amplitude=2e-5).elsewhere() == ()  # the first one leads
    assert found.replacing(order=400.0).elsewhere() == ()  # there is no order above 1000
    beating = hm.BeatingKinematicError(amplitude=1e-6, order=2.0, third_amplitude=2.2e-5, modulation=0.1)
    assert [(type(item), item.order, item.modulation) for item in beating.elsewhere()] == [(hm.BeatingKinematicError, 6.0, 0.1)]
