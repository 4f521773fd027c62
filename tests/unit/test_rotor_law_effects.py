"""Changed laws of bearings, supports and shafts against closed forms and against equations integrated by scipy."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from scipy.integrate import solve_ivp
from scipy.special import ellipk

import hdrive_mbs as hm
from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices
from hdrive_mbs.analysis.whirl.rotor_point import rotor_point
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.engine.assembly import LoweringWarning, assemble
from hdrive_mbs.engine.linearisation import linearise
from hdrive_mbs.errors import ParameterError, PlaceError
from hdrive_mbs.network.coupling import Coupling
from tests.unit.rotor_pieces import DISC, EARTH, E, bearing, eigenvalues, frequencies, line, section, steady

FloatArray = npt.NDArray[np.float64]

MASS, STIFFNESS, DAMPING = 8.0, 4e6, 300.0
NATURAL = math.sqrt(STIFFNESS / MASS)
"""707 rad/s."""
ECCENTRICITY = 2e-5


def turning(speed: float) -> hm.DriveTorque:
    """A spin that is given: then unbalance is a force m e w^2 of time."""
    return hm.DriveTorque(characteristic=hm.IdealSpeedMotor(motion=hm.ConstantSpeed(value=speed)))


def jeffcott(
    *, damping: float = DAMPING, speed: float | None = None, housing: hm.Housing | None = None, weight: bool = False, **rotor: float
) -> hm.Scene:
    """A disc on one bearing; tilts are held by a spring and stay zero."""
    values = {"mass": MASS, "polar_inertia": 0.04, "transverse_inertia": 0.0206, **rotor}
    law = hm.LinearBearing.isotropic(radial=STIFFNESS, damping=damping, tilt=1e3, axial=1e4)
    parts: dict[str, hm.Component] = {"disc": hm.Rotor(**values), "bearing": hm.Bearing(law=law, housing=housing)}
    chain = ("disc", "bearing")
    if speed is not None:
        parts, chain = {**parts, "drive": turning(speed)}, ("drive", *chain)
    if weight:
        parts["gravity"] = hm.Gravity()
    return hm.Scene(name="jeffcott", parts=parts, connections=[chain])


def run(scene: hm.Scene, duration: float, step: float, **start: Any) -> hm.Response:
    with warnings.catch_warnings():
        warnings.simplefilter("error", LoweringWarning)
        return hm.simulate(scene, duration, solver=hm.RungeKutta4(step=step), progress=False, **start)


def reference(
    forces: Callable[[float, Any, Any], Sequence[complex]], times: FloatArray, start: Sequence[complex], masses: Sequence[float] = (MASS,)
) -> npt.NDArray[np.complex128]:
    """m_k z_k'' = F_k(t, z, z') for z = x + i y, from rest; shape (bodies, times)."""
    n, inertia = len(masses), np.array(masses)

    def rates(t: float, y: npt.NDArray[np.complex128]) -> npt.NDArray[np.complex128]:
        return np.concatenate([y[n:], np.array(forces(t, y[:n], y[n:])) / inertia])

    start = np.concatenate([np.array(start, complex), np.zeros(n)])
    made = solve_ivp(rates, (0.0, times[-1]), start, t_eval=times, rtol=1e-10, atol=1e-14, max_step=1e-4)
    assert made.success
    return np.asarray(made.y[:n])


def whirl_of(response: hm.Response, place: str = "disc") -> npt.NDArray[np.complex128]:
    return np.asarray(response.values[f"{place}.x"] + 1j * response.values[f"{place}.y"])


def agrees(found: npt.NDArray[np.complex128], wanted: npt.NDArray[np.complex128], share: float) -> None:
    assert np.max(np.abs(found - wanted)) <= share * np.max(np.abs(wanted))


def unbalance(speed: float) -> Callable[[float], complex]:
    return lambda t: MASS * ECCENTRICITY * speed**2 * np.exp(1j * speed * t)


# -- clearance ------------------------------------------------------------------------------------------


def test_period_in_a_gap_is_that_of_a_free_flight_and_half_a_swing_at_each_end() -> None:
    """From +A to +A: T = 2 pi/w + 4 c/(w (A - c)), as the mass flies through the gap at w (A - c)."""
    gap, amplitude = 2e-5, 6e-5
    scene = jeffcott(damping=0.0).with_effect(hm.BearingClearance(gap=gap), at="bearing")
    period = 2.0 * math.pi / NATURAL + 4.0 * gap / (NATURAL * (amplitude - gap))
    response = run(scene, 5.0 * period, 2e-6, initial={"disc.x": amplitude})
    x = response.values["disc.x"]
    falling = [k for k in range(len(x) - 1) if x[k] > 0.0 >= x[k + 1]]
    crossings = np.array([response.times[k] + (response.times[k + 1] - response.times[k]) * x[k] / (x[k] - x[k + 1]) for k in falling])
    # a step h that meets a corner is wrong by k v h^2/m/8 in speed at most, 1e-5 of w (A - c)
    np.testing.assert_allclose(np.diff(crossings), period, rtol=2e-5)


def contact(z: complex, v: complex, gap: float, film: tuple[float, float], law: Callable[[float, float], float]) -> complex:
    """Force on the ring: film, and a contact that only pushes, in polar coordinates."""
    r, direction = abs(z), z / abs(z)
    total = -film[0] * STIFFNESS * z - film[1] * DAMPING * v
    if r > gap:
        total -= direction * max(law(r - gap, (v * direction.conjugate()).real), 0.0)
    return total


@pytest.mark.parametrize("kind", ["linear", "roller"])
def test_unbalanced_rotor_in_a_gap_moves_as_scipy_says(kind: str) -> None:
    """With weight, spin and a thin film; the ring leaves the race on every turn at first."""
    gap, film, speed, at = 1e-5, (0.02, 0.3), 800.0, 200.0

    def linear(p: float, rate: float) -> float:
        return (1.0 - film[0]) * STIFFNESS * p + (1.0 - film[1]) * DAMPING * rate

    def roller(p: float, rate: float) -> float:
        # N = A p^n with n N/p = k at N = F_0 without film, of which 1 - a is left
        n, p_0 = 10.0 / 9.0, 10.0 / 9.0 * at / STIFFNESS
        return at * ((1.0 - film[0]) * p / p_0) ** n * (1.0 + (1.0 - film[1]) * DAMPING * rate / at)

    shares = {"gap": gap, "film_stiffness": film[0], "film_damping": film[1]}
    effect = hm.BearingClearance(**shares) if kind == "linear" else hm.HertzianClearance(**shares, reference_force=at)
    scene = jeffcott(speed=speed, weight=True, eccentricity=ECCENTRICITY).with_effect(effect, at="bearing")
    response = run(scene, 0.08, 5e-6, initial={"disc.y": -3e-5})
    push = unbalance(speed)
    law = linear if kind == "linear" else roller
    (wanted,) = reference(lambda t, z, v: [push(t) - 1j * MASS * EARTH + contact(z[0], v[0], gap, film, law)], response.times, [-3e-5j])
    depth = np.abs(wanted) - gap
    assert np.sum(np.diff(np.sign(depth)) != 0.0) >= 4  # it does touch and leave
    agrees(whirl_of(response), wanted, 3e-5)  # corners met inside a step h: (w h)^2/8 = 2e-6 of the motion at each
    force = response.values["bearing.force_x"] + 1j * response.values["bearing.force_y"]
    rate = response.values["disc.x_rate"] + 1j * response.values["disc.y_rate"]
    known = np.array([-contact(z, v, gap, film, law) for z, v in zip(whirl_of(response), rate, strict=True)])
    np.testing.assert_allclose(force, known, rtol=0.0, atol=1e-9 * np.max(np.abs(known)))


# a step of the damper inside a step h of the solver: (1 - d) D h/m of the speed, 1.2e-4; over a length there is none
@pytest.mark.parametrize(("rounding", "share"), [(1e-9, 1e-4), (2e-6, 1e-6)])
def test_unbalanced_rotor_in_a_damped_gap_moves_as_scipy_says(rounding: float, share: float) -> None:
    """The stiffness rises along a line from c - w to c + w, and so does the share of the damping from that of the film to all of it."""
    gap, film, speed = 1e-5, 0.2, 100.0
    effect = hm.DampedClearance(gap=gap, film_damping=film, rounding=rounding)
    scene = jeffcott(speed=speed, weight=True, eccentricity=ECCENTRICITY).with_effect(effect, at="bearing")
    response = run(scene, 0.08, 5e-6, initial={"disc.x": 2e-5, "disc.y": 4e-5})
    push = unbalance(speed)

    def force(z: complex, v: complex) -> complex:
        beyond = abs(z) - gap
        inside = min(max(beyond, -rounding), rounding) + rounding  # of the ramp
        approach = inside**2 / (4.0 * rounding) + max(beyond - rounding, 0.0)
        damper = (film + (1.0 - film) * inside / (2.0 * rounding)) * DAMPING
        return -STIFFNESS * approach * z / abs(z) - damper * v

    (wanted,) = reference(lambda t, z, v: [push(t) - 1j * MASS * EARTH + force(z[0], v[0])], response.times, [2e-5 + 4e-5j])
    assert np.sum(np.diff(np.sign(np.abs(wanted) - gap)) != 0.0) >= 4  # it does touch and leave
    agrees(whirl_of(response), wanted, share)


@pytest.mark.parametrize("effect", [hm.BearingClearance(gap=0.0), hm.DampedClearance(gap=0.0)], ids=lambda effect: type(effect).__name__)
def test_without_a_gap_it_is_the_bearing_also_one_that_pushes_across(effect: Effect) -> None:
    skew = hm.LinearBearing.isotropic(radial=STIFFNESS, damping=DAMPING, tilt=1e3, axial=1e4).replacing(
        stiffness_xy=0.2 * STIFFNESS, stiffness_yx=-0.2 * STIFFNESS, stiffness_yy=0.5 * STIFFNESS
    )
    scene = hm.Scene(
        name="skew",
        parts={"disc": hm.Rotor(mass=MASS, polar_inertia=0.04, transverse_inertia=0.0206), "bearing": hm.Bearing(law=skew)},
        connections=[("disc", "bearing")],
    )
    moved = {"disc.x": 1e-6, "disc.y": 1e-6}
    bare, changed = (one.network().accelerations(state(one, moved)) for one in (scene, scene.with_effect(effect, at="bearing")))
    assert bare["disc.x"] * MASS == pytest.approx(-1.2e-6 * STIFFNESS)
    for name, value in bare.items():
        assert changed[name] == pytest.approx(value, rel=1e-9, abs=1e-9), name


def test_a_contact_that_tilting_pulls_open_does_not_push() -> None:
    stiffness = np.diag([STIFFNESS, STIFFNESS, 1e4, 1e3, 1e3, 0.0])
    stiffness[0, 4] = stiffness[4, 0] = 2e5
    law = hm.LinearBearing.from_matrices(stiffness=stiffness, damping=np.zeros((6, 6)))
    scene = hm.Scene(
        name="tilting",
        parts={"disc": hm.Rotor(mass=MASS, polar_inertia=0.04, transverse_inertia=0.0206), "bearing": hm.Bearing(law=law)},
        connections=[("disc", "bearing")],
    ).with_effect(hm.HertzianClearance(gap=1e-6, film_damping=1.0, reference_force=100.0), at="bearing")
    found = scene.network().accelerations(state(scene, {"disc.x": 2e-6, "disc.theta": -1e-3}))
    assert found["disc.x"] == pytest.approx(0.0, abs=1e-9)


def test_rotor_rests_on_the_race_below_the_gap() -> None:
    """y = -(c + m g/k)."""
    scene = jeffcott(weight=True).with_effect(hm.BearingClearance(gap=1e-5), at="bearing")
    assert rotor_point(scene, 0.0).angles["disc.y"] == pytest.approx(-(1e-5 + MASS * EARTH / STIFFNESS), rel=1e-9)


def test_roller_clearance_has_the_stiffness_of_the_bearing_at_the_reference_force() -> None:
    """Under the load F_0 alone the slope dF/dy is k, by central differences."""
    load = MASS * EARTH
    scene = jeffcott(weight=True).with_effect(hm.HertzianClearance(gap=1e-5, reference_force=load), at="bearing")
    at = rotor_point(scene, 0.0)
    lines = LineMatrices(scene.network())
    row = lines.names.index("disc.y")
    system = lines.at(at.angles, at.speeds, at.states)
    assert system.stiffness[row, row] == pytest.approx(STIFFNESS, rel=1e-9)
    # N = A p^n with n N/p = k: p = n F_0/k
    assert at.angles["disc.y"] == pytest.approx(-(1e-5 + 10.0 / 9.0 * load / STIFFNESS), rel=1e-9)


# -- hardening ------------------------------------------------------------------------------------------


def test_free_vibration_on_a_cubic_spring_has_the_period_of_duffings_equation() -> None:
    """x = A cn(W t | n),  W^2 = (k + b A^2)/m,  n = b A^2/(2 (k + b A^2)),  T = 4 K(n)/W."""
    amplitude, cubic = 1e-4, 0.8 * STIFFNESS / 1e-8
    whole = STIFFNESS + cubic * amplitude**2
    period = 4.0 * ellipk(cubic * amplitude**2 / (2.0 * whole)) / math.sqrt(whole / MASS)
    scene = jeffcott(damping=0.0).with_effect(hm.BearingCubicStiffness(stiffness=cubic), at="bearing")
    response = run(scene, period, period / 400.0, initial={"disc.x": amplitude})
    assert response.values["disc.x"][-1] == pytest.approx(amplitude, rel=1e-6)
    assert abs(response.values["disc.x_rate"][-1]) < 1e-5 * amplitude * NATURAL


@pytest.mark.parametrize(
    ("effect", "factor"),
    [
        (hm.BearingCubicStiffness(stiffness=5e14), 1.0 + 5e14 * 1e-8 / STIFFNESS),
        (hm.BearingHardening(rate=2e4), math.sinh(2.0) / 2.0),
        (hm.BearingHardening(rate=1.0), 1.0 + 1e-8 / 6.0),
    ],
    ids=["cubic", "sinh", "sinh in its series"],
)
def test_circular_whirl_on_a_hardening_bearing_keeps_its_radius_at_its_own_frequency(effect: Effect, factor: float) -> None:
    """r = const where w^2 = k f(r)/m."""
    radius = 1e-4
    frequency = math.sqrt(STIFFNESS * factor / MASS)
    scene = jeffcott(damping=0.0).with_effect(effect, at="bearing")
    period = 2.0 * math.pi / frequency
    response = run(scene, 3.0 * period, period / 400.0, initial={"disc.x": radius, "disc.y_rate": frequency * radius})
    agrees(whirl_of(response), radius * np.exp(1j * frequency * response.times), 1e-6)


def test_cubic_by_axis_does_not_couple_x_and_y() -> None:
    scene = jeffcott().with_effect(hm.BearingCubicStiffness(stiffness=1e15, by_axis=True), at="bearing", name="cubic")
    moment = state(scene, {"disc.x": 2e-5, "disc.y": -1e-5})
    channels = {channel.name: channel.read(moment) for channel in scene.network().channels if channel.name.startswith("cubic.")}
    assert channels == pytest.approx({"cubic.force_x": 8.0, "cubic.force_y": -1.0}, rel=1e-12)


def state(scene: hm.Scene, angles: Mapping[str, float], speeds: Mapping[str, float] | None = None) -> Any:
    network = scene.network()
    zero = dict.fromkeys((body.name for body in network.bodies), 0.0)
    unknown = (set(angles) | set(speeds or {})) - set(zero)
    assert not unknown, unknown
    states = {item.name: item.initial for item in network.states}
    return network.moment(0.0, zero | dict(angles), zero | dict(speeds or {}), states)


# -- what is linear equals the part with other numbers ------------------------------------------------

HOUSING = hm.Housing(mass=3.0, stiffness_x=2e7, stiffness_y=3e7, damping_x=400.0, damping_y=500.0)


def with_law(**changes: float) -> hm.Bearing:
    law = hm.LinearBearing.isotropic(radial=STIFFNESS, damping=DAMPING, tilt=1e3, axial=1e4).replacing(**changes)
    return hm.Bearing(law=law, housing=HOUSING)


def anisotropic(share: float, angle: float) -> dict[str, float]:
    c, s = STIFFNESS * share * math.cos(2.0 * angle), STIFFNESS * share * math.sin(2.0 * angle)
    return {"stiffness_xx": STIFFNESS + c, "stiffness_yy": STIFFNESS - c, "stiffness_xy": s, "stiffness_yx": s}


@pytest.mark.parametrize(
    ("effect", "changed"),
    [
        (hm.BearingStiffnessChange(change=0.7), with_law(stiffness_xx=1.7 * STIFFNESS, stiffness_yy=1.7 * STIFFNESS)),
        (hm.BearingDampingChange(change=-0.8), with_law(damping_xx=0.2 * DAMPING, damping_yy=0.2 * DAMPING)),
        (hm.BearingAnisotropy(asymmetry=0.3, angle=0.4), with_law(**anisotropic(0.3, 0.4))),
        (hm.BearingCrossCoupling(stiffness=7e5, asymmetry=0.1), with_law(stiffness_xy=1.1 * 7e5, stiffness_yx=-0.9 * 7e5)),
        (
            hm.SupportStiffnessChange(change=-0.4),
            with_law().replacing(housing=HOUSING.replacing(stiffness_x=0.6 * 2e7, stiffness_y=0.6 * 3e7)),
        ),
        (hm.SupportStiffnessChange(change=-0.4, direction="y"), with_law().replacing(housing=HOUSING.replacing(stiffness_y=0.6 * 3e7))),
        (hm.SupportDampingChange(change=1.5), with_law().replacing(housing=HOUSING.replacing(damping_x=1000.0, damping_y=1250.0))),
        (hm.SupportMassChange(change=0.4), with_law().replacing(housing=HOUSING.replacing(mass=1.4 * 3.0))),
    ],
    ids=lambda item: type(item).__name__ if isinstance(item, Effect) else "",
)
@pytest.mark.parametrize("across", [False, True], ids=["housing", "counted across"])
def test_a_linear_change_is_the_part_with_other_numbers(effect: Effect, changed: hm.Bearing, across: bool) -> None:
    """Matrices at a spin, static deflection and the channel of the bearing's force; also with the housing counted across the bearing."""

    def on(part: hm.Bearing) -> hm.Scene:
        law = part.law
        if across:  # a law with forces of its own, here of no size
            law = hm.PowerBearing(power_stiffness_xx=1e-30, power_stiffness_yy=1e-30, **{name: value for name, value, _ in law.fields()})
        return jeffcott(weight=True, housing=HOUSING).replacing(bearing=part.replacing(law=law))

    with_effect, other = on(with_law()).with_effect(effect, at="bearing"), on(changed)
    systems = []
    for item in (with_effect, other):
        at = rotor_point(item, 300.0)
        systems.append((LineMatrices(item.network()).at(at.angles, at.speeds, at.states), at))
    (ours, here), (theirs, there) = systems
    for a, b in ((ours.mass, theirs.mass), (ours.damping, theirs.damping), (ours.stiffness, theirs.stiffness)):
        np.testing.assert_allclose(a, b, rtol=0.0, atol=1e-12 * np.max(np.abs(b)))
    assert [here.angles[name] for name in ours.names] == pytest.approx([there.angles[name] for name in ours.names], abs=1e-15)
    forces = []
    for item in (with_effect, other):
        place = "bearing.across_x" if across else "disc.x"
        moment = state(item, {place: 3e-6, f"{place[:-1]}y": -2e-6}, {place: 0.02})
        forces.append([c.read(moment) for c in item.network().channels if c.name in ("bearing.force_x", "bearing.force_y")])
    assert forces[0] == pytest.approx(forces[1], rel=1e-12)


# -- what feeds whirl -----------------------------------------------------------------------------------


@pytest.mark.parametrize("share", [0.5, 1.0, 2.0])
def test_cross_coupling_drives_forward_whirl_beyond_the_damping_of_the_bearing(share: float) -> None:
    """m s^2 + c s + k - i q = 0 for z = x + i y:  s = i w_k is a root where q = c w_k."""
    q = share * DAMPING * NATURAL
    scene = jeffcott().with_effect(hm.BearingCrossCoupling(stiffness=q), at="bearing")
    found = eigenvalues(steady(scene), ("disc.x", "disc.y"))
    forward = np.roots([MASS, DAMPING, STIFFNESS - 1j * q])
    wanted = np.concatenate([forward, forward.conj()])
    assert sorted(found.real) == pytest.approx(sorted(wanted.real), abs=1e-8 * NATURAL)
    assert np.sign(np.round(np.max(found.real), 6)) == np.sign(share - 1.0)


@pytest.mark.parametrize("spin", [600.0, -600.0])
@pytest.mark.parametrize("exponent", [1.0, 2.0])
def test_cross_coupling_that_grows_with_the_spin_turns_with_it(spin: float, exponent: float) -> None:
    """q (|w|/w_0)^n drives whirl in the sense of the spin: the root of m s^2 + c s + k -+ i q."""
    scene = jeffcott().with_effect(hm.BearingCrossCoupling(stiffness=2e6, exponent=exponent, reference_speed=1000.0), at="bearing")
    system = steady(scene, spin)
    at = np.ix_(*[[system.names.index(name) for name in ("disc.x", "disc.y")]] * 2)
    q = math.copysign(2e6 * 0.6**exponent, spin)
    np.testing.assert_allclose(system.stiffness[at], [[STIFFNESS, q], [-q, STIFFNESS]], rtol=1e-12)


@pytest.mark.parametrize(
    ("effect", "at"),
    [
        *((hm.BearingCrossCoupling(stiffness=1e5, exponent=exponent), "bearing") for exponent in (0.5, 1.0, 2.5)),
        (hm.PreslidingFriction(coulomb=1.0, drop=0.3, stribeck_exponent=0.75, presliding=1e-3), "disc"),
        (hm.LubricatedFriction(coulomb=1.0, drop=0.3, stribeck_exponent=0.75, smoothing_speed=0.1), "disc"),
    ],
)
def test_what_depends_on_a_power_of_the_speed_has_a_slope_at_standstill(effect: Effect, at: str) -> None:
    assert np.isfinite(hm.whirl_modes(jeffcott().with_effect(effect, at=at), 0.0).eigenvalues).all()


def test_cross_coupling_that_fades_leaves_a_circle_whose_radius_is_known() -> None:
    """q/(1 + f r^2) = c w_k on the limit cycle."""
    fading, q = 1e8, 2.0 * DAMPING * NATURAL
    scene = jeffcott().with_effect(hm.BearingCrossCoupling(stiffness=q, fading=fading), at="bearing")
    response = run(scene, 0.6, 2e-5, initial={"disc.x": 8e-5})
    # growth near the circle: rate c/(2 m) with a slope of order one, 0.6 s are 11 time constants
    assert response.values["disc.radial"][-1] == pytest.approx(1.0 / math.sqrt(fading), rel=1e-3)


LENGTH, DIAMETER = 0.8, 0.03
BENDING = E * math.pi * DIAMETER**4 / 64.0
SHAFT = 48.0 * BENDING / LENGTH**3
"""Stiffness of the middle of a pinned shaft [N/m]."""
PINS = 1e9
"""Stiffness of each pin [N/m]; in series 1/(2 k)."""
LINE = 1.0 / (1.0 / SHAFT + 0.5 / PINS)
CRITICAL = math.sqrt(LINE / DISC.mass)


def pinned(*, damping: float = 0.0, speed: float | None = None, weight: bool = False, **fields: Any) -> hm.Scene:
    """A disc in the middle of a massless shaft between two pins."""
    parts: dict[str, hm.Component] = {
        "left": bearing(PINS, mass=0.2, damping=1e3),
        "shaft_1": section(LENGTH / 2.0, diameter=DIAMETER, damping=damping, **fields),
        "disc": DISC,
        "shaft_2": section(LENGTH / 2.0, diameter=DIAMETER, damping=damping, **fields),
        "right": bearing(PINS, mass=0.2, damping=1e3, axial=1e6),
    }
    chain = ("left", "shaft_1", "disc", "shaft_2", "right")
    if speed is not None:
        parts, chain = {**parts, "drive": turning(speed)}, ("drive", *chain)
    if weight:
        parts["gravity"] = hm.Gravity()
    return line("pinned", parts, chain)


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_internal_damping_drives_whirl_beyond_the_speed_of_the_closed_form(share: float) -> None:
    """Outer and inner damping in proportion to stiffness: w = w_k (1 + c_a/c_i) (pins add w_k/k_pin, 1e-3)."""
    outer, inner = 3e-5, 2e-5
    scene = pinned(damping=outer).with_effect(hm.InternalDamping(time=inner), at="shaft_1")
    threshold = CRITICAL * (1.0 + outer / inner)
    found = eigenvalues(steady(scene, share * threshold))
    first = found[np.abs(np.abs(found.imag) - CRITICAL) < 0.05 * CRITICAL]
    assert np.sign(np.max(first.real)) == np.sign(share - 1.0)


def test_internal_damping_is_the_rotating_damping_of_the_shaft() -> None:
    """The same matrices at a speed, from other code; and all pieces, wherever it is put."""
    scene = pinned()
    for at in ("shaft_1", "shaft_2"):
        ours = steady(scene.with_effect(hm.InternalDamping(time=2e-5), at=at), 700.0)
        theirs = steady(pinned(rotating_damping=2e-5), 700.0)
        spins = [k for k, name in enumerate(ours.names) if "." not in name]
        lateral = [k for k in range(len(ours.names)) if k not in spins]
        for a, b in ((ours.damping, theirs.damping), (ours.stiffness, theirs.stiffness)):
            part = np.ix_(lateral, lateral)
            np.testing.assert_allclose(a[part], b[part], rtol=0.0, atol=1e-11 * np.max(np.abs(b[part])))
    alone = steady(scene.with_effect(hm.InternalDamping(time=2e-5, alone=True), at="shaft_2"), 700.0)
    k = alone.names.index("left.theta")
    assert alone.damping[k, k] == pytest.approx(steady(scene).damping[k, k], abs=1e-12)
    assert hm.InternalDamping.places(scene.network()) == ("shaft_1",)


# -- supports -------------------------------------------------------------------------------------------

STIFF = 1e13
"""Of a bearing that is to move with its housing [N/m]: adds k/k_b, 1e-6."""


def on_housing(stiffness_x: float, stiffness_y: float, *, mass: float = 2.0, damping: float = 0.0, weight: bool = False) -> hm.Scene:
    """Disc and housing as one mass on the foundation."""
    law = hm.LinearBearing.isotropic(radial=STIFF, damping=0.0, tilt=1e3, axial=1e4)
    housing = hm.Housing(mass=mass, stiffness_x=stiffness_x, stiffness_y=stiffness_y, damping_x=damping, damping_y=damping)
    scene = jeffcott(housing=housing, weight=weight)
    return scene.replacing(bearing=hm.Bearing(law=law, housing=housing))


@pytest.mark.parametrize("angle", [0.0, 0.6])
def test_tuned_mass_on_a_housing_splits_its_resonance_as_den_hartog_says(angle: float) -> None:
    """Tuned to w_0 with a mass ratio u:  (w/w_0)^2 = 1 + u/2 +- sqrt(u + u^2/4), whatever the direction of the springs."""
    whole, stiffness, share = MASS + 2.0, 5e6, 0.1
    alone = math.sqrt(stiffness / whole)
    effect = hm.HiddenModeSupport(mass=share * whole, natural_frequency=alone, damping_ratio=0.0, angle=angle)
    scene = on_housing(stiffness, stiffness).with_effect(effect, at="bearing", name="pipe")
    system = steady(scene)
    for key in "xy" if angle == 0.0 else ():
        found = frequencies(system, (f"disc.{key}", f"bearing.housing.{key}", f"pipe.{key}"))[:2]
        wanted = [alone * math.sqrt(1.0 + share / 2.0 + sign * math.sqrt(share + share**2 / 4.0)) for sign in (-1.0, 1.0)]
        assert list(found) == pytest.approx(wanted, rel=1e-5)
    names = [f"{place}.{key}" for place in ("disc", "bearing.housing", "pipe") for key in "xy"]
    found = frequencies(system, names)[:4]
    wanted = [alone * math.sqrt(1.0 + share / 2.0 + sign * math.sqrt(share + share**2 / 4.0)) for sign in (-1.0, -1.0, 1.0, 1.0)]
    assert list(found) == pytest.approx(wanted, rel=1e-5)


def test_hidden_mode_has_a_frequency_along_each_spring_and_hangs_by_its_weight() -> None:
    """With the housing all but fixed: f_1 along the angle, f_2 across; turned by 90 degrees it sags by g/f_1^2 in y."""
    effect = hm.HiddenModeSupport(mass=0.5, natural_frequency=300.0, ratio=1.5, damping_ratio=0.01, angle=math.pi / 2.0)
    scene = on_housing(1e12, 1e12, weight=True).with_effect(effect, at="bearing", name="pipe")
    system = steady(scene)
    assert [float(frequencies(system, (f"pipe.{key}",))[0]) for key in "xy"] == pytest.approx([450.0, 300.0], rel=1e-9)
    row = system.names.index("pipe.y")
    assert system.damping[row, row] == pytest.approx(2.0 * 0.01 * 0.5 * 300.0, rel=1e-9)
    assert rotor_point(scene, 0.0).angles["pipe.y"] == pytest.approx(-EARTH / 300.0**2, rel=1e-6)


def slid(y: float, low: float, high: float) -> float:
    return min(max(y, low), high)


@pytest.mark.parametrize(
    ("effect", "low", "high", "direction"),
    [
        (hm.Looseness(share=0.7, lift_off=-5e-6), -5e-6, math.inf, "y"),
        (hm.Looseness(share=0.7, lift_off=-5e-6, play=1e-5), -5e-6, 5e-6, "y"),
        (hm.LooseBolt(share=0.7, lift_off=-5e-6, play=1e-5), -5e-6, 5e-6, "y"),
        (hm.LooseFit(share=0.7, half_play=8e-6), -8e-6, 8e-6, "x"),
    ],
    ids=["lifts", "lifts to the bolt", "loose bolt", "sideways"],
)
def test_disc_on_a_loose_support_moves_as_scipy_says(effect: Effect, low: float, high: float, direction: str) -> None:
    """Disc and housing; the foundation pulls with k (y - a (b - b_0)), b being y between the corners.  Dropped in both directions."""
    stiffness, damping, between, rings = 5e6, 200.0, 2e7, 100.0
    law = hm.LinearBearing.isotropic(radial=between, damping=rings, tilt=1e3, axial=1e4)
    scene = on_housing(stiffness, stiffness, damping=damping, weight=True).replacing({"bearing.law": law}).with_effect(effect, at="bearing")
    response = run(scene, 0.05, 1e-5, initial={f"{place}.{key}": 3e-5 for place in ("disc", "bearing.housing") for key in "xy"})
    zero = 0.0 if isinstance(effect, hm.LooseFit) else low

    def forces(t: float, z: Any, v: Any) -> list[complex]:
        parts = {"x": float(z[1].real), "y": float(z[1].imag)}
        parts[direction] -= 0.7 * (slid(parts[direction], low, high) - zero)
        pull = between * (z[0] - z[1]) + rings * (v[0] - v[1])
        foundation = stiffness * complex(parts["x"], parts["y"]) + damping * v[1]
        return [-1j * MASS * EARTH - pull, -1j * 2.0 * EARTH + pull - foundation]

    wanted = reference(forces, response.times, [3e-5 + 3e-5j] * 2, masses=(MASS, 2.0))
    corners = np.imag(wanted[1]) if direction == "y" else np.real(wanted[1])
    assert np.sum(np.diff(np.sign(corners - low)) != 0.0) > 4
    # corners met inside a step: (w h)^2/8 = 1e-6 at each, w of both masses on the foundation
    agrees(whirl_of(response), wanted[0], 3e-5)
    agrees(whirl_of(response, "bearing.housing"), wanted[1], 3e-5)


# -- cracks ---------------------------------------------------------------------------------------------


def cracked(angle: float = -math.pi / 2.0, **fields: Any) -> hm.BreathingCrack:
    return hm.BreathingCrack(**({"compliance": 2e-6, "cross_share": 0.3, "position": 0.7, "angle": angle} | fields))


LEVER = 0.5 * 0.7 * LENGTH / 2.0
"""Bending moment at the crack per load in the middle: P/2 times the distance from the pin [m]."""


@pytest.mark.parametrize(
    "hinge",
    [cracked(0.0, always_open=True, cross_share=0.0), hm.Keyway(compliance=2e-6, position=0.7)],
    ids=["crack", "keyway"],
)
def test_what_is_always_open_is_a_hinge_between_two_beams(hinge: Effect) -> None:
    """Stiffness of the piece with the hinge in the plane of the front: two beams and a spring of 1/c between, condensed."""
    share, compliance = 0.7, 2e-6
    scene = pinned().with_effect(hinge, at="shaft_1", name="hinge")
    names = ("left.x", "left.theta", "disc.x", "disc.theta")
    whole, sound = (steady(item) for item in (scene, pinned()))
    at = np.ix_(*[[whole.names.index(name) for name in names]] * 2)
    found = whole.stiffness[at] - sound.stiffness[at]

    def beam(length: float) -> FloatArray:
        a, b, c = 12.0 / length**2, 6.0 / length, np.array([[4.0, 2.0], [2.0, 4.0]])
        return BENDING / length * np.array([[a, b, -a, b], [b, c[0, 0], -b, c[0, 1]], [-a, -b, a, -b], [b, c[1, 0], -b, c[1, 1]]])

    parts = np.zeros((7, 7))  # ends, then x and both slopes at the crack
    parts[np.ix_([0, 1, 4, 5], [0, 1, 4, 5])] += beam(share * LENGTH / 2.0)
    parts[np.ix_([4, 6, 2, 3], [4, 6, 2, 3])] += beam((1.0 - share) * LENGTH / 2.0)
    parts[np.ix_([5, 6], [5, 6])] += np.array([[1.0, -1.0], [-1.0, 1.0]]) / compliance
    inner = np.linalg.solve(parts[4:, 4:], parts[4:, :4])
    wanted = parts[:4, :4] - parts[:4, 4:] @ inner - beam(LENGTH / 2.0)
    np.testing.assert_allclose(found, wanted, rtol=0.0, atol=1e-9 * np.max(np.abs(wanted)))
    across = np.ix_(*[[whole.names.index(name) for name in ("left.y", "left.psi", "disc.y", "disc.psi")]] * 2)
    np.testing.assert_allclose(whole.stiffness[across], sound.stiffness[across], rtol=1e-12)


@pytest.mark.parametrize("angle", [-math.pi / 2.0, -0.4, 0.9, 2.0])
@pytest.mark.parametrize("steepness", [0.0, 3.0])
def test_crack_adds_the_deflection_of_its_opening_under_the_weight(angle: float, steepness: float) -> None:
    """Statically determinate: kinks g c M_1 and g e c M_2 times the lever, with M = m g times the lever."""
    scene = pinned(weight=True).with_effect(cracked(angle, steepness=steepness), at="shaft_1")
    found, sound = (rotor_point(item, 0.0).angles for item in (scene, pinned(weight=True)))
    down = -math.sin(angle)  # cosine to the weight
    opened = 0.5 * (1.0 + (math.tanh(steepness * down) / math.tanh(steepness) if steepness else down))
    kink = opened * 2e-6 * DISC.mass * EARTH * LEVER**2
    along, across = kink * math.sin(angle), 0.3 * kink * math.cos(angle)
    wanted = np.array([along * math.cos(angle) - across * math.sin(angle), along * math.sin(angle) + across * math.cos(angle)])
    # the sag is along -y: M_1 = -M sin(angle), M_2 = -M cos(angle)
    assert [found[f"disc.{key}"] - sound[f"disc.{key}"] for key in "xy"] == pytest.approx(list(-wanted), rel=1e-6, abs=1e-15)


def test_crack_that_follows_the_moment_shuts_where_it_is_pressed() -> None:
    """Down it is open, up it is shut, sideways half; M/M_c = 20."""
    moment = DISC.mass * EARTH * LEVER
    effect = hm.MomentCrack(compliance=2e-9, position=0.7, closing_moment=moment / 20.0)
    for angle, opened in ((-math.pi / 2.0, 1.0), (math.pi / 2.0, 0.0), (0.0, 0.5)):
        scene = pinned(weight=True).with_effect(effect.replacing(angle=angle), at="shaft_1", name="crack")
        at = rotor_point(scene, 0.0)
        channels = {channel.name: channel for channel in scene.network().channels}
        assert channels["crack.opening"].read(state(scene, at.angles)) == pytest.approx(opened, abs=1e-6)


@pytest.mark.parametrize(
    "effect",
    [
        cracked(0.4, always_open=True),
        cracked(0.4),
        cracked(0.4, steepness=4.0),
        hm.Keyway(compliance=2e-6, cross_share=0.3, position=0.7, angle=0.4),
        hm.ShaftStiffnessAsymmetry(asymmetry=0.1, angle=0.4, alone=True),
    ],
    ids=["open", "cosine", "steep", "keyway", "asymmetry"],
)
def test_forces_of_what_turns_with_the_shaft_have_a_potential(effect: Effect) -> None:
    """V = q.F(q, phi)/2 as F is linear in q; torque and forces are its derivatives, by differences."""
    scene = pinned(weight=True).with_effect(effect, at="shaft_1")
    (element,) = [e for e in scene.network().elements if isinstance(e, Coupling)]
    rng = np.random.default_rng(3)
    names = [f"{place}.{key}" for place in ("left", "disc") for key in ("x", "y", "psi", "theta")]
    q = dict(zip(names, 1e-4 * rng.normal(size=8), strict=True)) | {"left": 0.7, "disc": 0.7}
    spin = next(name for name in ("left", "disc") if name in {c for f in element.stretches.values() for c in f})

    def potential(angles: Mapping[str, float]) -> float:
        found = element.contribution(state(scene, angles))
        return -0.5 * sum(angles[name] * float(found[name]) for name in names)

    forces = element.contribution(state(scene, q))
    for name in (*names, spin):
        h = 1e-5 * (1.0 if name == spin else 1e-3)
        slope = (potential(q | {name: q[name] + h}) - potential(q | {name: q[name] - h})) / (2.0 * h)
        # differences of second order: 1e-10 of V/h
        assert float(forces[name]) == pytest.approx(-slope, rel=1e-6, abs=1e-9 * abs(potential(q)) / h)


def test_breathing_crack_shakes_a_jeffcott_rotor_as_gasch_says() -> None:
    """At half the critical speed: m q'' + K(phi) q + c q' = m g, K^-1 = H_0 + g L^2 R diag(c, e c) R^T, integrated by scipy.

    The 2x that builds up there is the crack's alone: the disc is balanced.
    """
    compliance, speed = 4e-6, 0.5 * CRITICAL
    damping = 2e-4
    scene = pinned(damping=damping, speed=speed, weight=True).with_effect(cracked(compliance=compliance, cross_share=0.2), at="shaft_1")
    rest = rotor_point(pinned(weight=True), 0.0).angles
    laterals = {name: value for name, value in rest.items() if "." in name}
    times_of_a_turn = 2.0 * math.pi / speed
    response = hm.simulate(
        scene, 12.0 * times_of_a_turn, solver=hm.Trapezoidal(step=times_of_a_turn / 400.0), progress=False, initial=laterals
    )
    assert set(response.lowering.values()) <= {"native", "symbolic"}

    def forces(t: float, z: Any, v: Any) -> list[complex]:
        beta = speed * t - math.pi / 2.0
        opened = 0.5 * (1.0 - math.sin(beta))
        turn = np.array([[math.cos(beta), -math.sin(beta)], [math.sin(beta), math.cos(beta)]])
        more = opened * LEVER**2 * compliance * turn @ np.diag([1.0, 0.2]) @ turn.T
        pull = np.linalg.solve(np.eye(2) / LINE + more, [z[0].real, z[0].imag])
        return [-complex(pull[0], pull[1]) - damping * SHAFT * v[0] - 1j * DISC.mass * EARTH]

    (wanted,) = reference(forces, response.times, [-1j * DISC.mass * EARTH / LINE], masses=(DISC.mass,))
    turn = slice(-401, -1)

    def order(z: npt.NDArray[np.complex128], number: int) -> complex:
        return complex(np.mean(z[turn] * np.exp(-1j * number * speed * response.times[turn])))

    for number in (1, 2):
        # on paper neither rings nor disc tilt or move with mass: some 3e-4 of the critical speed, over D = 0.03 of the 2x
        assert abs(order(whirl_of(response), number) - order(wanted, number)) < 0.02 * abs(order(wanted, number))
    assert abs(order(whirl_of(response), 2)) > 5.0 * abs(order(whirl_of(response), 1))


def test_asymmetric_shaft_under_its_weight_has_the_2x_of_the_closed_form_at_half_the_critical_speed() -> None:
    """z'' + 2 D w_0 z' + w_0^2 z + a w_0^2 exp(2 i w t) z* = -i g:  |z_2| = a (g/w_0^2)/(2 D) at w = w_0/2, to the order a."""
    asymmetry, damping = 0.002, 2e-4
    ratio = damping * SHAFT / (2.0 * DISC.mass * CRITICAL)
    scene = pinned(damping=damping, speed=0.5 * CRITICAL, weight=True)
    scene = scene.with_effect(hm.ShaftStiffnessAsymmetry(asymmetry=asymmetry), at="shaft_1")
    rest = {name: value for name, value in rotor_point(pinned(weight=True), 0.0).angles.items() if "." in name}
    turn = 4.0 * math.pi / CRITICAL
    response = hm.simulate(scene, 16.0 * turn, solver=hm.Trapezoidal(step=turn / 400.0), progress=False, initial=rest)
    last = slice(-401, -1)
    second = np.mean(whirl_of(response)[last] * np.exp(-1j * CRITICAL * response.times[last]))
    # what has not built up yet exp(-D w_0 t); the pins' share of the stiffness, 1e-3; the step, (2 pi/200)^2/12 of the frequency over 2 D
    left = math.exp(-ratio * CRITICAL * response.times[-1])
    assert abs(second) == pytest.approx(asymmetry * EARTH / CRITICAL**2 / (2.0 * ratio), rel=left + 0.01)


def test_laws_of_the_shaft_on_the_engine_equal_the_plain_functions() -> None:
    """They act on sums of coordinates there: symbolic and as Python callbacks on the coordinates themselves."""
    for effect in (cracked(), hm.InternalDamping(time=2e-5), hm.ShaftStiffnessAsymmetry(asymmetry=0.1)):
        scene = pinned(weight=True).with_effect(effect, at="shaft_1")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", LoweringWarning)
            runs = [
                hm.simulate(scene, 0.01, solver=solver, initial_speed=300.0, progress=False, lowering=how)
                for solver in (hm.RungeKutta4(step=1e-5), hm.Trapezoidal(step=1e-4))
                for how in ("symbolic", "python")
            ]
        for ours, theirs, limit in ((*runs[:2], 1e-10), (*runs[2:], 1e-7)):  # rounding; Newton's tolerance
            assert "python" not in ours.lowering.values()
            assert "python" in theirs.lowering.values()
            for kinds in (("x", "y"), ("x_rate", "y_rate"), ("psi", "theta"), ("psi_rate", "theta_rate")):
                names = [f"{place}.{kind}" for place in ("left", "disc", "right") for kind in kinds]
                scale = max(np.max(np.abs(theirs.values[name])) for name in names)
                for name in names:
                    np.testing.assert_allclose(ours.values[name], theirs.values[name], rtol=0.0, atol=limit * scale, err_msg=name)


# -- rub ------------------------------------------------------------------------------------------------

RUB: dict[str, float] = {"gap": 2e-5, "stiffness": 2e6, "friction": 0.15, "radius": 0.05, "centre_x": 3e-6, "centre_y": -8e-6}


def rub_force(
    z: complex, v: complex, spin: float, damping: float = 0.0, exponent: float = 1.0, loss: float = 0.0, coat_depth: float = math.inf
) -> tuple[complex, float]:
    """Force on the rotor and torque on its spin, in polar coordinates about the centre of the ring."""
    arm = z - complex(RUB["centre_x"], RUB["centre_y"])
    depth = abs(arm) - RUB["gap"]
    if depth <= 0.0:
        return 0.0, 0.0
    out = arm / abs(arm)
    local = v / out
    wall = RUB["stiffness"] * depth * (depth / 1e-5) ** (exponent - 1.0) / (1.0 + depth / coat_depth)
    normal = max(wall * (1.0 + loss * local.real) + damping * local.real, 0.0)
    friction = RUB["friction"] * normal * math.tanh((local.imag + RUB["radius"] * spin) / 0.05)
    return -(normal + 1j * friction) * out, -RUB["radius"] * friction


@pytest.mark.parametrize(
    ("law", "fields"),
    [
        (hm.Rub, {}),
        (hm.Rub, {"damping": 50.0}),
        (hm.Rub, {"exponent": 1.5}),
        (hm.DampedRub, {"damping": 50.0}),
        (hm.HertzianRub, {"exponent": 1.5, "loss": 1.5}),
        (hm.CoatedRub, {"damping": 50.0, "coat_depth": 6e-5}),
    ],
)
def test_rubbing_rotor_moves_as_scipy_says(law: type[hm.Rub], fields: dict[str, float]) -> None:
    speed = 600.0
    scene = jeffcott(speed=speed, weight=True, eccentricity=ECCENTRICITY).with_effect(law(**RUB, **fields), at="disc")
    response = run(scene, 0.06, 5e-6)
    push = unbalance(speed)

    def forces(t: float, z: Any, v: Any) -> list[complex]:
        return [push(t) - 1j * MASS * EARTH - STIFFNESS * z[0] - DAMPING * v[0] + rub_force(z[0], v[0], speed, **fields)[0]]

    (wanted,) = reference(forces, response.times, [0.0])
    depth = np.abs(wanted - complex(RUB["centre_x"], RUB["centre_y"])) - RUB["gap"]
    assert np.sum(np.diff(np.sign(depth)) != 0.0) > 6
    agrees(whirl_of(response), wanted, 3e-5)  # corners met inside a step: (w h)^2/8 = 2e-6 at each, w of rotor and wall


def test_rub_takes_friction_times_normal_force_times_sliding_speed_and_stores_the_rest() -> None:
    """Power = N r' + mu N v: what is taken of spin and whirl together."""
    scene = jeffcott().with_effect(hm.Rub(**RUB), at="disc", name="rub")
    (element,) = [e for e in scene.network().elements if isinstance(e, Coupling)]
    rng = np.random.default_rng(5)
    for _ in range(20):
        z, v = 4e-5 * complex(*rng.normal(size=2)), 0.05 * complex(*rng.normal(size=2))
        spin = 300.0 * float(rng.normal())
        moment = state(scene, {"disc.x": z.real, "disc.y": z.imag}, {"disc.x": v.real, "disc.y": v.imag, "disc": spin})
        force, torque = rub_force(z, v, spin)
        found = {name: float(value) for name, value in element.contribution(moment).items()}
        assert [found["disc.x"], found["disc.y"], found["disc"]] == pytest.approx([force.real, force.imag, torque], rel=1e-9, abs=1e-12)
        arm = z - complex(RUB["centre_x"], RUB["centre_y"])
        normal = RUB["stiffness"] * max(abs(arm) - RUB["gap"], 0.0)
        sliding = (v / (arm / abs(arm))).imag + RUB["radius"] * spin
        heat = RUB["friction"] * normal * sliding * math.tanh(sliding / 0.05)
        assert float(element.power(moment)) == pytest.approx(heat + normal * (v / (arm / abs(arm))).real, rel=1e-9, abs=1e-12)


# -- bad input ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: hm.BearingClearance(gap=-1e-6), "BearingClearance.gap = -1e-06 m: must be at least 0"),
        (lambda: hm.Rub(**(RUB | {"gap": 0.0})), "Rub.gap = 0 m: must be greater than 0"),
        (lambda: hm.HertzianRub(**RUB, loss=0.5, damping=50.0), "HertzianRub.damping = 50 N s/m would not be used. Give loss"),
        (lambda: hm.CoatedRub(**RUB, damping=50.0, coat_depth=1e-5, exponent=1.5), "CoatedRub.exponent = 1.5 would not be used"),
        (lambda: hm.Looseness(share=1.0), "Looseness.share = 1: must be at most 0.999"),
        (lambda: hm.Looseness(share=0.5, direction="up"), "Looseness.direction = 'up': must be one of x, y, both"),
        (lambda: hm.BreathingCrack(compliance=1e-6, position=1.2), "BreathingCrack.position = 1.2: must be at most 1"),
        (lambda: hm.BearingAnisotropy(asymmetry=1.0), "must be at most 0.95"),
    ],
)
def test_values_that_make_no_sense_are_refused(make: Callable[[], Effect], words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        make()


@pytest.mark.parametrize(
    ("effect", "at", "words"),
    [
        (hm.BearingClearance(gap=1e-6), "shaft_1", "BearingClearance acts on a bearing, and 'shaft_1' is none. Bearings: left, right"),
        (hm.BearingClearance(gap=1e-6), "lft", "No bearing 'lft'"),
        (hm.Looseness(share=0.5), "left", "acts on a bearing with a housing, and 'left' is none. Such bearings: none"),
        (hm.BreathingCrack(compliance=1e-6, position=0.5), "disc", "a piece of shaft that bends, and 'disc' is none. .*: shaft_1, shaft_2"),
        (hm.BreathingCrack(compliance=1e-6, position=0.5), "shaft_1", "no gravity acts across the axis"),
        (hm.InternalDamping(time=1e-6), "left", "InternalDamping acts on a piece of shaft"),
    ],
)
def test_places_that_do_not_fit_are_refused_with_those_that_do(effect: Effect, at: str, words: str) -> None:
    with pytest.raises(PlaceError, match=words):
        pinned().with_effect(effect, at=at)


def test_the_engine_linearises_laws_over_sums_of_coordinates_as_the_equations_say() -> None:
    """Stiffness and damping of a crack and of internal damping at a spin, by Exudyn's differences and by differentiation."""
    scene = pinned().with_effect(cracked(0.4, always_open=True), at="shaft_1").with_effect(hm.InternalDamping(time=2e-5), at="shaft_1")
    network = scene.network()
    assembly, lines = assemble(network), LineMatrices(network)
    assert max(len(copy) for copy in assembly.copies) > 1
    angles = dict.fromkeys(lines.names, 0.0)
    speeds = {body.name: 0.0 if body.lateral else 300.0 for body in network.bodies}
    wanted, found = lines.at(angles, speeds), linearise(assembly, angles=angles, speeds=speeds, states={})
    lateral = [name for name in lines.names if "." in name]
    ours = np.ix_(*[[found.bodies.index(name) for name in lateral]] * 2)
    theirs = np.ix_(*[[lines.names.index(name) for name in lateral]] * 2)
    # differences of a law that is linear in the displacements: rounding over the step, some 1e-7 of the largest entry of a row
    for one, other in ((found.stiffness, wanted.stiffness), (found.damping, wanted.damping)):
        assert np.all(np.abs(one[ours] - other[theirs]) <= 1e-5 * np.max(np.abs(other[theirs]), axis=1, keepdims=True) + 1e-9)
