"""RelaxingDamping against closed forms: a standard linear solid that turns under a disc in the middle of a pinned shaft."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.analysis.whirl.rotor_point import rotor_point
from hdrive_mbs.engine.assembly import LoweringWarning
from hdrive_mbs.errors import LawError
from tests.unit.rotor_pieces import DISC, EARTH
from tests.unit.test_rotor_law_effects import CRITICAL, LENGTH, LINE, PINS, SHAFT, agrees, pinned, whirl_of

TIME, RELAXATION = 2e-4, 3e-3
START = 1e-4


def share(frequency: complex, time: float = TIME, relaxation: float = RELAXATION) -> complex:
    """What the springs add to the stiffness, over it, for a motion exp(frequency t) of the turning shaft: (t/r) s/(s + 1/r)."""
    return time / relaxation * frequency / (frequency + 1.0 / relaxation)


def relaxing(scene: hm.Scene, time: float = TIME, relaxation: float = RELAXATION) -> hm.Scene:
    return scene.with_effect(hm.RelaxingDamping(time=time, relaxation_time=relaxation), at="shaft_1", name="it")


def simulated(scene: hm.Scene, duration: float, step: float, **start: object) -> hm.Response:
    with warnings.catch_warnings():
        warnings.simplefilter("error", LoweringWarning)
        return hm.simulate(scene, duration, solver=hm.Trapezoidal(step=step), progress=False, **start)


@pytest.mark.parametrize("speed", [60.0, 1500.0])
def test_turning_shaft_sags_sideways_and_brakes_the_drive(speed: float) -> None:
    """Kimball's test.  In the shaft weight turns at -w, and it yields by -i m g/(k (1 + share(-i w))); the drive covers the heat."""
    response = simulated(relaxing(pinned(damping=2e-3, speed=speed, weight=True)), 0.25, 1e-4)
    yielding = 1.0 / (SHAFT * (1.0 + share(-1j * speed)))
    bent = -1j * DISC.mass * EARTH * yielding
    found = complex(whirl_of(response)[-1] - whirl_of(response, "left")[-1])
    assert abs(found - bent) < 1e-8 * abs(bent)  # outer damping leaves exp(-c w_k^2/2 T) = 3e-11 of the start
    stretch = -1j * speed / (1.0 / RELAXATION - 1j * speed) * bent
    heat = SHAFT * TIME / RELAXATION * abs(stretch) ** 2 / RELAXATION
    # the drive's torque is read beside rigid steps of the spin: rounding of the whole line's torques, some 1e-5 of it at each sample
    assert np.mean(response.values["drive.torque"][-400:]) * speed == pytest.approx(heat, rel=1e-6)


def test_static_deflection_of_a_turning_line_has_the_sideways_sag_in_it() -> None:
    """Where the states come to rest, by solving and not by waiting: the same as the simulation's end."""
    scene = relaxing(pinned(damping=2e-3, speed=200.0, weight=True))
    response = simulated(scene, 0.25, 1e-4)
    point = rotor_point(scene, 200.0)
    for key in ("x", "y"):
        assert point.angles[f"disc.{key}"] == pytest.approx(response.values[f"disc.{key}"][-1], rel=1e-8)
    for name in ("it.shaft_1.0.x", "it.shaft_1.0.y", "it.shaft_2.1.y"):
        assert point.states[name] == pytest.approx(response.values[name][-1], rel=1e-6, abs=1e-15)


def let_go(scene: hm.Scene, duration: float, **start: float) -> hm.Response:
    """Whirl of a disc that was moved by 0.1 mm in x, the shaft bent by a force in its middle, and let go."""
    give = START * LINE / (2.0 * PINS)
    slope = 3.0 * (START - give) / LENGTH
    bent = {"disc.x": START, "left.x": give, "right.x": give, "left.theta": slope, "right.theta": -slope}
    # rings on the bent ends tilt and are gyroscopes, which the closed forms leave out
    still = {f"{ring}.{kind}_inertia": value for ring in ("left", "right") for kind, value in (("polar", 1e-8), ("transverse", 1e-7))}
    return simulated(scene.replacing(still), duration, 2e-5, initial=bent, **start)


@pytest.mark.parametrize("ratio", [0.5, 3.0])
def test_whirl_moves_with_the_poles_of_the_turning_solid(ratio: float) -> None:
    """m p^2 + k (1 + share(p - i w)) = 0: with z(0) = z_0, z'(0) = 0 and m z''(0) = -k z_0, as the springs begin without stretch."""
    speed, back = ratio * CRITICAL, 1.0 / RELAXATION
    # times (p - i w + 1/r)
    poles = np.roots(
        [DISC.mass, DISC.mass * (back - 1j * speed), LINE * (1.0 + TIME * back), LINE * (back - 1j * speed * (1.0 + TIME * back))]
    )
    given = np.array([START, 0.0, -LINE / DISC.mass * START])
    amplitudes = np.linalg.solve(np.vander(poles, 3, increasing=True).T, given)
    response = let_go(relaxing(pinned(speed=speed)), 0.12, initial_speed=speed)
    wanted = np.exp(np.outer(response.times, poles)) @ amplitudes
    # rings of 0.2 kg whose pins give way by k/(2 k_pin) = 4e-4 of the disc's motion; the solid is the shaft's, not the pins' (4e-4)
    agrees(whirl_of(response), wanted, 2e-3)
    assert np.max(np.abs(wanted - START * np.cos(np.sqrt(LINE / DISC.mass) * response.times))) > 0.3 * START  # it does something


def test_with_a_short_time_it_is_viscous() -> None:
    """The stretch is r (q' - w J q) to the order of r: 0.4 % of the damping with 1/r at 250 times the whirl."""
    speed, viscous = 3.0 * CRITICAL, 2e-5
    fast = let_go(relaxing(pinned(speed=speed), viscous, 6e-6), 0.06)
    plain = let_go(pinned(speed=speed).with_effect(hm.InternalDamping(time=viscous), at="shaft_1"), 0.06)
    agrees(whirl_of(fast), whirl_of(plain), 1e-3)


def test_springs_without_damping_are_not_there() -> None:
    agrees(
        whirl_of(let_go(relaxing(pinned(speed=900.0), 0.0), 0.02)), whirl_of(let_go(pinned(speed=900.0), 0.02)), 1e-7
    )  # Newton's tolerance


def test_what_whirl_and_spin_lose_becomes_heat() -> None:
    """The balance of energy closes to the integrator's error, with what the springs hold."""
    balance = hm.energy_balance(let_go(relaxing(pinned()), 0.05, initial_speed=900.0))
    assert balance.energy_error < 1e-6


def test_linearised_analyses_refuse_forces_that_remember() -> None:
    """They have no place for its states, and would give eigenvalues without it."""
    scene = relaxing(pinned(weight=True))
    for ask in (
        lambda: hm.whirl_modes(scene, 100.0),
        lambda: hm.campbell(scene, np.linspace(0.0, 500.0, 3)),
        lambda: hm.unbalance_response(scene.replacing({"disc.eccentricity": 1e-5}), np.linspace(10.0, 500.0, 3)),
    ):
        with pytest.raises(LawError, match=r"it\.shaft_1\.0: its force across the axis depends on the first-order state .*InternalDamping"):
            ask()
